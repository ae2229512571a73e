//! Color maps, opacity, ranges, constants of cells, time steps and raw volumes, asked for as a user asks for them.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;
use std::process::{Command, Output};

use tetrascope::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells, read_exr, write_vtu};

fn run(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tetrascope")).args(args).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A picture of 16 by 16 pixels, drawn in the folder.
fn picture(folder: &Path, args: &[&str]) -> Vec<[f32; 4]> {
    let common = ["render", "--size", "16", "-o", "picture.exr", "--quiet"];
    let output = run(folder, &[&common[..], args].concat());
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", text(&output.stderr));
    read_exr(&folder.join("picture.exr")).unwrap().pixels().to_vec()
}

fn refusal(folder: &Path, args: &[&str], code: i32) -> String {
    let output = run(folder, &[&["render", "--size", "16", "--quiet"], args].concat());
    assert_eq!(output.status.code(), Some(code), "{args:?}: {}", text(&output.stderr));
    text(&output.stderr)
}

fn difference(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Two cubes side by side along x, with a value each and values of points that rise along x.
fn two_cells(folder: &Path) {
    let points = (0..12_usize).map(|i| glam::DVec3::new((i % 3) as f64, (i / 3 % 2) as f64, (i / 6) as f64));
    let points: Vec<_> = points.collect();
    let corners = |first: u32| [0, 1, 3, 4, 6, 7, 9, 10].map(|corner| corner + first);
    let cells = UnstructuredCells {
        kinds: vec![CellKind::Voxel; 2],
        offsets: vec![0, 8, 16],
        connectivity: [corners(0), corners(1)].concat(),
        polyhedra: Vec::new(),
    };
    let array = |name: &str, values: Vec<f64>| DataArray {
        name: name.to_owned(),
        components: 1,
        values: ArrayValues::F64(values),
    };
    let x = array("x", points.iter().map(|point| point.x).collect());
    let dataset = Dataset {
        points,
        cells: Cells::Unstructured(cells),
        point_arrays: vec![x],
        cell_arrays: vec![array("c", vec![1.0, 3.0])],
    };
    write_vtu(&folder.join("two.vtu"), &dataset).unwrap();
}

#[test]
fn color_maps_and_opacity() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let rings = |args: &[&str]| picture(at, &[&["builtin:rings"], args].concat());
    let default = rings(&[]);
    assert_eq!(rings(&["--cmap", "viridis"]), default);
    assert!(difference(&rings(&["--cmap", "viridis_r"]), &default) > 0.1);
    assert!(difference(&rings(&["--opacity", "linear"]), &default) < 1e-5);
    assert_eq!(rings(&["--opacity", "0,1"]), rings(&["--opacity", "linear"]));
    assert!(difference(&rings(&["--range", "0,0.1"]), &default) > 0.1);
    assert!(difference(&rings(&["--opacity", "linear", "--opacity-length", "9"]), &default) > 0.1);

    // A file of the same colors, beside the scene and not in the current folder.
    let gray = r#"[{"Name": "a", "ColorSpace": "RGB", "RGBPoints": [5, 0, 0, 0, 9, 1, 1, 1]},
        {"Name": "b", "ColorSpace": "RGB", "RGBPoints": [5, 1, 1, 1, 9, 0, 0, 0]}]"#;
    std::fs::create_dir(at.join("scenes")).unwrap();
    std::fs::write(at.join("scenes/maps.json"), gray).unwrap();
    let scene = "[mesh]\npath = \"builtin:rings\"\n[transfer]\npreset = \"maps.json\"\npreset_name = \"b\"\n";
    std::fs::write(at.join("scenes/scene.toml"), scene).unwrap();
    let turned = picture(at, &["scenes/scene.toml"]);
    assert!(difference(&turned, &rings(&["--cmap", "gray_r"])) < 1e-5);
    assert_eq!(rings(&["--cmap", "scenes/maps.json:b"]), turned);
    assert!(difference(&picture(at, &["scenes/scene.toml", "--cmap", "gray"]), &rings(&["--cmap", "gray"])) < 1e-6);
    let said = run(at, &["render", "scenes/scene.toml", "--cmap", "gray", "--size", "16"]);
    assert!(!text(&said.stderr).contains("transfer.preset"), "{}", text(&said.stderr));

    // Kept as numbers, it is the same picture.
    picture(at, &["scenes/scene.toml", "--opacity", "sigmoid", "--write-scene", "kept.toml"]);
    assert_eq!(picture(at, &["kept.toml"]), picture(at, &["scenes/scene.toml", "--opacity", "sigmoid"]));

    for (args, words) in [
        (&["--cmap", "virids"][..], "viridis"),
        (&["--cmap", "gone.json"], "gone.json"),
        (&["--cmap", "scenes/maps.json"], "2 color maps"),
        (&["--cmap", "scenes/maps.json:c"], "\"c\""),
        (&["--opacity", "sigmund"], "sigmoid"),
    ] {
        let message = refusal(at, &[&["builtin:rings"], args].concat(), 1);
        assert!(message.contains(words), "{args:?}: {message}");
    }
    for args in [&["--range", "2,1"][..], &["--cmap", "gray", "--color", "0:1,1,1"], &["--opacity-length", "a"]] {
        refusal(at, &[&["builtin:rings"], args].concat(), 2);
    }
}

