//! `tetrascope animate`, run as a user runs it: one scale for all frames, and going on where it stopped.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tetrascope::{
    ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells, mesh::rings_sample, read_png, write_vtu,
};

fn run(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tetrascope")).args(args).current_dir(folder).output().unwrap()
}

fn animate(folder: &Path, args: &[&str]) -> Output {
    run(folder, &[&["animate", "--size", "16"], args].concat())
}

fn good(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    text(&output.stdout)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn pixels(path: &Path) -> Vec<[u16; 4]> {
    read_png(path).unwrap().pixels
}

/// A mesh on which the field grows from step to step.
fn step(factor: f64) -> Dataset {
    let points: Vec<_> = rings_sample(1).points;
    // A cube whose points are counted along x, y and z, as VTK has the corners of a voxel.
    let cells = UnstructuredCells {
        kinds: vec![CellKind::Voxel],
        offsets: vec![0, 8],
        connectivity: (0..8).collect(),
        polyhedra: Vec::new(),
    };
    let values = points.iter().map(|point| factor * (1.0 + point.x)).collect();
    let array = DataArray { name: "T".to_owned(), components: 1, values: ArrayValues::F64(values) };
    Dataset { points, cells: Cells::Unstructured(cells), point_arrays: vec![array], cell_arrays: Vec::new() }
}

/// Three files and a list of them with times.
fn series(folder: &Path) {
    let mut list = String::from("<VTKFile type=\"Collection\"><Collection>");
    for (number, factor) in [1.0, 2.0, 5.0].into_iter().enumerate() {
        let name = format!("out_{number}.vtu");
        write_vtu(&folder.join(&name), &step(factor)).unwrap();
        list.push_str(&format!("<DataSet timestep=\"{}\" file=\"{name}\"/>", 0.5 * factor));
    }
    std::fs::write(folder.join("out.pvd"), list + "</Collection></VTKFile>").unwrap();
}

#[test]
fn all_time_steps_have_one_scale() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    series(at);
    let said = good(&animate(at, &["out.pvd", "-o", "a/b"]));
    assert!(said.contains("3, times 0.5 to 2.5") && said.contains("frames      3 drawn"), "{said}");
    assert_eq!(names(&at.join("a/b")), ["animation.json", "frame_0000.png", "frame_0001.png", "frame_0002.png"]);
    let frame = |folder: &str, number: usize| pixels(&at.join(folder).join(format!("frame_000{number}.png")));
    // The first frame has colors of the low end of what the last one reaches.
    good(&run(
        at,
        &["render", "out_0.vtu", "--size", "16", "--range", &range(&at.join("a/b")), "-o", "first.png", "--quiet"],
    ));
    assert_eq!(pixels(&at.join("first.png")), frame("a/b", 0));
    good(&run(at, &["render", "out_0.vtu", "--size", "16", "-o", "alone.png", "--quiet"]));
    assert_ne!(pixels(&at.join("alone.png")), frame("a/b", 0));

    // A list of files is the same, and so is every second of the steps.
    let listed = ["out_0.vtu", "out_1.vtu", "out_2.vtu", "-o", "list", "--json"];
    let said: Value = serde_json::from_str(&good(&animate(at, &listed))).unwrap();
    assert_eq!((&said["frames"], &said["drawn"], &said["steps"]), (&3.into(), &3.into(), &3.into()));
    good(&animate(at, &["out.pvd", "-o", "half", "--every", "2"]));
    for number in 0..3 {
        assert_eq!(frame("list", number), frame("a/b", number), "{number}");
    }
    assert_eq!((frame("half", 0), frame("half", 1)), (frame("a/b", 0), frame("a/b", 2)));
}

/// What the record says of the scale.
fn range(folder: &Path) -> String {
    let record: Value = serde_json::from_slice(&std::fs::read(folder.join("animation.json")).unwrap()).unwrap();
    format!("{},{}", record["range"][0], record["range"][1])
}

