//! `tetrascope colormaps`: names, swatches where they are asked for, files of presets.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

fn tetrascope(folder: &Path, args: &[&str], environment: &[(&str, &str)]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tetrascope"));
    for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "COLORTERM"] {
        command.env_remove(name);
    }
    command.arg("colormaps").args(args).envs(environment.iter().copied()).current_dir(folder).output().unwrap()
}

fn good(args: &[&str], environment: &[(&str, &str)]) -> String {
    let output = tetrascope(Path::new("."), args, environment);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn all_names_in_groups() {
    let text = good(&[], &[]);
    assert!(!text.contains('\x1b'), "colors go to what is no terminal");
    let lines: Vec<&str> = text.lines().collect();
    let place = |line: &str| lines.iter().position(|other| *other == line).unwrap_or_else(|| panic!("no line {line}"));
    assert_eq!(place("matplotlib"), 0);
    assert!(place("  viridis") < place("ParaView") && place("ParaView") < place("  Cool to Warm"));
    let opacity = lines.iter().position(|line| line.starts_with("opacity")).unwrap();
    assert!(
        opacity > place("  Cool to Warm")
            && lines[opacity + 1].starts_with("  linear ")
            && lines[opacity + 1].ends_with('█')
    );
}

#[test]
fn swatches_as_the_environment_asks() {
    let text = |environment: &[(&str, &str)]| good(&["VIRIDIS"], environment);
    assert!(text(&[("CLICOLOR_FORCE", "1"), ("COLORTERM", "truecolor")]).contains("\x1b[38;2;68;"));
    let cube = text(&[("CLICOLOR_FORCE", "1")]);
    assert!(cube.contains("\x1b[38;5;53") && !cube.contains("38;2;"), "{cube:?}");
    assert!(!text(&[("COLORTERM", "truecolor")]).contains('\x1b'));
    assert!(!text(&[("CLICOLOR_FORCE", "0")]).contains('\x1b'));
}

#[test]
fn for_machines() {
    let said: Value = serde_json::from_str(&good(&["viridis", "--json"], &[("CLICOLOR_FORCE", "1")])).unwrap();
    let first = &said["colormaps"][0];
    assert_eq!((&first["name"], &first["origin"]), (&json!("viridis"), &json!("matplotlib")));
    assert_eq!((&first["colors"][0], &first["colors"][4]), (&json!("#440154"), &json!("#fde725")));
    assert_eq!(said["places"], json!([0.0, 0.25, 0.5, 0.75, 1.0]));
    let all: Value = serde_json::from_str(&good(&["--json"], &[])).unwrap();
    assert!(all["colormaps"].as_array().unwrap().len() > 200);
    let linear = all["opacities"].as_array().unwrap().iter().find(|opacity| opacity["name"] == "linear").unwrap();
    assert_eq!(linear["values"], json!([0.0, 0.25, 0.5, 0.75, 1.0]));
}

#[test]
fn presets_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| tetrascope(folder.path(), args, &[]);
    let preset = r#"[{"Name": "mine", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 2, 1, 1, 1], "NanColor": [1, 0, 0]},
        {"Name": "broken", "RGBPoints": [0]}]"#;
    std::fs::write(folder.path().join("saved.json"), preset).unwrap();
    let output = run(&["saved.json"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stdout), "saved.json\n  mine\n");
    let warning = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(warning.starts_with("warning: ") && warning.contains("broken"), "{warning}");
    let said: Value = serde_json::from_slice(&run(&["saved.json", "--json"]).stdout).unwrap();
    let map = &said["colormaps"][0];
    assert_eq!(
        (&map["colors"][2], &map["nan_color"], &map["origin"]),
        (&json!("#808080"), &json!("#ff0000"), &json!("saved.json"))
    );
    std::fs::write(folder.path().join("damaged.xml"), "<ColorMaps><ColorMap").unwrap();
    for (word, part) in
        [("absent.json", "cannot be read"), ("damaged.xml", "damaged.xml"), ("nosuchname", "`nosuchname`")]
    {
        let output = run(&[word]);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{word}");
        assert!(text.starts_with("error: ") && text.contains(part), "{text}");
    }
}
