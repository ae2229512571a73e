//! Cases of several parts: what processors wrote, regions, and a real mesh written anew.

use tetrascope_mesh::{CellKind, Cells, Dataset};

use super::test_support::*;
use crate::{StepChoice, read_mesh, shared::shared, vtk::sanity_check};

fn decomposed(mesh: &TestMesh, count: usize, style: Style) -> (TestCase, Vec<TestPart>) {
    let case = TestCase::new();
    let parts = mesh.decompose(|cell| cell % count, count);
    for (processor, part) in parts.iter().enumerate() {
        part.write(&case, processor, style);
        let pressure: Vec<f64> = part.cells.iter().map(|&cell| cell as f64).collect();
        case.write(&format!("processor{processor}/4/p"), &style.field("volScalarField", "scalar", &pressure, 1));
        let heights: Vec<f64> = part.mesh.points.iter().map(|point| point[2]).collect();
        case.write(&format!("processor{processor}/4/z"), &style.field("pointScalarField", "scalar", &heights, 1));
    }
    (case, parts)
}

#[test]
fn decomposed_cases_are_joined_at_their_shared_points() {
    for style in [Style::Text, BINARY] {
        for count in [1, 2, 3, 5] {
            let (case, parts) = decomposed(&mixed(), count, style);
            let loaded = case.read().unwrap();
            assert!(loaded.warnings.is_empty(), "{count}: {:?}", loaded.warnings);
            assert!(loaded.format.contains(&format!("decomposed into {count}")), "{}", loaded.format);
            assert_eq!((loaded.dataset.points.len(), &loaded.times[..]), (17, &[4.0][..]), "{count}");
            assert!((volume(&loaded.dataset).0 - MIXED_VOLUME).abs() < 1e-12);
            let order: Vec<f64> = parts.iter().flat_map(|part| part.cells.iter().map(|&cell| cell as f64)).collect();
            assert_eq!(loaded.dataset.cell_arrays[0].values.to_f64(), order);
            let heights: Vec<f64> = loaded.dataset.points.iter().map(|point| point.z).collect();
            assert_eq!(loaded.dataset.point_arrays[0].values.to_f64(), heights);
            let kinds: Vec<CellKind> = order.iter().map(|&cell| MIXED_KINDS[cell as usize]).collect();
            assert_eq!(cells(&loaded.dataset).kinds, kinds);
        }
    }
}

#[test]
fn seams_that_do_not_match_are_told() {
    let (case, parts) = decomposed(&mixed(), 2, Style::Text);
    let mut mesh = parts[1].mesh.clone();
    mesh.points.iter_mut().for_each(|point| point[0] += 0.25);
    case.write("processor1/constant/polyMesh/points", &mesh_files(&mesh, &parts[1].faces, Style::Text)[0].1);
    let loaded = case.read().unwrap();
    assert!(
        loaded.warnings.iter().any(|w| w.contains("faces between processors do not match")),
        "{:?}",
        loaded.warnings
    );
    // A field of another processor alone, and a patch that names faces that are not there.
    case.write("processor1/4/T", &Style::Text.field("volScalarField", "scalar", &vec![1.0; parts[1].cells.len()], 1));
    let loaded = case.read().unwrap();
    let temperature = loaded.dataset.cell_arrays.iter().find(|array| array.name == "T").unwrap().values.to_f64();
    assert_eq!(temperature.iter().filter(|t| t.is_nan()).count(), parts[0].cells.len());
    assert!(
        loaded.warnings.iter().any(|w| w.contains("field T is not there in 1 of 2 parts")),
        "{:?}",
        loaded.warnings
    );
    let wrong = parts[0].boundary.replace("nFaces 2", "nFaces 20");
    let wrong = [Style::Text.header("polyBoundaryMesh"), wrong.into_bytes()].concat();
    case.write("processor0/constant/polyMesh/boundary", &wrong);
    if let Err(error) = case.read() {
        assert!(error.to_string().contains("patch to processor 1"), "{error}");
    }
    std::fs::remove_file(case.path("processor1/constant/polyMesh/owner")).unwrap();
    let error = case.read().unwrap_err().to_string();
    assert!(error.contains("processor"), "{error}");
}

