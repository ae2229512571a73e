//! What renderers make of a mesh and a field before anything else; all of them alike, so that their pictures agree.

use rayon::prelude::*;

use crate::VertexId;

/// A tetrahedron's vertices by ascending index, and whether its volume in that order has the sign that it had.
pub fn ascending(mut vertices: [u32; 4]) -> ([u32; 4], bool) {
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
///
/// - `scalars`: one a point
///
/// # Panics
/// If a cell has a point without a scalar.
pub fn scalar_range(tetrahedra: &[[VertexId; 4]], scalars: &[f64]) -> [f64; 2] {
    let (low, high) = tetrahedra
        .par_iter()
        .map(|cell| cell.map(|v| scalars[v.index()]))
        .map(|s| s.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &s| (low.min(s), high.max(s))))
        .reduce(|| (f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    if low <= high { [low, high] } else { [0.0; 2] }
}

/// What renderers in floats subtract from the scalars of a field whose values are large against their differences, lowest and highest given: of 1e9 and
/// 1e9 + 1e-3 a sum has lost what a difference keeps. 0 for all other fields.
///
/// Exact: of two numbers of which one is at most twice the other the difference is a float [Sterbenz 1974].
pub fn scalar_base([low, high]: [f64; 2]) -> f64 {
    let (near, far) = if low.abs() <= high.abs() { (low, high) } else { (high, low) };
    if near != 0.0 && far / near >= 1.0 && far / near <= 2.0 { near } else { 0.0 }
}

/// The power of two that brings the range of a field, lowest and highest, to between 1 and 2, so that what f32 sees of it neither over- nor
/// underflows, whatever its unit; 1 for a field of one value. Being a power of two it changes no digit.
pub fn scalar_factor([low, high]: [f64; 2]) -> f64 {
    // Halves, whose difference is finite.
    let half = 0.5 * high - 0.5 * low;
    if half > 0.0 {
        // Within what has a finite inverse.
        (-half.log2().floor() - 1.0).clamp(-1022.0, 1022.0).exp2()
    } else {
        1.0
    }
}
