//! `tetrascope check`, run as a user runs it: what it finds where the answer is known.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn tetrascope(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tetrascope")).args(args).current_dir(folder).output().unwrap()
}

fn good(folder: &Path, args: &[&str]) -> String {
    let output = tetrascope(folder, args);
    assert_eq!(output.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn json(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_str(&good(folder, &[&["check", "--json"], args].concat())).unwrap()
}

/// A legacy file of tetrahedra; the scalar is the point's number.
fn write_mesh(folder: &Path, points: &[[f64; 3]], cells: &[[u32; 4]]) {
    let mut text = "# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\n".to_owned();
    text += &format!("POINTS {} double\n", points.len());
    points.iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z}\n"));
    text += &format!("CELLS {} {}\n", cells.len(), 5 * cells.len());
    cells.iter().for_each(|[a, b, c, d]| text += &format!("4 {a} {b} {c} {d}\n"));
    text += &format!("CELL_TYPES {}\n{}", cells.len(), "10\n".repeat(cells.len()));
    text += &format!("POINT_DATA {}\nSCALARS s double 1\nLOOKUP_TABLE default\n", points.len());
    (0..points.len()).for_each(|i| text += &format!("{i}\n"));
    std::fs::write(folder.join("mesh.vtk"), text).unwrap();
}

/// Three tetrahedra in a row along z, the last one in the file in the middle.
fn write_row(folder: &Path) {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let places = [-6.0, 6.0, 0.0];
    let points: Vec<[f64; 3]> = places.iter().flat_map(|z| corners.map(|[x, y, w]| [x, y, w + z])).collect();
    write_mesh(folder, &points, &[[0, 1, 2, 3], [4, 5, 6, 7], [8, 9, 10, 11]]);
}

fn order<'a>(view: &'a Value, name: &str) -> &'a Value {
    view["orders"].as_array().unwrap().iter().find(|order| order["order"] == name).unwrap()
}

#[test]
fn a_mesh_is_described() {
    let folder = tempfile::tempdir().unwrap();
    let report = json(folder.path(), &["builtin:rings", "--size", "32", "--order", "mpvo"]);
    assert_eq!(report["connected_parts"], 1);
    let faces = &report["faces"];
    // Every tetrahedron has four faces; those inside are shared by two.
    let inside = report["delaunay"]["faces"].as_u64().unwrap();
    assert_eq!(faces["all"].as_u64().unwrap(), inside + faces["boundary"].as_u64().unwrap());
    assert_eq!(2 * inside + faces["boundary"].as_u64().unwrap(), 4 * report["mesh"]["tetrahedra"].as_u64().unwrap());
    assert_eq!(
        (&faces["folded"], &faces["non_manifold"], &report["duplicate_tetrahedra"]),
        (&0.into(), &0.into(), &0.into())
    );
    assert_eq!(report["views"][0]["cyclic"], false);
    assert_eq!(order(&report["views"][0], "mpvo")["pairs"]["neighbors"]["misordered"], 0);

    let text = good(folder.path(), &["check", "builtin:rings", "--size", "32"]);
    for part in
        ["points", "boundary", "convex", "Delaunay", "one key", "view 1", "cyclic      no", "bsp-xmpvo", "1/255"]
    {
        assert!(text.contains(part), "\"{part}\" is not in:\n{text}");
    }
}

#[test]
fn convex_and_delaunay_or_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let corner = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let with = |apex: [f64; 3]| [corner.to_vec(), vec![apex]].concat();
    // The sphere around the first has its middle at (1/2, 1/2, 1/2) and meets the diagonal again at (1, 1, 1).
    // The mesh is convex where the way from the origin to the apex leads through the face between.
    for (apex, is_convex, is_delaunay) in [
        ([0.9; 3], true, false),
        ([1.5; 3], true, true),
        ([1.0, 1.0, -0.5], false, true),
        ([0.5, 0.6, -0.05], false, false),
    ] {
        write_mesh(path, &with(apex), &[[0, 1, 2, 3], [1, 2, 3, 4]]);
        let report = json(path, &["mesh.vtk", "--size", "16", "--order", "none"]);
        assert_eq!(
            (&report["convex"], &report["delaunay"]["proven"]),
            (&is_convex.into(), &is_delaunay.into()),
            "{apex:?}"
        );
        assert_eq!(report["one_key"].is_null(), !is_delaunay, "no heights were asked for");
        let report = json(path, &["mesh.vtk", "--size", "16", "--order", "none", "--heights"]);
        assert_eq!(report["one_key"]["proven"], true, "two cells can always be lifted");
    }
    // The second cell is folded back into the first.
    write_mesh(path, &with([0.1; 3]), &[[0, 1, 2, 3], [1, 2, 3, 4]]);
    let report = json(path, &["mesh.vtk", "--size", "16", "--heights", "--order", "none"]);
    assert_eq!((&report["faces"]["folded"], &report["one_key"]["proven"]), (&1.into(), &false.into()));
}

