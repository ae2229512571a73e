//! Cells as VTK's arrays have them.

use std::borrow::Cow;

use tetrascope_mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, StructuredBlock, UnstructuredCells};

use super::super::cell_types::{POLYHEDRON, number_of, number_of_flat};
use super::super::grids::hexahedra::push_hexahedra;
use super::WrittenVtu;
use super::file::Element;
use super::numbers::Numbers;

/// The cells that are written.
pub(super) struct Layout<'a> {
    pub(super) cells: Cow<'a, UnstructuredCells>,
    /// Cells of the dataset, which its arrays have tuples for.
    pub(super) all: usize,
    /// Which of them are written, ascending; `None` where all are.
    pub(super) kept: Option<Vec<usize>>,
}

impl<'a> Layout<'a> {
    /// Of a dataset whose layout was checked. `said` hears what becomes another cell, and what is left out.
    pub(super) fn of(dataset: &'a Dataset, said: &mut WrittenVtu) -> Self {
        let cells = match &dataset.cells {
            Cells::Unstructured(cells) => Cow::Borrowed(cells),
            Cells::Structured(blocks) => Cow::Owned(hexahedra(blocks, said)),
        };
        let all = cells.kinds.len();
        let is_hidden = |cell: usize| type_of(&cells, cell).is_none();
        if !(0..all).any(is_hidden) {
            return Self { cells, all, kept: None };
        }
        let kept: Vec<usize> = (0..all).filter(|&cell| !is_hidden(cell)).collect();
        said.warnings.push(format!(
            "{} of {all} cells are left out: the file that they come from hides them, or they are faces of a kind that VTK does not have",
            all - kept.len()
        ));
        let own = only(&cells, &kept);
        Self { cells: Cow::Owned(own), all, kept: Some(kept) }
    }

    /// The arrays of the element `Cells`.
    pub(super) fn elements(&self, points: usize) -> Vec<Element<'_>> {
        let cells = self.cells.as_ref();
        let entries = cells.connectivity.len();
        let one = |name: &str, numbers| Element { name: name.to_owned(), components: 1, numbers };
        let types = move || {
            let number = |cell| type_of(cells, cell).unwrap_or_default();
            ArrayValues::U8((0..cells.kinds.len()).map(number).collect())
        };
        let mut elements = vec![
            one(
                "connectivity",
                Numbers::of_indices(points, || cells.connectivity.iter().map(|&point| i64::from(point))),
            ),
            one("offsets", Numbers::of_indices(entries, || cells.offsets.iter().skip(1).map(|&end| end as i64))),
            one("types", Numbers::made("UInt8", types)),
        ];
        if !cells.polyhedra.is_empty() {
            let entries: usize = cells.polyhedra.iter().map(|faces| stream_length(faces)).sum();
            // A face may name more points than there are, and a polyhedron have more faces.
            let limit = points.max(entries);
            elements.push(one(
                "faces",
                Numbers::of_indices(limit, || cells.polyhedra.iter().flat_map(|faces| stream(faces))),
            ));
            elements.push(one("faceoffsets", Numbers::of_indices(limit, || face_ends(cells))));
        }
        elements
    }
}

/// VTK's number for a cell; nothing for what is hidden or of no kind.
fn type_of(cells: &UnstructuredCells, cell: usize) -> Option<u8> {
    match cells.kinds.get(cell)? {
        CellKind::Polyhedron => u8::try_from(POLYHEDRON).ok(),
        CellKind::Flat => {
            let (start, end) = (cells.offsets.get(cell)?, cells.offsets.get(cell + 1)?);
            number_of_flat(end - start)
        }
        kind => number_of(*kind),
    }
}

fn hexahedra(blocks: &[StructuredBlock], said: &mut WrittenVtu) -> UnstructuredCells {
    let mut cells = UnstructuredCells::default();
    blocks.iter().for_each(|block| push_hexahedra(&mut cells, block, |_| true));
    if !cells.kinds.is_empty() {
        let grids = if blocks.len() == 1 { "the grid is".to_owned() } else { format!("{} grids are", blocks.len()) };
        said.notes.push(format!(
            "{grids} written as hexahedra that name their points, of which each is cut into 6 tetrahedra, not 5 in a checkerboard"
        ));
    }
    cells
}

/// Some of the cells, over the same points.
fn only(cells: &UnstructuredCells, kept: &[usize]) -> UnstructuredCells {
    let mut own = UnstructuredCells::default();
    let mut polyhedra = cells.polyhedra.iter();
    let mut wanted = kept.iter().peekable();
    for (cell, (kind, ends)) in cells.kinds.iter().zip(cells.offsets.windows(2)).enumerate() {
        let faces = if *kind == CellKind::Polyhedron { polyhedra.next() } else { None };
        if wanted.next_if(|&&next| next == cell).is_none() {
            continue;
        }
        own.kinds.push(*kind);
        own.polyhedra.extend(faces.cloned());
        if let &[start, end] = ends {
            own.connectivity.extend_from_slice(cells.connectivity.get(start..end).unwrap_or_default());
        }
        own.offsets.push(own.connectivity.len());
    }
    own
}

/// The tuples of some cells, of an array whose length was checked.
pub(super) fn gathered(array: &DataArray, cells: &[usize]) -> ArrayValues {
    macro_rules! each {
        ($($kind:ident),*) => {
            match &array.values {
                $(ArrayValues::$kind(numbers) => {
                    let tuple = |&cell: &usize| {
                        numbers.get(cell * array.components..(cell + 1) * array.components).unwrap_or_default()
                    };
                    ArrayValues::$kind(cells.iter().flat_map(tuple).copied().collect())
                })*
            }
        };
    }
    each!(I8, U8, I16, U16, I32, U32, I64, U64, F32, F64)
}

/// Numbers that the faces of a polyhedron take: how many there are, and for each its number of points and the points.
fn stream_length(faces: &[Vec<u32>]) -> usize {
    1 + faces.iter().map(|face| 1 + face.len()).sum::<usize>()
}

fn stream(faces: &[Vec<u32>]) -> impl Iterator<Item = i64> {
    let face = |face: &Vec<u32>| {
        let points: Vec<i64> = face.iter().map(|&point| i64::from(point)).collect();
        std::iter::once(face.len() as i64).chain(points)
    };
    std::iter::once(faces.len() as i64).chain(faces.iter().flat_map(face))
}

/// Where each polyhedron's faces end; -1 for all other cells.
fn face_ends(cells: &UnstructuredCells) -> impl Iterator<Item = i64> {
    let mut polyhedra = cells.polyhedra.iter();
    let mut end = 0;
    cells.kinds.iter().map(move |kind| match (kind, polyhedra.len()) {
        (CellKind::Polyhedron, 1..) => {
            end += polyhedra.next().map_or(0, |faces| stream_length(faces)) as i64;
            end
        }
        _ => -1,
    })
}
