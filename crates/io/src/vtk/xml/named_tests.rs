//! Files that name pieces, time steps and blocks, written into a folder here.

use std::fs;
use std::path::Path;

use tempfile::TempDir;
use tetrascope_mesh::{Cells, Dataset};

use super::super::test_support::{cells, sanity_check};
use super::tests::{array, ascii_file, cell_arrays, file, piece};
use crate::{IoError, Loaded, ReadOptions, StepChoice, read_mesh};

fn folder(files: &[(&str, String)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn open(folder: &Path, name: &str, step: StepChoice) -> Result<Loaded, IoError> {
    let loaded = read_mesh(&folder.join(name), &ReadOptions { step, ..ReadOptions::default() })?;
    sanity_check(&loaded.dataset);
    Ok(loaded)
}

/// Two tetrahedra; `value` is the array `s` everywhere.
fn mesh(value: f64, cell_data: &str) -> String {
    let s = array("Float32", "s", 1, &vec![value.to_string(); 5].join(" "));
    file(&piece(2, &s, cell_data, &cell_arrays("0 1 2 3 1 2 3 4", "4 8", "10 10", "")))
}

fn parallel(kind: &str, pieces: &[&str]) -> String {
    let pieces: String = pieces.iter().map(|name| format!("<Piece Source=\"{name}\"/>")).collect();
    format!(
        "<?xml version=\"1.0\"?><VTKFile type=\"P{kind}\" version=\"0.1\"><P{kind} GhostLevel=\"1\"><PPointData/>{pieces}</P{kind}></VTKFile>"
    )
}

fn collection(entries: &[(&str, &str)]) -> String {
    let entries: String = entries
        .iter()
        .map(|(time, file)| format!("<DataSet timestep=\"{time}\" group=\"\" part=\"0\" file=\"{file}\"/>"))
        .collect();
    format!("<VTKFile type=\"Collection\" version=\"0.1\"><Collection>{entries}</Collection></VTKFile>")
}

fn image(extent: &str, points: usize, value: f64) -> String {
    let p = array("Float32", "p", 1, &vec![value.to_string(); points].join(" "));
    format!(
        "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 4 0 1 0 1\"><Piece Extent=\"{extent}\"><PointData>{p}</PointData></Piece></ImageData></VTKFile>"
    )
}

fn values(dataset: &Dataset) -> Vec<f64> {
    dataset.point_arrays[0].component(0)
}

#[test]
fn parallel_pieces_without_copies() {
    let ghosts = |marks: &str| array("UInt8", "vtkGhostType", 1, marks);
    let folder = folder(&[
        ("p.pvtu", parallel("UnstructuredGrid", &["parts/a.vtu", "parts\\b.vtu", "parts/../parts/a.vtu"])),
        ("parts/a.vtu", mesh(1.0, &ghosts("0 1"))),
        ("parts/b.vtu", mesh(2.0, &ghosts("0 0"))),
    ]);
    let loaded = open(folder.path(), "p.pvtu", StepChoice::Last).unwrap();
    let rows = cells(&loaded.dataset);
    assert_eq!(rows.connectivity, [0, 1, 2, 3, 5, 6, 7, 8, 6, 7, 8, 9]);
    assert_eq!(values(&loaded.dataset)[4..6], [1.0, 2.0]);
    assert!(loaded.dataset.cell_arrays.is_empty());
    assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].contains("more than once") && loaded.warnings[1].contains("1 of 2 cells"));
    assert!(loaded.format.contains("parallel unstructured grid of 2 pieces"), "{}", loaded.format);
}

