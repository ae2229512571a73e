//! One mesh in many encodings: the same tetrahedra, positions and values, to the last bit that the encoding keeps.

use tetrascope_mesh::{CellKind, Cells, DataArray, Dataset, UnstructuredCells, decompose};

use crate::{load, shared::shared};

const BINARY: &str = "vtu/encodings/mixed_appended_raw_none_u64.vtu";

fn dataset(name: &str) -> Option<Dataset> {
    Some(load(name)?.dataset)
}

fn cells(dataset: &Dataset) -> &UnstructuredCells {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells,
        Cells::Structured(_) => panic!("structured cells"),
    }
}

/// Type and numbers of an array by its name; widening to 64 bits keeps every bit that tells two numbers apart.
fn by_name(arrays: &[DataArray]) -> Vec<(&str, usize, &str, Vec<u64>)> {
    let bits = |array: &DataArray| array.values.to_f64().into_iter().map(f64::to_bits).collect();
    let mut all: Vec<_> = arrays
        .iter()
        .map(|array| (array.name.as_str(), array.components, array.values.type_name(), bits(array)))
        .collect();
    // The writer puts the active array first in one format and in the order of creation in the other.
    all.sort();
    all
}

fn assert_same(a: &Dataset, b: &Dataset, what: &str) {
    assert_same_tetrahedra(a, b, what);
    assert!(by_name(&a.point_arrays) == by_name(&b.point_arrays), "{what}: point arrays");
    assert!(by_name(&a.cell_arrays) == by_name(&b.cell_arrays), "{what}: cell arrays");
}

fn assert_same_tetrahedra(a: &Dataset, b: &Dataset, what: &str) {
    let bits = |d: &Dataset| -> Vec<[u64; 3]> { d.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect() };
    assert!(bits(a) == bits(b), "{what}: points");
    let (a, b) = (decompose(a).unwrap(), decompose(b).unwrap());
    assert_eq!(a.counts, b.counts, "{what}");
    assert_eq!(a.mesh.tetrahedra(), b.mesh.tetrahedra(), "{what}");
    assert_eq!(a.mesh.source_cells(), b.mesh.source_cells(), "{what}");
    let local = |mesh: &tetrascope_mesh::TetMesh| -> Vec<[u64; 3]> {
        mesh.positions().iter().map(|p| p.to_array().map(f64::to_bits)).collect()
    };
    assert!(local(&a.mesh) == local(&b.mesh), "{what}: positions of the tetrahedra");
}

/// Text too: VTK prints as many digits as tell every number apart.
#[test]
fn encodings_of_vtu_give_the_same_tetrahedra() {
    let (Some(folder), Some(binary)) = (shared("data/vtu/encodings"), dataset(BINARY)) else { return };
    assert_eq!(decompose(&binary).unwrap().counts.tetrahedra, 892);
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names.len(), 18);
    for name in names {
        assert_same(&dataset(&format!("vtu/encodings/{name}")).unwrap(), &binary, &name);
    }
}

#[test]
fn encodings_of_legacy_files_give_the_tetrahedra_of_vtu() {
    let Some(reference) = dataset(BINARY) else { return };
    let get = |name: &str| dataset(&format!("vtk/mixed_{name}.vtk")).unwrap();
    assert_same(&get("binary_v4.2"), &reference, "binary 4.2 against VTU");
    assert_same(&get("binary_v5.1"), &reference, "binary 5.1 against VTU");
    assert_same(&get("ascii_v4.2"), &get("ascii_v5.1"), "text 4.2 against 5.1");

    // Legacy text has six digits of a float and eleven of a double: every number is what is printed of the binary one.
    let (text, binary) = (get("ascii_v4.2"), get("binary_v4.2"));
    let (cut, cut_binary) = (decompose(&text).unwrap(), decompose(&binary).unwrap());
    assert_eq!(cut.mesh.tetrahedra(), cut_binary.mesh.tetrahedra());
    for (a, b) in text.points.iter().zip(&binary.points) {
        for (a, b) in a.to_array().into_iter().zip(b.to_array()) {
            assert!((a - b).abs() <= 5.01e-11 * b.abs(), "{a} of {b}");
        }
    }
    let arrays = |dataset: &Dataset| [&dataset.point_arrays[..], &dataset.cell_arrays].concat();
    for (a, b) in arrays(&text).iter().zip(&arrays(&binary)) {
        assert_eq!((&a.name, a.values.type_name()), (&b.name, b.values.type_name()));
        let digits = if a.values.type_name() == "Float64" { 5.01e-11 } else { 5.01e-6 };
        for (x, y) in a.values.to_f64().iter().zip(b.values.to_f64()) {
            assert!((x - y).abs() <= digits * y.abs(), "{}: {x} of {y}", a.name);
        }
    }
}

#[test]
fn layouts_of_polyhedra_give_the_same_cells() {
    let Some(reference) = dataset("vtu/polyhedra_new_layout_v2.3.vtu") else { return };
    for name in ["vtk/polyhedra_ascii_v4.2.vtk", "vtk/polyhedra_binary_v5.1.vtk"] {
        let other = dataset(name).unwrap();
        let (a, b) = (cells(&reference), cells(&other));
        assert_eq!(a.kinds, b.kinds, "{name}");
        assert_eq!(a.polyhedra, b.polyhedra, "{name}");
        for (cell, kind) in a.kinds.iter().enumerate() {
            let row = |cells: &UnstructuredCells| {
                let mut row = cells.connectivity[cells.offsets[cell]..cells.offsets[cell + 1]].to_vec();
                // Legacy files have no list of a polyhedron's points, so its order may differ.
                if *kind == CellKind::Polyhedron {
                    row.sort_unstable();
                }
                row
            };
            assert_eq!(row(a), row(b), "{name}: cell {cell}");
        }
        if name.contains("binary") {
            assert!(by_name(&reference.cell_arrays) == by_name(&other.cell_arrays), "{name}");
        }
    }
}
