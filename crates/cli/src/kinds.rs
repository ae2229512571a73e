//! The kinds of cells of a mesh, counted, under names for people.

use std::collections::BTreeMap;

use tetrascope::{CellKind, Cells, Dataset, StructuredBlock};

/// How many cells there are of each kind; those of grids are hexahedra, and all flat ones are one kind.
pub(crate) fn kinds(dataset: &Dataset) -> BTreeMap<CellKind, usize> {
    let mut kinds = BTreeMap::new();
    match &dataset.cells {
        Cells::Unstructured(cells) => {
            for &kind in &cells.kinds {
                *kinds.entry(if kind.is_flat() { CellKind::Flat } else { kind }).or_default() += 1;
            }
        }
        Cells::Structured(blocks) => {
            let count: usize = blocks.iter().map(StructuredBlock::cell_count).sum();
            if count > 0 {
                kinds.insert(CellKind::Hexahedron, count);
            }
        }
    }
    kinds
}

/// `QuadraticTetrahedron` as "quadratic tetrahedron".
pub(crate) fn name_of(kind: CellKind) -> String {
    match kind {
        CellKind::Flat | CellKind::FlatOf(_) => "point, line or face".to_owned(),
        CellKind::Other(number) => format!("VTK type {number}"),
        named => {
            let mut words = String::new();
            for letter in format!("{named:?}").chars() {
                if letter.is_uppercase() && !words.is_empty() {
                    words.push(' ');
                }
                words.extend(letter.to_lowercase());
            }
            words
        }
    }
}
