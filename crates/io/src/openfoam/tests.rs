//! Meshes with every kind of cell, in every way that OpenFOAM writes them, and where cases are found.

use super::test_support::*;
use crate::{IoError, ReadOptions, StepChoice, bytes::ByteOrder, read_mesh};

#[test]
fn a_mesh_of_all_kinds_as_text() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    let loaded = case.read().unwrap();
    assert_eq!(loaded.format, "OpenFOAM case, text, one mesh");
    assert!(loaded.warnings.is_empty() && loaded.times.is_empty(), "{:?}", loaded.warnings);
    let rows = cells(&loaded.dataset);
    assert_eq!(rows.kinds, MIXED_KINDS);
    assert_eq!(rows.offsets, [0, 8, 13, 19, 23, 32]);
    assert_eq!(rows.polyhedra.len(), 1);
    assert_eq!(loaded.dataset.points.len(), 17);
    let (volume, _) = volume(&loaded.dataset);
    assert!((volume - MIXED_VOLUME).abs() < 1e-12, "{volume}");
}

#[test]
fn cells_are_right_side_out() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    let dataset = case.read().unwrap().dataset;
    let rows = cells(&dataset);
    let cell = |cell: usize| -> Vec<_> {
        rows.connectivity[rows.offsets[cell]..rows.offsets[cell + 1]]
            .iter()
            .map(|&p| dataset.points[p as usize])
            .collect()
    };
    // Six times the volume of the corners (0, 1, 2) and another one: above in VTK's order, but below of a wedge.
    let side = |p: &[glam::DVec3], other: usize| (p[1] - p[0]).cross(p[2] - p[0]).dot(p[other] - p[0]);
    for (number, other, sign) in [(0, 4, 1.0), (1, 4, 1.0), (2, 3, -1.0), (3, 3, 1.0)] {
        assert!(side(&cell(number), other) * sign > 0.0, "cell {number}");
    }
    // Sides of the wedge and of the hexahedron join corners that lie above each other.
    let wedge = cell(2);
    assert!((0..3).all(|i| wedge[i + 3] - wedge[i] == wedge[3] - wedge[0]));
    let hex = cell(0);
    assert!((0..4).all(|i| hex[i + 4] - hex[i] == hex[4] - hex[0]));
}

#[test]
fn binary_files_of_all_sizes_are_the_same_mesh() {
    let mesh = mixed();
    let text = TestCase::with_mesh(&mesh, Style::Text).read().unwrap().dataset;
    for label in [4, 8] {
        for scalar in [4, 8] {
            for (order, arch) in [(ByteOrder::Little, true), (ByteOrder::Big, true), (ByteOrder::Little, false)] {
                let style = Style::Binary { label, scalar, order, arch };
                let loaded = TestCase::with_mesh(&mesh, style).read().unwrap_or_else(|e| panic!("{style:?}: {e}"));
                assert_eq!(loaded.format, "OpenFOAM case, binary, one mesh");
                // All coordinates are exact in 32 bits.
                assert_eq!(loaded.dataset.points, text.points, "{style:?}");
                let (a, b) = (cells(&loaded.dataset), cells(&text));
                assert_eq!(
                    (&a.kinds, &a.connectivity, &a.polyhedra),
                    (&b.kinds, &b.connectivity, &b.polyhedra),
                    "{style:?}"
                );
            }
        }
    }
}

#[test]
fn compressed_files() {
    for style in [Style::Text, BINARY] {
        let case = TestCase::with_mesh(&mixed(), style);
        for name in ["points", "faces", "owner", "neighbour"] {
            case.compress(&format!("constant/polyMesh/{name}"));
        }
        case.write("2/p.gz", &gzip(&style.field("volScalarField", "scalar", &[1.0, 2.0, 3.0, 4.0, 5.0], 1)));
        let loaded = case.read().unwrap();
        assert_eq!(cells(&loaded.dataset).kinds, MIXED_KINDS);
        assert_eq!(loaded.dataset.cell_arrays[0].values.to_f64(), [1.0, 2.0, 3.0, 4.0, 5.0]);
        let by_file = case.read_at("constant/polyMesh/points.gz", StepChoice::Last).unwrap();
        assert_eq!(by_file.dataset.points, loaded.dataset.points);
        let by_field = case.read_at("2/p.gz", StepChoice::Last).unwrap();
        assert_eq!(by_field.dataset.cell_arrays.len(), 1);
    }
}

