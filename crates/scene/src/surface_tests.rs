//! Isosurfaces, light and tables: from the file to the plan, what is refused and what is said.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_integrate::{Integration, LengthAxis, OpticalModel, SurfaceShading, TableSettings};
use tetrascope_order::OrderMethod;

use crate::{
    Choice, Completed, Gradients, IsosurfaceMethod, LengthAxisName, Lighting, MeshFacts, Mixing, Plan, SceneFile,
};

fn facts() -> MeshFacts {
    MeshFacts { lowest: DVec3::new(-1.0, 0.0, 2.0), highest: DVec3::new(3.0, 1.0, 2.5), scalar_range: (0.1, 4.7) }
}

fn file(text: &str) -> SceneFile {
    SceneFile::parse(&format!("[mesh]\npath = \"m\"\n{text}\n"), Path::new("a.toml")).unwrap()
}

fn completed(text: &str) -> Completed {
    file(text).complete(&facts()).unwrap()
}

fn plan(text: &str) -> Plan {
    completed(text).scene.plan().unwrap()
}

fn refusal(text: &str) -> String {
    file(text).complete(&facts()).unwrap_err().to_string()
}

fn decision(plan: &Plan, subject: &str) -> String {
    plan.decisions.iter().find(|decision| decision.subject == subject).unwrap().to_string()
}

/// Surfaces in a file: value, opacity and shading of each.
fn surfaces(all: &[(f64, f64, &str)]) -> String {
    let section = |(value, opacity, shading): &(f64, f64, &str)| {
        format!(
            "[[isosurface]]\nvalue = {value:?}\ncolor = [0.9, 0.6, 0.2]\nopacity = {opacity:?}\nshading = \"{shading}\"\n"
        )
    };
    all.iter().map(section).collect()
}

#[test]
fn isosurfaces_reach_the_plan_sorted() {
    let text = "[[isosurface]]\nvalue = 2.5\ncolor = [0.9, 0.6, 0.2]\nback_color = [0.2, 0.6, 0.9]\nopacity = 0.5\n\
                [[isosurface]]\nvalue = 1\ncolor = [1, 0, 0]\nshading = \"smooth\"\n";
    let plan = plan(text);
    let isosurfaces = plan.isosurfaces.unwrap();
    assert_eq!(isosurfaces.method, IsosurfaceMethod::Exact);
    let [low, high] = isosurfaces.surfaces.as_slice() else { panic!("not two") };
    assert_eq!((low.value, low.color, low.back_color), (1.0, [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]));
    assert_eq!((low.opacity, low.shading), (1.0, SurfaceShading::Smooth));
    assert_eq!((high.value, high.back_color, high.opacity), (2.5, [0.2, 0.6, 0.9], 0.5));
    assert_eq!(high.shading, SurfaceShading::None);
}

#[test]
fn defaults_of_surfaces_and_light_are_written_out() {
    let plain = completed(&surfaces(&[(1.0, 1.0, "none")])).file;
    assert_eq!(plain.isosurface[0].back_color, Some([0.9, 0.6, 0.2]));
    assert_eq!((plain.light, plain.quality.map_size), (None, None));
    let text = completed(&format!("{}[quality]\nisosurfaces = \"map-smooth\"", surfaces(&[(1.0, 1.0, "flat")])));
    let text = text.file.to_toml().unwrap();
    for line in [
        "back_color = [0.9, 0.6, 0.2]",
        "isosurfaces = \"map-smooth\"",
        "map_size = 256",
        "direction = \"headlight\"",
        "ambient = 0.2",
        "diffuse = 0.7",
        "specular = 0.3",
        "shininess = 32.0",
        "volume = false",
    ] {
        assert!(text.lines().any(|l| l == line), "{line} is not in:\n{text}");
    }
}

#[test]
fn what_is_not_asked_for_is_not_in_the_plan() {
    let plan = plan("");
    assert!(plan.isosurfaces.is_none() && plan.lighting.is_none() && plan.tables.is_none());
    assert_eq!(plan.gradients(), Gradients::None);
    assert_eq!(decision(&plan, "isosurfaces"), "isosurfaces: none (no map, no crossing)");
    assert_eq!(decision(&plan, "tables"), "tables: none (the integration looks nothing up)");
    assert_eq!(decision(&plan, "gradients"), "gradients: none (no lighting)");
}