#[test]
fn constants_of_cells_are_drawn_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    two_cells(at);
    let seen =
        ["--eye", "1,0.5,9", "--orthographic", "1", "--color", "1:1,0,0; 2:0,1,0; 3:0,0,1", "--extinction", "0:1"];
    let drawn = picture(at, &[&["two.vtu", "--cells"], &seen[..]].concat());
    let alpha = 1.0 - (-1.0_f32).exp();
    for row in drawn.chunks(16) {
        for (column, [r, g, b, a]) in row.iter().enumerate() {
            let red = if column < 8 { alpha } else { 0.0 };
            for (found, wanted) in [(r, red), (g, 0.0), (b, alpha - red), (a, alpha)] {
                assert!((found - wanted).abs() < 1e-5, "column {column}: {found}, not {wanted}");
            }
        }
    }
    // Averaged onto the points it is 2 between the cells, and that is said.
    let averaged = picture(at, &[&["two.vtu", "--field", "c"], &seen[..]].concat());
    assert!(averaged[8][1] > 0.3 * alpha);
    let said = run(at, &["render", "two.vtu", "--field", "c", "--size", "16"]);
    assert!(text(&said.stderr).contains("--cells"), "{}", text(&said.stderr));
    let message = refusal(at, &["two.vtu", "--cells", "--field", "x"], 1);
    assert!(message.contains("no cell array \"x\""), "{message}");
}

#[test]
fn raw_volumes_and_time_steps() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let bytes: Vec<u8> = (0..27).collect();
    std::fs::write(at.join("samples.bin"), &bytes).unwrap();
    std::fs::write(at.join("samples_3x3x3_uint8.raw"), &bytes).unwrap();
    assert_eq!(picture(at, &["samples.bin", "--raw", "3x3x3:uint8"]), picture(at, &["samples_3x3x3_uint8.raw"]));
    assert!(refusal(at, &["samples.bin", "--raw", "3x3x4:uint8"], 1).contains("36 bytes"));
    assert!(refusal(at, &["samples.bin", "--raw", "3x3:uint8"], 2).contains("SIZE:TYPE"));

    two_cells(at);
    let list = "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"two.vtu\"/>\
                <DataSet timestep=\"2\" file=\"samples_3x3x3_uint8.raw\"/></Collection></VTKFile>";
    std::fs::write(at.join("list.pvd"), list).unwrap();
    let first = picture(at, &["two.vtu"]);
    assert_eq!(picture(at, &["list.pvd", "--step", "0"]), first);
    assert_eq!(picture(at, &["list.pvd", "--time", "0.9"]), first);
    assert_eq!(picture(at, &["list.pvd"]), picture(at, &["samples_3x3x3_uint8.raw"]));
    let said = run(at, &["render", "list.pvd", "--step", "0", "--size", "16", "--write-scene", "kept.toml"]);
    assert!(text(&said.stdout).contains("time step 0 of 0 to 1, at 0"), "{}", text(&said.stdout));
    assert_eq!(picture(at, &["kept.toml"]), first);
    assert!(refusal(at, &["list.pvd", "--step", "2"], 1).contains("no step 2"));
    refusal(at, &["list.pvd", "--step", "1", "--time", "2"], 2);
}
