//! Interior faces as linear inequalities in the heights of five points.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};

use crate::Cells;

/// One interior face: the lift is strictly convex across it where `weights · heights` is positive.
///
/// The points are the three of the face and the two opposite corners. The weights are an affine dependency of the five
/// (they sum to zero, and so do the weighted positions), positive for the two corners; what a linear function adds to the
/// heights changes nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct LiftedFace {
    pub(super) points: [u32; 5],
    pub(super) weights: [f64; 5],
}

impl LiftedFace {
    /// How far above the one cell's affine function the other cell's corner lies, in the row's own scale.
    #[inline]
    pub(super) fn convexity(&self, heights: &[f64]) -> f64 {
        self.points.iter().zip(self.weights).map(|(&point, weight)| heights[point as usize] * weight).sum()
    }
}

/// All interior faces of a mesh.
#[derive(Debug)]
pub(super) struct LiftedMesh {
    /// Faces between two cells of positive volume that lie on different sides.
    pub(super) faces: Vec<LiftedFace>,
    /// Shortest edge squared at each point: the natural unit of a height there; the mean at points of no cell.
    pub(super) scales: Vec<f64>,
}

/// Of every cell, its faces shared with a cell of higher index, as points: the three of the face, the first cell's corner, the second's.
pub(super) fn face_pairs<'a>(
    cells: Cells<'a>,
    adjacency: &'a FaceAdjacency,
) -> impl IndexedParallelIterator<Item = impl Iterator<Item = [VertexId; 5]>> {
    cells.tetrahedra.par_iter().enumerate().map(move |(cell, &points)| {
        (0..4).filter_map(move |corner| {
            let other = adjacency.neighbor(CellId(cell as u32), corner)?;
            if other.index() <= cell {
                return None;
            }
            let face = [1, 2, 3].map(|k| points[(corner + k) % 4]);
            // The same four points again: a pair that folds onto itself.
            let apex =
                cells.tetrahedra[other.index()].into_iter().find(|p| !face.contains(p)).unwrap_or(points[corner]);
            Some([face[0], face[1], face[2], points[corner], apex])
        })
    })
}

impl LiftedMesh {
    pub(super) fn new(cells: Cells<'_>, adjacency: &FaceAdjacency) -> Self {
        let row = |points: [VertexId; 5]| {
            let weights = affine_dependency(points.map(|p| cells.positions[p.index()]))?;
            Some(LiftedFace { points: points.map(|p| p.0), weights })
        };
        let chunks: Vec<Vec<LiftedFace>> = face_pairs(cells, adjacency)
            .fold(Vec::new, |mut rows, pairs| {
                rows.extend(pairs.filter_map(row));
                rows
            })
            .collect();
        Self { faces: chunks.concat(), scales: shortest_edges_squared(cells) }
    }

    /// The faces for heights that are divided by `scales` (one a point), each with weights of length 1.
    pub(super) fn in_units_of(&self, scales: &[f64]) -> Vec<LiftedFace> {
        self.faces
            .par_iter()
            .map(|face| {
                let scaled: [f64; 5] = std::array::from_fn(|k| face.weights[k] * scales[face.points[k] as usize]);
                let length = scaled.iter().map(|w| w * w).sum::<f64>().sqrt();
                LiftedFace { points: face.points, weights: scaled.map(|w| w / length) }
            })
            .collect()
    }
}

/// Weights of five points as [`LiftedFace`] has them, or `None` if the two corners do not lie strictly on two sides.
fn affine_dependency(points: [DVec3; 5]) -> Option<[f64; 5]> {
    let e = points[4];
    let [a, b, c, d] = [points[0], points[1], points[2], points[3]].map(|p| p - e);
    let det = |u: DVec3, v: DVec3, w: DVec3| u.dot(v.cross(w));
    // Cramer's rule for four vectors in space; the fifth weight makes the sum zero.
    let w = [det(b, c, d), -det(a, c, d), det(a, b, d), -det(a, b, c)];
    let sign = w[3].signum();
    let weights = [w[0] * sign, w[1] * sign, w[2] * sign, w[3] * sign, -(w[0] + w[1] + w[2] + w[3]) * sign];
    (weights[3] > 0.0 && weights[4] > 0.0 && weights.iter().all(|w| w.is_finite())).then_some(weights)
}

fn shortest_edges_squared(cells: Cells<'_>) -> Vec<f64> {
    let mut scales = vec![f64::INFINITY; cells.positions.len()];
    for points in cells.tetrahedra {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let (p, q) = (points[i].index(), points[j].index());
            let length = (cells.positions[p] - cells.positions[q]).length_squared();
            if length > 0.0 {
                scales[p] = scales[p].min(length);
                scales[q] = scales[q].min(length);
            }
        }
    }
    let (sum, count) = scales.iter().filter(|s| s.is_finite()).fold((0.0, 0_usize), |(sum, n), s| (sum + s, n + 1));
    // No cell, or no extent: the mean changes no mean.
    let mean = if count > 0 { sum / count as f64 } else { 1.0 };
    scales.iter_mut().filter(|s| s.is_infinite()).for_each(|s| *s = mean);
    scales
}
