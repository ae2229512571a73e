//! Orders and what goes with them: what is chosen, what is dropped with a word, what is written.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use glam::DVec3;
use tetrascope_order::{CycleRemedy, OrderMethod};

use crate::{Choice, Completed, MeshFacts, SceneFile};

fn completed(text: &str) -> Completed {
    let facts = MeshFacts { lowest: DVec3::ZERO, highest: DVec3::ONE, scalar_range: (0.0, 1.0) };
    SceneFile::parse(&format!("[mesh]\npath = \"m\"\n{text}"), "a.toml".as_ref()).unwrap().complete(&facts).unwrap()
}

fn reason(completed: &Completed, subject: &str) -> Option<String> {
    completed.decisions.iter().find(|d| d.subject == subject).map(|d| d.to_string())
}

#[test]
fn numbers_go_with_their_order() {
    for (text, order) in [
        ("order = \"bucket\"", OrderMethod::Bucket { slabs: 20 }),
        ("order = \"k-buffer\"", OrderMethod::KBuffer { window: 6 }),
        ("order = \"k-buffer\"\nwindow = 2", OrderMethod::KBuffer { window: 2 }),
        ("order = \"per-pixel\"", OrderMethod::PerPixel),
        ("order = \"power\"", OrderMethod::Power),
        ("order = \"bsp-xmpvo\"", OrderMethod::BspXmpvo),
    ] {
        let scene = completed(&format!("[quality]\n{text}"));
        assert_eq!((scene.scene.order, scene.scene.plan().unwrap().order), (Some(order), order));
        assert_eq!(scene.file.quality.order, Choice::Named(order));
        assert_eq!(scene.warnings, Vec::<String>::new());
        assert!(!scene.leaves_order_open());
    }
    assert_eq!(completed("[quality]\norder = \"k-buffer\"").file.quality.window, Some(6));
}

#[test]
fn keys_of_another_order_are_dropped_with_a_warning() {
    for (order, key, value, why) in [
        ("mpvo", "window", "3", "the order is mpvo, not k-buffer"),
        ("auto", "window", "3", "the order is auto, not k-buffer"),
        ("k-buffer", "slabs", "3", "the order is k-buffer, not bucket"),
        ("centroid", "cycles", "\"cut\"", "looks for no rings"),
        ("power", "cycles", "\"cut\"", "looks for no rings"),
        ("mpvo", "keep_heights", "true", "mpvo has no heights"),
        ("none", "keep_heights", "false", "none has no heights"),
    ] {
        let scene = completed(&format!("[quality]\norder = \"{order}\"\n{key} = {value}"));
        let [warning] = scene.warnings.as_slice() else { panic!("{order}, {key}: {:?}", scene.warnings) };
        assert!(warning.contains(&format!("quality.{key} has no effect: ")) && warning.contains(why), "{warning}");
        assert!(!scene.file.to_toml().unwrap().contains(key), "{key} is written");
    }
    let commuting = completed("[optics]\nmodel = \"emission\"\n[quality]\ncycles = \"cut\"\nkeep_heights = true");
    assert_eq!(commuting.warnings.len(), 2);
}

#[test]
fn rings_are_drawn_rightly_where_nothing_is_said() {
    for text in ["", "[quality]\norder = \"mpvo\"", "[quality]\norder = \"bsp-xmpvo\""] {
        let scene = completed(text);
        assert_eq!(scene.scene.plan().unwrap().cycles, CycleRemedy::PerPixel);
        assert_eq!(scene.file.quality.cycles, Some(CycleRemedy::PerPixel));
        assert!(reason(&scene, "cycles").unwrap().contains("per-pixel"));
    }
    for (name, remedy) in [("report", CycleRemedy::Report), ("cut", CycleRemedy::Cut)] {
        let scene = completed(&format!("[quality]\ncycles = \"{name}\""));
        assert_eq!(scene.scene.plan().unwrap().cycles, remedy);
    }
    let centroid = completed("[quality]\norder = \"centroid\"");
    assert_eq!((centroid.file.quality.cycles, reason(&centroid, "cycles")), (None, None));
}

#[test]
fn an_open_order_is_settled_for_the_mesh() {
    let mut scene = completed("[quality]\nkeep_heights = true");
    assert!(scene.leaves_order_open());
    scene.settle_order(OrderMethod::Power, "proven");
    assert!(!scene.leaves_order_open());
    let plan = scene.scene.plan().unwrap();
    assert_eq!((plan.order, plan.cycles), (OrderMethod::Power, CycleRemedy::Report));
    assert_eq!(reason(&scene, "order").unwrap(), "order: power (proven)");
    assert_eq!(reason(&scene, "cycles"), None);
    let quality = &scene.file.quality;
    assert_eq!((quality.order, quality.cycles), (Choice::Named(OrderMethod::Power), None));
    assert_eq!(quality.keep_heights, Some(true));

    let mut scene = completed("[quality]\nkeep_heights = true\ncycles = \"cut\"");
    scene.settle_order(OrderMethod::Mpvo, "convex");
    let quality = &scene.file.quality;
    assert_eq!((quality.cycles, quality.keep_heights), (Some(CycleRemedy::Cut), None));

    let commuting = completed("[optics]\nmodel = \"absorption\"");
    assert!(!commuting.leaves_order_open());
    assert!(!completed("[quality]\nbackend = \"reference\"").leaves_order_open());
    let surface = "[[isosurface]]\nvalue = 0.5\ncolor = [1, 1, 1]\n[optics]\nmodel = \"absorption\"";
    assert!(completed(surface).leaves_order_open());
    assert!(!completed(&surface.replace("color", "opacity = 0\ncolor")).leaves_order_open());
}
