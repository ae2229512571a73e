//! A mesh and a field as the device holds them: whole numbers on a lattice, 16 bytes a point and 20 a cell.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::{TetMesh, VertexId};
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

/// A tetrahedron's vertices by ascending index, and whether its volume is positive in that order.
fn ascending(mut vertices: [u32; 4]) -> ([u32; 4], bool) {
    let mut is_positive = true;
    for end in (1..4).rev() {
        for i in 0..end {
            if vertices[i] > vertices[i + 1] {
                vertices.swap(i, i + 1);
                is_positive = !is_positive;
            }
        }
    }
    (vertices, is_positive)
}

/// Lowest and highest scalar that a cell uses; both 0 without cells.
fn scalar_range(tetrahedra: &[[VertexId; 4]], scalars: &[f64]) -> [f64; 2] {
    let (low, high) = tetrahedra
        .par_iter()
        .map(|cell| cell.map(|vertex| scalars[vertex.index()]))
        .map(|s| s.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &s| (low.min(s), high.max(s))))
        .reduce(|| (f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    if low <= high { [low, high] } else { [0.0; 2] }
}

/// The power of two that brings the range of a field to between 1 and 2; 1 for a field of one value.
fn scalar_factor([low, high]: [f64; 2]) -> f64 {
    // Halves, whose difference is finite.
    let half = 0.5 * high - 0.5 * low;
    if half > 0.0 {
        // Within what has a finite inverse.
        (-half.log2().floor() - 1.0).clamp(-1000.0, 1000.0).exp2()
    } else {
        1.0
    }
}

/// The positions of points that a lattice stands for, local units.
#[cfg(test)]
pub(crate) fn positions(lattice: &Lattice) -> Vec<DVec3> {
    lattice.vertices.iter().map(|v| DVec3::new(v[0].into(), v[1].into(), v[2].into()) * LATTICE_STEP).collect()
}
