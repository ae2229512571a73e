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

/// Two cells that need heights, and beside them three sticks of which each lies over the next one, seen along z.
fn write_ring(folder: &Path) {
    let mut points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.9; 3]];
    let mut cells = vec![[0, 1, 2, 3], [1, 2, 3, 4]];
    for stick in 0..3 {
        let (sin, cos) = (f64::from(stick) * std::f64::consts::TAU / 3.0).sin_cos();
        // Along the sides of a triangle around a circle of radius 1, rising; the corners are at ±√3.
        let at = |along: f64, beside: f64, above: f64| {
            let across = 1.0 + beside;
            [10.0 + along * cos - across * sin, along * sin + across * cos, 0.4 * along + above]
        };
        let first = points.len() as u32;
        points.extend([at(-2.5, -0.1, 0.0), at(-2.5, 0.1, 0.0), at(2.5, 0.0, -0.1), at(2.5, 0.0, 0.1)]);
        cells.push([first + 1, first, first + 2, first + 3]);
    }
    write_mesh(folder, &points, &cells);
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
    // What is proven across faces may be open across gaps, and the other way round nothing is.
    write_ring(path);
    let args = ["mesh.vtk", "--size", "16", "--order", "none", "--heights"];
    let report = json(path, &args);
    let one_key = &report["one_key"];
    assert_eq!((&one_key["proven"], &one_key["proven_across_gaps"]), (&true.into(), &false.into()));
    assert!(one_key["open_across_gaps"].as_u64().unwrap() > 0);
    let text = good(path, &[&["check"], &args[..]].concat());
    assert!(text.contains("one key     across faces, not across gaps: proven for all 1 faces"), "{text}");
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
    let seen = view["pixels_seen"].as_u64().unwrap();
    assert!(seen > 10 && seen < 4096, "{seen}");
}

#[test]
fn a_view_in_which_nothing_is_seen_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_row(path);
    let args = ["mesh.vtk", "--size", "16", "--order", "none", "--view", "1e9,0,0"];
    let report = json(path, &args);
    assert_eq!(report["views"][0]["pixels_seen"], 0);
    assert_eq!(order(&report["views"][0], "none")["pixels"]["above_rounding"], 0);
    let text = good(path, &[&["check"], &args[..]].concat());
    assert!(text.contains("seen        in no pixel of 256"), "{text}");
}

/// A window of three holds all that a ray meets here, and one slab is no order at all.
#[test]
fn orders_with_numbers_are_judged_for_each() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_row(path);
    let numbers = ["--window", "1", "--window", "3", "--slabs", "1", "--slabs", "50"];
    let common = ["mesh.vtk", "--size", "32", "--view", "0.1,0.2,40"];
    let report = json(path, &[&common, &numbers[..], &["--map", "wrong.png"]].concat());
    let orders = report["views"][0]["orders"].as_array().unwrap();
    let with = |name: &str, key: &str, number: u32| {
        orders.iter().find(|order| order["order"] == name && order[key] == number).unwrap()
    };
    assert_eq!(orders.iter().filter(|order| order["order"] == "k-buffer").count(), 2);
    assert_eq!(with("k-buffer", "window", 3)["pixels"]["above_rounding"], 0);
    assert_eq!(with("k-buffer", "window", 3)["map"], "wrong-k-buffer-3.png");
    assert_eq!(with("bucket", "slabs", 50)["pairs"]["across_gaps"]["misordered"], 0);
    assert_eq!(with("bucket", "slabs", 1)["pairs"]["across_gaps"]["misordered"], 2);
    let text = good(path, &[&["check"], &common[..], &numbers[..]].concat());
    for row in ["k-buffer, 1 ", "k-buffer, 3 ", "bucket, 1 ", "bucket, 50 "] {
        assert!(text.lines().any(|line| line.starts_with(row)), "{row}: {text}");
    }
    let report = json(path, &[&common[..], &["--order", "mpvo", "--window", "2"]].concat());
    let warnings = report["warnings"].as_array().unwrap();
    assert_eq!(warnings, &["--window has no effect: k-buffer is not among the orders"]);
}