#[test]
fn surfaces_of_opacity_zero_are_left_out() {
    let one = plan(&surfaces(&[(1.0, 0.0, "smooth"), (2.0, 0.5, "none")]));
    assert_eq!(one.isosurfaces.as_ref().unwrap().surfaces.as_slice().len(), 1);
    assert!(one.lighting.is_none());
    assert!(
        decision(&one, "isosurfaces").contains("1 by exact") && decision(&one, "isosurfaces").contains("1 of opac")
    );
    let all = completed(&surfaces(&[(1.0, 0.0, "none"), (2.0, 0.0, "none")]));
    assert_eq!(all.warnings, ["the opacity of every isosurface is 0: none is seen"]);
    let plan = all.scene.plan().unwrap();
    assert!(plan.isosurfaces.is_none());
    assert!(decision(&plan, "isosurfaces").contains("the opacity of all is 0"));
}

#[test]
fn isosurfaces_need_an_order_in_every_model() {
    for model in OpticalModel::ALL {
        let text = format!("[optics]\nmodel = \"{model}\"\n{}", surfaces(&[(1.0, 0.5, "none")]));
        assert_eq!(plan(&text).order, OrderMethod::BspXmpvo, "{model}");
        let unordered = plan(&format!("{text}[quality]\norder = \"none\""));
        assert!(decision(&unordered, "order").contains("wrong where they overlap"), "{model}");
    }
}

#[test]
fn gradients_follow_the_most_demanding_light() {
    let lit = "[light]\nvolume = true\n";
    for (text, gradients, reason) in [
        (surfaces(&[(1.0, 1.0, "none")]), Gradients::None, "no lighting"),
        (surfaces(&[(1.0, 1.0, "none"), (2.0, 1.0, "flat")]), Gradients::Cells, "one normal a cell"),
        (surfaces(&[(1.0, 1.0, "smooth"), (2.0, 1.0, "flat")]), Gradients::Points, "smooth shading"),
        (lit.to_owned(), Gradients::Points, "the volume is lit"),
        (format!("{lit}{}", surfaces(&[(1.0, 1.0, "flat")])), Gradients::Points, "the volume is lit"),
    ] {
        let plan = plan(&text);
        assert_eq!(plan.gradients(), gradients, "{text}");
        assert!(decision(&plan, "gradients").contains(reason), "{text}");
        assert_eq!(plan.lighting.is_some(), gradients != Gradients::None);
    }
    let light = decision(&plan(&format!("{lit}direction = [0.0, -3.0, 4.0]\n")), "light");
    assert_eq!(
        light,
        "light: from the direction (0, -0.6, 0.8) (on the volume; ambient 0.2, diffuse 0.7, specular 0.3, shininess 32)"
    );
}

#[test]
fn a_shaded_scene_without_a_light_has_the_usual_one() {
    let mut scene = completed(&surfaces(&[(1.0, 1.0, "smooth")])).scene;
    assert_eq!(scene.plan().unwrap().lighting, Some(Lighting::default()));
    scene.lighting = None;
    assert_eq!(scene.plan().unwrap().lighting, Some(Lighting::default()));
}

/// Often in range, sometimes any float, NaN and infinities included.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![12 => 0.0..=1.0_f64, 1 => prop::num::f64::ANY]
}

proptest! {
    /// Components of any size, all of one sign or not; a component may be 0.
    #[test]
    fn light_directions_have_length_one(x in any::<f64>(), y in any::<f64>(), z in any::<f64>()) {
        prop_assume!([x, y, z].iter().all(|c| c.is_finite()) && [x, y, z] != [0.0; 3]);
        let mut file = file("[light]\nvolume = true");
        file.light.as_mut().unwrap().direction = crate::LightDirection::Vector([x, y, z]);
        let plan = file.complete(&facts()).unwrap().scene.plan().unwrap();
        let direction = plan.lighting.unwrap().direction.unwrap();
        // One division each for three components of a length that is right to 2 ulp.
        prop_assert!((direction.length() - 1.0).abs() < 8.0 * f64::EPSILON);
        let largest = x.abs().max(y.abs()).max(z.abs());
        let parallel = DVec3::new(x / largest, y / largest, z / largest).cross(direction).length();
        prop_assert!(parallel < 8.0 * f64::EPSILON, "{parallel}");
    }

    /// Whatever numbers a surface and a light have, the answer is a plan or an error that names the key.
    #[test]
    fn any_number_gives_a_plan_or_names_its_key(
        value in number(), color in prop::array::uniform3(number()), opacity in number(),
        numbers in prop::array::uniform4(number()),
        shading in prop::sample::select(vec!["none", "flat", "smooth"]),
    ) {
        let mut file = file(&format!("[light]\nvolume = true\n{}", surfaces(&[(1.0, 1.0, shading)])));
        let section = &mut file.isosurface[0];
        (section.value, section.color, section.opacity) = (value, color, opacity);
        let light = file.light.as_mut().unwrap();
        [light.ambient, light.diffuse, light.specular, light.shininess] = numbers;
        match file.complete(&facts()) {
            Ok(_) => {
                prop_assert!(value.is_finite() && (0.0..=1.0).contains(&opacity));
                prop_assert!(color.iter().chain(&numbers).all(|n| n.is_finite() && *n >= 0.0));
            }
            Err(error) => {
                let text = error.to_string();
                prop_assert!(text.starts_with("isosurface[0].") || text.starts_with("light."), "{}", text);
            }
        }
    }
}

