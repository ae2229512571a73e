//! Made meshes: along random rays, every cell comes before all that the ray meets later.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope::mesh::CellId;
use tetrascope::order::{Cells, Guarantee, MeshVisibility, Order, OrderMethod};
use tetrascope::view::Viewpoint;
use tetrascope_tests::meshes::Random;
use tetrascope_tests::shapes::{self, Shape, along_ray};

use super::views::hundred;

/// Rays for each viewpoint.
const RAYS: usize = 24;

/// Segments shorter than this, relative to the shapes' size of about 1, judge nobody: rounding in [`along_ray`] may put them
/// on either side of their neighbors.
const SHORTEST: f64 = 1e-7;

/// Pairs along rays, and how many of them come in the wrong order.
#[derive(Debug, Default)]
struct Found {
    pairs: usize,
    wrong: usize,
    /// Pairs whose two cells are in one ring: no order has them all right.
    in_rings: usize,
}

/// Neighbors along rays through random cells. What a ray meets later than the next comes later too if all neighbors are right.
fn judge_by_rays(shape: &Shape, viewpoint: Viewpoint, order: &Order, random: &mut Random) -> Found {
    let mut rank = vec![0; shape.tetrahedra.len()];
    for (place, cell) in order.front_to_back.iter().enumerate() {
        rank[cell.index()] = place;
    }
    let mut ring_of = vec![usize::MAX; shape.tetrahedra.len()];
    for (ring, cells) in order.cycles.iter().enumerate() {
        cells.iter().for_each(|cell| ring_of[cell.index()] = ring);
    }
    let mut found = Found::default();
    for _ in 0..RAYS {
        let corners = shape.corners((random.unit() * shape.tetrahedra.len() as f64) as usize);
        let shares = corners.map(|_| random.between(0.05, 1.0));
        let total: f64 = shares.iter().sum();
        let aim: DVec3 = corners.iter().zip(shares).map(|(&p, w)| p * (w / total)).sum();
        let (origin, direction, from) = match viewpoint {
            Viewpoint::Eye(eye) => (eye, (aim - eye).normalize(), 0.0),
            Viewpoint::Direction(direction) => (aim, direction, f64::NEG_INFINITY),
        };
        if !direction.is_finite() {
            continue;
        }
        for pair in along_ray(shape, origin, direction, from, SHORTEST).windows(2) {
            let [(_, front), (_, back)] = [pair[0], pair[1]];
            found.pairs += 1;
            if ring_of[front] != usize::MAX && ring_of[front] == ring_of[back] {
                found.in_rings += 1;
            } else {
                found.wrong += usize::from(rank[front] > rank[back]);
            }
        }
    }
    found
}

fn views_of(shape: &Shape, random: &mut Random) -> Vec<Viewpoint> {
    let cells = shape.tetrahedra.len() as f64;
    hundred(random, DVec3::ZERO, 1.0, |random| shape.corners((random.unit() * cells) as usize))
}

/// The methods that promise to be right for a shape.
fn promised(shape: &Shape, visibility: &MeshVisibility, cells: Cells<'_>) -> Vec<OrderMethod> {
    let mut methods = vec![OrderMethod::BspXmpvo];
    if shape.is_convex {
        methods.push(OrderMethod::Mpvo);
    }
    if visibility.power(cells).certificate().is_exact_across_gaps() {
        methods.push(OrderMethod::Power);
    }
    methods
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    /// A hundred views of each shape for every method that promises to be right there.
    #[test]
    fn rays_meet_cells_in_order(seed in 0..1_000_000_u64, kind in 0..7_usize) {
        let shape = &shapes::all(seed)[kind];
        let cells = Cells { positions: &shape.points, tetrahedra: &shape.tetrahedra };
        let drawn: Vec<CellId> = (0..shape.tetrahedra.len() as u32).map(CellId).collect();
        let visibility = MeshVisibility::new();
        prop_assert_eq!(visibility.is_convex(cells), shape.is_convex, "{}", shape.name);
        prop_assert_eq!(visibility.piercing(cells).pairs, 0, "{}", shape.name);
        let methods = promised(shape, &visibility, cells);
        if shape.is_delaunay {
            prop_assert!(visibility.quick_certificate(cells).is_exact_across_gaps());
            prop_assert!(methods.contains(&OrderMethod::Power));
        }
        let mut random = Random::new(seed ^ 0x0bde);
        let mut pairs = 0;
        for viewpoint in views_of(shape, &mut random) {
            for &method in &methods {
                let order = visibility.prepare(cells, method).order(cells, viewpoint, &drawn);
                let mut listed = order.front_to_back.clone();
                listed.sort_unstable();
                prop_assert_eq!(&listed, &drawn, "{}, {}: not a permutation", shape.name, method);
                prop_assert_eq!(order.guarantee, Guarantee::Exact, "{}, {}", shape.name, method);
                let found = judge_by_rays(shape, viewpoint, &order, &mut random);
                prop_assert_eq!(found.wrong, 0, "{}, {}, {:?}: {:?}", shape.name, method, viewpoint, found);
                pairs += found.pairs;

                let verdict = visibility.judge(cells, viewpoint, &order.front_to_back);
                prop_assert_eq!((verdict.misordered_faces, verdict.misordered_gaps), (0, 0), "{}, {}, {:?}: {:?}", shape.name, method, viewpoint, verdict);
            }
        }
        prop_assert!(pairs > 100 * methods.len(), "{}: rays meet {pairs} pairs only", shape.name);
    }
}

/// What the orders without a promise get wrong on these shapes is what the judges are for.
#[test]
fn judges_find_what_centroids_get_wrong() {
    let mut by_rays = Vec::new();
    for seed in 0..3 {
        for shape in shapes::all(seed) {
            let cells = Cells { positions: &shape.points, tetrahedra: &shape.tetrahedra };
            let drawn: Vec<CellId> = (0..shape.tetrahedra.len() as u32).map(CellId).collect();
            let visibility = MeshVisibility::new();
            let mut random = Random::new(seed);
            let (mut pairs, mut wrong, mut judged) = (0, 0, 0);
            for viewpoint in views_of(&shape, &mut random) {
                let order = visibility.prepare(cells, OrderMethod::Centroid).order(cells, viewpoint, &drawn);
                let found = judge_by_rays(&shape, viewpoint, &order, &mut random);
                let verdict = visibility.judge(cells, viewpoint, &order.front_to_back);
                (pairs, wrong) = (pairs + found.pairs, wrong + found.wrong);
                judged += verdict.misordered_faces + verdict.misordered_gaps;
            }
            println!("{}, seed {seed}: centroid has {wrong} of {pairs} pairs wrong along rays", shape.name);
            assert_eq!(wrong > 0, judged > 0, "{}: the judges do not agree", shape.name);
            by_rays.push(wrong);
        }
    }
    assert!(by_rays.iter().filter(|&&wrong| wrong > 0).count() > by_rays.len() / 2, "{by_rays:?}");
}