#[test]
fn parallel_images_make_one_grid() {
    let folder = folder(&[
        ("p.pvti", parallel("ImageData", &["a.vti", "b.vti"])),
        ("a.vti", image("0 2 0 1 0 1", 12, 1.0)),
        ("b.vti", image("2 4 0 1 0 1", 12, 2.0)),
    ]);
    let loaded = open(folder.path(), "p.pvti", StepChoice::Last).unwrap();
    let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!("not structured") };
    assert_eq!((blocks.len(), blocks[0].dims), (1, [5, 2, 2]));
    assert_eq!(values(&loaded.dataset)[..5], [1.0, 1.0, 2.0, 2.0, 2.0]);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn pieces_that_are_missing_or_of_another_kind() {
    let folder = folder(&[
        ("missing.pvtu", parallel("UnstructuredGrid", &["a.vtu", "gone.vtu"])),
        ("other.pvtu", parallel("UnstructuredGrid", &["i.vti"])),
        ("web.pvtu", parallel("UnstructuredGrid", &["http://example.org/a.vtu"])),
        ("folder.pvtu", parallel("UnstructuredGrid", &["."])),
        ("self.pvtu", parallel("UnstructuredGrid", &["self.pvtu"])),
        ("none.pvtu", parallel("UnstructuredGrid", &[])),
        ("wrong.pvtu", collection(&[])),
        ("broken.pvtu", parallel("UnstructuredGrid", &["a.vtu", "b.vtu"])),
        ("a.vtu", mesh(1.0, "")),
        ("b.vtu", mesh(1.0, "").replace("4 8", "4 9")),
        ("i.vti", image("0 2 0 1 0 1", 12, 1.0)),
    ]);
    for (name, words) in [
        ("missing.pvtu", &["missing.pvtu", "line 1", "`gone.vtu`", "keep the files together"][..]),
        ("other.pvtu", &["i.vti", "\"ImageData\""]),
        ("web.pvtu", &["network"]),
        ("folder.pvtu", &["no regular file"]),
        ("self.pvtu", &["\"PUnstructuredGrid\""]),
        ("none.pvtu", &["`Piece`", "`Source`"]),
        ("wrong.pvtu", &["`DataSet`"]),
        ("broken.pvtu", &["b.vtu", "cell 1"]),
    ] {
        let message = open(folder.path(), name, StepChoice::Last).unwrap_err().to_string();
        for word in words {
            assert!(message.contains(word), "\"{word}\" is not in: {message}");
        }
    }
}

#[test]
fn collections_have_times_and_parts() {
    let folder = folder(&[
        ("c.pvd", collection(&[("0", "a.vtu"), ("0.5", "p.pvtu"), ("0.5", "i.vti"), ("2e0", "a.vtu")])),
        ("p.pvtu", parallel("UnstructuredGrid", &["a.vtu", "b.vtu"])),
        ("a.vtu", mesh(1.0, "")),
        ("b.vtu", mesh(2.0, "")),
        ("i.vti", image("0 2 0 1 0 1", 12, 3.0)),
        ("back.pvd", collection(&[("1", "b.vtu"), ("0", "a.vtu")])),
        ("still.pvd", collection(&[("", "a.vtu")]).replace("timestep=\"\"", "")),
    ]);
    let last = open(folder.path(), "c.pvd", StepChoice::Last).unwrap();
    assert_eq!((last.times.as_slice(), last.step), ([0.0, 0.5, 2.0].as_slice(), 2));
    assert_eq!(values(&last.dataset), [1.0; 5]);
    assert!(last.warnings.is_empty(), "{:?}", last.warnings);
    let middle = open(folder.path(), "c.pvd", StepChoice::Time(0.6)).unwrap();
    assert_eq!(middle.step, 1);
    // Of the image two hexahedra; it lacks `s`, and the others lack `p`.
    assert_eq!((middle.dataset.points.len(), cells(&middle.dataset).kinds.len()), (22, 6));
    assert_eq!(middle.dataset.point_arrays.len(), 2);
    let message = middle.warnings.join("\n");
    for word in ["one part at the time 0.5", "`s` is in 1 of 2 parts", "`p` is in 1 of 2 parts", "hexahedra"] {
        assert!(message.contains(word), "{message}");
    }
    assert!(middle.format.contains("ParaView collection of 3 time steps, 2 parts"), "{}", middle.format);
    assert!(open(folder.path(), "c.pvd", StepChoice::Number(3)).unwrap_err().to_string().contains("c.pvd"));

    let back = open(folder.path(), "back.pvd", StepChoice::Last).unwrap();
    assert_eq!((back.times.as_slice(), values(&back.dataset)[0]), ([0.0, 1.0].as_slice(), 2.0));
    assert!(back.warnings[0].contains("do not rise"), "{:?}", back.warnings);
    let still = open(folder.path(), "still.pvd", StepChoice::Last).unwrap();
    assert!(still.times.is_empty());
}

