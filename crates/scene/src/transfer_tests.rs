//! Colors and opacity by names, by a file, by points: what counts before what, and what it becomes.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use glam::DVec3;
use tetrascope_colors::{ColorMap, linear_from_srgb, read_presets};

use crate::file::PresetMap;
use crate::{Completed, MeshFacts, SceneError, SceneFile};

/// A mesh with a diagonal of 16: the length that opacity is for is 2.
fn facts() -> MeshFacts {
    let corner = 16.0 / 3.0_f64.sqrt();
    MeshFacts { lowest: DVec3::ZERO, highest: DVec3::splat(corner), scalar_range: (-1.0, 3.0) }
}

fn scene(transfer: &str) -> SceneFile {
    SceneFile::parse(&format!("[mesh]\npath = \"m\"\n[transfer]\n{transfer}\n"), "a.toml".as_ref()).unwrap()
}

fn complete(transfer: &str) -> Completed {
    scene(transfer).complete(&facts()).unwrap()
}

fn refusal(transfer: &str) -> String {
    scene(transfer).complete(&facts()).unwrap_err().to_string()
}

fn color(completed: &Completed, scalar: f64) -> [f64; 3] {
    completed.scene.plan().unwrap().transfer.color(scalar)
}

fn extinction(completed: &Completed, scalar: f64) -> f64 {
    completed.scene.plan().unwrap().transfer.extinction(scalar)
}

fn is_near(color: [f64; 3], map: &ColorMap, x: f64) -> bool {
    color.into_iter().zip(map.color_at(x)).all(|(linear, srgb)| (linear - linear_from_srgb(srgb)).abs() < 5e-3)
}

#[test]
fn a_color_map_by_name_spans_the_range() {
    let plasma = ColorMap::named("plasma_r").unwrap();
    let completed = complete("colormap = \"plasma_r\"");
    for i in 0..=20 {
        let x = f64::from(i) / 20.0;
        assert!(is_near(color(&completed, -1.0 + 4.0 * x), &plasma, x), "{x}");
    }
    let narrow = complete("colormap = \"plasma_r\"\nrange = [0.0, 0.5]");
    assert!(is_near(color(&narrow, 0.25), &plasma, 0.5) && is_near(color(&narrow, 3.0), &plasma, 1.0));
    // The default ramp goes with it.
    assert!((extinction(&narrow, 0.25) - 0.25).abs() < 1e-12 && (extinction(&narrow, 2.0) - 0.5).abs() < 1e-12);
    // What it came from is gone from the file, which gives the same again.
    assert!(narrow.file.transfer.colormap.is_none() && narrow.file.transfer.range.is_none());
    assert_eq!(narrow.file.complete(&facts()).unwrap().file, narrow.file);
}

#[test]
fn opacity_is_for_a_length() {
    let linear = complete("opacity = \"linear\"");
    let default = complete("");
    for scalar in [-1.0, 0.0, 1.7, 3.0] {
        assert!((extinction(&linear, scalar) - extinction(&default, scalar)).abs() < 1e-12, "{scalar}");
    }
    let points = complete("opacity = [[0.0, 0.0], [1.0, 0.5]]\nopacity_length = 0.25");
    assert_eq!((extinction(&points, 1.0), extinction(&points, 0.5)), (2.0, 1.0));
    let values = complete("opacity = [0.0, 0.5, 0.5]\nopacity_length = 0.5");
    assert_eq!((extinction(&values, 0.0), extinction(&values, 2.0)), (0.5, 1.0));
    let sigmoid = complete("opacity = \"sigmoid\"\nopacity_length = 1.0\nrange = [0.0, 1.0]");
    assert!((extinction(&sigmoid, 0.5) - 0.5).abs() < 2e-3 && extinction(&sigmoid, 1.0) > 0.99);
    let said = points.decisions.iter().find(|decision| decision.subject == "opacity").unwrap();
    assert!(said.reason.contains("extinction of 4") && said.reason.contains("length of 0.25"), "{said}");
}

#[test]
fn points_count_before_names_and_names_before_files() {
    let bytes =
        br#"[{"Name": "p", "RGBPoints": [0, 1, 0, 0, 2, 1, 0, 0], "Points": [0, 0.25, 0.5, 0, 2, 0.25, 0.5, 0]}]"#;
    let map = read_presets("p.json", bytes).unwrap().choose(None).unwrap();
    let with_preset = |transfer: &str| {
        let mut scene = scene(&format!("preset = \"p.json\"\n{transfer}"));
        scene.transfer.preset_map = Some(PresetMap { map: map.clone(), warnings: vec!["odd".to_owned()] });
        scene.complete(&facts()).unwrap()
    };
    let preset = with_preset("");
    assert_eq!(color(&preset, 1.0), [1.0, 0.0, 0.0]);
    assert!((extinction(&preset, 1.0) - 0.125).abs() < 1e-12);
    assert!(preset.warnings.contains(&"odd".to_owned()));
    assert!(preset.file.transfer.preset.is_none() && preset.file.transfer.preset_map.is_none());

    let named = with_preset("colormap = \"gray\"");
    assert!(color(&named, 3.0).iter().all(|channel| (channel - 1.0).abs() < 1e-9));
    assert!((extinction(&named, 1.0) - 0.125).abs() < 1e-12);
    let points = with_preset(
        "colormap = \"gray\"\ncolor = [[0.0, 0.0, 0.0, 1.0]]\nextinction = [[0.0, 7.0]]\nopacity = \"linear\"",
    );
    assert_eq!((color(&points, 1.0), extinction(&points, 1.0)), ([0.0, 0.0, 1.0], 7.0));
    for key in ["transfer.colormap", "transfer.preset", "transfer.opacity"] {
        assert!(points.warnings.iter().any(|warning| warning.contains(key)), "{key}: {:?}", points.warnings);
    }
}

#[test]
fn what_is_wrong_names_its_key() {
    assert!(refusal("colormap = \"virids\"").contains("viridis"));
    assert!(refusal("opacity = \"sigmund\"").starts_with("transfer.opacity"));
    assert!(refusal("opacity = [[0.0, 1.5]]").contains("0 to 1"));
    assert!(refusal("range = [1.0, 1.0]").starts_with("transfer.range"));
    assert!(refusal("opacity = \"linear\"\nopacity_length = 0.0").starts_with("transfer.opacity_length"));
    let error = scene("preset = \"p.json\"").complete(&facts()).unwrap_err();
    assert!(matches!(error, SceneError::PresetNotRead { .. }), "{error}");
    let text = "[mesh]\npath = \"m\"\n[transfer]\nopacity = 3\n";
    let error = SceneFile::parse(text, "a.toml".as_ref()).unwrap_err().to_string();
    assert!(error.contains("sigmoid") && error.contains("line 4"), "{error}");
}

#[test]
fn what_has_no_effect_is_said() {
    for (transfer, key) in [
        ("range = [0.0, 1.0]\ncolor = [[0.0, 1.0, 1.0, 1.0]]\nextinction = [[0.0, 1.0]]", "transfer.range"),
        ("preset_name = \"a\"", "transfer.preset_name"),
        ("opacity_length = 2.0", "transfer.opacity_length"),
    ] {
        let warnings = complete(transfer).warnings;
        assert!(warnings.iter().any(|warning| warning.starts_with(key)), "{key}: {warnings:?}");
    }
}
