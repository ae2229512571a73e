//! What the tests of both readers share: small meshes written here, and the project's shared data where it is present.

use std::path::{Path, PathBuf};

use tetrascope_mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells};

use super::{LEGACY, VTI, VTR, VTS, VTU};
use crate::{IoError, Loaded, MeshReader, Source};

/// The folder of the shared data, or nothing where it is absent.
pub(super) fn shared() -> Option<PathBuf> {
    crate::shared::shared("data")
}

/// Reads bytes as a file of this name, by its content or else its extension.
pub(super) fn read(name: &str, bytes: &[u8]) -> Result<Loaded, IoError> {
    let source = Source { path: name.into(), bytes: bytes.to_vec(), ..Default::default() };
    let readers: [&dyn MeshReader; 5] = [&LEGACY, &VTU, &VTI, &VTR, &VTS];
    let reader = readers
        .iter()
        .find(|reader| reader.recognizes(bytes))
        .or_else(|| readers.iter().find(|reader| reader.extensions().contains(&source.extension().as_str())));
    reader.expect("a reader for the name").read(&source)
}

/// Reads one of the shared files.
pub(super) fn read_file(folder: &Path, name: &str) -> Result<Loaded, IoError> {
    read(name, &std::fs::read(folder.join(name)).expect("a shared file"))
}

pub(super) fn cells(dataset: &Dataset) -> &UnstructuredCells {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells,
        Cells::Structured(_) => panic!("structured cells"),
    }
}

/// Fails unless the cells keep what their type promises.
pub(crate) fn sanity_check(dataset: &Dataset) {
    let point_count = dataset.points.len();
    let cell_count = match &dataset.cells {
        Cells::Unstructured(rows) => {
            sanity_check_rows(rows, point_count);
            rows.kinds.len()
        }
        Cells::Structured(blocks) => {
            for block in blocks {
                assert!(!block.dims.contains(&0) && block.first_point + block.point_count() <= point_count);
                assert!([0, block.point_count()].contains(&block.hidden_points.len()));
            }
            blocks.iter().map(tetrascope_mesh::StructuredBlock::cell_count).sum()
        }
    };
    for (arrays, tuples) in [(&dataset.point_arrays, point_count), (&dataset.cell_arrays, cell_count)] {
        for array in arrays {
            assert!(array.components >= 1 && !array.name.is_empty());
            assert_eq!(array.values.len(), tuples * array.components, "{}", array.name);
        }
    }
}

fn sanity_check_rows(rows: &UnstructuredCells, point_count: usize) {
    assert_eq!(rows.offsets.len(), rows.kinds.len() + 1);
    assert_eq!(rows.offsets[0], 0);
    assert!(rows.offsets.is_sorted());
    assert_eq!(*rows.offsets.last().unwrap(), rows.connectivity.len());
    let polyhedra = rows.kinds.iter().filter(|&&kind| kind == CellKind::Polyhedron).count();
    assert_eq!(polyhedra, rows.polyhedra.len());
    let faces = rows.polyhedra.iter().flatten().flatten();
    assert!(rows.connectivity.iter().chain(faces).all(|&point| (point as usize) < point_count));
}

/// Bit patterns of an array's numbers, so that equality means equality.
pub(super) fn bits(values: &ArrayValues) -> Vec<u64> {
    match values {
        ArrayValues::F32(v) => v.iter().map(|x| x.to_bits().into()).collect(),
        ArrayValues::F64(v) => v.iter().map(|x| x.to_bits()).collect(),
        ArrayValues::U64(v) => v.clone(),
        other => super::scalars::to_indices(other).unwrap().iter().map(|&x| x.cast_unsigned()).collect(),
    }
}

/// Fails unless all is the same, bit for bit.
pub(super) fn assert_same(a: &Dataset, b: &Dataset, what: &str) {
    let point_bits =
        |d: &Dataset| -> Vec<[u64; 3]> { d.points.iter().map(|p| p.to_array().map(f64::to_bits)).collect() };
    assert_eq!(point_bits(a), point_bits(b), "{what}: points");
    assert_same_cells(a, b, what);
    for (a, b) in [(&a.point_arrays, &b.point_arrays), (&a.cell_arrays, &b.cell_arrays)] {
        let mut a: Vec<&DataArray> = a.iter().collect();
        let mut b: Vec<&DataArray> = b.iter().collect();
        // The writer puts the active array first in one format and in the order of creation in the other.
        a.sort_by(|x, y| x.name.cmp(&y.name));
        b.sort_by(|x, y| x.name.cmp(&y.name));
        assert_eq!(a.len(), b.len(), "{what}");
        for (a, b) in a.iter().zip(b) {
            assert_eq!((&a.name, a.components), (&b.name, b.components), "{what}");
            assert_eq!(a.values.type_name(), b.values.type_name(), "{what}: {}", a.name);
            assert_eq!(bits(&a.values), bits(&b.values), "{what}: {}", a.name);
        }
    }
}

pub(super) fn assert_same_cells(a: &Dataset, b: &Dataset, what: &str) {
    let (a, b) = (cells(a), cells(b));
    assert_eq!(a.kinds, b.kinds, "{what}: kinds");
    assert_eq!(a.offsets, b.offsets, "{what}: offsets");
    assert_eq!(a.connectivity, b.connectivity, "{what}: connectivity");
    assert_eq!(a.polyhedra, b.polyhedra, "{what}: polyhedra");
}

/// Range of all numbers that are finite, and how many are not.
pub(super) fn finite_range(values: &ArrayValues) -> (f64, f64, usize) {
    let all = values.to_f64();
    let finite: Vec<f64> = all.iter().copied().filter(|x| x.is_finite()).collect();
    let low = finite.iter().copied().fold(f64::INFINITY, f64::min);
    let high = finite.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (low, high, all.len() - finite.len())
}
