//! The pieces of image data, rectilinear and structured grids: decoded here, put together in `grids`.

use super::super::DAMAGED;
use super::super::grids::extent::Extent;
use super::super::grids::ghosts::{hidden_points, left_out_cells};
use super::super::grids::{Geometry, GridPiece, spend_points};
use super::Kind;
use super::arrays::{read_coordinates, read_data, read_points};
use super::file::{Piece, XmlFile};
use crate::{IoError, Source};

/// Decodes all pieces of a file that have points.
pub(super) fn read_pieces(
    source: &Source,
    file: &XmlFile<'_>,
    warnings: &mut Vec<String>,
) -> Result<Vec<GridPiece>, IoError> {
    let mut pieces = Vec::new();
    for piece in &file.pieces {
        let Some(extent) = piece.extent.filter(|extent| !extent.is_empty()) else { continue };
        let geometry = read_geometry(source, file, piece, &extent)?;
        let mut point_arrays = read_data(source, file, &piece.point_data, "point", piece.point_count, warnings)?;
        let mut cell_arrays = read_data(source, file, &piece.cell_data, "cell", piece.cell_count, warnings)?;
        let hidden_points = hidden_points(&mut point_arrays);
        let left_out_cells = left_out_cells(&mut cell_arrays);
        pieces.push(GridPiece { extent, geometry, point_arrays, cell_arrays, hidden_points, left_out_cells });
    }
    Ok(pieces)
}

fn read_geometry(source: &Source, file: &XmlFile<'_>, piece: &Piece<'_>, extent: &Extent) -> Result<Geometry, IoError> {
    // Points that no number of the file stands for cost as much as those that it lists.
    let spend = || {
        let [i, j, k] = extent.dims;
        spend_points(file.budget, extent)
            .map_err(|problem| source.invalid(format!("the grid of {i} x {j} x {k} points"), problem, DAMAGED))
    };
    Ok(match file.kind {
        Kind::Image => {
            spend()?;
            Geometry::Image(file.lattice)
        }
        Kind::Rectilinear => {
            let along = |axis: usize| read_coordinates(source, file, piece, axis, extent.dims[axis]);
            let coordinates = [along(0)?, along(1)?, along(2)?];
            spend()?;
            Geometry::Rectilinear(coordinates)
        }
        Kind::Structured | Kind::Unstructured => Geometry::Structured(read_points(source, file, piece)?),
    })
}
