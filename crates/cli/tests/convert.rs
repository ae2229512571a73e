//! `tetrascope convert`: what is written is read again, by the program itself and by the library.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

mod common;

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::{Value, json};
use tempfile::TempDir;
use tetrascope::{Cells, Dataset, Loaded, ReadOptions, read_mesh};

use common::{has, shared};

/// A hexahedron as a polyhedron beside an inverted tetrahedron, a flat one and a triangle; arrays of points and cells, an odd name among them.
const MESH: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="9" NumberOfCells="4">
<PointData>
<DataArray type="Float32" Name="s" format="ascii">0 1 2 3 4 5 6 7 0.1</DataArray>
<DataArray type="Int16" Name="a &lt; &quot;b&quot; &amp; c" NumberOfComponents="2" format="ascii">
0 0 1 -1 2 -2 3 -3 4 -4 5 -5 6 -6 7 -7 8 -8</DataArray>
</PointData>
<CellData><DataArray type="UInt8" Name="c" format="ascii">10 20 30 255</DataArray></CellData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1 0.1 0.2 3.3</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7 4 6 5 8 0 1 2 3 0 1 8</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8 12 16 19</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">42 10 10 5</DataArray>
<DataArray type="Int64" Name="faces" format="ascii">6 4 0 2 3 1 4 4 5 7 6 4 0 1 5 4 4 2 6 7 3 4 0 4 6 2 4 1 3 7 5</DataArray>
<DataArray type="Int64" Name="faceoffsets" format="ascii">31 -1 -1 -1</DataArray>
</Cells></Piece></UnstructuredGrid></VTKFile>
"#;

struct Run {
    folder: TempDir,
}

impl Run {
    fn new() -> Self {
        let run = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::write(run.path("mesh.vtu"), MESH).unwrap();
        run
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn tetrascope(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_tetrascope")).args(args).current_dir(self.folder.path()).output().unwrap()
    }

    /// Runs what must succeed; standard output and standard error.
    fn good(&self, args: &[&str]) -> (String, String) {
        let output = self.tetrascope(args);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}: {errors}");
        (String::from_utf8(output.stdout).unwrap(), errors)
    }

    fn json(&self, args: &[&str]) -> Value {
        serde_json::from_str(&self.good(args).0).unwrap()
    }

    /// Runs what must fail with this code and leave nothing behind; standard error.
    fn bad(&self, code: i32, args: &[&str]) -> String {
        let names = || {
            let entries = std::fs::read_dir(self.folder.path()).unwrap();
            entries.map(|entry| entry.unwrap().file_name()).collect::<std::collections::BTreeSet<_>>()
        };
        let before = names();
        let output = self.tetrascope(args);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {errors}");
        assert_eq!(names(), before, "{args:?}");
        errors
    }

    fn read(&self, name: &str) -> Loaded {
        read_mesh(&self.path(name), &ReadOptions::default()).unwrap()
    }
}

/// All of a dataset in a form that can be compared: the readers' words for numbers are exact.
fn told(dataset: &Dataset) -> String {
    format!("{dataset:?}")
}

fn kinds(dataset: &Dataset) -> usize {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells.kinds.len(),
        Cells::Structured(_) => panic!("a grid"),
    }
}

#[test]
fn a_mesh_is_the_same_in_every_encoding() {
    let run = Run::new();
    let original = told(&run.read("mesh.vtu").dataset);
    for encoding in ["raw", "zlib", "text"] {
        let (said, errors) = run.good(&["convert", "mesh.vtu", "out.vtu", "--encoding", encoding]);
        has(
            &said,
            &["read        mesh.vtu (VTK XML", "points      9", "1 polyhedron", "s, a < \"b\" & c", "of cells    c"],
        );
        has(&said, &["wrote       out.vtu", "bytes)"]);
        assert_eq!(errors, "");
        assert_eq!(told(&run.read("out.vtu").dataset), original, "{encoding}");
    }
    // What is written of what was written is the same file.
    run.good(&["convert", "out.vtu", "a.vtu"]);
    run.good(&["convert", "a.vtu", "b.vtu"]);
    assert_eq!(std::fs::read(run.path("a.vtu")).unwrap(), std::fs::read(run.path("b.vtu")).unwrap());
}

