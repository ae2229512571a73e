//! Both readers on the shared files: counts, kinds and ranges as their description states them, and equality between
//! the encodings of one mesh.

use std::collections::BTreeMap;

use tetrascope_mesh::{Cells, Dataset};

use super::shared_table::{Array, FILES, File};
use super::test_support::{assert_same, bits, cells, finite_range, read_file, sanity_check, shared};

fn check_file(file: &File, dataset: &Dataset) {
    let name = file.name;
    sanity_check(dataset);
    assert_eq!(dataset.points.len(), file.points, "{name}");
    let kinds = &cells(dataset).kinds;
    assert_eq!(kinds.len(), file.cells, "{name}");
    let mut counts = BTreeMap::new();
    for &kind in kinds {
        *counts.entry(kind).or_insert(0) += 1;
    }
    assert_eq!(counts, file.kinds.iter().copied().collect(), "{name}");
    check_arrays(name, file.arrays, dataset);
}

fn check_arrays(name: &str, described: &[Array], dataset: &Dataset) {
    assert_eq!(dataset.point_arrays.len() + dataset.cell_arrays.len(), described.len(), "{name}");
    for &(owner, array, type_name, components, low, high, not_finite) in described {
        let arrays = if owner == "point" { &dataset.point_arrays } else { &dataset.cell_arrays };
        let found =
            arrays.iter().find(|a| a.name == array).unwrap_or_else(|| panic!("{name}: no {owner} array {array}"));
        assert_eq!((found.values.type_name(), found.components), (type_name, components), "{name}: {array}");
        let range = finite_range(&found.values);
        // Six significant digits are given.
        let close = |a: f64, b: f64| (a - b).abs() <= 5.01e-6 * b.abs();
        assert!(close(range.0, low) && close(range.1, high), "{name}: {array}: {range:?}, not {low} .. {high}");
        assert_eq!(range.2, not_finite, "{name}: {array}");
    }
}

#[test]
fn shared_files_are_as_described() {
    let Some(folder) = shared() else { return };
    for file in FILES {
        let loaded = read_file(&folder, file.name).unwrap_or_else(|e| panic!("{e}"));
        check_file(file, &loaded.dataset);
        // The one file among them with something odd: hexahedra of 20 points and wedges of 15.
        assert_eq!(
            loaded.warnings.is_empty(),
            file.name != "vtk/notch_stress.vtk",
            "{}: {:?}",
            file.name,
            loaded.warnings
        );
    }
}

#[test]
fn shared_table_names_every_file() {
    let Some(folder) = shared() else { return };
    for part in ["vtk", "vtu", "vtu/encodings"] {
        for entry in std::fs::read_dir(folder.join(part)).unwrap() {
            let path = entry.unwrap().path();
            let name = format!("{part}/{}", path.file_name().unwrap().to_string_lossy());
            let is_grid = GRIDS.iter().any(|grid| grid.0 == name);
            assert!(path.is_dir() || is_grid || FILES.iter().any(|f| f.name == name), "{name} is in no test");
        }
    }
}

#[test]
fn shared_encodings_are_equal() {
    let Some(folder) = shared() else { return };
    let binary = read_file(&folder, "vtu/encodings/mixed_appended_raw_none_u32.vtu").unwrap().dataset;
    let ascii = read_file(&folder, "vtu/encodings/mixed_ascii.vtu").unwrap().dataset;
    let mut compared = 0;
    for file in FILES.iter().filter(|file| file.name.starts_with("vtu/encodings/")) {
        let loaded = read_file(&folder, file.name).unwrap();
        assert_same(&loaded.dataset, &binary, file.name);
        compared += 1;
    }
    assert_same(&ascii, &binary, "ASCII against binary");
    assert_eq!(compared, 18);
}

#[test]
fn shared_legacy_encodings_are_equal() {
    let Some(folder) = shared() else { return };
    let get = |name: &str| read_file(&folder, &format!("vtk/mixed_{name}.vtk")).unwrap().dataset;
    let reference = read_file(&folder, "vtu/encodings/mixed_ascii.vtu").unwrap().dataset;
    assert_same(&get("binary_v4.2"), &reference, "binary 4.2 against VTU");
    assert_same(&get("binary_v5.1"), &reference, "binary 5.1 against VTU");
    assert_same(&get("ascii_v4.2"), &get("ascii_v5.1"), "ASCII 4.2 against 5.1");
    // Legacy text holds six digits of a float and eleven of a double.
    let (text, exact) = (get("ascii_v4.2"), get("binary_v4.2"));
    for (a, b) in
        text.point_arrays.iter().chain(&text.cell_arrays).zip(exact.point_arrays.iter().chain(&exact.cell_arrays))
    {
        assert_eq!(a.name, b.name);
        for (x, y) in a.values.to_f64().iter().zip(b.values.to_f64()) {
            assert!((x - y).abs() <= 5.01e-6 * y.abs(), "{}: {x} and {y}", a.name);
        }
    }
    for (p, q) in text.points.iter().zip(&exact.points) {
        assert!((p - q).length() < 1e-9);
    }
}

