//! Points, cells, tetrahedra and the range of every array, row by row of the description.

use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::path::Path;

use tetrascope_io::{Loaded, ReadOptions};
use tetrascope_mesh::{CellKind, Cells, DataArray, Dataset, StructuredBlock, decompose};

use crate::exceptions::{MORE_ARRAYS, NAMES, NO_VOLUME, TYPES, WARNINGS, WITH_OTHERS};
use crate::readme::{Array, Row, Shape, rows};
use crate::{load_with, shared::shared};

/// A cell by the description's word: its kind, into how many tetrahedra the description cuts it and into how many the specification
/// does. Of polyhedra neither is a fixed number.
const CELLS: &[(&str, CellKind, usize, usize)] = &[
    ("tet", CellKind::Tetrahedron, 1, 1),
    ("tetra", CellKind::Tetrahedron, 1, 1),
    ("hex", CellKind::Hexahedron, 5, 6),
    ("hexahedron", CellKind::Hexahedron, 5, 6),
    ("wedge", CellKind::Wedge, 3, 3),
    ("pyramid", CellKind::Pyramid, 2, 2),
    ("pent. prism", CellKind::PentagonalPrism, 0, 9),
    ("hex. prism", CellKind::HexagonalPrism, 0, 12),
    ("polyhedron", CellKind::Polyhedron, 0, 0),
    ("quadratic tet", CellKind::QuadraticTetrahedron, 1, 8),
    ("tetra10", CellKind::QuadraticTetrahedron, 1, 8),
    ("quadratic pyramid", CellKind::QuadraticPyramid, 2, 16),
    ("quadratic wedge", CellKind::QuadraticWedge, 3, 24),
    ("quadratic hex", CellKind::QuadraticHexahedron, 5, 48),
    ("triquadratic hex", CellKind::TriquadraticHexahedron, 5, 48),
    ("vertex", CellKind::Flat, 0, 0),
    ("line", CellKind::Flat, 0, 0),
    ("triangle", CellKind::Flat, 0, 0),
    ("strip", CellKind::FlatOf(6), 0, 0),
    ("polygon", CellKind::FlatOf(7), 0, 0),
    ("quad", CellKind::Flat, 0, 0),
    ("quadratic triangle", CellKind::FlatOf(22), 0, 0),
    ("quadratic quad", CellKind::FlatOf(23), 0, 0),
];

#[test]
fn every_file_is_read_as_the_description_says() {
    let Some(folder) = shared("data") else { return };
    let rows = rows(&std::fs::read_to_string(folder.join("README.md")).unwrap());
    let files = rows.iter().map(|row| row.files.len()).sum::<usize>();
    assert!(rows.len() >= 90 && files >= 180, "{} rows of {files} files", rows.len());
    // All rows that are wrong are told, not the first alone.
    let wrong: Vec<&str> = rows
        .iter()
        .filter(|row| catch_unwind(|| check(row, &read(&folder, row))).is_err())
        .map(|row| row.files[0].as_str())
        .collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn every_file_has_a_row_and_every_row_a_file() {
    let Some(folder) = shared("data") else { return };
    let rows = rows(&std::fs::read_to_string(folder.join("README.md")).unwrap());
    let mut described: Vec<String> = rows.into_iter().flat_map(|row| row.files).collect();
    described.sort();
    let mut found = Vec::new();
    files_below(&folder, "", &mut found);
    found.retain(|name| name != "README.md" && !name.starts_with("hostile/"));
    found.sort();
    assert_eq!(found, described);
}

fn files_below(folder: &Path, prefix: &str, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = format!("{prefix}{}", path.file_name().unwrap().to_string_lossy());
        if path.is_dir() {
            files_below(&path, &format!("{name}/"), found);
        } else {
            found.push(name);
        }
    }
}

/// The row's file, or the one that it belongs to, with it.
fn read(folder: &Path, row: &Row) -> Loaded {
    let name = row.files[0].as_str();
    let Some((_, other)) = WITH_OTHERS.iter().find(|(file, _)| *file == name) else {
        return load_with(&folder.join(name), &ReadOptions::default());
    };
    let solution = name.starts_with("plot3d/").then(|| folder.join(name));
    load_with(&folder.join(other), &ReadOptions { solution, ..ReadOptions::default() })
}

fn check(row: &Row, loaded: &Loaded) {
    let name = row.files[0].as_str();
    let dataset = &loaded.dataset;
    assert_eq!(dataset.points.len(), row.points, "{name}: points");
    check_cells(name, row, dataset);
    check_tetrahedra(name, row, dataset);
    check_arrays(name, row, dataset);
    let words = WARNINGS.iter().find(|(file, _)| name.ends_with(file)).map_or(&[][..], |(_, words)| words);
    assert_eq!(loaded.warnings.len(), words.len(), "{name}: {:?}", loaded.warnings);
    for (warning, word) in loaded.warnings.iter().zip(words) {
        assert!(warning.contains(word), "{name}: `{word}` is not in: {warning}");
    }
}