#[test]
fn an_interrupted_one_goes_on_where_it_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    series(at);
    let args = ["out.pvd", "-o", "film", "--frames", "6", "--turn", "90"];
    good(&animate(at, &args));
    let film = at.join("film");
    let all: Vec<Vec<[u16; 4]>> = (0..6).map(|n| pixels(&film.join(format!("frame_000{n}.png")))).collect();
    assert!(all.windows(2).all(|pair| pair[0] != pair[1]));
    // What is there is not drawn again, what is not is as it was.
    for gone in [1, 4, 5] {
        std::fs::remove_file(film.join(format!("frame_000{gone}.png"))).unwrap();
    }
    std::fs::write(film.join("frame_0000.png"), "kept").unwrap();
    let said = good(&animate(at, &args));
    assert!(said.contains("3 drawn, 3 were there before"), "{said}");
    assert_eq!(std::fs::read(film.join("frame_0000.png")).unwrap(), b"kept");
    for number in [1, 4, 5] {
        assert_eq!(pixels(&film.join(format!("frame_000{number}.png"))), all[number], "{number}");
    }

    // Another animation does not go into the folder unasked, and leaves nothing of the old one when it is asked.
    let other = ["out.pvd", "-o", "film", "--frames", "2"];
    let refused = animate(at, &other);
    assert_eq!(refused.status.code(), Some(1));
    let message = text(&refused.stderr);
    assert!(message.contains("animation.json") && message.contains("--restart"), "{message}");
    std::fs::write(film.join("notes.txt"), "mine").unwrap();
    good(&animate(at, &[&other[..], &["--restart"]].concat()));
    assert_eq!(names(&film), ["animation.json", "frame_0000.png", "frame_0001.png", "notes.txt"]);
    // A file that has changed is another one.
    write_vtu(&at.join("out.pvd.vtu"), &step(1.0)).unwrap();
    std::fs::write(at.join("out.pvd"), std::fs::read_to_string(at.join("out.pvd")).unwrap() + "\n").unwrap();
    assert_eq!(animate(at, &other).status.code(), Some(1));
}

#[test]
fn a_turn_around_one_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    good(&animate(at, &["builtin:rings", "-o", "turn", "--frames", "4", "--format", "exr"]));
    assert_eq!(names(&at.join("turn")).len(), 5);
    let half = ["render", "builtin:rings", "--size", "16", "-o", "plain.exr", "--quiet"];
    good(&run(at, &half));
    let compared = run(at, &["compare", "plain.exr", "turn/frame_0000.exr", "--threshold", "1e-6"]);
    assert_eq!(compared.status.code(), Some(0), "{}", text(&compared.stdout));
    let turned = run(at, &["compare", "plain.exr", "turn/frame_0001.exr", "--threshold", "1e-6"]);
    assert_eq!(turned.status.code(), Some(3), "{}", text(&turned.stdout));
}

#[test]
fn what_cannot_be_shown_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    series(at);
    for (args, code, words) in [
        (&["out.pvd", "--first", "3"][..], 1, "no time step 3"),
        (&["out.pvd", "scene.toml"], 2, "one scene"),
        (&["gone.pvd"], 1, "gone.pvd"),
        (&["out.pvd", "--axis", "0,0,0", "--turn", "10"], 1, "direction"),
        (&["builtin:rings", "--frames", "0"], 2, "frames"),
        (&["out.pvd", "--step", "1", "--first", "1"], 2, "cannot be used with"),
    ] {
        let output = animate(at, args);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{args:?}: {message}");
        assert!(message.contains(words), "{args:?}: {message}");
    }
    std::fs::create_dir(at.join("other")).unwrap();
    std::fs::write(at.join("other/frame_0000.png"), "somebody's").unwrap();
    let output = animate(at, &["out.pvd", "-o", "other"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(std::fs::read(at.join("other/frame_0000.png")).unwrap(), b"somebody's");
    // Nor is another of its frames taken for one that is drawn, and on demand none is.
    std::fs::create_dir(at.join("later")).unwrap();
    std::fs::write(at.join("later/frame_0002.png"), "somebody's").unwrap();
    let output = animate(at, &["out.pvd", "-o", "later"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("frame_0002.png"), "{}", text(&output.stderr));
    for (folder, frame) in [("other", 0), ("later", 2)] {
        let said = good(&animate(at, &["out.pvd", "-o", folder, "--restart"]));
        assert!(said.contains("3 drawn\n"), "{said}");
        assert_eq!(pixels(&at.join(folder).join(format!("frame_000{frame}.png"))).len(), 256);
    }
}
