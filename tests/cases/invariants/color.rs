//! What color and extinction do to a picture: linear, bounded, and only as far as the transfer function says.
//!
//! All pictures of one test have the same cells in the same order, so that even a wrong order must obey.

use glam::DVec3;
use tetrascope::{Integration, LinearImage, OpticalModel, Plan, View};
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, Worst, largest, mean_opacity, plan, random_camera};

const EXTINCTION: &[[f64; 2]] = &[[-1.0, 0.0], [-0.2, 3.0], [-0.15, 9.0], [-0.1, 0.2], [1.0, 2.0]];
const COLOR: &[[f64; 4]] = &[[-1.0, 0.9, 0.1, 0.2], [0.0, 0.1, 0.8, 0.3], [0.0, 0.4, 0.6, 0.9], [1.2, 1.0, 0.9, 0.1]];

/// For each renderer meshes, scalars and views.
fn each_case(mut check: impl FnMut(Renderer, &Tets, &dyn Fn(&[f64], &Plan) -> LinearImage, View, &str)) {
    for seed in 0..4 {
        let tets = Tets::block(3, seed + 1500);
        let mesh = tets.mesh();
        for is_perspective in [false, true] {
            let camera = random_camera(&mut Random::new(seed), DVec3::ZERO, 1.0, is_perspective);
            let view = View::new(&camera, 40, 40).unwrap();
            for renderer in Renderer::ALL {
                let draw = |scalars: &[f64], plan: &Plan| renderer.draw(&mesh, scalars, plan);
                check(
                    renderer,
                    &tets,
                    &draw,
                    view,
                    &format!("seed {seed}, perspective {is_perspective}, {renderer:?}"),
                );
            }
        }
    }
}

/// Tolerance 2e-6: one color is one factor in every cell; some 20 sums of rounded products.
#[test]
fn one_color_is_opacity_times_color() {
    let mut worst = Worst::new("one color", 2e-6);
    each_case(|_, tets, draw, view, place| {
        let image = draw(&tets.scalars, &plan(view, &[[0.0, 0.9, 0.5, 0.25]], EXTINCTION));
        for pixel in image.pixels() {
            for (c, color) in [0.9, 0.5, 0.25].into_iter().enumerate() {
                worst.note((f64::from(pixel[c]) - color * f64::from(pixel[3])).abs(), || place.to_owned());
            }
        }
    });
    worst.finish();
}

/// `C(p kappa + q) = p C(kappa) + q alpha` for the density emitter; the models that add color per length have no alpha to add,
/// but are linear too.
#[test]
fn color_is_linear() {
    let mut worst = Worst::new("linearity in color", 5e-6);
    let (p, q) = (1.7, 0.4);
    let changed = |factor: f64, add: f64| -> Vec<[f64; 4]> {
        COLOR.iter().map(|&[s, r, g, b]| [s, factor * r + add, factor * g + add, factor * b + add]).collect()
    };
    each_case(|_, tets, draw, view, place| {
        let one = draw(&tets.scalars, &plan(view, COLOR, EXTINCTION));
        let two = draw(&tets.scalars, &plan(view, &changed(p, q), EXTINCTION));
        for (a, b) in one.pixels().iter().zip(two.pixels()) {
            let [alpha_a, alpha_b] = [a, b].map(|pixel| f64::from(pixel[3]));
            worst.note((alpha_a - alpha_b).abs(), || format!("{place}, opacity"));
            for c in 0..3 {
                let expected = p * f64::from(a[c]) + q * alpha_a;
                worst.note((f64::from(b[c]) - expected).abs(), || place.to_owned());
            }
        }
        for model in [OpticalModel::Emitter, OpticalModel::Emission] {
            let draw = |color: &[[f64; 4]]| draw(&tets.scalars, &Plan { model, ..plan(view, color, EXTINCTION) });
            let (one, two) = (draw(COLOR), draw(&changed(p, 0.0)));
            for (a, b) in one.pixels().iter().zip(two.pixels()) {
                for c in 0..3 {
                    worst.note((f64::from(b[c]) - p * f64::from(a[c])).abs(), || format!("{place}, {model}"));
                }
            }
        }
    });
    worst.finish();
}

