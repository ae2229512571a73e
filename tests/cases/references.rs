//! Every reference picture, drawn by the f64 reference and by the fast renderer.
//!
//! The limits of the reference are those that the pictures' README states. The fast renderer, with the order that it chooses by
//! itself, is held to rounding, a twentieth and less of what they grant it, and where isosurfaces have edges to what they grant.

use tetrascope::{Backend, Choice, Integration, LinearImage, OrderMethod, SceneFile, Silent, read_exr, render_scene};
use tetrascope_tests::compare::{Difference, difference};
use tetrascope_tests::shared;

struct Case {
    name: &'static str,
    reference_within: f64,
    fast: Fast,
    /// Pixels (column, row) where the mesh overlaps itself.
    leave_out: &'static [(u32, u32)],
}

struct Fast {
    /// Largest difference of the pixels that count.
    within: f64,
    /// Share of the pixels that may differ by more: those along steps of the color, and those that the order gets wrong.
    but_for: f64,
    /// Largest difference of those.
    at_most: f64,
}

/// Largest difference of the opacities: rounding in f32 over some hundred layers.
const OPACITY_WITHIN: f64 = 2e-5;

const CASES: &[Case] = &[
    Case {
        name: "cube5",
        reference_within: 1e-6,
        fast: Fast { within: 2e-5, but_for: 0.0, at_most: 2e-5 },
        leave_out: &[],
    },
    Case {
        name: "bluntfin",
        reference_within: 1e-5,
        fast: Fast { within: 2e-5, but_for: 0.0, at_most: 2e-5 },
        leave_out: &[],
    },
    Case {
        name: "bluntfin-inside",
        reference_within: 1e-5,
        fast: Fast { within: 2e-5, but_for: 0.0, at_most: 2e-5 },
        leave_out: &[],
    },
    Case {
        name: "bluntfin-isosurfaces",
        reference_within: 1e-5,
        fast: Fast { within: 1e-4, but_for: 0.0, at_most: 1e-4 },
        leave_out: &[],
    },
    Case {
        name: "combustor",
        reference_within: 1e-5,
        fast: Fast { within: 2e-5, but_for: 0.0, at_most: 2e-5 },
        leave_out: &[(123, 84)],
    },
    Case {
        name: "block",
        reference_within: 1e-5,
        fast: Fast { within: 2e-5, but_for: 0.0, at_most: 2e-5 },
        leave_out: &[],
    },
    Case {
        name: "fire",
        reference_within: 1e-5,
        fast: Fast { within: 5e-4, but_for: 0.003, at_most: 1e-1 },
        leave_out: &[],
    },
    Case {
        name: "cyclic",
        reference_within: 1e-6,
        fast: Fast { within: 2e-5, but_for: 0.0, at_most: 2e-5 },
        leave_out: &[],
    },
];

/// Draws a scene of the reference folder with a back end and the order that it chooses; gives it and the picture it should be.
fn draw(name: &str, backend: Backend) -> Option<(LinearImage, LinearImage)> {
    draw_in(name, backend, Choice::Auto)
}

fn draw_in(name: &str, backend: Backend, order: Choice<OrderMethod>) -> Option<(LinearImage, LinearImage)> {
    let folder = shared::folder(name)?.join("reference");
    let path = folder.join(format!("{name}.toml"));
    let text = std::fs::read_to_string(&path).unwrap();
    let mut scene = SceneFile::parse(&text, &path).unwrap();
    scene.quality.integration = Choice::Named(Integration::Exact);
    (scene.quality.backend, scene.quality.order) = (Choice::Named(backend), order);
    let picture = render_scene(&scene, &folder, &Silent).unwrap();
    Some((picture.image, read_exr(&folder.join(format!("{name}.exr"))).unwrap()))
}

fn report(name: &str, what: &str, found: &Difference) {
    println!(
        "{name} by {what}: largest {:.2e} at {:?}, opacity {:.2e}, rms {:.2e}, {} pixels beyond",
        found.largest, found.at, found.opacity, found.rms, found.beyond
    );
}

#[test]
fn references_by_the_f64_renderer() {
    let mut failures = Vec::new();
    for case in CASES {
        let Some((drawn, expected)) = draw(case.name, Backend::Reference) else { return };
        let found = difference(&drawn, &expected, case.reference_within, case.leave_out);
        report(case.name, "reference", &found);
        if found.largest > case.reference_within {
            failures.push((case.name, found));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn references_by_the_fast_renderer() {
    let mut failures = Vec::new();
    for case in CASES {
        let fast = &case.fast;
        let Some((drawn, expected)) = draw(case.name, Backend::Cpu) else { return };
        let found = difference(&drawn, &expected, fast.within, case.leave_out);
        report(case.name, "cpu", &found);
        let too_many = found.beyond as f64 > fast.but_for * drawn.pixels().len() as f64;
        if too_many || found.largest > fast.at_most || found.opacity > OPACITY_WITHIN {
            failures.push((case.name, found));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Where an order of cells is exact, sorting along every ray gives the same picture.
#[test]
fn references_in_order_and_sorted_per_pixel() {
    const WITHIN: f64 = 1e-5;
    let mut failures = Vec::new();
    for case in CASES {
        let Some((sorted, _)) = draw_in(case.name, Backend::Cpu, Choice::Named(OrderMethod::PerPixel)) else { return };
        for order in [Choice::Auto, Choice::Named(OrderMethod::BspXmpvo)] {
            let Some((ordered, _)) = draw_in(case.name, Backend::Cpu, order) else { return };
            let found = difference(&ordered, &sorted, WITHIN, case.leave_out);
            report(case.name, &format!("order {order} against per-pixel"), &found);
            if found.largest > WITHIN {
                failures.push((case.name, order, found));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
