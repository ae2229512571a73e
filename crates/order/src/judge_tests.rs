//! Right orders are acquitted, wrong ones caught, pair by pair.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_mesh::{TetMesh, VertexId, decompose, rings_sample};

use super::*;
use crate::OrderMethod;

fn all(count: usize) -> Vec<CellId> {
    (0..count as u32).map(CellId).collect()
}

fn direction() -> impl Strategy<Value = Viewpoint> {
    prop::array::uniform3(-1.0..1.0_f64)
        .prop_map(DVec3::from)
        .prop_filter("a direction", |d| d.length() > 0.1)
        .prop_map(|d| Viewpoint::Direction(d.normalize()))
}

/// A tetrahedron of the given size around the origin, moved.
fn simplices(places: &[(DVec3, f64)]) -> (Vec<DVec3>, Vec<[VertexId; 4]>) {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]].map(DVec3::from);
    let points = places.iter().flat_map(|&(at, size)| corners.map(|c| at + c * size)).collect();
    let cells = (0..places.len() as u32).map(|c| [0, 1, 2, 3].map(|v| VertexId(4 * c + v))).collect();
    (points, cells)
}

#[test]
fn two_neighbors_in_both_orders() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(1.0)];
    let tetrahedra = [[0, 1, 2, 3].map(VertexId), [1, 2, 3, 4].map(VertexId)];
    let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
    let visibility = MeshVisibility::new();
    let judge = |order: [u32; 2]| visibility.judge(cells, Viewpoint::Eye(DVec3::splat(9.0)), &order.map(CellId));
    let right = Verdict { pairs_of_faces: 1, gaps_complete: true, ..Verdict::default() };
    assert_eq!(judge([1, 0]), right);
    assert_eq!(judge([0, 1]), Verdict { misordered_faces: 1, ..right });
    // A cell alone has nobody to be wrong with; seen edge-on no pair is judged.
    let visibility = MeshVisibility::new();
    let alone = visibility.judge(cells, Viewpoint::Eye(DVec3::splat(9.0)), &[CellId(0)]);
    assert_eq!(alone.pairs_of_faces, 0);
    let edge_on = Viewpoint::Direction(DVec3::new(1.0, -1.0, 0.0).normalize());
    assert_eq!(visibility.judge(cells, edge_on, &all(2)).pairs_of_faces, 0);
}

#[test]
fn parts_in_a_row_are_judged_across_the_gaps() {
    let (points, tetrahedra) = simplices(&[(DVec3::ZERO, 1.0), (DVec3::X * 5.0, 1.0), (DVec3::X * 10.0, 1.0)]);
    let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
    let visibility = MeshVisibility::new();
    let relations = visibility.relations(cells, Viewpoint::Direction(DVec3::X));
    let judge = |order: [u32; 3]| relations.judge(&order.map(CellId));
    let right = Verdict { pairs_across_gaps: 3, gaps_complete: true, ..Verdict::default() };
    assert_eq!(judge([0, 1, 2]), right);
    assert_eq!(judge([1, 0, 2]), Verdict { misordered_gaps: 1, ..right });
    assert_eq!(judge([2, 1, 0]).misordered(), 3);
    // In pieces: the first of cell 1 stands in front of cell 0, the second behind it, so that nothing is known to be wrong.
    assert_eq!(relations.judge(&[1, 0, 1, 2].map(CellId)), right);
    assert_eq!(relations.judge(&[1, 1, 0, 2].map(CellId)).misordered_gaps, 1);
}

#[test]
fn pairs_of_a_ring_are_counted_apart() {
    // 0 before 1 before 2 before 0 across gaps, and 3 behind them all by a face of 2.
    const NONE: u32 = u32::MAX;
    let table = [[NONE; 4], [NONE; 4], [3, NONE, NONE, NONE], [2, NONE, NONE, NONE]];
    let nearer = vec![0, 0, 0, 1];
    let arrows: Vec<_> = [(0, 1), (1, 2), (2, 0), (0, 3)].map(|(a, b)| (CellId(a), CellId(b))).to_vec();
    let rings = rings(&nearer, &table, &arrows);
    assert_eq!(rings, [[0, 1, 2].map(CellId)]);
    let ring_of = vec![1, 1, 1, 0];
    let relations = Relations { table: &table, nearer, arrows, gaps_complete: true, rings, ring_of };
    let expected = Verdict {
        pairs_of_faces: 1,
        pairs_across_gaps: 1,
        gaps_complete: true,
        in_rings: 3,
        misordered_in_rings: 1,
        ..Verdict::default()
    };
    assert_eq!(relations.judge(&all(4)), expected);
    let turned = relations.judge(&[3, 2, 1, 0].map(CellId));
    assert_eq!((turned.misordered_faces, turned.misordered_gaps, turned.misordered_in_rings), (1, 1, 2));
}