#[test]
fn numbers_out_of_range_name_their_key() {
    let iso = |line: &str| format!("{}[[isosurface]]\n{line}", surfaces(&[(1.0, 1.0, "none")]));
    let light = |line: &str| format!("[light]\nvolume = true\n{line}");
    let table = |line: &str| format!("[quality]\nintegration = \"table-3d\"\n{line}");
    for (text, message) in [
        (iso("value = nan\ncolor = [1, 1, 1]"), "isosurface[1].value is NaN; give a finite number"),
        (iso("value = -inf\ncolor = [1, 1, 1]"), "isosurface[1].value is -inf"),
        (iso("value = 1\ncolor = [1, 1, 1]\nopacity = 1.5"), "isosurface[1].opacity is 1.5; give a number from 0 to 1"),
        (iso("value = 1\ncolor = [1, 1, 1]\nopacity = nan"), "isosurface[1].opacity is NaN"),
        (iso("value = 1\ncolor = [1, 1, 1]\nopacity = -0.5"), "isosurface[1].opacity is -0.5"),
        (iso("value = 1\ncolor = [1, -2, 1]"), "isosurface[1].color is -2; give finite numbers, zero or more"),
        (iso("value = 1\ncolor = [1, 2, 1]\nback_color = [0, inf, 0]"), "isosurface[1].back_color is inf"),
        (light("direction = [0, 0, 0]"), "light.direction is [0.0, 0.0, 0.0]; give \"headlight\", or three"),
        (light("direction = [0, nan, 1]"), "light.direction is [0.0, NaN, 1.0]"),
        (light("ambient = -0.1"), "light.ambient is -0.1; give a finite number, zero or more"),
        (light("diffuse = nan"), "light.diffuse is NaN"),
        (light("specular = inf"), "light.specular is inf"),
        (light("shininess = -1"), "light.shininess is -1"),
        (table("table_size = 1"), "quality.table_size is 1; give 2 to 1024"),
        (table("table_size = 5000"), "quality.table_size is 5000; give 2 to 1024"),
        (table("table_lengths = 0"), "quality.table_lengths is 0; give 2 to 1024"),
        (
            format!("[quality]\nisosurfaces = \"map-smooth\"\nmap_size = 1\n{}", surfaces(&[(1.0, 1.0, "none")])),
            "quality.map_size is 1; give 2 to 4096",
        ),
    ] {
        let error = refusal(&text);
        assert!(error.contains(message), "{message} is not in: {error}");
    }
}

#[test]
fn methods_that_do_not_go_together_are_refused_with_a_way_out() {
    let quality = |line: &str, all: &[(f64, f64, &str)]| format!("[quality]\n{line}\n{}", surfaces(all));
    let stopped = "integration = \"table-3d\"\nisosurfaces = \"map-stopped\"";
    let glass = [(1.0, 0.5, "none")];
    for (text, parts) in [
        (
            "[optics]\nmodel = \"emitter\"\n[quality]\nintegration = \"partial\"".to_owned(),
            ["quality.integration", "\"partial\"", "\"emitter\"", "\"cumulative\""],
        ),
        (
            quality("integration = \"vertex\"", &glass),
            ["quality.integration = \"vertex\"", "cannot cut", "\"exact\"", "\"map-smooth\""],
        ),
        (
            quality("integration = \"exact\"\nisosurfaces = \"map-stopped\"", &glass),
            ["quality.isosurfaces = \"map-stopped\"", "\"exact\" has none", "\"table-2d\"", "\"map-smooth\""],
        ),
        (
            quality(stopped, &[(1.0, 1.0, "flat"), (2.0, 0.5, "none")]),
            ["quality.isosurfaces = \"map-stopped\"", "transparent", "opacities 1", "\"map-smooth\""],
        ),
    ] {
        let error = refusal(&text);
        for part in parts {
            assert!(error.contains(part), "{part} is not in: {error}");
        }
    }
    // What is not among them is planned.
    for text in [
        quality(stopped, &[(1.0, 1.0, "none"), (2.0, 0.0, "none")]),
        quality(stopped, &[(1.0, 1.0, "flat"), (2.0, 1.0, "smooth")]),
        quality("integration = \"vertex\"\nisosurfaces = \"map-smooth\"", &glass),
        quality("integration = \"vertex\"", &[]),
        quality("integration = \"vertex\"", &[(1.0, 0.0, "none")]),
        quality("integration = \"partial\"", &[(1.0, 0.5, "smooth")]),
    ] {
        plan(&text);
    }
}

