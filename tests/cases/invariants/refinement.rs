//! Splitting cells at points inside, on faces and on edges, with the interpolated scalar, changes no picture.
//!
//! The segments of a ray are cut at other places and add up to the same, so everything along one ray is unchanged. What may
//! change is the order of whole cells by their centroids: the fast renderer's pictures are compared where the order has no
//! influence (absorption, emission, one color), the reference, which sorts along each ray, with all colors.
//!
//! Tolerance 1e-5: twice the error that each picture has on its own (see `chords`), and cells of a tenth of the size.

use tetrascope::{Integration, OpticalModel, OrderMethod, Plan, View};
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, Worst, largest, mean_opacity, plan, random_camera};

/// Peaks, slopes and a step; extinction up to 5.
const EXTINCTION: &[[f64; 2]] =
    &[[-1.5, 0.0], [-0.6, 1.5], [-0.55, 5.0], [-0.5, 0.5], [0.2, 0.5], [0.2, 2.5], [0.9, 0.0], [1.3, 3.0]];
const COLOR: &[[f64; 4]] = &[[-1.0, 0.9, 0.1, 0.2], [0.0, 0.1, 0.8, 0.3], [0.0, 0.2, 0.3, 1.0], [1.2, 1.0, 0.9, 0.1]];
const ONE_COLOR: &[[f64; 4]] = &[[0.0, 0.9, 0.5, 0.2]];
/// Without a corner in any cell's range the mean scalar has the mean extinction, so that even `average` is exact in opacity.
const RAMP: &[[f64; 2]] = &[[-3.0, 0.0], [3.0, 2.0]];

/// Splits `count` times in one of three ways: edges (2 parents), faces (3) or cells (4).
fn refined(tets: &Tets, parents: usize, count: usize, random: &mut Random) -> Tets {
    let mut fine = tets.clone();
    for _ in 0..count {
        let mut corners = fine.cells[(random.unit() * fine.cells.len() as f64) as usize];
        // Which of the corners: any.
        for end in (1..4).rev() {
            corners.swap(end, (random.unit() * (end + 1) as f64) as usize);
        }
        let mut shares: Vec<f64> = (0..parents).map(|_| random.between(0.2, 1.0)).collect();
        if parents == 2 {
            shares.fill(1.0);
        }
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|s| *s /= sum);
        fine.split(&corners[..parents], &shares);
    }
    fine
}

/// What to draw with which renderers, so that no order of cells can be seen.
pub(super) fn order_free(view: View) -> Vec<(Plan, Vec<Renderer>)> {
    let with_model = |color, extinction, model| {
        let mut plan = plan(view, color, extinction);
        plan.model = model;
        if model.is_commutative() {
            plan.order = OrderMethod::None;
        }
        plan
    };
    vec![
        (with_model(ONE_COLOR, EXTINCTION, OpticalModel::DensityEmitter), Renderer::EXACT.to_vec()),
        (with_model(COLOR, EXTINCTION, OpticalModel::Emission), Renderer::EXACT.to_vec()),
        (with_model(COLOR, EXTINCTION, OpticalModel::Absorption), Renderer::EXACT.to_vec()),
        (with_model(COLOR, EXTINCTION, OpticalModel::DensityEmitter), vec![Renderer::Reference(Integration::Exact)]),
        (with_model(COLOR, EXTINCTION, OpticalModel::Emitter), vec![Renderer::Reference(Integration::Exact)]),
    ]
}

#[test]
fn splitting_cells_changes_nothing() {
    let mut worst = Worst::new("refinement", 1e-5);
    for seed in 0..5 {
        let tets = Tets::block(2, seed + 500);
        let mesh = tets.mesh();
        let mut random = Random::new(seed);
        for is_perspective in [false, true] {
            let camera = random_camera(&mut random, glam::DVec3::ZERO, 1.0, is_perspective);
            let view = View::new(&camera, 40, 40).unwrap();
            for (parents, name) in [(4, "inside"), (3, "on faces"), (2, "on edges")] {
                let fine = refined(&tets, parents, 25, &mut random);
                assert!(fine.cells.len() >= tets.cells.len() + 25);
                let fine_mesh = fine.mesh();
                let ramp = (
                    plan(view, ONE_COLOR, RAMP),
                    vec![Renderer::Fast(Integration::Average), Renderer::Reference(Integration::Average)],
                );
                for (plan, renderers) in order_free(view).into_iter().chain([ramp]) {
                    for renderer in renderers {
                        let coarse = renderer.draw(&mesh, &tets.scalars, &plan);
                        let split = renderer.draw(&fine_mesh, &fine.scalars, &plan);
                        assert!(plan.model == OpticalModel::Emission || mean_opacity(&coarse) > 0.1);
                        worst.note(largest(&coarse, &split, 0..4), || {
                            format!("seed {seed}, {name}, perspective {is_perspective}, {renderer:?}, {}", plan.model)
                        });
                    }
                }
            }
        }
    }
    worst.finish();
}

/// The same test where it must fail: with scalars that are not the interpolated ones the pictures differ.
#[test]
fn splitting_with_another_scalar_changes_the_picture() {
    let tets = Tets::block(2, 600);
    let view = View::new(&random_camera(&mut Random::new(1), glam::DVec3::ZERO, 1.0, true), 40, 40).unwrap();
    let mut fine = refined(&tets, 4, 5, &mut Random::new(2));
    let first_new = tets.points.len();
    fine.scalars[first_new..].iter_mut().for_each(|s| *s += 0.1);
    let plan = plan(view, ONE_COLOR, EXTINCTION);
    for renderer in Renderer::EXACT {
        let coarse = renderer.draw(&tets.mesh(), &tets.scalars, &plan);
        let split = renderer.draw(&fine.mesh(), &fine.scalars, &plan);
        assert!(largest(&coarse, &split, 0..4) > 1e-3);
    }
}
