//! The sections of an unstructured grid, in any order.

use glam::DVec3;
use tetrascope_mesh::{Cells, DataArray, Dataset, UnstructuredCells};

use super::super::DAMAGED;
use super::super::cell_types::POLYHEDRON;
use super::super::cells::{CellBuilder, read_face_stream};
use super::super::named::NamedArrays;
use super::super::scalars::{ScalarType, to_indices};
use super::attributes;
use super::lexer::{LegacyType, Lexer};
use crate::IoError;

/// What the sections give.
pub(super) struct Grid {
    pub(super) dataset: Dataset,
    pub(super) is_binary: bool,
    pub(super) warnings: Vec<String>,
}

/// The arrays that follow one POINT_DATA or CELL_DATA line.
pub(super) struct Attributes {
    /// "point" or "cell".
    pub(super) owner: &'static str,
    /// Tuples an array as the line declares them; nothing before the line was met.
    pub(super) declared: Option<usize>,
    pub(super) arrays: NamedArrays,
}

/// The CELLS section as rows.
struct Rows {
    /// One more than there are cells.
    offsets: Vec<i64>,
    values: Vec<i64>,
}

/// Reads all sections up to the file's end.
pub(super) fn read(mut lexer: Lexer<'_>) -> Result<Grid, IoError> {
    let mut warnings = Vec::new();
    let mut points: Option<Vec<DVec3>> = None;
    let mut rows: Option<Rows> = None;
    let mut types: Option<Vec<i64>> = None;
    let mut of_points = Attributes { owner: "point", declared: None, arrays: NamedArrays::default() };
    let mut of_cells = Attributes { owner: "cell", declared: None, arrays: NamedArrays::default() };
    // Which of the two the next array belongs to; fields before either belong to the file as a whole.
    let mut in_cells: Option<bool> = None;
    while !lexer.is_at_end() {
        let keyword = lexer.keyword("a section")?;
        match keyword.as_str() {
            "POINTS" => points = Some(read_points(&mut lexer)?),
            "CELLS" => rows = Some(read_rows(&mut lexer)?),
            "CELL_TYPES" => types = Some(read_types(&mut lexer)?),
            "METADATA" => attributes::skip_metadata(&mut lexer),
            "POINT_DATA" | "CELL_DATA" => {
                let is_cells = keyword == "CELL_DATA";
                let target = if is_cells { &mut of_cells } else { &mut of_points };
                let count = lexer.count(&keyword)?;
                lexer.line();
                if target.declared.is_some_and(|before| before != count) {
                    return Err(lexer.invalid(format!("{keyword} is given twice, with different counts")));
                }
                target.declared = Some(count);
                in_cells = Some(is_cells);
            }
            other => {
                let target = match in_cells {
                    None => None,
                    Some(false) => Some(&mut of_points),
                    Some(true) => Some(&mut of_cells),
                };
                attributes::read(&mut lexer, other, target, &mut warnings)?;
            }
        }
    }
    let Some(points) = points else { return Err(lexer.invalid("the file ends without a POINTS section")) };
    let cells = build_cells(&lexer, points.len(), rows, types, &mut warnings)?;
    let point_arrays = checked(&lexer, of_points, points.len())?;
    let cell_arrays = checked(&lexer, of_cells, cells.kinds.len())?;
    let dataset = Dataset { points, cells: Cells::Unstructured(cells), point_arrays, cell_arrays };
    Ok(Grid { dataset, is_binary: lexer.is_binary, warnings })
}

fn checked(lexer: &Lexer<'_>, attributes: Attributes, there: usize) -> Result<Vec<DataArray>, IoError> {
    let Attributes { owner, declared, arrays } = attributes;
    let arrays = arrays.into_arrays();
    match declared {
        // A section without arrays says nothing, so its count does no harm.
        Some(count) if count != there && !arrays.is_empty() => Err(lexer.source.invalid(
            format!("{owner} array `{}`", arrays[0].name),
            format!("it has {count} tuples, where {there} were expected (one a {owner})"),
            DAMAGED,
        )),
        _ => Ok(arrays),
    }
}

fn read_points(lexer: &mut Lexer<'_>) -> Result<Vec<DVec3>, IoError> {
    let count = lexer.count("the number of points")?;
    let Some(kind) = lexer.scalar_type()? else { return Err(lexer.invalid("points cannot be text")) };
    lexer.line();
    let numbers = count.checked_mul(3).ok_or_else(|| lexer.invalid(format!("POINTS declares {count} points")))?;
    let flat = lexer.numbers(kind, numbers, "POINTS")?.to_f64();
    Ok(flat.as_chunks::<3>().0.iter().map(|&triple| DVec3::from_array(triple)).collect())
}

fn read_indices(lexer: &mut Lexer<'_>, kind: LegacyType, count: usize, what: &str) -> Result<Vec<i64>, IoError> {
    let values = lexer.numbers(kind, count, what)?;
    to_indices(&values).ok_or_else(|| lexer.invalid(format!("{what} cannot be of the type {}", values.type_name())))
}

/// Reads CELLS in either form. Up to 4.2: the number of cells, the number of integers, then each cell's number of points
/// and its points. From 5.0: the number of offsets (one more than cells), the number of points, then two arrays.
fn read_rows(lexer: &mut Lexer<'_>) -> Result<Rows, IoError> {
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

fn read_types(lexer: &mut Lexer<'_>) -> Result<Vec<i64>, IoError> {
    let count = lexer.count("the number of cell types")?;
    lexer.line();
    read_indices(lexer, LegacyType::Plain(ScalarType::I32), count, "CELL_TYPES")
}

fn build_cells(
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
