//! A mesh and a field as the device holds them: whole numbers on a lattice, 16 bytes a point and 20 a cell.

use rayon::prelude::*;
use tetrascope_mesh::{TetMesh, ascending, scalar_factor, scalar_range};
use tetrascope_shaders::layout::{LATTICE_STEP, NEGATIVE_BIT};

/// Lattice steps of one step of a cell's range of scalars, as a power of two.
const RANGE_BITS: u32 = 14;
/// The scalar of a range's step 0, lattice steps.
const RANGE_START: i32 = -(1 << 29);

/// A mesh and its field on the lattice.
///
/// Rounding moves a point by up to half a step along each axis, 1e-9 of the mesh's size, and a scalar by as much of the range.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// For every point its position in lattice steps of the mesh's local unit, and its scalar in those of the renderer's unit, about the
    /// range's middle. 0 where a point that no cell uses is not finite.
    pub(crate) vertices: Vec<[i32; 4]>,
    /// For every cell its vertices in ascending order; [`NEGATIVE_BIT`] in the last if the volume is negative in that order.
    pub(crate) cells: Vec<[u32; 4]>,
    /// For every cell its lowest (low half) and highest scalar, rounded outward, see [`decompress`].
    pub(crate) ranges: Vec<u32>,
    /// Scalars of the field times this are in the renderer's unit; a power of two.
    pub(crate) scalar_factor: f64,
    /// The middle of the range of scalars, renderer's unit.
    pub(crate) scalar_middle: f64,
    /// Lowest and highest scalar, renderer's unit.
    pub(crate) scalar_range: [f64; 2],
    /// Cells that have no volume left on the lattice: they draw nothing.
    pub(crate) collapsed: usize,
}

impl Lattice {
    /// Rounds a mesh and a field onto the lattice.
    ///
    /// - `scalars`: one a point of the mesh, finite where a cell uses it
    pub(crate) fn new(mesh: &TetMesh, scalars: &[f64]) -> Self {
        let range = scalar_range(mesh.tetrahedra(), scalars);
        let scalar_factor = scalar_factor(range);
        let scalar_range = range.map(|scalar| scalar * scalar_factor);
        let scalar_middle = 0.5 * scalar_range[0] + 0.5 * scalar_range[1];
        let vertices: Vec<[i32; 4]> = mesh
            .positions()
            .par_iter()
            .zip(scalars)
            .map(|(position, scalar)| {
                let [x, y, z] = position.to_array().map(to_steps);
                [x, y, z, to_steps(scalar * scalar_factor - scalar_middle)]
            })
            .collect();
        let cells: Vec<[u32; 4]> = mesh
            .tetrahedra()
            .par_iter()
            .map(|cell| {
                let ([a, b, c, d], is_positive) = ascending(cell.map(|vertex| vertex.0));
                [a, b, c, if is_positive { d } else { d | NEGATIVE_BIT }]
            })
            .collect();
        let corners = |cell: &[u32; 4]| bare(cell).map(|vertex| vertices[vertex as usize]);
        let ranges = cells.par_iter().map(|cell| compress(corners(cell).map(|corner| corner[3]))).collect();
        let collapsed = cells.par_iter().filter(|cell| six_volume(corners(cell)) == 0).count();
        Self { vertices, cells, ranges, scalar_factor, scalar_middle, scalar_range, collapsed }
    }
}

/// A cell's vertices without the bit.
pub(crate) fn bare([a, b, c, d]: &[u32; 4]) -> [u32; 4] {
    [*a, *b, *c, *d & !NEGATIVE_BIT]
}

/// The nearest lattice step; 0 for what is not finite.
fn to_steps(value: f64) -> i32 {
    // A cast saturates, and makes 0 of NaN.
    if value.is_finite() { (value / LATTICE_STEP).round() as i32 } else { 0 }
}

/// Lowest and highest of a cell's scalars (lattice steps) in one word.
fn compress(scalars: [i32; 4]) -> u32 {
    let [low, high] = scalars.iter().fold([i64::MAX, i64::MIN], |[low, high], &scalar| {
        let scalar = i64::from(scalar) - i64::from(RANGE_START);
        [low.min(scalar), high.max(scalar)]
    });
    // Downward, and upward.
    let low = (low >> RANGE_BITS).clamp(0, 0xffff);
    let high = (-(-high >> RANGE_BITS)).clamp(0, 0xffff);
    low as u32 | (high as u32) << 16
}

/// The lowest and the highest scalar that a cell with this word may have, lattice steps: the inverse of what [`Lattice::ranges`] holds.
#[cfg(test)]
pub(crate) fn decompress(range: u32) -> [i32; 2] {
    [range & 0xffff, range >> 16].map(|value| ((value as i32) << RANGE_BITS) + RANGE_START)
}

/// Six times a cell's volume, lattice steps cubed. Exact.
fn six_volume([a, b, c, d]: [[i32; 4]; 4]) -> i128 {
    let edge = |to: [i32; 4]| [0, 1, 2].map(|axis| i128::from(to[axis]) - i128::from(a[axis]));
    let (p, q, r) = (edge(b), edge(c), edge(d));
    let cross = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    cross[0] * r[0] + cross[1] * r[1] + cross[2] * r[2]
}
