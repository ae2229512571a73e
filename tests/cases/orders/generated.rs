//! Made meshes: along random rays, every cell comes before all that the ray meets later.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope::mesh::CellId;
use tetrascope::order::{Cells, Guarantee, MeshVisibility, OrderMethod};
use tetrascope::view::Viewpoint;
use tetrascope_tests::meshes::Random;
use tetrascope_tests::shapes::{self, Shape};

use super::rays::judge_by_rays;
use super::views::hundred;

/// Rays for each viewpoint.
const RAYS: usize = 24;

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
    #![proptest_config(ProptestConfig { cases: 3, ..ProptestConfig::default() })]

    /// A hundred views of each shape for every method that promises to be right there.
    #[test]
    fn rays_meet_cells_in_order(seed in 0..1_000_000_u64) {
        for shape in &shapes::all(seed) {
            check_promises(shape, seed)?;
        }
    }
}

fn check_promises(shape: &Shape, seed: u64) -> Result<(), TestCaseError> {
    let (cells, name) = (shape.cells(), shape.name);
    let drawn: Vec<CellId> = (0..shape.tetrahedra.len() as u32).map(CellId).collect();
    let visibility = MeshVisibility::new();
    prop_assert_eq!(visibility.is_convex(cells), shape.is_convex, "{}", name);
    prop_assert!(!visibility.overlaps(cells).any(), "{}", name);
    let methods = promised(shape, &visibility, cells);
    if shape.is_delaunay {
        prop_assert!(visibility.quick_certificate(cells).is_exact_across_gaps());
        prop_assert!(methods.contains(&OrderMethod::Power));
    }
    // One for all views, so that orders which are repaired from view to view are.
    let orders: Vec<_> = methods.iter().map(|&method| (method, visibility.prepare(cells, method))).collect();
    let mut random = Random::new(seed ^ 0x0bde);
    let mut pairs = 0;
    for viewpoint in views_of(shape, &mut random) {
        for (method, order) in &orders {
            let order = order.order(cells, viewpoint, &drawn);
            let mut listed = order.front_to_back.clone();
            listed.sort_unstable();
            prop_assert_eq!(&listed, &drawn, "{}, {}: not a permutation", name, method);
            prop_assert_eq!(order.guarantee, Guarantee::Exact, "{}, {}", name, method);
            let found = judge_by_rays(cells, 1.0, viewpoint, &order, RAYS, &mut random);
            prop_assert_eq!(found.wrong, 0, "{}, {}, {:?}: {:?}", name, method, viewpoint, found);
            pairs += found.pairs;

            let verdict = visibility.judge(cells, viewpoint, &order.front_to_back);
            prop_assert_eq!(verdict.misordered(), 0, "{}, {}, {:?}: {:?}", name, method, viewpoint, verdict);
        }
    }
    prop_assert!(pairs > 100 * methods.len(), "{name}: rays meet {pairs} pairs only");
    Ok(())
}

/// What the orders without a promise get wrong on these shapes is what the judges are for.
#[test]
fn judges_find_what_centroids_get_wrong() {
    let mut by_rays = Vec::new();
    for seed in 0..3 {
        for shape in shapes::all(seed) {
            let cells = shape.cells();
            let drawn: Vec<CellId> = (0..shape.tetrahedra.len() as u32).map(CellId).collect();
            let visibility = MeshVisibility::new();
            let mut random = Random::new(seed);
            let (mut pairs, mut wrong, mut judged) = (0, 0, 0);
            for viewpoint in views_of(&shape, &mut random) {
                let order = visibility.prepare(cells, OrderMethod::Centroid).order(cells, viewpoint, &drawn);
                let found = judge_by_rays(cells, 1.0, viewpoint, &order, RAYS, &mut random);
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
