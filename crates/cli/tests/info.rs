//! `tetrascope info` beyond a single mesh: time steps, histograms, what machines hear.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

mod common;

use std::process::{Command, Output};

use serde_json::{Value, json};
use tempfile::TempDir;

use common::{has, shared};

/// A tetrahedron and its mirror image, with values that are easily counted.
fn mesh(scalars: &str) -> String {
    format!(
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 0 0 1 0 0 0 1 0 0 -1\n\
         CELLS 2 10\n4 0 1 2 3\n4 0 1 2 4\nCELL_TYPES 2\n10\n10\nPOINT_DATA 5\nSCALARS s double 1\nLOOKUP_TABLE default\n{scalars}\n\
         VECTORS v double\n0 0 0 0 3 4 0 0 1 0 0 2 0 0 5\nCELL_DATA 2\nSCALARS c double 1\nLOOKUP_TABLE default\n-1 1\n"
    )
}

struct Run {
    folder: TempDir,
}

impl Run {
    fn new() -> Self {
        let run = Self { folder: tempfile::tempdir().unwrap() };
        run.write("mesh.vtk", &mesh("0 1 2 4 4"));
        run
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.folder.path().join(name), text).unwrap();
    }

    fn tetrascope(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_tetrascope")).args(args).current_dir(self.folder.path()).output().unwrap()
    }

    fn good(&self, args: &[&str]) -> String {
        let output = self.tetrascope(args);
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    fn json(&self, args: &[&str]) -> Value {
        serde_json::from_str(&self.good(args)).unwrap()
    }
}

#[test]
fn a_histogram_has_its_range_at_both_ends() {
    let run = Run::new();
    let text = run.good(&["info", "mesh.vtk", "--bins", "4"]);
    has(&text, &["histogram   of s: 5 points in 4 bins of at most 2"]);
    let bottom = text.lines().find(|line| line.starts_with("            0 ")).unwrap();
    // 80 columns where there is no terminal, 12 of them for the subjects.
    assert!(bottom.ends_with(" 4") && bottom.len() == 80, "{bottom:?}");
    let bars = text.lines().find(|line| line.ends_with(&"█".repeat(17))).unwrap();
    assert_eq!(bars.chars().count(), 80, "{bars:?}");
    // As wide as there is room where nothing is said.
    has(&run.good(&["info", "mesh.vtk"]), &["in 68 bins"]);
    has(
        &run.good(&["info", "mesh.vtk", "--log", "--bins", "200"]),
        &["200 bins", "3 in a column", "drawn by logarithm"],
    );
    assert_eq!(run.tetrascope(&["info", "mesh.vtk", "--bins", "0"]).status.code(), Some(2));
}

#[test]
fn histograms_of_any_field() {
    let run = Run::new();
    let histogram =
        |field: &str| run.json(&["info", "mesh.vtk", "--json", "--bins", "2", "--field", field])["histogram"].clone();
    assert_eq!(
        histogram("s"),
        json!({ "field": "s", "association": "point", "range": [0.0, 4.0], "bins": 2, "counts": [2, 3], "non_finite": 0 })
    );
    assert_eq!(
        histogram("v"),
        json!({ "field": "v:mag", "association": "point", "range": [0.0, 5.0], "bins": 2, "counts": [3, 2], "non_finite": 0 })
    );
    assert_eq!(histogram("v:z")["range"], json!([0.0, 5.0]));
    // Cells have their own values, not those that are drawn at points.
    assert_eq!(
        histogram("c"),
        json!({ "field": "c", "association": "cell", "range": [-1.0, 1.0], "bins": 2, "counts": [1, 1], "non_finite": 0 })
    );
    has(&run.good(&["info", "mesh.vtk", "--field", "c"]), &["of c: 2 cells in 68 bins"]);
    let unknown = run.tetrascope(&["info", "mesh.vtk", "--field", "d"]);
    assert_eq!(unknown.status.code(), Some(1));
    has(&String::from_utf8_lossy(&unknown.stderr), &["mesh.vtk", "no array \"d\"", "point array \"s\""]);
}

