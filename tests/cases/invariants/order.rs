//! Opacity needs no order: it is one minus a product of transmittances.

use glam::DVec3;
use tetrascope::{Camera, Integration, OpticalModel, OrderMethod, Plan, Projection, View};
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, Worst, largest, mean_opacity, plan, random_camera};

const EXTINCTION: &[[f64; 2]] = &[[-1.0, 0.0], [-0.2, 3.0], [0.1, 0.2], [1.0, 2.0]];
const COLOR: &[[f64; 4]] = &[[-1.0, 0.9, 0.1, 0.2], [0.0, 0.1, 0.8, 0.3], [1.2, 1.0, 0.9, 0.1]];

/// Tolerance 2e-6: some 30 products of numbers below one, each rounded to half an ulp of 6e-8, in another order.
#[test]
fn order_has_no_part_in_opacity() {
    for integration in Integration::ALL {
        let mut worst = Worst::new(format!("opacity in four orders, {integration}"), 2e-6);
        let mut color_changes = 0.0_f64;
        for seed in 0..6 {
            let tets = Tets::block(5, seed + 1300);
            let mesh = tets.mesh();
            let camera = random_camera(&mut Random::new(seed), DVec3::ZERO, 1.0, seed % 2 == 0);
            let plan = plan(View::new(&camera, 48, 40).unwrap(), COLOR, EXTINCTION);
            let draw = |order| Renderer::Fast(integration).draw(&mesh, &tets.scalars, &Plan { order, ..plan.clone() });
            let sorted = draw(OrderMethod::Centroid);
            assert!(mean_opacity(&sorted) > 0.1);
            for order in [OrderMethod::None, OrderMethod::Bucket { slabs: 20 }, OrderMethod::Bucket { slabs: 1 }] {
                let other = draw(order);
                worst.note(largest(&sorted, &other, 3..4), || format!("seed {seed}, {order}"));
                color_changes = color_changes.max(largest(&sorted, &other, 0..3));
            }
        }
        worst.finish();
        assert!(color_changes > 0.05, "the orders are not different ones: color changes by {color_changes}");
    }
}

/// Seen from the other side, a parallel ray meets the same segments: mirrored, the opacity is the same. The color is not.
#[test]
fn opacity_from_behind_is_the_mirrored_opacity() {
    // Twice the error of one picture (see `chords`).
    let mut worst = Worst::new("opacity from behind", 1e-5);
    let mut color_changes = 0.0_f64;
    for seed in 0..6 {
        let tets = Tets::block(4, seed + 1400);
        let mesh = tets.mesh();
        let front = random_camera(&mut Random::new(seed), DVec3::ZERO, 1.0, false);
        assert!(matches!(front.projection, Projection::Orthographic { .. }));
        let behind = Camera { eye: 2.0 * front.target - front.eye, ..front };
        let [front, behind] = [front, behind].map(|camera| View::new(&camera, 48, 41).unwrap());
        for renderer in Renderer::EXACT.into_iter().chain([Renderer::Fast(Integration::Average)]) {
            for model in [OpticalModel::DensityEmitter, OpticalModel::Absorption] {
                let draw = |view| renderer.draw(&mesh, &tets.scalars, &Plan { model, ..plan(view, COLOR, EXTINCTION) });
                let (one, other) = (draw(front), draw(behind));
                for y in 0..one.height() {
                    for x in 0..one.width() {
                        let (p, q) = (one.pixel(x, y), other.pixel(one.width() - 1 - x, y));
                        worst.note(f64::from((p[3] - q[3]).abs()), || format!("seed {seed}, {renderer:?}, ({x}, {y})"));
                        color_changes = color_changes.max(f64::from((p[0] - q[0]).abs()));
                    }
                }
            }
        }
    }
    worst.finish();
    assert!(color_changes > 0.05, "the sides look alike: color changes by {color_changes}");
}