#[test]
fn file_series_have_times() {
    let series = "{ \"file-series-version\" : \"1.0\",\n \"files\" : [ {\"name\" : \"a.vtu\", \"time\" : 0},\n { \"name\" : \"b.vtu\", \"time\" : 0.5 }, ] }";
    let folder = folder(&[
        ("bad.vtu.series", series.to_owned()),
        ("s.vtu.series", series.replace("}, ]", "} ]")),
        ("none.series", "{\"file-series-version\":\"1.0\",\"files\":[]}".to_owned()),
        ("a.vtu", mesh(1.0, "")),
        ("b.vtu", mesh(2.0, "")),
    ]);
    let loaded = open(folder.path(), "s.vtu.series", StepChoice::Number(1)).unwrap();
    assert_eq!((loaded.times.as_slice(), values(&loaded.dataset)[0]), ([0.0, 0.5].as_slice(), 2.0));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    for (name, word) in [("bad.vtu.series", "line 3"), ("none.series", "no file is named")] {
        let message = open(folder.path(), name, StepChoice::Last).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn collections_do_not_name_collections() {
    let folder = folder(&[
        ("self.pvd", collection(&[("0", "self.pvd")])),
        ("a.pvd", collection(&[("0", "b.pvd")])),
        ("b.pvd", collection(&[("0", "a.pvd")])),
        ("odd.pvd", collection(&[("soon", "a.vtu")])),
        ("surfaces.pvd", collection(&[("0", "s.vtp")])),
        ("s.vtp", "<VTKFile type=\"PolyData\"/>".to_owned()),
        ("blocks.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><Block index=\"0\"><DataSet index=\"0\" file=\"a.vtu\"/><DataSet index=\"1\"/></Block><Block><DataSet file=\"s.vtp\"/></Block></vtkMultiBlockDataSet></VTKFile>".to_owned()),
        ("a.vtu", ascii_file()),
    ]);
    for (name, word) in [
        ("self.pvd", "inside another"),
        ("a.pvd", "inside another"),
        ("odd.pvd", "\"soon\""),
        ("surfaces.pvd", "PolyData"),
    ] {
        let message = open(folder.path(), name, StepChoice::Last).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    }
    let blocks = open(folder.path(), "blocks.vtm", StepChoice::Last).unwrap();
    assert_eq!(cells(&blocks.dataset).kinds.len(), 2);
    assert_eq!(blocks.warnings.len(), 1, "{:?}", blocks.warnings);
    assert!(blocks.warnings[0].contains("`s.vtp` is left out"), "{:?}", blocks.warnings);
}

#[test]
fn lists_cut_anywhere() {
    let folder = folder(&[("a.vtu", mesh(1.0, "")), ("b.vtu", mesh(2.0, ""))]);
    for (name, text) in [
        ("p.pvtu", parallel("UnstructuredGrid", &["a.vtu", "b.vtu"])),
        ("c.pvd", collection(&[("0", "a.vtu"), ("1", "b.vtu")])),
    ] {
        for length in 0..text.len() {
            fs::write(folder.path().join(name), &text[..length]).unwrap();
            let message = open(folder.path(), name, StepChoice::Last).unwrap_err().to_string();
            assert!(message.contains(name), "{length}: {message}");
        }
    }
}
