//! From the arrays of all pieces of an unstructured grid to one dataset.

use tetrascope_mesh::{Cells, Dataset};

use super::super::DAMAGED;
use super::super::cell_types::POLYHEDRON;
use super::super::cells::CellBuilder;
use super::super::grids::ghosts::leave_out_ghosts;
use super::super::join::Joined;
use super::arrays::{index_array, indices, read_data, read_points};
use super::faces::{FaceArrays, broken_row, row};
use super::file::{Piece, XmlFile};
use super::payload::place;
use super::regular::read_regular;
use crate::{IoError, Source};

/// Decodes all arrays and puts the pieces one behind the other, without ghosts.
pub(super) fn assemble(source: &Source, file: &XmlFile<'_>, warnings: &mut Vec<String>) -> Result<Dataset, IoError> {
    let mut points = Vec::new();
    let mut builder = CellBuilder::new(source);
    let (mut point_arrays, mut cell_arrays) = (Joined::new("point"), Joined::new("cell"));
    for (number, piece) in file.pieces.iter().enumerate() {
        let own = read_points(source, file, piece)?;
        let label = if file.pieces.len() == 1 { "Cells".to_owned() } else { format!("piece {number}, Cells") };
        builder.begin_piece(&label, points.len(), own.len())?;
        if points.is_empty() {
            points = own;
        } else {
            points.extend(own);
        }
        match read_regular(source, file, piece, builder.point_base(), builder.point_count())? {
            Some(cells) => builder.push_all(cells),
            None => read_cells(source, file, piece, &mut builder)?,
        }
        if piece.point_count > 0 {
            let own = read_data(source, file, &piece.point_data, "point", piece.point_count, warnings)?;
            point_arrays.add_piece(own, warnings);
        }
        if piece.cell_count > 0 {
            let own = read_data(source, file, &piece.cell_data, "cell", piece.cell_count, warnings)?;
            cell_arrays.add_piece(own, warnings);
        }
    }
    let cells = Cells::Unstructured(builder.finish(warnings));
    let mut dataset = Dataset { points, cells, point_arrays: point_arrays.arrays, cell_arrays: cell_arrays.arrays };
    leave_out_ghosts(&mut dataset, warnings);
    Ok(dataset)
}

fn read_cells(
    source: &Source,
    file: &XmlFile<'_>,
    piece: &Piece<'_>,
    builder: &mut CellBuilder<'_>,
) -> Result<(), IoError> {
    let required = |name: &str| match indices(source, file, piece, name)? {
        Some(found) => Ok(found),
        None if piece.cell_count == 0 => Ok(Vec::new()),
        None => {
            let problem = format!("the array `{name}` is missing, though {} cells are declared", piece.cell_count);
            Err(source.invalid("element Cells", problem, DAMAGED))
        }
    };
    let connectivity = required("connectivity")?;
    let (ends, types) = (required("offsets")?, required("types")?);
    for (values, name) in [(&ends, "offsets"), (&types, "types")] {
        if u64::try_from(values.len()) != Ok(piece.cell_count) {
            let problem = format!("it has {} values, where {} were expected", values.len(), piece.cell_count);
            // Found only here: counting the lines of the whole file for every piece takes time with the square of their number.
            let place = index_array(piece, name).map_or_else(|| name.to_owned(), |array| place(source, array, name));
            return Err(source.invalid(place, problem, DAMAGED));
        }
    }
    let mut faces = FaceArrays::read(source, file, piece)?;
    for (cell, &kind) in types.iter().enumerate() {
        let points =
            row(&ends, cell, &connectivity).ok_or_else(|| builder.invalid(broken_row("offsets", &ends, cell)))?;
        if kind == POLYHEDRON {
            let own = faces.of_cell(cell).map_err(|problem| builder.invalid(problem))?;
            builder.push_polyhedron(points, &own)?;
        } else {
            builder.push(kind, points)?;
        }
    }
    Ok(())
}