/// No pixel is brighter than its opacity times the brightest color, nor darker than that times the darkest.
#[test]
fn colors_and_opacities_stay_in_bounds() {
    // Rounding of some 20 sums.
    let slack = 2e-6;
    let mut brightest = 0.0_f64;
    each_case(|_, tets, draw, view, place| {
        for factor in [1.0, 1e3, 1e-3, 1e30] {
            let extinction: Vec<[f64; 2]> = EXTINCTION.iter().map(|&[s, rho]| [s, rho * factor]).collect();
            let image = draw(&tets.scalars, &plan(view, COLOR, &extinction));
            for pixel in image.pixels() {
                let alpha = f64::from(pixel[3]);
                assert!((0.0..=1.0).contains(&alpha), "{place}, factor {factor:e}: opacity {alpha}");
                for c in 0..3 {
                    let channel = |f: fn(f64, f64) -> f64, start| COLOR.iter().map(|k| k[c + 1]).fold(start, f);
                    let (low, high) = (channel(f64::min, f64::INFINITY), channel(f64::max, 0.0));
                    let value = f64::from(pixel[c]);
                    assert!(
                        value >= low * alpha - slack && value <= high * alpha + slack,
                        "{place}, factor {factor:e}: channel {c} is {value}, with opacity {alpha} and colors {low} to {high}"
                    );
                    brightest = brightest.max(value);
                }
            }
        }
    });
    assert!(brightest > 0.5);
}

/// The exact opacity is `1 - exp(-m tau)`: twice the extinction squares the transmittance. Upwards only: the root of the
/// transmittance of an opaque pixel is mostly rounding.
#[test]
fn more_extinction_is_a_power_of_the_transmittance() {
    // The error of a depth of 4 (see `chords`) and of its square.
    let mut worst = Worst::new("power of the transmittance", 1e-5);
    each_case(|renderer, tets, draw, view, place| {
        if renderer == Renderer::Fast(Integration::Vertex) {
            return;
        }
        let one = draw(&tets.scalars, &plan(view, COLOR, EXTINCTION));
        for m in [1.5, 2.0, 3.0] {
            let extinction: Vec<[f64; 2]> = EXTINCTION.iter().map(|&[s, rho]| [s, rho * m]).collect();
            let other = draw(&tets.scalars, &plan(view, COLOR, &extinction));
            for (a, b) in one.pixels().iter().zip(other.pixels()) {
                let expected = 1.0 - (1.0 - f64::from(a[3])).powf(m);
                worst.note((f64::from(b[3]) - expected).abs(), || format!("{place}, m {m}"));
            }
        }
    });
    worst.finish();
}

/// `s -> p s + q` with the control points moved alike, and `s -> -s` with the transfer function mirrored.
///
/// Tolerance 1e-5: scalars are f32 about each cell's reference, whatever the scale; the thin peak makes most of it. Steps
/// are left out of the mirrored case, where the value on the step belongs to the other side, and of the methods that look
/// at single scalars.
#[test]
fn a_map_of_the_scalar_changes_nothing() {
    let mut worst = Worst::new("scalar map", 1e-5);
    let smooth: Vec<[f64; 4]> = [COLOR[0], COLOR[1], COLOR[3]].to_vec();
    each_case(|_, tets, draw, view, place| {
        let one = draw(&tets.scalars, &plan(view, &smooth, EXTINCTION));
        assert!(mean_opacity(&one) > 0.1);
        for (p, q) in [
            (2.0, 0.0),
            (1e-6, 300.0),
            (1e12, -7e11),
            (1e-30, 0.0),
            (1e-300, 0.0),
            (1e300, -1e299),
            (1.0, 1e5),
            (-1.0, 0.0),
            (-3e4, 12.0),
        ] {
            let map = |s: f64| p * s + q;
            let scalars: Vec<f64> = tets.scalars.iter().map(|&s| map(s)).collect();
            let mut color: Vec<[f64; 4]> = smooth.iter().map(|&[s, r, g, b]| [map(s), r, g, b]).collect();
            let mut extinction: Vec<[f64; 2]> = EXTINCTION.iter().map(|&[s, rho]| [map(s), rho]).collect();
            if p < 0.0 {
                color.reverse();
                extinction.reverse();
            }
            let other = draw(&scalars, &plan(view, &color, &extinction));
            worst.note(largest(&one, &other, 0..4), || format!("{place}, s -> {p:e} s + {q:e}"));
        }
    });
    worst.finish();
}