#[test]
fn orders_are_judged_from_every_view() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_row(path);
    let report =
        json(path, &["mesh.vtk", "--size", "32", "--view", "0.1,0.2,40", "--view=0.1,0.2,-40", "--view", "0,0,0"]);
    assert_eq!((&report["convex"], &report["connected_parts"]), (&false.into(), &3.into()));
    let views = report["views"].as_array().unwrap();
    assert_eq!(views.len(), 3);
    for (view, wrong) in views.iter().zip([2, 1]) {
        // From the front the file has the farthest first and the middle last: 0 before 1 and before 2 are wrong.
        let none = &order(view, "none")["pairs"]["across_gaps"];
        assert_eq!((&none["pairs"], &none["misordered"], &none["complete"]), (&3.into(), &wrong.into(), &true.into()));
        assert_eq!(order(view, "centroid")["pairs"]["across_gaps"]["misordered"], 0);
    }
    assert_eq!(views[1]["camera"]["eye"], serde_json::json!([0.1, 0.2, -40.0]));
}

/// `per-pixel` is what pictures are compared with, so that it differs in no pixel from itself.
#[test]
fn pixels_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_row(path);
    let names = ["none", "mpvo", "per-pixel", "k-buffer"];
    let options = names.iter().flat_map(|name| ["--order", name]);
    let args: Vec<&str> =
        ["mesh.vtk", "--size", "64", "--view", "0.1,0.2,40", "--map", "wrong.png"].into_iter().chain(options).collect();
    let report = json(path, &args);
    let view = &report["views"][0];
    let wrong = &order(view, "none")["pixels"];
    assert!(wrong["above_step"].as_u64().unwrap() > 10, "{wrong}");
    for right in ["mpvo", "per-pixel", "k-buffer"] {
        let pixels = &order(view, right)["pixels"];
        assert_eq!((&pixels["above_rounding"], &pixels["all"]), (&0.into(), &4096.into()), "{right}: {pixels}");
    }
    for left_to_pixels in ["per-pixel", "k-buffer"] {
        assert!(order(view, left_to_pixels)["pairs"].is_null());
    }
    for name in names {
        let map = order(view, name)["map"].as_str().unwrap();
        assert_eq!(map, format!("wrong-{name}.png"));
        assert!(std::fs::read(path.join(map)).unwrap().starts_with(b"\x89PNG"));
    }
}

#[test]
fn what_cannot_be_judged_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_row(path);
    for (code, args, said) in [
        (1, &["check", "absent.vtk"][..], "absent.vtk"),
        (1, &["check", "mesh.vtk", "--field", "t"], "\"t\""),
        (1, &["check", "mesh.vtk", "--map", "nowhere/a.png"], "no folder nowhere"),
        (2, &["check", "mesh.vtk", "--map", "a.exr"], ".png"),
        (2, &["check", "mesh.vtk", "--order", "depth"], "bsp-xmpvo"),
        (2, &["check", "mesh.vtk", "--view", "1,2"], "has 2 numbers"),
        (2, &["check", "mesh.vtk", "--view", "1,2,3", "--eye", "1,2,3"], "cannot be used with"),
        (2, &["check"], "INPUT"),
    ] {
        let output = tetrascope(path, args);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{args:?}: {text}");
        assert!(text.contains(said), "{args:?}: {text}");
        assert!(output.stdout.is_empty());
    }
    write_mesh(path, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]], &[[0, 1, 2, 3]]);
    let output = tetrascope(path, &["check", "mesh.vtk"]);
    assert_eq!(output.status.code(), Some(1), "nothing has a volume");
}

/// Two cells that are convex together and not Delaunay: heights have to be looked for.
#[test]
fn heights_are_kept_beside_the_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.9; 3]];
    write_mesh(path, &points, &[[0, 1, 2, 3], [1, 2, 3, 4]]);
    let render = |options: &[&str]| {
        let output = tetrascope(path, &[&["render", "mesh.vtk", "--size", "8"], options].concat());
        assert_eq!(output.status.code(), Some(0));
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (text(output.stdout), text(output.stderr))
    };
    let kept = path.join("mesh.vtk.heights");
    render(&["--order", "power"]);
    assert!(!kept.exists(), "nobody asked");
    let (out, errors) = render(&["--order", "power", "--keep-heights"]);
    assert!(out.contains("proven for all 1 faces") && errors.is_empty(), "{out}{errors}");
    let bytes = std::fs::read(&kept).unwrap();
    // With heights that are proven, power is what auto takes.
    let (out, _) = render(&["--keep-heights", "--write-scene", "a.toml"]);
    assert!(out.contains("order       power: one key a cell is proven"), "{out}");
    let written = std::fs::read_to_string(path.join("a.toml")).unwrap();
    assert!(written.contains("order = \"power\"") && written.contains("keep_heights = true"), "{written}");
    assert_eq!(std::fs::read(&kept).unwrap(), bytes);
    // Those of another mesh are told and replaced.
    let mut lifted = bytes.clone();
    let count = bytes.len() - 5 * 8;
    lifted[count..].copy_from_slice(&[0.0, 0.0, 0.0, 0.0, -9.0_f64].map(f64::to_le_bytes).concat());
    for (other, said) in [
        (lifted, "do not order this mesh (1 of 1 faces are violated)"),
        (bytes[..bytes.len() - 1].to_vec(), "but 39 follow"),
        (b"something else".to_vec(), "does not begin with TETRASCOPE-HEIGHTS"),
    ] {
        std::fs::write(&kept, other).unwrap();
        let (out, errors) = render(&["--order", "power", "--keep-heights"]);
        assert!(errors.contains("mesh.vtk.heights") && errors.contains(said), "{said}: {errors}");
        assert!(out.contains("proven for all 1 faces"), "{out}");
        assert_eq!(std::fs::read(&kept).unwrap(), bytes, "{said}");
    }
}