#[test]
fn tetrahedra_are_those_that_are_drawn() {
    let run = Run::new();
    let (said, errors) = run.good(&["convert", "mesh.vtu", "out.vtu", "--tetrahedra"]);
    has(&said, &["points      10", "13 tetrahedron", "4 cells were cut", "1 points are added"]);
    has(
        &errors,
        &[
            "warning: 1 cells are points, lines or faces",
            "1 of 14 tetrahedra have no volume",
            "1 of 14 tetrahedra were inverted",
        ],
    );
    let dataset = run.read("out.vtu").dataset;
    assert_eq!((dataset.points.len(), kinds(&dataset)), (10, 13));
    assert_eq!(dataset.point_arrays[0].component(0)[8..], [f64::from(0.1_f32), 3.5]);
    assert_eq!(dataset.cell_arrays[0].component(0)[11..], [10.0, 20.0]);
    // Both are drawn alike, and the file of tetrahedra has nothing to be mended.
    for name in ["mesh", "out"] {
        run.good(&["render", &format!("{name}.vtu"), "--size", "16", "-o", &format!("{name}.exr"), "--quiet"]);
    }
    let compared = run.json(&["compare", "mesh.exr", "out.exr", "--json"]);
    assert!(compared["largest"].as_f64().unwrap() < 1e-5, "{compared}");
    has(&run.good(&["info", "out.vtu"]).0, &["13; 13 to draw"]);
}

#[test]
fn some_arrays_are_kept() {
    let run = Run::new();
    let said = run.json(&["convert", "mesh.vtu", "out.vtu", "--field", "c", "--field", "s", "--json"]);
    assert_eq!((&said["point_arrays"], &said["cell_arrays"]), (&json!(["s"]), &json!(["c"])));
    assert_eq!((&said["points"], &said["cells"], &said["encoding"]), (&json!(9), &json!(4), &json!("raw")));
    assert_eq!(said["kinds"], json!({ "polyhedron": 1, "tetrahedron": 2, "point, line or face": 1 }));
    assert_eq!(said["bytes"], std::fs::metadata(run.path("out.vtu")).unwrap().len());
    assert_eq!((&said["written"], &said["warnings"]), (&json!(["out.vtu"]), &json!([])));
    let dataset = run.read("out.vtu").dataset;
    assert_eq!((dataset.point_arrays.len(), dataset.cell_arrays.len()), (1, 1));
    let unknown = run.bad(1, &["convert", "mesh.vtu", "new.vtu", "--field", "d"]);
    has(&unknown, &["mesh.vtu", "no array \"d\"", "point array \"s\"", "cell array \"c\", 10 to 255"]);
}

#[test]
fn grids_and_raw_volumes_become_hexahedra() {
    let run = Run::new();
    std::fs::write(run.path("scan.bin"), (0..27).collect::<Vec<u8>>()).unwrap();
    let raw = ["convert", "scan.bin", "out.vtu", "--raw", "3x3x3:uint8:spacing=1,1,2"];
    let (said, errors) = run.good(&raw);
    has(&said, &["raw volume", "8 hexahedron", "note        the grid is written as hexahedra", "ImageFile"]);
    assert_eq!(errors, "");
    let dataset = run.read("out.vtu").dataset;
    assert_eq!((kinds(&dataset), dataset.points[26].z), (8, 4.0));
    has(&run.bad(2, &["convert", "scan.bin", "new.vtu", "--raw", "3x3:uint8"]), &["does not begin with a size"]);
}