#[test]
fn the_mesh_that_is_drawn_is_described() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let corner = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    write_mesh(path, &[&corner[..], &[[1.5; 3]]].concat(), &[[0, 1, 2, 3], [1, 2, 3, 4]]);
    let text = std::fs::read_to_string(path.join("mesh.vtk")).unwrap();
    std::fs::write(path.join("mesh.vtk"), format!("{}nan\n", text.strip_suffix("4\n").unwrap())).unwrap();
    let report = json(path, &["mesh.vtk", "--size", "16", "--order", "none"]);
    assert_eq!((&report["mesh"]["tetrahedra"], &report["field_not_finite"]), (&1.into(), &1.into()));
    let faces = &report["faces"];
    assert_eq!((&faces["all"], &faces["boundary"], &report["connected_parts"]), (&4.into(), &4.into(), &1.into()));
    assert_eq!(report["convex"], true);
    let text = good(path, &["check", "mesh.vtk", "--size", "16", "--order", "none"]);
    for part in ["5 points, 1 tetrahedra", "1 where the field is not finite", "4: 4 on the boundary"] {
        assert!(text.contains(part), "{part}: {text}");
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
        (2, &["check", "mesh.vtk", "--map", "a.jpg"], "'tetrascope check --help'"),
        (2, &["check", "mesh.vtk", "--window", "0"], "0"),
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

/// The heights are proven for all faces, and across gaps nothing can be: auto takes another order, and the search is not repeated.
#[test]
fn heights_that_auto_looked_for_are_kept_whichever_order_it_takes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_ring(path);
    let render = |options: &[&str]| {
        let output = tetrascope(path, &[&["render"], options, &["--size", "8"]].concat());
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "{options:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let kept = path.join("mesh.vtk.heights");
    let out = render(&["mesh.vtk", "--keep-heights", "--write-scene", "a.toml"]);
    assert!(out.contains("order       bsp-xmpvo"), "{out}");
    let written = std::fs::read_to_string(path.join("a.toml")).unwrap();
    assert!(written.contains("order = \"bsp-xmpvo\"") && written.contains("keep_heights = true"), "{written}");
    // Others that are as good: found anew, they would be those of before.
    let bytes = std::fs::read(&kept).unwrap();
    let (header, heights) = bytes.split_at(24);
    let twice = heights.chunks_exact(8).flat_map(|b| (2.0 * f64::from_le_bytes(b.try_into().unwrap())).to_le_bytes());
    let others: Vec<u8> = header.iter().copied().chain(twice).collect();
    std::fs::write(&kept, &others).unwrap();
    for again in [&["mesh.vtk", "--keep-heights"][..], &["a.toml"], &["a.toml", "--order", "auto"]] {
        render(again);
        assert!(std::fs::read(&kept).unwrap() == others, "{again:?}");
    }
}

#[test]
fn heights_that_order_nothing_are_not_kept_and_that_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // The second cell is folded back into the first.
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1; 3]];
    write_mesh(path, &points, &[[0, 1, 2, 3], [1, 2, 3, 4]]);
    let output = tetrascope(path, &["render", "mesh.vtk", "--size", "8", "--keep-heights"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("no heights were found that order this mesh (1 of 1 faces"), "{text}");
    assert!(!path.join("mesh.vtk.heights").exists());
}

#[test]
fn remedies_for_rings_stay_with_orders_that_find_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write_ring(path);
    let scene = "[mesh]\npath = \"mesh.vtk\"\n[camera]\neye = [10, 0, 12]\ntarget = [10, 0, 0]\n[quality]\ncycles = \"report\"\n";
    std::fs::write(path.join("a.toml"), scene).unwrap();
    let render = |options: &[&str]| {
        let output =
            tetrascope(path, &[&["render", "a.toml", "--size", "32", "--write-scene", "b.toml"], options].concat());
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let written = std::fs::read_to_string(path.join("b.toml")).unwrap();
        (text(output.stdout), text(output.stderr), written)
    };
    for options in [&[][..], &["--order", "bsp-xmpvo"]] {
        let (out, errors, written) = render(options);
        assert!(errors.is_empty() && written.contains("cycles = \"report\""), "{errors}{written}");
        assert!(
            out.contains("cycles      report") && out.contains("3 tetrahedra hide one another in 1 ring,"),
            "{out}"
        );
        assert!(out.contains("drawn       3 of 5 tetrahedra"), "{out}");
    }
    let (out, _, _) = render(&["--cycles", "cut"]);
    assert!(out.contains("tetrahedra and pieces, of 5 tetrahedra"), "{out}");
    assert!(out.contains("are cut, where they can be"), "{out}");
    let (_, errors, written) = render(&["--order", "centroid"]);
    assert!(errors.is_empty() && !written.contains("cycles"), "{errors}{written}");
    // A Delaunay mesh is given "power", which finds no rings.
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.5; 3]];
    write_mesh(path, &points, &[[0, 1, 2, 3], [1, 2, 3, 4]]);
    let (_, errors, written) = render(&["--eye", "3,4,5"]);
    assert!(errors.contains("quality.cycles has no effect: the order power looks for no rings"), "{errors}");
    assert!(!written.contains("cycles"), "{written}");
}
