//! Which array a name means, and what happens to values that are not numbers.

use glam::DVec3;
use tetrascope_mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells, VertexId, decompose};

use crate::{Association, FieldError, MeshFacts, place_on_mesh, select_cell_field, select_field, summarize_arrays};

fn array(name: &str, components: usize, values: &[f64]) -> DataArray {
    DataArray { name: name.to_owned(), components, values: ArrayValues::F64(values.to_vec()) }
}

/// Two tetrahedra with a common face over five points.
fn two_cells(point_arrays: Vec<DataArray>, cell_arrays: Vec<DataArray>) -> Dataset {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let cells = UnstructuredCells {
        kinds: vec![CellKind::Tetrahedron; 2],
        offsets: vec![0, 4, 8],
        connectivity: vec![0, 1, 2, 3, 1, 2, 3, 4],
        polyhedra: Vec::new(),
    };
    Dataset { points, cells: Cells::Unstructured(cells), point_arrays, cell_arrays }
}

fn velocity() -> DataArray {
    let tuples = [[3.0, 4.0, 0.0], [0.0, -2.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 3.0, 4.0]];
    array("Velocity", 3, tuples.as_flattened())
}

fn full() -> Dataset {
    two_cells(
        vec![velocity(), array("p", 1, &[1.0, 2.0, 3.0, 4.0, 5.0]), array("a:b", 1, &[9.0; 5])],
        vec![array("c", 1, &[10.0, 20.0]), array("p", 1, &[0.0, 0.0])],
    )
}

fn values(name: &str) -> Vec<f64> {
    select_field(&full(), Some(name)).unwrap().values
}

#[test]
fn the_first_scalar_point_array_is_the_default() {
    let field = select_field(&full(), None).unwrap();
    assert_eq!((field.name.as_str(), field.association), ("p", Association::Point));
    assert!(field.notes[0].contains("first scalar point array"));
}

#[test]
fn other_defaults_say_what_they_are() {
    let field = select_field(&two_cells(vec![velocity()], vec![]), None).unwrap();
    assert_eq!((field.name.as_str(), field.notes.len()), ("Velocity:mag", 2));
    let field = select_field(&two_cells(vec![], vec![array("c", 1, &[1.0, 2.0])]), None).unwrap();
    assert_eq!((field.name.as_str(), field.association), ("c", Association::Cell));
    assert_eq!((field.notes.len(), field.warnings.len()), (1, 1));
    assert_eq!(select_field(&two_cells(vec![], vec![]), None).unwrap_err(), FieldError::NoArrays);
}

#[test]
fn parts_of_a_vector() {
    assert_eq!(values("Velocity:0"), [3.0, 0.0, 0.0, 1.0, 0.0]);
    assert_eq!(values("Velocity:y"), [4.0, -2.0, 0.0, 0.0, 3.0]);
    assert_eq!(values("Velocity:2"), values("Velocity:z"));
    assert_eq!(values("Velocity:mag"), [5.0, 2.0, 0.0, 1.0, 5.0]);
    let bare = select_field(&full(), Some("Velocity")).unwrap();
    assert_eq!((bare.values, bare.name.as_str()), (values("Velocity:mag"), "Velocity:mag"));
    assert!(bare.notes[0].contains("magnitude is taken"));
    assert!(select_field(&full(), Some("Velocity:mag")).unwrap().notes.is_empty());
    assert_eq!(values("a:b"), [9.0; 5]);
    for component in ["3", "w", "-1", ""] {
        let error = select_field(&full(), Some(&format!("Velocity:{component}"))).unwrap_err();
        assert!(matches!(error, FieldError::NoSuchComponent { .. }), "{error}");
        assert!(error.to_string().contains("Velocity:0 to Velocity:2 or Velocity:mag"), "{error}");
    }
    assert!(matches!(select_field(&full(), Some("p:1")), Err(FieldError::NoSuchComponent { .. })));
}

#[test]
fn a_cell_array_is_averaged_with_a_warning() {
    let field = select_field(&full(), Some("c")).unwrap();
    assert_eq!(field.values, [10.0, 15.0, 15.0, 15.0, 20.0]);
    assert!(field.warnings[0].contains("averaged onto the points"));
}

#[test]
fn doubled_names_are_said() {
    let field = select_field(&full(), Some("p")).unwrap();
    assert_eq!(field.association, Association::Point);
    assert!(field.notes[0].contains("point array and a cell array"));
    let twice = two_cells(vec![array("s", 1, &[0.0; 5]), array("s", 1, &[1.0; 5])], vec![]);
    let field = select_field(&twice, Some("s")).unwrap();
    assert_eq!(field.values[0], 0.0);
    assert!(field.warnings[0].contains("several point arrays"));
}

#[test]
fn an_unknown_name_lists_all_arrays_with_ranges() {
    let message = select_field(&full(), Some("Pressure")).unwrap_err().to_string();
    for part in [
        "\"Pressure\"",
        "point array \"Velocity\", 3 components, -2 to 4",
        "\"p\", 1 to 5",
        "cell array \"c\", 10 to 20",
    ] {
        assert!(message.contains(part), "{part} is not in:\n{message}");
    }
    let message = select_field(&two_cells(vec![], vec![]), Some("p")).unwrap_err().to_string();
    assert!(message.contains("no arrays at all"), "{message}");
}