#[test]
fn shared_polyhedra_are_equal_in_all_layouts() {
    let Some(folder) = shared() else { return };
    let reference = read_file(&folder, "vtu/polyhedra_new_layout_v2.3.vtu").unwrap().dataset;
    for name in ["vtk/polyhedra_ascii_v4.2.vtk", "vtk/polyhedra_binary_v5.1.vtk"] {
        let other = read_file(&folder, name).unwrap().dataset;
        let (a, b) = (cells(&reference), cells(&other));
        assert_eq!(a.kinds, b.kinds, "{name}");
        assert_eq!(a.polyhedra, b.polyhedra, "{name}");
        for cell in 0..a.kinds.len() {
            let row = |cells: &tetrascope_mesh::UnstructuredCells, sorted: bool| {
                let mut row = cells.connectivity[cells.offsets[cell]..cells.offsets[cell + 1]].to_vec();
                if sorted {
                    row.sort_unstable();
                }
                row
            };
            // Legacy files have no list of a polyhedron's points, so its order may differ.
            let sorted = a.kinds[cell] == tetrascope_mesh::CellKind::Polyhedron;
            assert_eq!(row(a, sorted), row(b, sorted), "{name}: cell {cell}");
        }
    }
    let binary = read_file(&folder, "vtk/polyhedra_binary_v5.1.vtk").unwrap().dataset;
    assert_eq!(bits(&reference.cell_arrays[0].values), bits(&binary.cell_arrays[0].values));
}

/// Name, dims, arrays as in [`File`].
type Grid = (&'static str, [usize; 3], &'static [Array]);

const GRIDS: &[Grid] = &[
    (
        "volume/StructuredGrid.vts",
        [6, 12, 9],
        &[
            ("point", "Density", "Float32", 1, 0.203009, 0.710419, 0),
            ("point", "Momentum", "Float32", 3, -350.012, 332.25, 0),
            ("point", "StagnationEnergy", "Float32", 1, 0.0, 0.0, 0),
        ],
    ),
    (
        "volume/cth.vtr",
        [129, 65, 65],
        &[
            ("cell", "Pressure", "Float32", 1, -2.35945e10, 1.12038e11, 0),
            ("cell", "Void Volume Fraction", "Float32", 1, 0.0, 1.0, 0),
            ("cell", "X Velocity", "Float32", 1, -86618.9, 327482.0, 0),
            ("cell", "Y Velocity", "Float32", 1, -74656.1, 78993.6, 0),
            ("cell", "Z Velocity", "Float32", 1, -88306.7, 132856.0, 0),
            ("cell", "Volume Fraction for Armor Plate", "Float32", 1, 0.0, 1.0, 0),
            ("cell", "Mass for Armor Plate", "Float32", 1, 0.0, 0.00944007, 0),
            ("cell", "Volume Fraction for Body, Nose", "Float32", 1, 0.0, 1.0, 0),
            ("cell", "Mass for Body, Nose", "Float32", 1, 0.0, 0.00944007, 0),
        ],
    ),
    (
        "vtk/RectGrid2.vtk",
        [47, 33, 11],
        &[
            ("point", "scalars", "Float32", 1, 0.0, 10.3964, 0),
            ("point", "vectors", "Float32", 3, -5.36145, 10.0787, 0),
        ],
    ),
    (
        "vtk/SampleStructGrid.vtk",
        [20, 30, 40],
        &[("point", "scalars", "Float64", 1, 0.0, 1.30456, 0), ("cell", "scalars", "Float64", 1, -0.262933, 1.0, 0)],
    ),
    ("vtk/ironProt.vtk", [68; 3], &[("point", "scalars", "UInt8", 1, 0.0, 255.0, 0)]),
    ("volume/heart.vti", [32, 32, 12], &[("point", "scalars", "Float32", 1, 0.0, 255.0, 0)]),
    ("volume/hydrogen.vti", [64; 3], &[("point", "probability_density", "Float32", 1, 0.0, 1.0, 0)]),
];

#[test]
fn shared_grids_are_as_described() {
    let Some(folder) = shared() else { return };
    for &(name, dims, arrays) in GRIDS {
        let loaded = read_file(&folder, name).unwrap_or_else(|e| panic!("{e}"));
        assert!(loaded.warnings.is_empty(), "{name}: {:?}", loaded.warnings);
        let Cells::Structured(blocks) = &loaded.dataset.cells else { panic!("{name}: not structured") };
        assert_eq!((blocks.len(), blocks[0].dims), (1, dims), "{name}");
        check_arrays(name, arrays, &loaded.dataset);
        let cut = tetrascope_mesh::decompose(&loaded.dataset).unwrap();
        assert_eq!(cut.counts.tetrahedra, 5 * blocks[0].cell_count(), "{name}");
    }
}
