//! Grids of points in their pieces, which legacy and XML files have in common.

pub(super) mod boxes;
pub(super) mod budget;
pub(super) mod extent;
pub(super) mod ghosts;
pub(super) mod hexahedra;
pub(super) mod merge;

use glam::DVec3;
use tetrascope_mesh::{Cells, DataArray, Dataset};

use crate::grid::RegularGrid;
use budget::Limit;
use extent::Extent;

/// What an image or a rectilinear grid may come to in memory: of an image a whole empty region is a few compressed bytes, so that the
/// segmentation of a scan comes to several hundred bytes a byte of its file.
pub(super) const GRID_LIMIT: Limit = Limit::BytesAByte(1024);

/// One piece of a grid.
#[derive(Debug)]
pub(in crate::vtk) struct GridPiece {
    pub(in crate::vtk) extent: Extent,
    pub(in crate::vtk) geometry: Geometry,
    pub(in crate::vtk) point_arrays: Vec<DataArray>,
    pub(in crate::vtk) cell_arrays: Vec<DataArray>,
    /// One flag a point, or none.
    pub(in crate::vtk) hidden_points: Vec<bool>,
    /// Which cells are marked to be left out: one flag a cell, or none.
    pub(in crate::vtk) left_out_cells: Vec<bool>,
}

/// Where the points of a piece are.
#[derive(Debug)]
pub(in crate::vtk) enum Geometry {
    /// At equal distances; the numbers of the extent say where.
    Image(Lattice),
    /// Coordinates along each direction.
    Rectilinear([Vec<f64>; 3]),
    /// Anywhere.
    Structured(Vec<DVec3>),
}

/// Points at equal distances along three directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::vtk) struct Lattice {
    /// Where point (0, 0, 0) would lie, whether a piece has it or not.
    pub(in crate::vtk) origin: [f64; 3],
    /// Distances along i, j and k.
    pub(in crate::vtk) spacing: [f64; 3],
    /// Row by row a matrix whose columns are the directions of i, j and k.
    pub(in crate::vtk) direction: [f64; 9],
}

impl Default for Lattice {
    fn default() -> Self {
        Self { origin: [0.0; 3], spacing: [1.0; 3], direction: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0] }
    }
}

/// Takes what a grid's points come to from the budget, as if their coordinates were listed. The error says what the limit is.
pub(super) fn spend_points(budget: &budget::Budget, extent: &Extent) -> Result<(), String> {
    budget.spend(extent.point_count().saturating_mul(3), size_of::<f64>())
}

impl Geometry {
    /// All points of the box that it covers, i fastest.
    pub(in crate::vtk) fn points(self, extent: &Extent) -> Vec<DVec3> {
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
                let first = |axis: usize| steps[axis] * extent.low[axis] as f64;
                let origin = DVec3::from(origin) + first(0) + first(1) + first(2);
                RegularGrid { dims: extent.dims, origin, steps }.dataset().points
            }
        }
    }
}

/// Whether two pieces lie on one lattice: to a thousandth of a step, as text rounds.
pub(in crate::vtk) fn is_same_lattice(a: &Lattice, b: &Lattice) -> bool {
    const TOLERANCE: f64 = 1e-3;
    let near = |a: &[f64], b: &[f64], unit: f64| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= TOLERANCE * unit);
    let step = a.spacing.iter().map(|step| step.abs()).fold(f64::INFINITY, f64::min);
    near(&a.origin, &b.origin, step) && near(&a.spacing, &b.spacing, step) && near(&a.direction, &b.direction, 1.0)
}

/// The size of a grid, to be put behind its name; nothing where there is not just one.
pub(super) fn dims_of(dataset: &Dataset) -> String {
    match &dataset.cells {
        Cells::Structured(blocks) if blocks.len() == 1 => {
            let [i, j, k] = blocks[0].dims;
            format!(", {i}x{j}x{k}")
        }
        _ => String::new(),
    }
}
