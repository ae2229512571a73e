//! Fields of all classes, time steps, and meshes that move.

use tetrascope_mesh::{ArrayValues, DataArray};

use super::test_support::*;
use crate::{StepChoice, bytes::ByteOrder};

fn array<'a>(arrays: &'a [DataArray], name: &str) -> &'a DataArray {
    arrays.iter().find(|array| array.name == name).unwrap_or_else(|| panic!("no {name}"))
}

fn field(class: &str, content: &str) -> Vec<u8> {
    [Style::Text.header(class), content.as_bytes().to_vec()].concat()
}

#[test]
fn fields_of_all_classes() {
    for style in [Style::Text, BINARY] {
        let case = TestCase::with_mesh(&mixed(), style);
        for (class, list, components) in [
            ("volScalarField", "scalar", 1),
            ("volVectorField", "vector", 3),
            ("volSphericalTensorField", "sphericalTensor", 1),
            ("volSymmTensorField", "symmTensor", 6),
            ("volTensorField", "tensor", 9),
            ("volScalarField::Internal", "scalar", 1),
        ] {
            let values: Vec<f64> = (0..5 * components as u32).map(|i| f64::from(i) / 4.0).collect();
            case.write(&format!("1/{}", class.replace(':', "")), &style.field(class, list, &values, components));
        }
        let points: Vec<f64> = (0..17 * 3).map(f64::from).collect();
        case.write("1/D", &style.field("pointVectorField", "vector", &points, 3));
        let loaded = case.read().unwrap();
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        let arrays = &loaded.dataset.cell_arrays;
        assert_eq!(arrays.len(), 6);
        for array in arrays {
            assert_eq!(array.values.len(), 5 * array.components, "{}", array.name);
        }
        assert_eq!(array(arrays, "volTensorField").values.to_f64()[9..11], [2.25, 2.5]);
        // xx xy xz yy yz zz in the file, xx yy zz xy yz xz as VTK has it.
        let symmetric = array(arrays, "volSymmTensorField");
        assert_eq!(symmetric.values.to_f64()[..6], [0.0, 0.75, 1.25, 0.25, 1.0, 0.5]);
        let displacement = array(&loaded.dataset.point_arrays, "D");
        assert_eq!((displacement.components, displacement.values.to_f64()), (3, points));
    }
}

#[test]
fn fields_of_all_sizes() {
    for (scalar, order) in [(4, ByteOrder::Little), (4, ByteOrder::Big), (8, ByteOrder::Big)] {
        for arch in [true, false] {
            let style = Style::Binary { label: 4, scalar, order, arch: arch || order == ByteOrder::Big };
            let case = TestCase::with_mesh(&mixed(), Style::Text);
            case.write("1/p", &style.field("volScalarField", "scalar", &[0.5, 1.0, 2.0, 4.0, 8.0], 1));
            let loaded = case.read().unwrap();
            let values = &loaded.dataset.cell_arrays[0].values;
            assert_eq!(values.to_f64(), [0.5, 1.0, 2.0, 4.0, 8.0]);
            assert_eq!(matches!(values, ArrayValues::F32(_)), scalar == 4);
        }
    }
}

#[test]
fn uniform_fields_macros_and_units() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    for (name, class, content, expected) in [
        ("a", "volScalarField", "internalField uniform 2.5;", vec![2.5; 5]),
        ("b", "volScalarField", "dimensions [0 0 0];\npressure 1e5; internalField uniform $pressure;", vec![1e5; 5]),
        ("c", "volVectorField", "u 3;\nv (1 $u 4);\ninternalField uniform $v;", [1.0, 3.0, 4.0].repeat(5)),
        ("d", "volScalarField", "#include \"x\"\ninternalField uniform [m/s] -1;", vec![-1.0; 5]),
        ("e", "volScalarField", "internalField nonuniform List<scalar> 5{7};", vec![7.0; 5]),
        (
            "f",
            "volScalarField",
            "a { internalField uniform 1; } internalField nonuniform (1 2 nan 4 -inf);",
            vec![1.0, 2.0, f64::NAN, 4.0, f64::NEG_INFINITY],
        ),
        ("g", "volScalarField::Internal", "dimensions [0 0 0];\nvalue uniform 3;", vec![3.0; 5]),
    ] {
        let case_of_one = TestCase::with_mesh(&mixed(), Style::Text);
        for case in [&case, &case_of_one] {
            case.write(&format!("1/{name}"), &field(class, content));
        }
        let loaded = case_of_one.read().unwrap_or_else(|e| panic!("{e}"));
        assert!(loaded.warnings.is_empty(), "{name}: {:?}", loaded.warnings);
        let values = loaded.dataset.cell_arrays[0].values.to_f64();
        assert_eq!(format!("{values:?}"), format!("{expected:?}"), "{name}");
    }
    assert_eq!(case.read().unwrap().dataset.cell_arrays.len(), 7);
}

