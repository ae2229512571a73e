//! The pieces of image data, rectilinear and structured grids: decoded here, put together in `merge`.

use glam::DVec3;
use tetrascope_mesh::DataArray;

use super::super::DAMAGED;
use super::Kind;
use super::arrays::{read_coordinates, read_data, read_points};
use super::extent::Extent;
use super::file::{Lattice, Piece, XmlFile};
use super::ghosts::{hidden_points, left_out_cells};
use crate::{IoError, Source};

/// Numbers that a point takes.
const NUMBERS_A_POINT: usize = 3;

/// One piece of a grid.
#[derive(Debug)]
pub(super) struct GridPiece {
    pub(super) extent: Extent,
    pub(super) geometry: Geometry,
    pub(super) point_arrays: Vec<DataArray>,
    pub(super) cell_arrays: Vec<DataArray>,
    /// One flag a point, or none.
    pub(super) hidden_points: Vec<bool>,
    /// Which cells are marked to be left out: one flag a cell, or none.
    pub(super) left_out_cells: Vec<bool>,
}

/// Where the points of a piece are.
#[derive(Debug)]
pub(super) enum Geometry {
    /// At equal distances; the numbers of the extent say where.
    Image(Lattice),
    /// Coordinates along each direction.
    Rectilinear([Vec<f64>; 3]),
    /// Anywhere.
    Structured(Vec<DVec3>),
}

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
        let numbers = extent.point_count().saturating_mul(NUMBERS_A_POINT);
        let [i, j, k] = extent.dims;
        file.budget
            .spend(numbers)
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

impl Geometry {
    /// All points of a box, i fastest.
    ///
    /// - `at`: where the box begins in what this geometry covers, which is `extent`
    pub(super) fn points(self, extent: &Extent) -> Vec<DVec3> {
        let [ni, nj, nk] = extent.dims;
        match self {
            Self::Structured(points) => points,
            Self::Rectilinear([x, y, z]) => {
                let mut points = Vec::with_capacity(extent.point_count());
                for z in z {
                    for &y in &y {
                        points.extend(x.iter().map(|&x| DVec3::new(x, y, z)));
                    }
                }
                points
            }
            Self::Image(lattice) => {
                let Lattice { origin, spacing, direction: d } = lattice;
                let columns = [[d[0], d[3], d[6]], [d[1], d[4], d[7]], [d[2], d[5], d[8]]];
                let steps = [0, 1, 2].map(|axis| DVec3::from(columns[axis]) * spacing[axis]);
                let along = |axis: usize, place: usize| steps[axis] * (extent.low[axis] + place as i64) as f64;
                let mut points = Vec::with_capacity(extent.point_count());
                for k in 0..nk {
                    for j in 0..nj {
                        let row = DVec3::from(origin) + along(2, k) + along(1, j);
                        points.extend((0..ni).map(|i| row + along(0, i)));
                    }
                }
                points
            }
        }
    }
}

/// Whether two pieces lie on one lattice: to a thousandth of a step, as text rounds.
pub(super) fn is_same_lattice(a: &Lattice, b: &Lattice) -> bool {
    const TOLERANCE: f64 = 1e-3;
    let near = |a: &[f64], b: &[f64], unit: f64| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= TOLERANCE * unit);
    let step = a.spacing.iter().map(|step| step.abs()).fold(f64::INFINITY, f64::min);
    near(&a.origin, &b.origin, step) && near(&a.spacing, &b.spacing, step) && near(&a.direction, &b.direction, 1.0)
}
