//! Cells as nearly all meshes have them: rows that follow each other, with as many points as their kinds have, and no polyhedra.
//!
//! Their arrays go straight from the file into the mesh. All else is left to the way that looks at each cell and can say what is wrong.

use tetrascope_mesh::{CellKind, UnstructuredCells};

use super::super::cell_types::{kind_of, number_of_flat, point_count_of};
use super::arrays::{index_array, wanted_indices};
use super::file::{Piece, XmlFile};
use crate::{IoError, Source};

/// Arrays that polyhedra need; where one is there, cells are looked at one by one.
const OF_FACES: [&str; 6] =
    ["faces", "faceoffsets", "face_connectivity", "face_offsets", "polyhedron_to_faces", "polyhedron_offsets"];

/// Reads the cells of a piece; nothing where there is anything about them to look at, and then nothing is counted against the budget.
///
/// - `point_base`: the points of pieces before
///
/// # Errors
/// As of the arrays, in the order connectivity, offsets, types.
pub(super) fn read_regular(
    source: &Source,
    file: &XmlFile<'_>,
    piece: &Piece<'_>,
    point_base: u32,
    point_count: u32,
) -> Result<Option<UnstructuredCells>, IoError> {
    if OF_FACES.iter().any(|name| index_array(piece, name).is_some()) {
        return Ok(None);
    }
    let spent = file.budget.spent();
    let cells = read(source, file, piece, point_base, point_count)?;
    let mut cells = cells.filter(|cells| is_regular(cells, piece.cell_count));
    match &mut cells {
        Some(cells) => name_plain_faces(cells),
        None => file.budget.restore(spent),
    }
    Ok(cells)
}

fn read(
    source: &Source,
    file: &XmlFile<'_>,
    piece: &Piece<'_>,
    point_base: u32,
    point_count: u32,
) -> Result<Option<UnstructuredCells>, IoError> {
    let wanted = |name| wanted_indices(source, file, piece, name);
    let mut cells = UnstructuredCells::default();
    let Some(connectivity) = wanted("connectivity")? else { return Ok(None) };
    let point = |index: i64| {
        let index = u32::try_from(index).ok().filter(|&index| index < point_count)?;
        point_base.checked_add(index)
    };
    if !connectivity.turn_indices(&mut cells.connectivity, 0, point)? {
        return Ok(None);
    }
    let Some(ends) = wanted("offsets")? else { return Ok(None) };
    if !ends.turn_indices(&mut cells.offsets, 0, |end| usize::try_from(end).ok())? {
        return Ok(None);
    }
    let Some(types) = wanted("types")? else { return Ok(None) };
    let kind = |number: i64| {
        let kind = kind_of(number)?;
        // Which of them are plain their points will tell.
        let of = u8::try_from(number).ok().filter(|&number| kind == CellKind::Flat && number > 0);
        Some(of.map_or(kind, CellKind::FlatOf))
    };
    if !types.turn_indices(&mut cells.kinds, CellKind::Flat, kind)? {
        return Ok(None);
    }
    Ok(Some(cells))
}

/// Points, lines and faces whose number of points says their kind keep no number besides.
fn name_plain_faces(cells: &mut UnstructuredCells) {
    let counts = cells.offsets.windows(2).map(|row| row[1] - row[0]);
    for (kind, count) in cells.kinds.iter_mut().zip(counts) {
        if let CellKind::FlatOf(number) = *kind
            && number_of_flat(count) == Some(number)
        {
            *kind = CellKind::Flat;
        }
    }
}

fn is_regular(cells: &UnstructuredCells, declared: u64) -> bool {
    u64::try_from(cells.kinds.len()) == Ok(declared)
        && cells.offsets.len() == cells.kinds.len() + 1
        && cells.offsets.last() == Some(&cells.connectivity.len())
        && cells.offsets.iter().zip(&cells.offsets[1..]).zip(&cells.kinds).all(|((start, end), &kind)| {
            end.checked_sub(*start).is_some_and(|count| point_count_of(kind).is_none_or(|needed| needed == count))
                && kind != CellKind::Polyhedron
        })
}