#[test]
fn fields_that_are_left_out_are_named() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    for (name, class, content, reason) in [
        ("a", "volScalarField", "#include \"initial\"\ninternalField uniform $p;", "included \"initial\""),
        ("b", "volScalarField", "internalField uniform $p;", "`$p`, which the file does not define"),
        ("c", "volScalarField", "internalField #codeStream { code #{ x #}; };", "only OpenFOAM works out"),
        ("d", "volScalarField", "internalField nonuniform List<scalar> 4(1 2 3 4);", "4 values for 5 cells"),
        ("e", "volScalarField", "x $y; y $x;\ninternalField uniform $x;", "leads to itself"),
        ("f", "volScalarField", "#include \"all\"", "includes \"all\""),
        ("phi", "surfaceScalarField", "internalField uniform 1;", "phi is left out: a field on faces"),
    ] {
        case.write(&format!("1/{name}"), &field(class, content));
        let warnings = case.read().unwrap().warnings;
        assert!(warnings.iter().any(|warning| warning.contains(reason)), "{name}: {warnings:?}");
    }
    // What is no field, an editor's copy, folders: nothing to say.
    let quiet = TestCase::with_mesh(&mixed(), Style::Text);
    quiet.write("1/uniform/time", &field("dictionary", "value 1;"));
    quiet.write("1/notes", b"what I did");
    quiet.write("1/p~", &field("volScalarField", "broken"));
    quiet.write("1/coordinates", &field("vectorField", "0()"));
    let loaded = quiet.read().unwrap();
    assert!(loaded.warnings.is_empty() && loaded.dataset.cell_arrays.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn damaged_fields_name_their_place() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    for (content, part) in [
        ("internalField uniform x;", "line 12: there is `x;`"),
        ("internalField nonuniform List<scalar> 5(1 2\n3 x 5);", "line 13: there is `x 5);`"),
        ("internalField nonuniform List<scalar> 5(1 2 3 4);", "should have 5 elements and has 4"),
        ("internalField nonuniform List<scalar> 99999999999{1};", "repeated 99999999999 times"),
        ("internalField steady;", "`uniform` or `nonuniform`"),
        ("dimensions [0 0 0];", "no internalField"),
    ] {
        case.write("1/p", &field("volScalarField", content));
        let error = case.read().unwrap_err().to_string();
        assert!(error.contains("1/p") && error.contains(part), "{error}");
    }
}

#[test]
fn uniform_fields_have_a_limit() {
    let mut points = Vec::new();
    let mut cells = Vec::new();
    for i in 0..4000_u32 {
        let x = f64::from(i);
        points.extend([[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0]]);
        cells.push([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(|face| face.map(|p| 4 * i + p).to_vec()).to_vec());
    }
    let case = TestCase::with_mesh(&TestMesh { points, cells }, Style::Text);
    for i in 0..900 {
        case.write(&format!("1/t{i}"), &field("volTensorField", "internalField uniform (1 2 3 4 5 6 7 8 9);"));
    }
    let error = case.read().unwrap_err().to_string();
    assert!(error.contains("16 numbers for each byte") && error.contains("1/t"), "{error}");
    (100..900).for_each(|i| std::fs::remove_file(case.path(&format!("1/t{i}"))).unwrap());
    assert_eq!(case.read().unwrap().dataset.cell_arrays.len(), 100);
}

#[test]
fn time_steps_by_their_folders() {
    let case = TestCase::with_mesh(&mixed(), Style::Text);
    let pressure = |value: f64| Style::Text.field("volScalarField", "scalar", &[value; 5], 1);
    for (step, time) in ["0", "1e-05", "0.25", "2", "10"].iter().enumerate() {
        case.write(&format!("{time}/p"), &pressure(step as f64));
    }
    case.write("0.orig/p", &pressure(9.0));
    case.write("processor/p", &pressure(9.0));
    case.write("nan/p", &pressure(9.0));
    for (choice, step) in [(StepChoice::Last, 4), (StepChoice::Number(1), 1), (StepChoice::Time(1.9), 3)] {
        let loaded = case.read_at("case.foam", choice).unwrap();
        assert_eq!(loaded.times, [0.0, 1e-5, 0.25, 2.0, 10.0]);
        assert_eq!((loaded.step, loaded.dataset.cell_arrays[0].values.to_f64()[0]), (step, step as f64));
    }
    assert_eq!(case.read().unwrap().format, "OpenFOAM case, text, one mesh, 5 time steps, time 10");
    let error = case.read_at("case.foam", StepChoice::Number(5)).unwrap_err().to_string();
    assert!(error.contains("the file has 5"), "{error}");
    // Only the chosen step is read.
    case.write("2/p", b"FoamFile { class volScalarField; } broken");
    assert!(case.read().is_ok() && case.read_at(".", StepChoice::Number(3)).is_err());
}

#[test]
fn meshes_that_move_and_change() {
    let mesh = mixed();
    let case = TestCase::with_mesh(&mesh, Style::Text);
    let mut moved = mesh.clone();
    moved.points.iter_mut().for_each(|point| point[2] *= 2.0);
    case.write("0/p", &field("volScalarField", "internalField uniform 0;"));
    case.write("1/polyMesh/points", &mesh_files(&moved, &mesh.faces(), BINARY)[0].1);
    case.write("2/p", &field("volScalarField", "internalField uniform 2;"));
    // Then only the hexahedron stays.
    let small = TestMesh { points: mesh.points[..8].to_vec(), cells: mesh.cells[..1].to_vec() };
    case.write_mesh("3/polyMesh", &small, &small.faces(), Style::Text);
    for (step, expected) in [(0, MIXED_VOLUME), (1, 2.0 * MIXED_VOLUME), (2, 2.0 * MIXED_VOLUME), (3, 1.0)] {
        let loaded = case.read_at(".", StepChoice::Number(step)).unwrap();
        assert!((volume(&loaded.dataset).0 - expected).abs() < 1e-12, "{step}");
    }
}
