//! Orders and what goes with them: what is chosen, what is dropped with a word, what is written.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use glam::DVec3;
use tetrascope_integrate::OpticalModel;
use tetrascope_order::{CycleRemedy, OrderMethod};

use crate::{Choice, Completed, MeshFacts, SceneError, SceneFile};

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
        ("k-buffer", "keep_heights", "true", "k-buffer has no heights"),
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

    // What auto has looked for it keeps, whichever order it takes; the scene that is written says so, and reads back without a word.
    let mut scene = completed("[quality]\nkeep_heights = true");
    scene.settle_order(OrderMethod::PerPixel, "parts stand in one another");
    assert_eq!((scene.warnings.as_slice(), scene.file.quality.keep_heights), (&[][..], Some(true)));
    let mut scene = completed("[quality]\nkeep_heights = true\ncycles = \"cut\"");
    scene.settle_order(OrderMethod::Mpvo, "convex");
    let quality = &scene.file.quality;
    assert_eq!((quality.cycles, quality.keep_heights), (Some(CycleRemedy::Cut), Some(true)));
    let text = scene.file.to_toml().unwrap();
    let again =
        completed(text.split_once("[quality]").map(|(_, quality)| format!("[quality]{quality}")).unwrap().as_str());
    assert_eq!((again.warnings, &again.file.quality), (Vec::new(), quality));

    let mut scene = completed("[quality]\nkeep_heights = true");
    scene.settle_order(OrderMethod::Centroid, "a guess");
    assert_eq!(scene.warnings, ["quality.keep_heights has no effect: the order centroid has no heights"]);
    assert_eq!((scene.file.quality.cycles, scene.file.quality.keep_heights), (None, None));

    let commuting = completed("[optics]\nmodel = \"absorption\"");
    assert!(!commuting.leaves_order_open());
    assert!(!completed("[quality]\nbackend = \"reference\"").leaves_order_open());
    let surface = "[[isosurface]]\nvalue = 0.5\ncolor = [1, 1, 1]\n[optics]\nmodel = \"absorption\"";
    assert!(completed(surface).leaves_order_open());
    assert!(!completed(&surface.replace("color", "opacity = 0\ncolor")).leaves_order_open());
}

#[test]
fn a_remedy_that_the_settled_order_has_no_use_for_is_dropped_with_a_warning() {
    for (asked, warnings) in [
        ("", vec![]),
        ("[quality]\ncycles = \"cut\"", vec!["quality.cycles has no effect: the order power looks for no rings"]),
    ] {
        let mut scene = completed(asked);
        scene.settle_order(OrderMethod::Power, "proven");
        assert_eq!(scene.warnings, warnings);
        assert_eq!((scene.file.quality.cycles, scene.scene.cycles), (None, CycleRemedy::Report));
    }
}

#[test]
fn another_order_forgets_only_what_it_has_no_use_for() {
    let named = Choice::Named;
    for (order, cycles, keep_heights) in [
        (named(OrderMethod::BspXmpvo), Some(CycleRemedy::Report), Some(true)),
        (Choice::Auto, Some(CycleRemedy::Report), Some(true)),
        (named(OrderMethod::Power), None, Some(true)),
        (named(OrderMethod::Centroid), None, None),
    ] {
        let text =
            "[mesh]\npath = \"m\"\n[quality]\norder = \"mpvo\"\ncycles = \"report\"\nkeep_heights = true\nwindow = 3";
        let mut quality = SceneFile::parse(text, "a.toml".as_ref()).unwrap().quality;
        quality.replace_order(order);
        assert_eq!((quality.order, quality.cycles, quality.keep_heights), (order, cycles, keep_heights));
        assert_eq!(quality.window, None);
    }
    let text = "[mesh]\npath = \"m\"\n[quality]\norder = \"k-buffer\"\nwindow = 3";
    let mut same = SceneFile::parse(text, "a.toml".as_ref()).unwrap().quality;
    same.replace_order(same.order);
    assert_eq!(same.window, Some(3));
}

#[test]
fn pieces_have_no_fans() {
    let plan = |text: &str| {
        let facts = MeshFacts { lowest: DVec3::ZERO, highest: DVec3::ONE, scalar_range: (0.0, 1.0) };
        let text = format!("[mesh]\npath = \"m\"\n[quality]\nintegration = \"vertex\"\n{text}");
        SceneFile::parse(&text, "a.toml".as_ref()).unwrap().complete(&facts)
    };
    for order in ["auto", "mpvo", "bsp-xmpvo"] {
        let error = plan(&format!("order = \"{order}\"\ncycles = \"cut\"")).unwrap_err();
        assert!(matches!(error, SceneError::Conflict { key: "quality.cycles", .. }), "{error:?}");
        let text = error.to_string();
        assert!(text.starts_with("quality.cycles = \"cut\" leaves pieces") && text.contains("\"per-pixel\""), "{text}");
        assert!(plan(&format!("order = \"{order}\"\ncycles = \"per-pixel\"")).is_ok());
    }
    // An order that finds no rings cuts none.
    assert!(plan("order = \"centroid\"\ncycles = \"cut\"").is_ok());
}

#[test]
fn a_plan_commutes_where_its_scene_does() {
    for model in OpticalModel::ALL {
        for surface in [
            "",
            "[[isosurface]]\nvalue = 0.5\ncolor = [1, 1, 1]",
            "[[isosurface]]\nvalue = 0.5\ncolor = [1, 1, 1]\nopacity = 0",
        ] {
            let scene = completed(&format!("{surface}\n[optics]\nmodel = \"{model}\"")).scene;
            let is_plain = surface.is_empty() || surface.contains("opacity");
            assert_eq!(scene.commutes(), model.is_commutative() && is_plain, "{model}, {surface}");
            assert_eq!(scene.plan().unwrap().commutes(), scene.commutes(), "{model}, {surface}");
        }
    }
}