fn check_cells(name: &str, row: &Row, dataset: &Dataset) {
    match (&row.shape, &dataset.cells) {
        (Shape::Grids(grids), Cells::Structured(blocks)) => {
            assert_eq!(&blocks.iter().map(|block| block.dims).collect::<Vec<_>>(), grids, "{name}");
            assert_eq!(blocks.iter().map(StructuredBlock::cell_count).sum::<usize>(), row.cells, "{name}: cells");
        }
        (Shape::Cells(counts), Cells::Unstructured(cells)) => {
            let (mut expected, mut found) = (BTreeMap::new(), BTreeMap::new());
            for (count, word) in counts {
                *expected.entry(cell(word).1).or_insert(0) += count;
            }
            cells.kinds.iter().for_each(|&kind| *found.entry(kind).or_insert(0) += 1);
            assert_eq!(found, expected, "{name}");
            assert_eq!(cells.kinds.len(), row.cells, "{name}: cells");
        }
        (shape, _) => panic!("{name}: {shape:?} is read as the other kind"),
    }
}

fn cell(word: &str) -> &'static (&'static str, CellKind, usize, usize) {
    CELLS.iter().find(|cell| cell.0 == word).unwrap_or_else(|| panic!("no cell is called {word}"))
}

fn check_tetrahedra(name: &str, row: &Row, dataset: &Dataset) {
    let cut = decompose(dataset).unwrap_or_else(|error| panic!("{name}: {error}"));
    let (described, expected) = match (&row.shape, &dataset.cells) {
        (Shape::Cells(counts), Cells::Unstructured(cells)) => {
            let sum = |of: fn(&(&str, CellKind, usize, usize)) -> usize| -> usize {
                counts.iter().map(|(count, word)| count * of(cell(word))).sum()
            };
            // One for every triangle of a polyhedron's faces.
            let faces = cells.polyhedra.iter().flatten().map(|face| face.len() - 2).sum::<usize>();
            (sum(|cell| cell.2), sum(|cell| cell.3) + faces)
        }
        _ => {
            let drawn = row.cells - cut.counts.hidden;
            (5 * drawn, 5 * drawn)
        }
    };
    // What the description has by its own rule comes from the same cells.
    if let Some(tetrahedra) = row.tetrahedra {
        assert_eq!(described, tetrahedra, "{name}: tetrahedra by the description's rule");
    }
    assert_eq!(cut.counts.tetrahedra, expected, "{name}: tetrahedra");
    // VTK cuts linear cells into as many as the specification does.
    let is_linear = |word: &str| ["tet", "hex", "wedge", "pyramid"].contains(&word) || cell(word).1.is_flat();
    if let (Shape::Cells(counts), Some(by_vtk)) = (&row.shape, row.by_vtk)
        && counts.iter().all(|(_, word)| is_linear(word))
        // Its hexahedra of 20 points confuse VTK's filter.
        && name != "vtk/notch_stress.vtk"
    {
        assert_eq!(expected, by_vtk, "{name}: tetrahedra of VTK");
    }
    let no_volume = NO_VOLUME.iter().find(|(file, _)| *file == name).map_or(0, |(_, count)| *count);
    assert_eq!((cut.counts.no_volume, cut.counts.malformed, cut.counts.non_finite), (no_volume, 0, 0), "{name}");
    assert_eq!(cut.mesh.tetrahedra().len(), expected - no_volume, "{name}");
}

fn check_arrays(name: &str, row: &Row, dataset: &Dataset) {
    for (grid, arrays) in row.arrays.iter().enumerate() {
        let points = match &dataset.cells {
            Cells::Structured(blocks) if row.arrays.len() > 1 => {
                let block = &blocks[grid];
                block.first_point..block.first_point + block.point_count()
            }
            _ => 0..dataset.points.len(),
        };
        for described in arrays {
            check_array(name, described, dataset, &points);
        }
    }
    let known: Vec<String> = row.arrays.iter().flatten().map(|array| name_here(name, array)).collect();
    for array in dataset.point_arrays.iter().chain(&dataset.cell_arrays) {
        let is_more =
            MORE_ARRAYS.iter().any(|(start, more)| name.starts_with(start) && more.contains(&array.name.as_str()));
        assert!(known.contains(&array.name) || is_more, "{name}: {} is not described", array.name);
    }
}

fn name_here(file: &str, array: &Array) -> String {
    let other = NAMES.iter().find(|(of, name, _)| *of == file && *name == array.name.as_deref());
    other.map_or_else(|| array.name.clone().unwrap_or_else(|| "ImageFile".to_owned()), |(.., here)| (*here).to_owned())
}

fn check_array(file: &str, described: &Array, dataset: &Dataset, points: &std::ops::Range<usize>) {
    let name = name_here(file, described);
    let arrays = if described.of_points { &dataset.point_arrays } else { &dataset.cell_arrays };
    let array: &DataArray =
        arrays.iter().find(|array| array.name == name).unwrap_or_else(|| panic!("{file}: {name} is missing"));
    let other = TYPES.iter().find(|(of, array, _)| *of == file && array.is_none_or(|array| array == name));
    let kind = other.map_or(described.kind.as_str(), |other| other.2);
    assert_eq!((array.values.type_name(), array.components), (kind, described.components), "{file}: {name}");

    let all = array.values.to_f64();
    let part =
        if described.of_points { array.components * points.start..array.components * points.end } else { 0..all.len() };
    let (finite, others): (Vec<f64>, Vec<f64>) = all[part].iter().partition(|value| value.is_finite());
    let low = finite.iter().copied().fold(f64::INFINITY, f64::min);
    let high = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(others.len(), described.not_finite, "{file}: {name}: values that are not finite");
    // Six digits are given.
    let is_close = |found: f64, given: f64| (found - given).abs() <= 5.01e-6 * given.abs();
    let is_right = is_close(low, described.range[0]) && is_close(high, described.range[1]);
    assert!(is_right, "{file}: {name}: {low} .. {high}, not {:?}", described.range);
}
