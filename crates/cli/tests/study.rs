//! `tetrascope study`, run as a user runs it.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn study(folder: &Path, args: &[&str]) -> Output {
    let common = ["study", "builtin:rings", "--quick", "--size", "24", "--frames", "1"];
    let program = env!("CARGO_BIN_EXE_tetrascope");
    Command::new(program).args(common).args(args).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn a_table_and_four_files() {
    let folder = tempfile::tempdir().unwrap();
    let output = study(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for part in [
        "setting ",
        "average, ",
        "* nothing else is faster",
        "> what the scene asks for",
        "left out    ",
        "wrote ",
        "study.html",
    ] {
        assert!(table.contains(part), "\"{part}\" is not in:\n{table}");
    }
    let times: Vec<f64> = table
        .lines()
        .skip(1)
        .take_while(|line| !line.starts_with("* nothing"))
        .map(|line| line.rsplit_once(", cpu").unwrap().1.split_whitespace().next().unwrap().parse().unwrap())
        .collect();
    assert!(times.len() > 10 && times.is_sorted(), "{times:?}");
    for name in ["study.csv", "study.json", "study.svg", "study.html"] {
        assert!(folder.path().join("study").join(name).is_file(), "{name}");
    }
}

#[test]
fn the_same_for_machines() {
    let folder = tempfile::tempdir().unwrap();
    let output = study(folder.path(), &["--json", "-o", "a/b", "--fov", "40"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(said["written"].as_array().unwrap().len(), 4);
    let written: Value = serde_json::from_slice(&std::fs::read(folder.path().join("a/b/study.json")).unwrap()).unwrap();
    assert_eq!(said["settings"], written["settings"]);
    assert_eq!((&said["scene"]["width"], &said["frames"]), (&Value::from(24), &Value::from(1)));
}

#[test]
fn a_folder_that_cannot_be_made_is_said_before_anything_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "here first").unwrap();
    let output = study(folder.path(), &["-o", "file/study"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("file/study") && said.contains("folder"), "{said}");
    assert_eq!(std::fs::read_to_string(folder.path().join("file")).unwrap(), "here first");
}
