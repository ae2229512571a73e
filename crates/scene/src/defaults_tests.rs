//! Defaults: that they fit, and that they do not depend on the unit of length.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_colors::ColorMap;
use tetrascope_integrate::{Integration, OpticalModel};
use tetrascope_order::OrderMethod;

use crate::{MeshFacts, Plan, SceneFile, defaults, explain_blank};

fn facts() -> MeshFacts {
    MeshFacts { lowest: DVec3::new(-1.0, 0.5, 2.0), highest: DVec3::new(3.0, 1.0, 2.5), scalar_range: (-0.3, 4.7) }
}

fn plan(text: &str, facts: &MeshFacts) -> Plan {
    let text = format!("[mesh]\npath = \"m\"\n{text}\n");
    let file = SceneFile::parse(&text, std::path::Path::new("a.toml")).unwrap();
    file.complete(facts).unwrap().scene.plan().unwrap()
}

/// Largest distance of a point of the bounding sphere's outline from the picture's middle, in half smaller sides.
fn sphere_fill(plan: &Plan, facts: &MeshFacts) -> f64 {
    let view = &plan.view;
    let radius = facts.diagonal() / 2.0;
    let depth = (facts.center() - view.eye).dot(view.forward);
    let half = view.half_width.min(view.half_height);
    if view.is_perspective { (radius / depth).asin().tan() / half } else { radius / half }
}

#[test]
fn the_bounding_sphere_fills_the_smaller_side() {
    for camera in ["", "[camera]\nfov_y = 100.0", "[camera]\nprojection = \"orthographic\""] {
        for size in ["width = 512", "width = 100", "height = 37"] {
            let plan = plan(&format!("{camera}\n[image]\n{size}"), &facts());
            let fill = sphere_fill(&plan, &facts());
            assert!((fill - 1.0).abs() < 1e-12, "{camera} {size}: {fill}");
            assert!((plan.view.forward - DVec3::NEG_Z).length() < 1e-12);
            assert!((plan.view.up - DVec3::Y).length() < 1e-12);
            assert!(explain_blank(&plan, &facts()).is_empty());
        }
    }
}