proptest! {
    /// Two rings that share a cell are one; every other cell is in none.
    #[test]
    fn rings_are_what_leads_back(edges in prop::collection::vec((0..12_u32, 0..12_u32), 0..30)) {
        let edges: Vec<_> = edges.into_iter().filter(|(a, b)| a != b).map(|(a, b)| (CellId(a), CellId(b))).collect();
        let found = rings(&[0; 12], &[[u32::MAX; 4]; 12], &edges);
        // By the closure of "leads to".
        let mut leads = [[false; 12]; 12];
        for (a, b) in &edges {
            leads[a.index()][b.index()] = true;
        }
        for k in 0..12 {
            for i in 0..12 {
                for j in 0..12 {
                    leads[i][j] |= leads[i][k] && leads[k][j];
                }
            }
        }
        let together = |i: usize, j: usize| leads[i][j] && leads[j][i];
        let mut expected: Vec<Vec<CellId>> = (0..12)
            .filter(|&i| together(i, i) && (0..i).all(|j| !together(i, j)))
            .map(|i| (i..12).filter(|&j| together(i, j)).map(|j| CellId(j as u32)).collect())
            .collect();
        expected.retain(|ring| ring.len() > 1);
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn the_order_of_a_convex_mesh_is_acquitted_and_one_swap_is_caught(view in direction(), at in 0..1000_usize) {
        let mesh: TetMesh = decompose(&rings_sample(4)).unwrap().mesh;
        let cells: Cells<'_> = (&mesh).into();
        let visibility = MeshVisibility::new();
        let mut order = visibility.prepare(cells, OrderMethod::Mpvo).order(cells, view, &all(cells.tetrahedra.len()));
        let relations = visibility.relations(cells, view);
        let verdict = relations.judge(&order.front_to_back);
        prop_assert!(verdict.pairs_of_faces > 500);
        prop_assert_eq!((verdict.misordered_faces, verdict.in_rings), (0, 0));
        // A cell changes places with a neighbor behind it: that pair at least is wrong now.
        let rank = |cell: CellId, order: &[CellId]| order.iter().position(|&c| c == cell).unwrap();
        let place = at % order.front_to_back.len();
        let cell = order.front_to_back[place];
        let nearer = relations.nearer[cell.index()];
        prop_assume!(nearer != 0);
        let other = neighbor(relations.table, cell, nearer.trailing_zeros());
        let there = rank(other, &order.front_to_back);
        order.front_to_back.swap(place, there);
        prop_assert!(relations.judge(&order.front_to_back).misordered_faces > 0);
    }

    /// Parts far enough apart that the distance of their middles orders them.
    #[test]
    fn separate_parts_by_distance_are_acquitted(view in direction(), places in prop::collection::vec((-2..3_i32, -2..3_i32, -2..3_i32), 2..20)) {
        let mut places = places;
        places.sort_unstable();
        places.dedup();
        let places: Vec<_> = places
            .into_iter()
            .map(|(x, y, z)| (DVec3::new(x.into(), y.into(), z.into()), 0.25))
            .collect();
        let (points, tetrahedra) = simplices(&places);
        let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
        // Balls of radius 0.25 √3 < 1/2 about the places do not meet, so parallel rays meet them by the depth of the places.
        let Viewpoint::Direction(along) = view else { panic!("a direction") };
        let mut order = all(places.len());
        order.sort_by(|a, b| places[a.index()].0.dot(along).total_cmp(&places[b.index()].0.dot(along)));
        let visibility = MeshVisibility::new();
        let relations = visibility.relations(cells, view);
        let verdict = relations.judge(&order);
        prop_assert_eq!((verdict.misordered(), verdict.in_rings, verdict.gaps_complete), (0, 0, true));
        order.reverse();
        let turned = relations.judge(&order);
        prop_assert_eq!(turned.misordered_gaps, turned.pairs_across_gaps);
    }
}