#[test]
fn summaries_count_what_is_not_finite() {
    let odd = array("s", 1, &[f64::NAN, f64::INFINITY, 2.0, -1.0, f64::NEG_INFINITY]);
    let none = array("n", 1, &[f64::NAN; 5]);
    let summaries = summarize_arrays(&two_cells(vec![odd, none], vec![]));
    assert_eq!((summaries[0].range, summaries[0].non_finite), (Some((-1.0, 2.0)), 3));
    assert_eq!((summaries[1].range, summaries[1].non_finite), (None, 5));
    assert!(summaries[1].to_string().contains("no finite value"));
}

#[test]
fn a_length_that_does_not_fit_is_an_error() {
    let error = select_field(&two_cells(vec![array("s", 1, &[1.0])], vec![]), Some("s")).unwrap_err();
    assert!(matches!(error, FieldError::WrongLength { tuples: 1, expected: 5, .. }));
}

#[test]
fn tetrahedra_that_touch_no_number_are_left_out() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let dataset = two_cells(vec![array("s", 1, &[bad, 2.0, 3.0, 4.0, 5.0])], vec![]);
        let decomposition = decompose(&dataset).unwrap();
        let on_mesh = place_on_mesh(&select_field(&dataset, None).unwrap(), &decomposition).unwrap();
        assert_eq!((on_mesh.left_out, on_mesh.non_finite), (1, 1));
        assert_eq!(on_mesh.range, (2.0, 5.0));
        assert_eq!(on_mesh.mesh.tetrahedra().len(), 1);
        assert!(on_mesh.mesh.tetrahedra()[0].contains(&VertexId(4)));
        assert!(on_mesh.warning().unwrap().contains("1 of 2 tetrahedra"));
        // The camera stays where it is for a field that is finite everywhere.
        let facts = MeshFacts::new(&decomposition.mesh, on_mesh.range).unwrap();
        assert!((facts.diagonal() - 3.0_f64.sqrt()).abs() < 1e-15);
    }
    let dataset = two_cells(vec![array("s", 1, &[f64::NAN; 5])], vec![]);
    let error = place_on_mesh(&select_field(&dataset, None).unwrap(), &decompose(&dataset).unwrap()).unwrap_err();
    assert!(matches!(error, FieldError::NothingFinite { non_finite: 5, all: 5, .. }));
}

#[test]
fn the_range_is_that_of_the_points_that_cells_use() {
    let mut dataset = two_cells(vec![array("s", 1, &[1.0, 2.0, 3.0, 4.0, 5.0, 1e30])], vec![]);
    dataset.points.push(DVec3::splat(50.0));
    let decomposition = decompose(&dataset).unwrap();
    let on_mesh = place_on_mesh(&select_field(&dataset, None).unwrap(), &decomposition).unwrap();
    assert_eq!((on_mesh.range, on_mesh.left_out), ((1.0, 5.0), 0));
    assert!(on_mesh.warning().is_none());
}

#[test]
fn constants_of_cells_stay_in_their_cells() {
    let c = array("c", 1, &[10.0, 20.0]);
    let dataset = two_cells(vec![array("s", 1, &[1.0, 2.0, 3.0, 4.0, 5.0])], vec![velocity_of_cells(), c.clone()]);
    let decomposition = decompose(&dataset).unwrap();
    let field = select_cell_field(&dataset, None).unwrap();
    assert_eq!((field.name.as_str(), field.is_per_cell, field.values.as_slice()), ("c", true, &[10.0, 20.0][..]));
    assert!(field.warnings.is_empty() && field.notes[0].contains("first scalar cell array"));
    let on_mesh = place_on_mesh(&field, &decomposition).unwrap();
    assert_eq!((on_mesh.range, on_mesh.left_out, on_mesh.mesh.positions().len()), ((10.0, 20.0), 0, 5 + 8));
    for (corners, value) in on_mesh.mesh.tetrahedra().iter().zip([10.0, 20.0]) {
        assert!(corners.iter().all(|vertex| on_mesh.scalars[vertex.index()] == value));
    }
    assert_eq!(select_cell_field(&dataset, Some("w:1")).unwrap().values, [4.0, 0.0]);

    let error = select_cell_field(&dataset, Some("s")).unwrap_err();
    assert!(
        matches!(error, FieldError::UnknownOfCells { .. }) && error.to_string().contains("\"c\", 10 to 20"),
        "{error}"
    );
    let none = select_cell_field(&two_cells(vec![c.clone()], vec![]), None).unwrap_err();
    assert!(matches!(none, FieldError::NoCellArrays { .. }), "{none}");

    // A cell whose own value is no number, and no neighbor, is left out.
    for (values, left_out) in [([f64::NAN, 2.0], 1), ([1.0, f64::INFINITY], 1)] {
        let dataset = two_cells(vec![], vec![array("c", 1, &values)]);
        let field = select_cell_field(&dataset, None).unwrap();
        let on_mesh = place_on_mesh(&field, &decomposition).unwrap();
        assert_eq!((on_mesh.left_out, on_mesh.mesh.tetrahedra().len(), on_mesh.non_finite), (left_out, 1, 1));
        assert!(on_mesh.warning().unwrap().contains("1 cells where"));
    }
    let dataset = two_cells(vec![], vec![array("c", 1, &[f64::NAN; 2])]);
    let error = place_on_mesh(&select_cell_field(&dataset, None).unwrap(), &decomposition).unwrap_err();
    assert!(error.to_string().contains("2 of 2 cells"), "{error}");
}

/// Two vectors of two components.
fn velocity_of_cells() -> DataArray {
    array("w", 2, &[3.0, 4.0, 0.0, 0.0])
}