#[test]
fn a_step_goes_out_with_its_time() {
    let run = Run::new();
    let other = MESH.replace("0 1 2 3 4 5 6 7 0.1", "9 9 9 9 9 9 9 9 9");
    std::fs::write(run.path("other.vtu"), other).unwrap();
    let list = r#"<VTKFile type="Collection" version="0.1"><Collection>
        <DataSet timestep="0.25" file="mesh.vtu"/><DataSet timestep="1.5" file="other.vtu"/></Collection></VTKFile>"#;
    std::fs::write(run.path("list.pvd"), list).unwrap();
    for (options, step, time, first) in [
        (&[][..], 1, 1.5, 9.0),
        (&["--step", "0"], 0, 0.25, 0.0),
        (&["--time", "-7"], 0, 0.25, 0.0),
        (&["--time", "1.4"], 1, 1.5, 9.0),
    ] {
        let said = run.json(&[&["convert", "list.pvd", "out.vtu", "--json"], options].concat());
        assert_eq!((&said["step"], &said["time"], &said["times"]), (&json!(step), &json!(time), &json!([0.25, 1.5])));
        let loaded = run.read("out.vtu");
        assert_eq!((loaded.times, loaded.dataset.point_arrays[0].component(0)[0]), (vec![time], first));
    }
    has(&run.bad(1, &["convert", "list.pvd", "new.vtu", "--step", "2"]), &["list.pvd", "no step 2", "has 2"]);
    run.bad(2, &["convert", "list.pvd", "new.vtu", "--step", "1", "--time", "1"]);
}

#[test]
fn what_cannot_be_written_is_said_before_the_work() {
    let run = Run::new();
    for name in ["out.vtk", "out", "out.png"] {
        has(&run.bad(2, &["convert", "mesh.vtu", name]), &[name, "meshes are written as .vtu"]);
    }
    has(&run.bad(1, &["convert", "mesh.vtu", "nowhere/out.vtu"]), &["nowhere/out.vtu", "no folder nowhere"]);
    has(&run.bad(2, &["convert", "mesh.vtu", "./mesh.vtu"]), &["would be replaced"]);
    has(&run.bad(1, &["convert", "absent.vtu", "out.vtu"]), &["absent.vtu", "cannot be read"]);
    has(&run.bad(2, &["convert", "mesh.vtu"]), &["2 values required"]);
    std::fs::create_dir(run.path("folder.vtu")).unwrap();
    has(&run.bad(1, &["convert", "mesh.vtu", "folder.vtu"]), &["folder.vtu", "not a regular file"]);
    // The old file stays where the new one fails.
    std::fs::write(run.path("old.vtu"), "old").unwrap();
    run.bad(1, &["convert", "absent.vtu", "old.vtu"]);
    assert_eq!(std::fs::read(run.path("old.vtu")).unwrap(), b"old");
}

#[test]
fn a_mesh_of_faces_alone_goes_out_but_not_as_tetrahedra() {
    let run = Run::new();
    let faces =
        MESH.replace("42 10 10 5", "7 9 9 5").replace("faces\"", "unused\"").replace("faceoffsets\"", "unused too\"");
    std::fs::write(run.path("faces.vtu"), faces).unwrap();
    run.good(&["convert", "faces.vtu", "out.vtu"]);
    assert_eq!(told(&run.read("out.vtu").dataset), told(&run.read("faces.vtu").dataset));
    has(&run.bad(1, &["convert", "faces.vtu", "new.vtu", "--tetrahedra"]), &["faces.vtu"]);
}

#[test]
fn a_grid_and_its_solution_become_one_file() {
    let Some(folder) = shared("data/plot3d") else { return };
    let run = Run::new();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (grid, solution) = (path("bluntfinxyz.bin"), path("bluntfinq.bin"));
    let args = ["convert", &grid, &solution, "fin.vtu", "--field", "Density", "--encoding", "zlib"];
    has(&run.good(&args).0, &["37479 hexahedron", "Density"]);
    let info = run.json(&["info", "fin.vtu", "--json"]);
    assert_eq!((&info["points"], &info["tetrahedra_cut"]), (&json!(40_960), &json!(6 * 37_479)));
}