#[test]
fn maps_that_stop_the_integral_bring_their_table() {
    let text = format!("[quality]\nisosurfaces = \"map-stopped\"\nmap_size = 64\n{}", surfaces(&[(1.0, 1.0, "none")]));
    let completed = completed(&text);
    assert_eq!(completed.file.quality.integration, Choice::Named(Integration::Table3d));
    assert_eq!((completed.file.quality.table_size, completed.file.quality.table_lengths), (Some(64), Some(64)));
    let plan = completed.scene.plan().unwrap();
    let method = IsosurfaceMethod::Map { size: 64, mixing: Mixing::Stopped };
    assert_eq!(plan.isosurfaces.as_ref().unwrap().method, method);
    assert!(decision(&plan, "integration").contains("need a table"));
    let said = decision(&plan, "isosurfaces");
    assert!(said.contains("1 by map-stopped, 64 x 64 samples"), "{said}");
}

#[test]
fn table_sizes_reach_plan_file_and_report() {
    let tables = |text: &str| {
        let completed = completed(&format!("[quality]\n{text}"));
        let plan = completed.scene.plan().unwrap();
        (plan.tables.unwrap(), decision(&plan, "integration"), completed.file.quality)
    };
    let linear = LengthAxis::Linear;
    let (settings, said, quality) = tables("integration = \"table-3d\"");
    assert_eq!(settings, TableSettings { scalars: 64, lengths: 64, length_axis: linear });
    assert!(said.contains("table-3d, 64 x 64 x 64 samples, 4 MiB"), "{said}");
    assert_eq!((quality.table_size, quality.table_lengths), (Some(64), Some(64)));
    assert_eq!(quality.length_axis, Some(LengthAxisName::Linear));

    let (settings, said, _) = tables("integration = \"table-3d\"\ntable_size = 32");
    assert_eq!(settings, TableSettings { scalars: 32, lengths: 32, length_axis: linear });
    assert!(said.contains("0.5 MiB"), "{said}");

    let (settings, said, _) =
        tables("integration = \"table-3d\"\ntable_size = 128\ntable_lengths = 16\nlength_axis = \"logarithmic\"");
    assert_eq!(settings, TableSettings { scalars: 128, lengths: 16, length_axis: LengthAxis::Logarithmic });
    assert!(said.contains("128 x 128 x 16 samples, logarithmic lengths, 4 MiB"), "{said}");

    let (settings, said, quality) = tables("integration = \"table-2d\"");
    assert_eq!(settings.scalars, 256);
    assert!(said.contains("table-2d, 256 x 256 samples, 1 MiB"), "{said}");
    assert_eq!((quality.table_size, quality.table_lengths, quality.length_axis), (Some(256), None, None));
}

#[test]
fn isovalues_that_no_ray_meets_are_said() {
    // The range is 0.1 to 4.7; a ray cannot come from below the lowest scalar.
    for (value, is_met) in [(-3.0, false), (0.1, false), (0.2, true), (4.7, true), (4.8, false)] {
        let completed = completed(&surfaces(&[(2.0, 1.0, "none"), (value, 1.0, "none")]));
        assert_eq!(completed.warnings.is_empty(), is_met, "{value}: {:?}", completed.warnings);
        if let Some(warning) = completed.warnings.first() {
            let text = format!("isosurface[1].value is {value}, and the field goes from 0.1 to 4.7");
            assert!(warning.contains(&text) && warning.contains("not seen"), "{warning}");
        }
    }
}

#[test]
fn light_without_an_effect_is_said_once_and_not_written() {
    for (text, part) in [
        ("[light]\nambient = 0.3".to_owned(), "nothing is lit"),
        (format!("[light]\n{}", surfaces(&[(1.0, 1.0, "none")])), "nothing is lit"),
        ("[optics]\nmodel = \"absorption\"\n[light]\nvolume = true".to_owned(), "no color to light"),
    ] {
        let completed = completed(&text);
        assert_eq!(completed.warnings.len(), 1, "{:?}", completed.warnings);
        assert!(completed.warnings[0].contains(part), "{:?}", completed.warnings);
        assert!(completed.file.light.is_none() && completed.scene.plan().unwrap().lighting.is_none());
    }
    let text = format!("[optics]\nmodel = \"absorption\"\n[light]\nvolume = true\n{}", surfaces(&[(1.0, 1.0, "flat")]));
    let completed = completed(&text);
    assert_eq!(completed.warnings.len(), 1);
    assert!(!completed.file.light.unwrap().volume);
    assert_eq!(completed.scene.plan().unwrap().gradients(), Gradients::Cells);
}
