//! The cells of an unstructured grid: CELLS and CELL_TYPES.

use tetrascope_mesh::UnstructuredCells;

use super::super::DAMAGED;
use super::super::cell_types::POLYHEDRON;
use super::super::cells::{CellBuilder, read_face_stream};
use super::super::scalars::{ScalarType, to_indices};
use super::lexer::{LegacyType, Lexer};
use crate::IoError;

/// The CELLS section as rows.
pub(super) struct Rows {
    /// One more than there are cells.
    offsets: Vec<i64>,
    values: Vec<i64>,
}

fn read_indices(lexer: &mut Lexer<'_>, kind: LegacyType, count: usize, what: &str) -> Result<Vec<i64>, IoError> {
    let values = lexer.numbers(kind, count, what)?;
    to_indices(&values).ok_or_else(|| lexer.invalid(format!("{what} cannot be of the type {}", values.type_name())))
}

/// Reads CELLS in either form. Up to 4.2: the number of cells, the number of integers, then each cell's number of points
/// and its points. From 5.0: the number of offsets (one more than cells), the number of points, then two arrays.
pub(super) fn read_rows(lexer: &mut Lexer<'_>) -> Result<Rows, IoError> {
    const INT: LegacyType = LegacyType::Plain(ScalarType::I32);
    let count = lexer.count("the number of cells")?;
    let size = lexer.count("the size of CELLS")?;
    lexer.line();
    if lexer.accept("OFFSETS") {
        let array = |lexer: &mut Lexer<'_>, count: usize, what: &str| {
            let Some(kind) = lexer.scalar_type()? else { return Err(lexer.invalid(format!("{what} cannot be text"))) };
            lexer.line();
            read_indices(lexer, kind, count, what)
        };
        let offsets = array(lexer, count, "OFFSETS")?;
        if !lexer.accept("CONNECTIVITY") {
            return Err(lexer.invalid("CONNECTIVITY does not follow OFFSETS"));
        }
        let values = array(lexer, size, "CONNECTIVITY")?;
        return Ok(Rows { offsets, values });
    }
    let flat = read_indices(lexer, INT, size, "CELLS")?;
    let mut rows = Rows { offsets: vec![0], values: Vec::with_capacity(flat.len()) };
    let mut at = 0;
    for cell in 0..count {
        let row = flat.get(at).and_then(|&n| {
            let start = at + 1;
            flat.get(start..start.checked_add(usize::try_from(n).ok()?)?)
        });
        let Some(row) = row else {
            let found = flat.get(at).map_or_else(|| "nothing is left".to_owned(), |n| format!("its count is {n}"));
            let problem = format!("{found}, with {} of {size} integers left", flat.len().saturating_sub(at));
            return Err(lexer.source.invalid(format!("CELLS, cell {cell}"), problem, DAMAGED));
        };
        rows.values.extend_from_slice(row);
        rows.offsets.push(i64::try_from(rows.values.len()).unwrap_or(i64::MAX));
        at += 1 + row.len();
    }
    Ok(rows)
}

/// Reads CELL_TYPES.
pub(super) fn read_types(lexer: &mut Lexer<'_>) -> Result<Vec<i64>, IoError> {
    let count = lexer.count("the number of cell types")?;
    lexer.line();
    read_indices(lexer, LegacyType::Plain(ScalarType::I32), count, "CELL_TYPES")
}

/// The cells that both sections make.
pub(super) fn build_cells(
    lexer: &Lexer<'_>,
    point_count: usize,
    rows: Option<Rows>,
    types: Option<Vec<i64>>,
    warnings: &mut Vec<String>,
) -> Result<UnstructuredCells, IoError> {
    let rows = rows.unwrap_or(Rows { offsets: Vec::new(), values: Vec::new() });
    let types = types.unwrap_or_default();
    let count = rows.offsets.len().saturating_sub(1);
    if types.len() != count {
        let problem = format!("it has {} types, where {count} were expected (one a cell)", types.len());
        return Err(lexer.source.invalid("CELL_TYPES", problem, DAMAGED));
    }
    let mut builder = CellBuilder::new(lexer.source);
    builder.begin_piece("CELLS", 0, point_count)?;
    for (ends, &kind) in rows.offsets.windows(2).zip(&types) {
        let row = usize::try_from(ends[0]).ok().zip(usize::try_from(ends[1]).ok());
        let Some(row) = row.and_then(|(start, end)| rows.values.get(start..end)) else {
            return Err(builder.invalid(format!(
                "its offsets go from {} to {}, which falls or is outside the {} values of CONNECTIVITY",
                ends[0],
                ends[1],
                rows.values.len()
            )));
        };
        if kind == POLYHEDRON {
            // A polyhedron's row is its face stream.
            let (faces, used) = read_face_stream(row).map_err(|problem| builder.invalid(problem))?;
            if used != row.len() {
                return Err(builder.invalid(format!("its faces take {used} of the {} integers of its row", row.len())));
            }
            builder.push_polyhedron(&[], &faces)?;
        } else {
            builder.push(kind, row)?;
        }
    }
    Ok(builder.finish(warnings))
}