#[test]
fn compressed_files_have_a_limit() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    let mut zeros = Style::Text.header("vectorField");
    zeros.resize(32 << 20, b' ');
    case.write("constant/polyMesh/points.gz", &gzip(&zeros));
    std::fs::remove_file(case.path("constant/polyMesh/points")).unwrap();
    let error = case.read().unwrap_err().to_string();
    assert!(error.contains("points.gz") && error.contains("256 bytes") && error.contains("gunzip"), "{error}");
}

#[test]
fn other_ways_to_write_lists() {
    // Without counts, with comments between, -1 for faces of the boundary, one cell whose owners are a repetition.
    let mesh = TestMesh {
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        cells: vec![vec![vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3], vec![0, 3, 2]]],
    };
    let case = TestCase::with_mesh(&mesh, Style::Text);
    let write = |name: &str, class: &str, list: &str| {
        case.write(&format!("constant/polyMesh/{name}"), &[&Style::Text.header(class), list.as_bytes()].concat());
    };
    write("points", "vectorField", "((0 0 0)(1 0 0) // one\n (0 1 0) /* ( */ (0 0 1))");
    write("faces", "faceList", "(3(0 2 1) (0 1 3) 3(1 2 3) 3(0 3 2))");
    write("owner", "labelList", "4{0}");
    write("neighbour", "labelList", "(-1 -1 -1 -1)");
    assert!((volume(&case.read().unwrap().dataset).0 - 1.0 / 6.0).abs() < 1e-15);
    for nothing in ["0()", "0", "()"] {
        write("neighbour", "labelList", nothing);
        assert_eq!(cells(&case.read().unwrap().dataset).kinds.len(), 1, "{nothing}");
    }
    // A compact list as text, and a list of faces in binary.
    write("faces", "faceCompactList", "5(0 3 6 9 12) 12(0 2 1 0 1 3 1 2 3 0 3 2)");
    assert_eq!(cells(&case.read().unwrap().dataset).kinds.len(), 1);
    let mut binary = BINARY.header("faceList");
    binary.extend(b"4\n(\n");
    for face in mesh.faces().faces {
        binary.extend(BINARY.labels(&face.iter().map(|&p| i64::from(p)).collect::<Vec<_>>()));
    }
    binary.extend(b")\n");
    case.write("constant/polyMesh/faces", &binary);
    assert_eq!(cells(&case.read().unwrap().dataset).kinds.len(), 1);
}

#[test]
fn a_case_is_found_from_its_files() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    for (time, value) in [("0", 0.0), ("0.5", 1.0), ("10", 2.0)] {
        case.write(&format!("{time}/p"), &Style::Text.field("volScalarField", "scalar", &[value; 5], 1));
    }
    for (below, step) in [
        (".", 2),
        ("case.foam", 2),
        ("constant", 2),
        ("constant/polyMesh", 2),
        ("constant/polyMesh/points", 2),
        ("constant/polyMesh/owner", 2),
        ("system/controlDict", 2),
        ("0.5", 1),
        ("0.5/p", 1),
    ] {
        let loaded = case.read_at(below, StepChoice::Last).unwrap_or_else(|e| panic!("{below}: {e}"));
        assert_eq!((loaded.step, &loaded.times[..]), (step, &[0.0, 0.5, 10.0][..]), "{below}");
        assert_eq!(loaded.dataset.cell_arrays[0].values.to_f64(), [step as f64; 5], "{below}");
        assert!(loaded.warnings.is_empty(), "{below}: {:?}", loaded.warnings);
    }
    let chosen = case.read_at("0.5", StepChoice::Number(0)).unwrap();
    assert_eq!(chosen.step, 0);
}