#[test]
fn histograms_of_odd_values() {
    let run = Run::new();
    run.write("odd.vtk", &mesh("nan 1 2 3 nan"));
    has(&run.good(&["info", "odd.vtk"]), &["of s: 3 points in 68 bins of at most 1; 2 more not finite"]);
    assert_eq!(run.json(&["info", "odd.vtk", "--json"])["histogram"]["non_finite"], 2);
    run.write("same.vtk", &mesh("7 7 7 7 7"));
    has(&run.good(&["info", "same.vtk"]), &["of s: 5 points", "all are 7"]);
    run.write("none.vtk", &mesh("nan nan nan nan nan"));
    has(&run.good(&["info", "none.vtk"]), &["of s: none of 5 values is finite"]);
    assert_eq!(run.json(&["info", "none.vtk", "--json"])["histogram"]["range"], Value::Null);
    let bare = mesh("0 0 0 0 0");
    run.write("bare.vtk", bare.split("POINT_DATA").next().unwrap());
    let text = run.good(&["info", "bare.vtk"]);
    assert!(!text.contains("histogram"), "{text}");
    assert_eq!(run.json(&["info", "bare.vtk", "--json"])["histogram"], Value::Null);
}

#[test]
fn steps_of_a_list() {
    let run = Run::new();
    run.write("later.vtk", &mesh("5 6 7 8 9"));
    run.write(
        "list.pvd",
        r#"<VTKFile type="Collection" version="0.1"><Collection><DataSet timestep="0.5" file="mesh.vtk"/>
           <DataSet timestep="2" file="later.vtk"/></Collection></VTKFile>"#,
    );
    has(&run.good(&["info", "list.pvd"]), &["steps       2 from time 0.5 to 2; read: step 1, time 2", "\"s\", 5 to 9"]);
    has(&run.good(&["info", "list.pvd", "--step", "0"]), &["read: step 0, time 0.5", "\"s\", 0 to 4"]);
    let said = run.json(&["info", "list.pvd", "--time", "0.6", "--json"]);
    assert_eq!((&said["times"], &said["step"], &said["time"]), (&json!([0.5, 2.0]), &json!(0), &json!(0.5)));
    let none = run.json(&["info", "mesh.vtk", "--json"]);
    assert_eq!((&none["times"], &none["time"]), (&json!([]), &Value::Null));
}

#[test]
fn the_folder_of_a_case() {
    let run = Run::new();
    let file = |name: &str, class: &str, text: &str| {
        let path = format!("case/{name}");
        let folder = run.folder.path().join(&path);
        std::fs::create_dir_all(folder.parent().unwrap()).unwrap();
        run.write(&path, &format!("FoamFile {{ version 2.0; format ascii; class {class}; object a; }}\n{text}\n"));
    };
    file("constant/polyMesh/points", "vectorField", "4((0 0 0) (1 0 0) (0 1 0) (0 0 1))");
    file("constant/polyMesh/faces", "faceList", "4(3(0 2 1) 3(0 1 3) 3(0 3 2) 3(1 2 3))");
    file("constant/polyMesh/owner", "labelList", "4(0 0 0 0)");
    file("constant/polyMesh/neighbour", "labelList", "0()");
    file("constant/polyMesh/boundary", "polyBoundaryMesh", "1(walls { type wall; nFaces 4; startFace 0; })");
    for (time, value) in [("0", 1), ("0.5", 2), ("1.5", 3)] {
        let field = format!("dimensions [0 0 0 0 0 0 0]; internalField uniform {value}; boundaryField {{}}");
        file(&format!("{time}/p"), "volScalarField", &field);
    }
    let text = run.good(&["info", "case", "--step", "1"]);
    has(
        &text,
        &["OpenFOAM", "3 from time 0 to 1.5; read: step 1, time 0.5", "1  tetrahedron", "\"p\", 2 to 2", "all are 2"],
    );
    assert_eq!(run.json(&["info", "case", "--json"])["times"], json!([0.0, 0.5, 1.5]));
}

#[test]
fn raw_volumes_and_the_sample() {
    let run = Run::new();
    run.write("scan.bin", "abcdefgh");
    has(
        &run.good(&["info", "scan.bin", "--raw", "2x2x2:uint8"]),
        &["raw volume", "1  hexahedron", "of ImageFile: 8 points"],
    );
    has(&run.good(&["info", "builtin:rings"]), &["built-in sample", "of distance: 15625 points"]);
}

#[test]
fn all_of_a_real_file_fits_a_screen() {
    let Some(file) = shared("data/exodus/mug.e") else { return };
    let text = Run::new().good(&["info", file.to_str().unwrap()]);
    has(&text, &["steps       21 from time 0 to 2; read: step 20", "2476  hexahedron", "of convected: 3774 points"]);
    assert!(
        text.lines().count() <= 40 && text.lines().filter(|line| line.contains('█')).all(|l| l.chars().count() <= 80)
    );
}
