//! The built program, run as a user runs it.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

mod common;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

use common::{has, shared};

/// A folder of its own for every test; the program runs in it.
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

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    fn tetrascope(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_tetrascope")).args(args).current_dir(self.folder.path()).output().unwrap()
    }

    /// Runs what must succeed; standard output.
    fn good(&self, args: &[&str]) -> String {
        let output = self.tetrascope(args);
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", stderr(&output));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs what must fail with this code and leave no picture; standard error.
    fn bad(&self, code: i32, args: &[&str]) -> String {
        let output = self.tetrascope(args);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{args:?}: {text}");
        assert!(text.contains("error"), "{args:?}: {text}");
        let files = || std::fs::read_dir(self.folder.path()).unwrap().map(|e| e.unwrap().file_name());
        let left: Vec<_> = files().filter(|name| !Path::new(name).extension().is_some_and(is_input)).collect();
        assert!(left.is_empty(), "{args:?} left {left:?}");
        text
    }
}

fn is_input(extension: &std::ffi::OsStr) -> bool {
    ["vtu", "toml", "json"].iter().any(|input| extension == *input)
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Two tetrahedra with a scalar, a vector, a cell array, and an array with a NaN at the far point.
const MESH: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="5" NumberOfCells="2">
<PointData>
<DataArray type="Float64" Name="v" NumberOfComponents="3" format="ascii">1 0 0  0 2 0  0 0 3  0 3 4  1 1 1</DataArray>
<DataArray type="Float64" Name="s" format="ascii">0 1 2 3 4</DataArray>
<DataArray type="Float64" Name="holes" format="ascii">0 1 2 3 nan</DataArray>
<DataArray type="Float64" Name="nothing" format="ascii">nan nan nan nan nan</DataArray>
<DataArray type="Float64" Name="flat" format="ascii">2.5 2.5 2.5 2.5 2.5</DataArray>
</PointData>
<CellData><DataArray type="Float64" Name="c" format="ascii">10 20</DataArray></CellData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0  1 0 0  0 1 0  0 0 1  1 1 1</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 1 2 3 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray>
</Cells></Piece></UnstructuredGrid></VTKFile>
"#;

#[test]
fn a_mesh_becomes_a_picture_and_the_choices_are_said() {
    let run = Run::new();
    let out = run.good(&["render", "mesh.vtu", "--size", "40x30", "-o", "a.png", "-o", "a.exr"]);
    has(
        &out,
        &["2 tetrahedra", "field       s, 0 to 4", "first scalar point array", "looks along -z", "exact", "mpvo"],
    );
    has(
        &out,
        &["viridis over 0 to 4", "no lighting", "cpu,", "thread", "wrote       a.png", "a.exr", "decompose", "write"],
    );
    assert!(std::fs::read(run.path("a.png")).unwrap().starts_with(b"\x89PNG"));
    let image = tetrascope::read_exr(&run.path("a.exr")).unwrap();
    assert_eq!((image.width(), image.height()), (40, 30));
    assert!(image.pixels().iter().any(|p| p[3] > 0.5));
}

#[test]
fn the_picture_goes_to_the_current_folder_by_default() {
    let run = Run::new();
    has(&run.good(&["render", "mesh.vtu", "--size", "8"]), &["tetrascope.png"]);
    assert!(run.path("tetrascope.png").exists());
    assert_eq!(run.good(&["render", "mesh.vtu", "--size", "8", "--quiet"]), "");
}

#[test]
fn without_arguments_the_sample_is_drawn() {
    let run = Run::new();
    has(&run.good(&[]), &["built-in sample", "tetrascope.png", "Try next", "tetrascope info"]);
    assert!(std::fs::metadata(run.path("tetrascope.png")).unwrap().len() > 10_000);
}

#[test]
fn a_wrong_field_lists_the_fields() {
    let run = Run::new();
    let text = run.bad(1, &["render", "mesh.vtu", "--field", "Density", "-o", "a.png"]);
    has(
        &text,
        &["mesh.vtu", "\"Density\"", "point array \"s\", 0 to 4", "\"v\", 3 components", "cell array \"c\", 10 to 20"],
    );
    has(&text, &["1 not finite"]);
    has(&run.bad(1, &["render", "mesh.vtu", "--field", "v:7"]), &["v:0 to v:2"]);
    has(&run.bad(1, &["render", "mesh.vtu", "--field", "nothing"]), &["no finite value"]);
}

#[test]
fn fields_by_part_and_association() {
    let run = Run::new();
    has(&run.good(&["render", "mesh.vtu", "--size", "8", "--field", "v"]), &["v:mag", "magnitude is taken"]);
    has(&run.good(&["render", "mesh.vtu", "--size", "8", "--field", "v:y"]), &["v:1, 0 to 3"]);
    let warnings = |field| stderr(&run.tetrascope(&["render", "mesh.vtu", "--size", "8", "--field", field]));
    has(&warnings("c"), &["warning", "averaged onto the points"]);
    has(&warnings("holes"), &["warning", "1 of 2 tetrahedra are left out"]);
    has(&warnings("flat"), &["warning", "2.5 everywhere"]);
    assert_eq!(warnings("s"), "");
}

#[test]
fn wrong_input_is_one() {
    let run = Run::new();
    run.write("broken.vtu", &MESH[..MESH.len() / 2]);
    run.write("typo.toml", "[mesh]\npath = \"mesh.vtu\"\n[image]\nwidht = 5\n");
    run.write("iso.toml", "[mesh]\npath = \"mesh.vtu\"\n[[isosurface]]\nvalue = 1.5\ncolor = [1, 1, 1]\nopacity = 2\n");
    run.write("file.toml", "[mesh]\npath = \"mesh.vtu\"\n[[surface]]\npath = \"fin.glb\"\n");
    run.write("typo.json", "{\"mesh\": {\"path\": \"mesh.vtu\"},\n\"lihgt\": {}}");
    has(&run.bad(1, &["render", "absent.vtu"]), &["absent.vtu", "check the path"]);
    has(&run.bad(1, &["render", "absent.toml"]), &["absent.toml", "check the path"]);
    has(&run.bad(1, &["render", "broken.vtu"]), &["broken.vtu"]);
    has(&run.bad(1, &["render", "typo.toml"]), &["typo.toml", "line 4", "`widht`", "`width`"]);
    has(&run.bad(1, &["render", "typo.json"]), &["typo.json", "line 2", "`lihgt`", "`light`"]);
    has(&run.bad(1, &["render", "iso.toml"]), &["iso.toml", "isosurface[0].opacity is 2", "0 to 1"]);
    has(&run.bad(1, &["render", "file.toml"]), &["file.toml", "[[surface]]", "not supported yet"]);
    has(&run.bad(1, &["render", "builtin:teapot"]), &["builtin:rings"]);
    has(&run.bad(1, &["render", "mesh.vtu", "-o", "nowhere/a.png"]), &["no folder nowhere"]);
    has(&run.bad(1, &["render", "mesh.vtu", "--eye", "1,1,1", "--target", "1,1,1"]), &["same point"]);
    has(&run.bad(1, &["info", "absent.vtu"]), &["absent.vtu"]);
}

#[test]
fn wrong_usage_is_two() {
    let run = Run::new();
    has(&run.bad(2, &["render", "mesh.vtu", "-o", "a.jpg"]), &["a.jpg", ".png and .exr", "'tetrascope render --help'"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--write-scene", "a.yaml"]), &["a.yaml", ".toml and .json"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--eye", "1,2"]), &["has 2 numbers"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--integration", "exakt"]), &["\"exact\""]);
    has(&run.bad(2, &["render", "mesh.vtu", "--integration", "exakt"]), &["\"table-3d\"", "\"partial\""]);
    has(&run.bad(2, &["render", "mesh.vtu", "--isosurface", "1:2,3"]), &["has 2 numbers", "red, green, blue"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--isosurface", "nan"]), &["not a finite number"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--shading", "flat"]), &["--isosurface"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--isosurface", "1", "--shading", "phong"]), &["none, flat and smooth"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--table-size", "1"]), &["2..=1024"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--length-axis", "cubic"]), &["linear and logarithmic"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--order", "depth"]), &["bsp-xmpvo", "k-buffer"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--cycles", "ignore"]), &["report, cut or per-pixel"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--order", "k-buffer", "--window", "0"]), &["0"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--backend", "cuda"]), &["cpu, gpu and reference"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--gpu-path", "mesh"]), &["triangles and compute"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--target-bits", "24"]), &["16 and 32"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--explain", "--quiet"]), &["cannot be used with"]);
    run.bad(2, &["devices", "mesh.vtu"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--fov", "30", "--orthographic", "2"]), &["cannot be used with"]);
    has(&run.bad(2, &["render", "mesh.vtu", "--threads", "0"]), &["0"]);
    has(&run.bad(2, &["render", "mesh.vtu", "a.toml"]), &["names its mesh itself"]);
    run.bad(2, &["render"]);
    run.bad(2, &["paint"]);
}

#[test]
fn a_failed_run_leaves_the_old_picture_alone() {
    let run = Run::new();
    run.write("a.png", "old");
    let output = run.tetrascope(&["render", "mesh.vtu", "--field", "none", "-o", "a.png"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(std::fs::read(run.path("a.png")).unwrap(), b"old");
}

#[test]
fn a_written_scene_gives_the_same_bytes() {
    let run = Run::new();
    std::fs::create_dir(run.path("sub")).unwrap();
    for (index, options) in [
        &[][..],
        &["--field", "v", "--orthographic", "2.5", "--model", "emitter"],
        &["--isosurface", "1.5", "--isosurface", "2.5:1,0.5,0,0.5", "--shading", "smooth"],
        &["--eye", "0.3,-4,2", "--up", "0,0,1", "--color", "0:0,0.5,1; 4:1,1,0", "--order", "bucket", "--slabs", "7"],
        &["--order", "k-buffer", "--window", "3"],
        &["--order", "mpvo", "--cycles", "report"],
        &["--field", "flat", "--integration", "average", "--backend", "reference", "--background", "0.1,0.2,0.3"],
    ]
    .into_iter()
    .enumerate()
    {
        for extension in ["toml", "json"] {
            let scene = format!("sub/{index}.{extension}");
            let first = [
                &["render", "mesh.vtu", "--size", "31x17", "-o", "a.exr", "-o", "a.png", "--write-scene", &scene],
                options,
            ];
            run.good(&first.concat());
            run.good(&["render", &scene, "-o", "b.exr", "-o", "b.png"]);
            for kind in ["exr", "png"] {
                let bytes = |name: &str| std::fs::read(run.path(&format!("{name}.{kind}"))).unwrap();
                assert!(bytes("a") == bytes("b"), "{scene} gives another .{kind}");
            }
        }
    }
}

#[test]
fn isosurfaces_are_added_to_those_of_the_scene() {
    let run = Run::new();
    run.write(
        "a.toml",
        "[mesh]\npath = \"mesh.vtu\"\n[[isosurface]]\nvalue = 3.5\ncolor = [1, 0, 0]\nback_color = [0, 0, 1]\n",
    );
    let options = ["--isosurface", "1.5:0,1,0,0.25", "--isosurface", "2", "--shading", "flat", "--size", "8"];
    let out = run.good(&[&["render", "a.toml", "--write-scene", "b.toml"], &options[..]].concat());
    has(&out, &["isosurfaces 3 by exact", "light       headlight: on isosurfaces", "gradients   one a cell"]);
    let written = std::fs::read_to_string(run.path("b.toml")).unwrap();
    let sections: Vec<&str> = written.split("[[isosurface]]").skip(1).collect();
    let [first, second, third] = sections[..] else { panic!("not three in:\n{written}") };
    has(first, &["value = 3.5", "back_color = [0.0, 0.0, 1.0]", "opacity = 1.0", "shading = \"none\""]);
    has(second, &["value = 1.5", "back_color = [0.0, 1.0, 0.0]", "opacity = 0.25", "shading = \"flat\""]);
    has(third, &["value = 2.0", "color = [0.9, 0.9, 0.9]", "opacity = 1.0", "shading = \"flat\""]);
    has(&written, &["[light]", "direction = \"headlight\"", "isosurfaces = \"exact\""]);
}

#[test]
fn isosurfaces_are_in_the_report() {
    let run = Run::new();
    let json = |options: &[&str]| -> serde_json::Value {
        let args = [&["render", "mesh.vtu", "--size", "8", "--json"], options].concat();
        serde_json::from_str(&run.good(&args)).unwrap()
    };
    let report = json(&["--isosurface", "2.5", "--isosurface=-1", "--shading", "smooth"]);
    assert_eq!(report["isosurfaces"], serde_json::json!({ "count": 2, "values": [-1.0, 2.5], "method": "exact" }));
    assert_eq!((&report["gradients"], &report["tables"]), (&"points".into(), &serde_json::Value::Null));
    let warnings = report["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1);
    has(warnings[0].as_str().unwrap(), &["isosurface[1].value is -1", "the field goes from 0 to 4", "not seen"]);
    let plain = json(&[]);
    assert_eq!(plain["isosurfaces"]["count"], 0);
    assert_eq!(plain["gradients"], "none");
}

#[test]
fn methods_that_do_not_go_together_are_refused() {
    let run = Run::new();
    let text = run.bad(1, &["render", "mesh.vtu", "--integration", "partial", "--model", "emitter"]);
    has(&text, &["quality.integration", "\"partial\"", "\"emitter\"", "\"exact\""]);
    let text = run.bad(1, &["render", "mesh.vtu", "--integration", "vertex", "--isosurface", "1"]);
    has(&text, &["quality.integration = \"vertex\"", "cannot cut", "\"map-smooth\""]);
    let text = run.bad(1, &["render", "mesh.vtu", "--integration", "vertex", "--order", "mpvo", "--cycles", "cut"]);
    has(&text, &["quality.cycles = \"cut\"", "quality.integration = \"vertex\"", "\"per-pixel\""]);
    run.write(
        "a.toml",
        "[mesh]\npath = \"mesh.vtu\"\n[quality]\nintegration = \"exact\"\nisosurfaces = \"map-stopped\"\n\
         [[isosurface]]\nvalue = 1\ncolor = [1, 1, 1]\n",
    );
    has(&run.bad(1, &["render", "a.toml"]), &["a.toml", "map-stopped", "\"table-3d\""]);
}

#[test]
fn keys_without_an_effect_are_said() {
    let run = Run::new();
    run.write(
        "a.toml",
        "[mesh]\npath = \"mesh.vtu\"\n[light]\nambient = 0.5\n[quality]\nintegration = \"table-3d\"\ntable_lengths = 8\n",
    );
    // With the integration goes what the scene says about its table.
    let args = ["render", "a.toml", "--integration", "exact", "--table-size", "16", "--size", "8", "-o", "a.png"];
    let output = run.tetrascope(&args);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    has(&text, &["quality.table_size has no effect: the integration exact", "[light] has no effect: nothing is lit"]);
    assert!(!text.contains("table_lengths"), "{text}");
}

#[test]
fn orders_are_chosen_and_their_worth_is_said() {
    let run = Run::new();
    run.write("a.toml", "[mesh]\npath = \"mesh.vtu\"\n[quality]\norder = \"k-buffer\"\nwindow = 3\n");
    for (options, said) in [
        (&[][..], &["order       mpvo: the mesh is convex", "guarantee   exact: the mesh is convex"][..]),
        (&["--order", "power"], &["order       power: asked for", "guarantee   proven for all 1 faces"]),
        (
            &["--order", "auto", "--model", "emission"],
            &["order       none", "guarantee   nothing depends on the order"],
        ),
        (&["--order", "mpvo"], &["order       mpvo: asked for", "cycles      per-pixel", "guarantee   exact"]),
        (&["--order", "centroid"], &["guarantee   not guaranteed: by one point of a cell"]),
        (&["--order", "k-buffer"], &["k-buffer, 6 cells a pixel", "within 6 cells"]),
        (&["--order", "per-pixel"], &["guarantee   exact: sorted in every pixel"]),
        (&["--backend", "reference"], &["order       per pixel", "exact: sorted along every ray"]),
    ] {
        let out = run.good(&[&["render", "mesh.vtu", "--size", "8"], options].concat());
        has(&out, said);
    }
    has(&run.good(&["render", "a.toml", "--size", "8"]), &["k-buffer, 3 cells a pixel"]);
    // With the order goes what the scene says about it, without a word.
    let output = run.tetrascope(&["render", "a.toml", "--size", "8", "--order", "mpvo", "--write-scene", "b.toml"]);
    assert_eq!(stderr(&output), "");
    let written = std::fs::read_to_string(run.path("b.toml")).unwrap();
    has(&written, &["order = \"mpvo\"", "cycles = \"per-pixel\""]);
    assert!(!written.contains("window"), "{written}");
    let text = stderr(&run.tetrascope(&["render", "mesh.vtu", "--size", "8", "--window", "3"]));
    has(&text, &["quality.window has no effect: the order is auto, not k-buffer"]);
}

#[test]
fn options_override_the_scene() {
    let run = Run::new();
    run.write(
        "a.toml",
        "[mesh]\npath = \"mesh.vtu\"\nfield = \"v\"\n[camera]\nheight = 2.0\nprojection = \"orthographic\"\n",
    );
    let out = run.good(&["render", "a.toml", "--field", "s", "--fov", "20", "--size", "8"]);
    has(&out, &["field       s,", "perspective, 20 degrees"]);
}

#[test]
fn json_is_json() {
    let run = Run::new();
    let json = |args: &[&str]| -> serde_json::Value { serde_json::from_str(&run.good(args)).unwrap() };
    let report = json(&["render", "mesh.vtu", "--size", "8", "--json", "--field", "holes", "-o", "a.png"]);
    assert_eq!(report["field"]["range"], serde_json::json!([0.0, 3.0]));
    assert_eq!(report["field"]["left_out"], 1);
    assert_eq!(report["written"][0], "a.png");
    assert_eq!(report["blank"], false);
    assert_eq!(report["warnings"].as_array().unwrap().len(), 1);
    assert!(report["timings_secs"]["rasterize"].as_f64().unwrap() >= 0.0);
    let info = json(&["info", "mesh.vtu", "--json"]);
    assert_eq!((&info["tetrahedra"], &info["cells"]["tetrahedron"]), (&2.into(), &2.into()));
    assert_eq!(info["arrays"][1]["name"], "s");
    assert_eq!(info["bounds"], serde_json::json!([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]));
}

#[test]
fn info_tells_what_is_there() {
    let run = Run::new();
    let out = run.good(&["info", "mesh.vtu"]);
    has(&out, &["2  tetrahedron", "point array \"s\", 0 to 4, Float64", "x 0 to 1", "none: the mesh is sound"]);
    has(&out, &["1 not finite", "VTK XML"]);
}

#[test]
fn a_blank_picture_is_explained() {
    let run = Run::new();
    for (options, reason) in [
        (
            ["--extinction", "7:0; 8:1"],
            "the field goes from 0 to 4, the control points of the extinction from 7 to 8, and the field lies outside of them",
        ),
        (["--target", "50,50,50"], "does not see the mesh"),
        (["--extinction", "0:1e-9"], "too small"),
    ] {
        let args = [&["render", "mesh.vtu", "--size", "16", "--eye", "9,9,9"], &options[..]].concat();
        let output = run.tetrascope(&args);
        assert_eq!(output.status.code(), Some(0));
        has(&stderr(&output), &["warning: the picture is blank", reason]);
    }
}

#[test]
fn hostile_files_end_in_a_picture_or_in_a_message() {
    let Some(folder) = shared("data/hostile") else { return };
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    files.sort();
    assert!(files.len() > 50);
    for file in files {
        let run = Run::new();
        let output = run.tetrascope(&["render", file.to_str().unwrap(), "--size", "16", "-o", "a.exr"]);
        let (text, name) = (stderr(&output), file.file_name().unwrap().to_string_lossy().into_owned());
        match output.status.code() {
            Some(0) => {
                let image = tetrascope::read_exr(&run.path("a.exr")).unwrap();
                let is_finite = image.pixels().iter().flatten().all(|c| c.is_finite());
                assert!(is_finite, "{name} gives NaN");
            }
            Some(1) => {
                assert!(text.contains("error: ") && text.contains(&name), "{name}: {text}");
                assert!(!run.path("a.exr").exists(), "{name} left a picture");
            }
            other => panic!("{name}: {other:?}: {text}"),
        }
    }
}

#[test]
fn odd_but_valid_files_are_drawn_and_their_oddness_is_said() {
    for (name, said) in [
        ("constant_scalar.vtu", "2.5 everywhere"),
        ("nan_inf_scalars_ascii.vtu", "NaN or infinite"),
        ("nan_coordinates.vtu", "not finite"),
        ("inverted_tets.vtu", "inverted"),
        ("nanometres.vtu", ""),
        ("scale_1e20.vtu", ""),
        ("crlf.vtk", ""),
        ("duplicate_points.vtu", ""),
    ] {
        let Some(file) = shared(&format!("data/hostile/{name}")) else { return };
        let run = Run::new();
        let output = run.tetrascope(&["render", file.to_str().unwrap(), "--size", "32", "-o", "a.exr"]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{name}: {text}");
        has(&text, &[said]);
        assert!(!text.contains("blank"), "{name}: {text}");
    }
}

#[test]
fn devices_are_listed_where_there_is_none_too() {
    let run = Run::new();
    let text = run.good(&["devices"]);
    has(text.lines().last().unwrap(), &["--backend auto draws with"]);
    let json: serde_json::Value = serde_json::from_str(&run.good(&["devices", "--json"])).unwrap();
    let adapters = json["adapters"].as_array().unwrap();
    for (number, adapter) in adapters.iter().enumerate() {
        assert_eq!(adapter["number"], number);
        assert!(adapter["name"].is_string() && adapter["largest_binding"].is_u64(), "{adapter}");
        assert!(text.contains(adapter["name"].as_str().unwrap()), "{text}");
    }
    assert!(json["auto"].is_null() || json["auto"].as_u64().is_some_and(|number| number < adapters.len() as u64));
}

#[test]
fn a_gpu_that_is_not_there() {
    let run = Run::new();
    let asked = ["render", "mesh.vtu", "--size", "8", "--adapter", "a card that no machine has", "--backend"];
    has(
        &run.bad(1, &[&asked[..], &["gpu"]].concat()),
        &["no graphics adapter's name contains \"a card that no machine has\""],
    );
    // Left open, the CPU draws, and one line says why.
    let output = run.tetrascope(&[&asked[..], &["auto", "--write-scene", "a.toml"]].concat());
    let (said, warned) = (String::from_utf8_lossy(&output.stdout).into_owned(), stderr(&output));
    assert_eq!(output.status.code(), Some(0), "{warned}");
    has(&said, &["backend     cpu, ", ": the GPU failed"]);
    has(&warned, &["the back end is cpu, as the GPU failed: no graphics adapter's name contains"]);
    assert_eq!(warned.lines().count(), 1, "{warned}");
    let written = std::fs::read_to_string(run.path("a.toml")).unwrap();
    has(&written, &["backend = \"cpu\""]);
    assert!(!written.contains("adapter"), "{written}");
}

#[test]
fn what_is_asked_of_a_gpu_goes_with_one() {
    let run = Run::new();
    run.write(
        "a.toml",
        "[mesh]\npath = \"mesh.vtu\"\n[quality]\nbackend = \"gpu\"\ngpu_path = \"triangles\"\ntarget_bits = 16\nadapter = \"0\"\n",
    );
    let vertex = ["render", "mesh.vtu", "--backend", "gpu", "--gpu-path", "compute", "--integration", "vertex"];
    has(&run.bad(1, &vertex), &["quality.integration = \"vertex\"", "quality.gpu_path = \"triangles\""]);
    let cut = ["render", "mesh.vtu", "--backend", "gpu", "--order", "mpvo", "--cycles", "cut"];
    has(&run.bad(1, &cut), &["quality.cycles = \"cut\"", "\"per-pixel\"", "quality.backend = \"cpu\""]);
    // With the back end goes what the scene asks of it, without a word.
    let output = run.tetrascope(&["render", "a.toml", "--size", "8", "--backend", "cpu", "--explain"]);
    assert_eq!(stderr(&output), "");
    has(&String::from_utf8_lossy(&output.stdout), &["explain     the back end cpu uses no device"]);
    let output = run.tetrascope(&["render", "mesh.vtu", "--size", "8", "--gpu-path", "compute"]);
    has(&stderr(&output), &["quality.gpu_path has no effect: the back end is cpu, not gpu"]);
}