#[test]
fn files_of_other_formats_in_a_case_are_not_taken() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    let tetrahedron = TestMesh { cells: vec![mixed().cells[3].clone()], ..mixed() };
    let mesh = TestCase::with_mesh(&tetrahedron, Style::Text).read().unwrap().dataset;
    let vtu = case.path("VTK/mesh.vtu");
    std::fs::create_dir_all(vtu.parent().unwrap()).unwrap();
    crate::write_vtu(&vtu, &mesh).unwrap();
    assert!(read_mesh(&vtu, &ReadOptions::default()).unwrap().format.contains("VTK"));
    assert!(matches!(case.read_at("VTK", StepChoice::Last), Err(IoError::Unsupported { .. })));
}

#[test]
fn folders_without_a_mesh_are_refused_with_a_remedy() {
    let case = TestCase::new();
    let error = case.read().unwrap_err().to_string();
    assert!(error.contains("case.foam") && error.contains("no mesh") && error.contains("blockMesh"), "{error}");
    let empty = tempfile::tempdir().unwrap();
    let mark = empty.path().join("x.foam");
    std::fs::write(&mark, b"").unwrap();
    let error = read_mesh(&mark, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("x.foam") && error.contains("no OpenFOAM case"), "{error}");
    let lone = empty.path().join("p");
    std::fs::write(&lone, Style::Text.field("volScalarField", "scalar", &[1.0], 1)).unwrap();
    let error = read_mesh(&lone, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("no OpenFOAM case"), "{error}");
}

#[test]
fn meshes_that_do_not_hold_together_are_refused_with_their_place() {
    let mesh = mixed();
    let faces = mesh.faces();
    let wrong = |name: &str, bytes: Vec<u8>, parts: &[&str]| {
        let case = TestCase::with_mesh(&mesh, Style::Text);
        case.write(&format!("constant/polyMesh/{name}"), &bytes);
        let error = case.read().unwrap_err().to_string();
        for part in parts.iter().chain(&[name]) {
            assert!(error.contains(part), "{error}: {part}");
        }
    };
    let labels = |values: &[i64]| [Style::Text.header("labelList"), Style::Text.labels(values)].concat();
    let mut far = faces.faces.clone();
    far[3][1] = 17;
    wrong("faces", Style::Text.faces(&far), &["face 3", "point 17", "there are 17"]);
    far[3] = vec![1, 2];
    wrong("faces", Style::Text.faces(&far), &["face 3", "2 points"]);
    wrong("owner", labels(&faces.owners[1..]), &["21 owners for 22 faces"]);
    let mut owners = faces.owners.clone();
    owners[2] = 4_000_000_000;
    wrong("owner", labels(&owners), &["cell 4000000000", "22 faces"]);
    owners[2] = -5;
    wrong("owner", labels(&owners), &["line 16", "-5 is no label"]);
    wrong("neighbour", labels(&[0; 23]), &["23 neighbors for 22 faces"]);
    wrong(
        "owner",
        [Style::Text.header("labelList"), b"99999999999{0}".to_vec()].concat(),
        &["repeated 99999999999 times"],
    );
    wrong("owner", [Style::Text.header("labelList"), b"3(1 2)".to_vec()].concat(), &["should have 3", "has 2"]);
    wrong("points", Style::Text.header("volScalarField"), &["class is `volScalarField`"]);
    wrong("points", b"3((0 0 0))".to_vec(), &["FoamFile"]);
    let compact = [Style::Text.header("faceCompactList"), b"3(0 9 3) 3(0 1 2)".to_vec()].concat();
    wrong("faces", compact, &["does not rise"]);
    let short = [BINARY.header("vectorField"), b"\n2000000000\n(abc)".to_vec()].concat();
    wrong("points", short, &["byte", "2000000000 elements"]);
}
