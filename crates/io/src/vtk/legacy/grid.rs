//! The sections of a dataset, in any order.

use glam::DVec3;
use tetrascope_mesh::{Cells, DataArray, Dataset};

use super::super::DAMAGED;
use super::super::grids::ghosts::leave_out_ghosts;
use super::super::named::NamedArrays;
use super::super::xml::Kind;
use super::attributes;
use super::cells::{Rows, build_cells, read_rows, read_types};
use super::lexer::Lexer;
use super::structured::{Lines, build_grid};
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

/// Reads all sections up to the file's end.
pub(super) fn read(mut lexer: Lexer<'_>, kind: Kind) -> Result<Grid, IoError> {
    let mut warnings = Vec::new();
    let mut points: Option<Vec<DVec3>> = None;
    let mut rows: Option<Rows> = None;
    let mut types: Option<Vec<i64>> = None;
    let mut lines = Lines::default();
    let mut of_points = Attributes { owner: "point", declared: None, arrays: NamedArrays::default() };
    let mut of_cells = Attributes { owner: "cell", declared: None, arrays: NamedArrays::default() };
    // Which of the two the next array belongs to; fields before either belong to the file as a whole.
    let mut in_cells: Option<bool> = None;
    let is_unstructured = kind == Kind::Unstructured;
    while !lexer.is_at_end() {
        let keyword = lexer.keyword("a section")?;
        match keyword.as_str() {
            "POINTS" if is_unstructured || kind == Kind::Structured => points = Some(read_points(&mut lexer)?),
            "CELLS" if is_unstructured => rows = Some(read_rows(&mut lexer)?),
            "CELL_TYPES" if is_unstructured => types = Some(read_types(&mut lexer)?),
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
            other if !is_unstructured && lines.read(&mut lexer, other)? => {}
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
    let is_binary = lexer.is_binary;
    if !is_unstructured {
        let extent = lines.extent(&lexer)?;
        let point_arrays = checked(&lexer, of_points, extent.point_count())?;
        let cell_arrays = checked(&lexer, of_cells, extent.cell_count())?;
        let dataset = build_grid(&lexer, kind, lines, points, (point_arrays, cell_arrays), &mut warnings)?;
        return Ok(Grid { dataset, is_binary, warnings });
    }
    let Some(points) = points else { return Err(lexer.invalid("the file ends without a POINTS section")) };
    let cells = build_cells(&lexer, points.len(), rows, types, &mut warnings)?;
    let point_arrays = checked(&lexer, of_points, points.len())?;
    let cell_arrays = checked(&lexer, of_cells, cells.kinds.len())?;
    let mut dataset = Dataset { points, cells: Cells::Unstructured(cells), point_arrays, cell_arrays };
    leave_out_ghosts(&mut dataset, &mut warnings);
    Ok(Grid { dataset, is_binary, warnings })
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