proptest! {
    /// The mesh in another unit gives the same picture: lengths grow with it, extinctions shrink, slopes stay.
    #[test]
    fn defaults_are_scale_free(exponent in -12.0..12.0_f64, orthographic in any::<bool>(), power in -6.0..6.0_f64) {
        let factor = 10.0_f64.powf(exponent);
        let scalars = 10.0_f64.powf(power);
        let text = if orthographic { "[camera]\nprojection = \"orthographic\"" } else { "" };
        let small = facts();
        let (low, high) = small.scalar_range;
        let large = MeshFacts {
            lowest: small.lowest * factor,
            highest: small.highest * factor,
            scalar_range: (low * scalars, high * scalars),
        };
        let (a, b) = (plan(text, &small), plan(text, &large));
        let close = |x: f64, y: f64| (x - y).abs() <= 1e-12 * x.abs().max(y.abs());
        let lengths = if orthographic { factor } else { 1.0 };
        prop_assert!(close(a.view.half_height * lengths, b.view.half_height));
        prop_assert!((a.view.eye * factor - b.view.eye).length() <= 1e-12 * b.view.eye.length());
        for i in 0..=20 {
            // From just inside the range: at its very ends rounding may fall off it.
            let s = low + (high - low) * (f64::from(i) * 0.9998 / 20.0 + 0.0001);
            prop_assert!(close(a.transfer.extinction(s), b.transfer.extinction(s * scalars) * factor)
                || (a.transfer.extinction(s) - b.transfer.extinction(s * scalars) * factor).abs() < 1e-12);
            for (x, y) in a.transfer.color(s).into_iter().zip(b.transfer.color(s * scalars)) {
                prop_assert!((x - y).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn color_points_ascend_for_any_range(low in any::<f64>(), steps in 0..100_u32, width in any::<f64>()) {
        prop_assume!(low.is_finite() && width.is_finite());
        let mut high = low;
        for _ in 0..steps {
            high = high.next_up();
        }
        for high in [high, low.max(width)] {
            prop_assume!(high.is_finite());
            let points = defaults::color((low, high));
            prop_assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
            prop_assert!(points.windows(3).all(|three| three[0][0] < three[2][0]));
            prop_assert_eq!(points.first().map(|p| p[0]), Some(low));
            prop_assert_eq!(points.last().map(|p| p[0]), Some(high));
        }
    }
}

#[test]
fn extinction_is_eight_over_the_diagonal() {
    let plan = plan("", &facts());
    let diagonal = facts().diagonal();
    assert!((plan.transfer.extinction(4.7) * diagonal - 8.0).abs() < 1e-12);
    assert!((plan.transfer.extinction(2.2) * diagonal - 4.0).abs() < 1e-12);
    assert_eq!(plan.transfer.extinction(-0.3), 0.0);
}

#[test]
fn viridis_is_close() {
    let plan = plan("", &facts());
    let viridis = ColorMap::named("viridis").unwrap();
    let mut largest = 0.0_f64;
    for i in 0..=1000 {
        let t = f64::from(i) / 1000.0;
        let exact = viridis.color_at(t);
        let color = plan.transfer.color(-0.3 + 5.0 * t);
        for (linear, exact) in color.into_iter().zip(exact) {
            let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
            largest = largest.max((encoded - exact).abs() * 255.0);
        }
    }
    assert!(largest < 0.5, "{largest}");
}

#[test]
fn a_constant_field_is_visible_and_said() {
    let constant = MeshFacts { scalar_range: (2.5, 2.5), ..facts() };
    let file = SceneFile::of_mesh("m").complete(&constant).unwrap();
    assert!(file.warnings.iter().any(|w| w.contains("2.5 everywhere")), "{:?}", file.warnings);
    let plan = file.scene.plan().unwrap();
    assert!((plan.transfer.extinction(2.5) * constant.diagonal() - 4.0).abs() < 1e-12);
    assert!(explain_blank(&plan, &constant).is_empty());
}

#[test]
fn up_is_never_along_the_line_of_sight() {
    for camera in [
        "eye = [1.0, 50.0, 2.25]",
        "eye = [1.0, -50.0, 2.25]",
        "up = [0.0, 0.0, 1.0]",
        "up = [0.0, 0.0, -1.0]",
        "up = [0.0, 1.0, 0.0]",
        "target = [1.0, 0.0, 0.0]",
    ] {
        plan(&format!("[camera]\n{camera}"), &facts());
        plan(&format!("[camera]\nprojection = \"orthographic\"\n{camera}"), &facts());
    }
}

#[test]
fn auto_chooses_by_the_optical_model() {
    for (model, order) in [
        ("density-emitter", OrderMethod::BspXmpvo),
        ("emitter", OrderMethod::BspXmpvo),
        ("absorption", OrderMethod::None),
        ("emission", OrderMethod::None),
    ] {
        let plan = plan(&format!("[optics]\nmodel = \"{model}\""), &facts());
        assert_eq!((plan.order, plan.integration), (order, Integration::Exact), "{model}");
        for subject in ["order", "integration", "gradients"] {
            let decision = plan.decisions.iter().find(|d| d.subject == subject).unwrap();
            assert!(!decision.reason.is_empty());
        }
    }
}

#[test]
fn blank_pictures_have_a_reason() {
    for (text, reason) in [
        ("[camera]\neye = [1.0, 0.75, 9.0]\ntarget = [1.0, 0.75, 12.0]", "behind it"),
        ("[camera]\neye = [1.0, 0.75, 9.0]\ntarget = [30.0, 0.75, 8.0]", "to its left"),
        ("[camera]\neye = [1.0, 0.75, 9e5]", "pixels large"),
        ("[transfer]\nextinction = [[5.0, 0.0], [6.0, 2.0]]", "whole range"),
        ("[transfer]\nextinction = [[0.0, 1e-6]]", "too small"),
        ("[optics]\nmodel = \"emission\"\n[transfer]\ncolor = [[0.0, 0.0, 0.0, 0.0]]", "adds per length"),
        ("[transfer]\nextinction = [[0, 0]]\n[[isosurface]]\nvalue = 9\ncolor = [1, 1, 1]", "meets no isosurface"),
        ("[transfer]\nextinction = [[0, 0]]\n[[isosurface]]\nvalue = 9\ncolor = [1, 1, 1]", "whole range"),
        ("[[isosurface]]\nvalue = 1\ncolor = [1, 1, 1]\nopacity = 1e-3", "add up to 0.001 only"),
    ] {
        let reasons = explain_blank(&plan(text, &facts()), &facts());
        assert!(reasons.iter().any(|r| r.contains(reason)), "{text}: {reasons:?}");
    }
}

#[test]
fn isosurfaces_alone_are_no_blank_picture() {
    for model in OpticalModel::ALL {
        let text = format!(
            "[optics]\nmodel = \"{model}\"\n[transfer]\ncolor = [[0, 0, 0, 0]]\nextinction = [[0, 0]]\n\
             [[isosurface]]\nvalue = 1.0\ncolor = [1, 1, 1]\nopacity = 0.5\n"
        );
        assert_eq!(explain_blank(&plan(&text, &facts()), &facts()), Vec::<String>::new(), "{model}");
        let aside = format!("[camera]\neye = [1.0, 0.75, 9.0]\ntarget = [1.0, 0.75, 12.0]\n{text}");
        assert!(explain_blank(&plan(&aside, &facts()), &facts())[0].contains("behind it"));
    }
}

#[test]
fn tiny_and_huge_meshes_have_finite_defaults() {
    for scale in [1e-150, 1e-9, 1e20, 1e150] {
        let facts = MeshFacts { lowest: facts().lowest * scale, highest: facts().highest * scale, ..facts() };
        let plan = plan("", &facts);
        assert!((plan.transfer.extinction(4.7) * facts.diagonal() - 8.0).abs() < 1e-12, "{scale}");
        assert!(explain_blank(&plan, &facts).is_empty(), "{scale}");
    }
}
