//! Cells on both sides of a gap come in the right order where that is proven, and it is not proven where they do not.

use glam::DVec3;
use proptest::prelude::*;
use robust::orient3d;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};
use tetrascope_view::Viewpoint;

use super::certify::{coord, is_convex};
use super::tests::{Mesh, checkerboard, misordered, unit, viewpoint};
use super::*;
use crate::{BspTree, Guarantee};

/// The checkerboard without some of its cubes, its heights those of the whole one.
fn holed(n: u32, full: &[bool], jitter: impl Fn(usize) -> DVec3) -> (Mesh, Vec<f64>) {
    let mut mesh = checkerboard(n).map(|i, p| p + jitter(i));
    let parity = |i: usize| {
        let (side, i) = (n + 1, i as u32);
        f64::from((i % side + i / side % side + i / side / side) % 2)
    };
    let heights = mesh.positions.iter().enumerate().map(|(i, p)| p.length_squared() + 0.05 * parity(i)).collect();
    let mut cube = 0;
    mesh.tetrahedra.retain(|_| {
        cube += 1;
        full[(cube - 1) / 5 % full.len()]
    });
    (mesh, heights)
}

fn proven(mesh: &Mesh, heights: &[f64]) -> Power {
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    Power::with_heights(mesh.cells(), &adjacency, heights).prove_gaps(mesh.cells(), &adjacency, false)
}

/// Pairs with a gap between them that come in the wrong order, of how many.
fn misordered_gaps(mesh: &Mesh, viewpoint: Viewpoint, order: &[CellId]) -> (usize, usize) {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(i, cell)| place[cell.index()] = i);
    let (mut wrong, mut all) = (0, 0);
    let tree = BspTree::new(mesh.cells(), &FaceAdjacency::new(&mesh.tetrahedra));
    let report = tree.arrows(viewpoint, &mut |front, back| {
        all += 1;
        wrong += usize::from(place[front.index()] > place[back.index()]);
    });
    assert!(report.is_complete);
    (wrong, all)
}

/// Every cell at the boundary with every point of it.
fn unproven_by_all_pairs(mesh: &Mesh, heights: &[f64]) -> usize {
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let mut cells: Vec<CellId> = adjacency.boundary_faces().iter().map(|face| face.cell).collect();
    cells.dedup();
    let points: Vec<VertexId> = adjacency
        .boundary_faces()
        .iter()
        .flat_map(|face| {
            (0..4).filter(|&i| i != face.corner).map(|i| mesh.tetrahedra[face.cell.index()][usize::from(i)])
        })
        .collect();
    let is_below = |cell: &CellId| {
        let corners = mesh.tetrahedra[cell.index()];
        let [a, b, c, d] = corners.map(|v| mesh.positions[v.index()]);
        let is_far_below = orient3d(coord(a), coord(b), coord(c), coord(d)) < 0.0;
        let [p, q, r, s] = corners.map(|v| heights[v.index()]);
        points.iter().filter(|point| !corners.contains(point)).all(|point| {
            let positions = [a, b, c, d, mesh.positions[point.index()]];
            is_convex(positions, [p, q, r, s, heights[point.index()]], is_far_below)
        })
    };
    cells.iter().filter(|cell| !is_below(cell)).count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn holes_in_a_regular_mesh_are_seen_through(
        full in prop::collection::vec(any::<bool>(), 64), offsets in prop::collection::vec(unit(), 125),
        viewpoint in viewpoint(4), is_bent: bool,
    ) {
        // The slightest bend keeps the heights convex; without one, many cells have the same keys from many eyes.
        let (mesh, heights) = holed(4, &full, |i| if is_bent { offsets[i] * 0.005 } else { DVec3::ZERO });
        prop_assume!(!mesh.tetrahedra.is_empty());
        let power = proven(&mesh, &heights);
        prop_assert!(power.certificate().is_exact_across_gaps(), "{:?}", power.certificate());
        let order = power.order(mesh.cells(), viewpoint, &mesh.drawn());
        prop_assert_eq!(order.guarantee, Guarantee::Exact);
        prop_assert_eq!(misordered_gaps(&mesh, viewpoint, &order.front_to_back).0, 0);
        prop_assert_eq!(misordered(&mesh, viewpoint, &order.front_to_back), 0);
    }

    /// The tree of boxes finds what all pairs find, whatever the heights.
    #[test]
    fn boxes_lose_no_pair(
        full in prop::collection::vec(any::<bool>(), 27), noise in prop::collection::vec(-1.0..1.0_f64, 64),
        scale in prop_oneof![Just(0.0), Just(0.02), Just(0.3)],
    ) {
        let (mesh, mut heights) = holed(3, &full, |_| DVec3::ZERO);
        heights.iter_mut().zip(noise).for_each(|(height, noise)| *height += noise * scale);
        let power = proven(&mesh, &heights);
        let certificate = power.certificate();
        let expected = certificate.is_exact().then(|| unproven_by_all_pairs(&mesh, &heights));
        prop_assert_eq!(certificate.gaps, expected);
    }
}

/// Two cells apart, one of them lowered: each alone is in order, and the keys put the far one first.
#[test]
fn parts_at_different_levels_are_not_proven() {
    let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let far = corner.map(|p| p + DVec3::splat(3.0));
    let mesh = Mesh {
        positions: [corner, far].concat(),
        tetrahedra: vec![[0, 1, 2, 3].map(VertexId), [4, 5, 6, 7].map(VertexId)],
    };
    let view = Viewpoint::Eye(-DVec3::ONE);
    let level = |lift: f64| -> Vec<f64> {
        mesh.positions.iter().enumerate().map(|(i, p)| p.length_squared() + if i < 4 { 0.0 } else { lift }).collect()
    };
    let right = proven(&mesh, &level(0.0));
    let order = right.order(mesh.cells(), view, &mesh.drawn());
    assert_eq!((right.certificate().gaps, order.guarantee), (Some(0), Guarantee::Exact));
    assert_eq!(misordered_gaps(&mesh, view, &order.front_to_back), (0, 1));

    let wrong = proven(&mesh, &level(-1000.0));
    let certificate = wrong.certificate();
    assert!(certificate.is_exact() && !certificate.is_exact_across_gaps(), "{certificate:?}");
    let order = wrong.order(mesh.cells(), view, &mesh.drawn());
    assert_eq!(order.guarantee, Guarantee::Faces);
    let from_behind = Viewpoint::Eye(DVec3::splat(9.0));
    let behind = wrong.order(mesh.cells(), from_behind, &mesh.drawn());
    let wrongs = misordered_gaps(&mesh, view, &order.front_to_back).0
        + misordered_gaps(&mesh, from_behind, &behind.front_to_back).0;
    assert_eq!(wrongs, 1, "the lowered part is always last or always first");

    // Nothing is asked, nothing is said.
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let unasked = Power::with_heights(mesh.cells(), &adjacency, &level(0.0)).certificate();
    assert!(unasked.gaps.is_none() && !unasked.is_exact_across_gaps());
}

/// Parts that touch in points of their own at the same places: the gap has no width and the points no two levels.
#[test]
fn points_that_are_there_twice_are_not_proven() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let mesh = Mesh {
        positions: [0, 1, 2, 3, 1, 2, 3, 4].map(|i| positions[i]).to_vec(),
        tetrahedra: vec![[0, 1, 2, 3].map(VertexId), [4, 5, 6, 7].map(VertexId)],
    };
    let heights: Vec<f64> = mesh.positions.iter().map(|p| p.length_squared()).collect();
    assert_eq!(proven(&mesh, &heights).certificate().gaps, Some(2));
}