#[test]
fn whole_or_decomposed_by_what_is_later() {
    let (case, _) = decomposed(&mixed(), 2, Style::Text);
    case.write_mesh("constant/polyMesh", &mixed(), &mixed().faces(), Style::Text);
    let field = |value: f64| Style::Text.field("volScalarField", "scalar", &[value; 5], 1);
    case.write("0/p", &field(0.0));
    let loaded = case.read().unwrap();
    assert_eq!(loaded.times, [4.0]);
    assert!(loaded.warnings.iter().any(|w| w.contains("the processors have later times")), "{:?}", loaded.warnings);
    case.write("4/p", &field(7.0));
    let loaded = case.read().unwrap();
    assert_eq!((&loaded.times[..], &loaded.warnings[..]), (&[0.0, 4.0][..], &[][..]));
    assert_eq!(loaded.dataset.cell_arrays[0].values.to_f64(), [7.0; 5]);
    // The folder of one processor is a case of its own.
    let one = case.read_at("processor1", StepChoice::Last).unwrap();
    assert_eq!(cells(&one.dataset).kinds.len(), 2);
}

/// One file of what several processors have in theirs; the first block alone keeps its header.
fn collate(case: &TestCase, count: usize, folder: &str, name: &str, content: impl Fn(usize) -> Vec<u8>) {
    let mut file = BINARY.header("decomposedBlockData");
    for processor in 0..count {
        let mut block = content(processor);
        if processor > 0 {
            let end = block.windows(2).position(|pair| pair == b"}\n").unwrap() + 2;
            block.drain(..end);
        }
        file.extend(format!("\n// Processor{processor}\n{}\n(", block.len()).into_bytes());
        file.extend(block);
        file.extend(b")\n");
    }
    case.write(&format!("{folder}/{name}"), &file);
}

#[test]
fn processors_that_write_together() {
    for style in [Style::Text, BINARY] {
        let (apart, parts) = decomposed(&mixed(), 3, style);
        let expected = apart.read().unwrap();
        let case = TestCase::new();
        let content = |below: &str, first: usize| {
            let below = below.to_owned();
            let apart = &apart;
            move |block: usize| std::fs::read(apart.path(&format!("processor{}/{below}", first + block))).unwrap()
        };
        let write = |folder: &str, first: usize, count: usize| {
            for below in ["points", "faces", "owner", "neighbour", "boundary"] {
                let below = format!("constant/polyMesh/{below}");
                collate(&case, count, folder, &below, content(&below, first));
            }
            for below in ["4/p", "4/z"] {
                collate(&case, count, folder, below, content(below, first));
            }
        };
        write("processors3", 0, parts.len());
        let loaded = case.read().unwrap();
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        assert_eq!(loaded.format, expected.format);
        assert_eq!(loaded.dataset.points, expected.dataset.points);
        assert_eq!(cells(&loaded.dataset).connectivity, cells(&expected.dataset).connectivity);
        let (p, expected_p) = (&loaded.dataset.cell_arrays[0], &expected.dataset.cell_arrays[0]);
        assert_eq!((&p.name, p.values.to_f64()), (&expected_p.name, expected_p.values.to_f64()));
        // Cut off anywhere.
        for below in ["processors3/4/p", "processors3/constant/polyMesh/boundary"] {
            let whole = std::fs::read(case.path(below)).unwrap();
            for length in 0..whole.len() {
                case.write(below, &whole[..length]);
                match case.read() {
                    Ok(loaded) => sanity_check(&loaded.dataset),
                    Err(error) => assert!(error.to_string().contains(below), "{error}"),
                }
            }
            case.write(below, &whole);
        }
        // In two folders, of which each holds some processors.
        std::fs::remove_dir_all(case.path("processors3")).unwrap();
        write("processors3_0-1", 0, 2);
        write("processors3_2-2", 2, 1);
        assert_eq!(case.read().unwrap().dataset.points, expected.dataset.points);
        // A processor less in one of the files, and a block that is damaged.
        collate(&case, 1, "processors3_0-1", "4/p", content("4/p", 0));
        let error = case.read().unwrap_err().to_string();
        assert!(error.contains("4/p") && error.contains("processor 1 has none"), "{error}");
        let broken = |block: usize| if block == 1 { b"}\n internalField x".to_vec() } else { content("4/p", 0)(block) };
        collate(&case, 2, "processors3_0-1", "4/p", broken);
        let error = case.read().unwrap_err().to_string();
        assert!(error.contains("the block of processor 1") && error.contains("`uniform` or `nonuniform`"), "{error}");
    }
}

#[test]
fn regions_one_or_all() {
    let mesh = mixed();
    let small = TestMesh { points: mesh.points[..8].to_vec(), cells: mesh.cells[..1].to_vec() };
    let case = TestCase::new();
    case.write_mesh("constant/fluid/polyMesh", &mesh, &mesh.faces(), Style::Text);
    case.write_mesh("constant/solid/polyMesh", &small, &small.faces(), BINARY);
    let field =
        |name: &str, values: &[f64]| case.write(name, &Style::Text.field("volScalarField", "scalar", values, 1));
    field("1/fluid/T", &[1.0; 5]);
    field("1/fluid/p", &[2.0; 5]);
    field("1/solid/T", &[3.0]);
    let all = case.read().unwrap();
    assert!(all.format.contains("2 regions"), "{}", all.format);
    let array = |dataset: &Dataset, name: &str| {
        dataset.cell_arrays.iter().find(|array| array.name == name).map(|array| array.values.to_f64())
    };
    assert_eq!(array(&all.dataset, "T").unwrap(), [1.0, 1.0, 1.0, 1.0, 1.0, 3.0]);
    assert_eq!(array(&all.dataset, "openfoam:region").unwrap(), [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    assert!(array(&all.dataset, "p").unwrap()[5].is_nan());
    assert_eq!(all.warnings.len(), 1, "{:?}", all.warnings);
    assert_eq!(all.dataset.points.len(), 25);
    case.write("case{solid}.foam", b"");
    for below in ["constant/solid", "constant/solid/polyMesh/points", "1/solid/T", "case{solid}.foam"] {
        let one = case.read_at(below, StepChoice::Last).unwrap_or_else(|e| panic!("{below}: {e}"));
        assert_eq!(array(&one.dataset, "T").unwrap(), [3.0], "{below}");
        assert!(one.format.contains("region solid") && one.warnings.is_empty(), "{}", one.format);
    }
}

/// Cells of a dataset with their faces.
fn mesh_of(dataset: &Dataset) -> TestMesh {
    let Cells::Unstructured(cells) = &dataset.cells else { panic!("structured") };
    let mut polyhedra = cells.polyhedra.iter();
    let hexahedron = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let wedge: [&[usize]; 5] = [&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]];
    let faces = |cell: usize| {
        let row = &cells.connectivity[cells.offsets[cell]..cells.offsets[cell + 1]];
        let of = |face: &[usize]| face.iter().map(|&i| row[i]).collect();
        match cells.kinds[cell] {
            CellKind::Hexahedron => hexahedron.iter().map(|face| of(face)).collect(),
            CellKind::Wedge => wedge.iter().map(|face| of(face)).collect(),
            CellKind::Polyhedron => polyhedra.next().unwrap().clone(),
            other => panic!("{other:?}"),
        }
    };
    let points = dataset.points.iter().map(|point| point.to_array()).collect();
    TestMesh { points, cells: (0..cells.kinds.len()).map(faces).collect() }
}

/// OpenFOAM's own converter told these cells from a case; a case made of them again has to give them back.
#[test]
fn shared_real_mesh_is_found_again() {
    let Some(path) = shared("data/vtu/openfoam_windAroundBuildings.vtu") else { return };
    let real = read_mesh(&path, &Default::default()).unwrap().dataset;
    let mesh = mesh_of(&real);
    let pressure = real.cell_arrays.iter().find(|array| array.name == "p").unwrap().values.to_f64();
    let expected = volume(&real).0;
    let counts = |dataset: &Dataset| {
        let kinds = &cells(dataset).kinds;
        [CellKind::Hexahedron, CellKind::Wedge, CellKind::Polyhedron]
            .map(|kind| kinds.iter().filter(|&&k| k == kind).count())
    };
    for style in [Style::Text, BINARY] {
        let case = TestCase::with_mesh(&mesh, style);
        case.write("400/p", &style.field("volScalarField", "scalar", &pressure, 1));
        let loaded = case.read().unwrap();
        assert_eq!(counts(&loaded.dataset), [69688, 454, 6533]);
        assert_eq!(cells(&loaded.dataset).kinds, cells(&real).kinds);
        assert_eq!(loaded.dataset.points, real.points);
        assert_eq!(loaded.dataset.cell_arrays[0].values.to_f64(), pressure);
        let found = volume(&loaded.dataset).0;
        assert!((found - expected).abs() < 1e-9 * expected, "{found}, not {expected}");
    }
    let (case, _) = decomposed(&mesh, 4, BINARY);
    let loaded = case.read().unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_eq!(loaded.dataset.points.len(), real.points.len());
    assert_eq!(counts(&loaded.dataset), [69688, 454, 6533]);
    let found = volume(&loaded.dataset).0;
    // Points have other numbers, and faces that are not flat are cut by these.
    assert!((found - expected).abs() < 1e-5 * expected, "{found}, not {expected}");
}
