//! What the cells of a scene ask of an integration: how many pieces of the transfer function they see.

use rayon::prelude::*;
use tetrascope_mesh::TetMesh;
use tetrascope_scene::Plan;

/// What cells are like, weighted by how many rays each is expected to meet: by its surface, a quarter of which is its mean silhouette.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Survey {
    /// Cells that the transfer function leaves visible.
    pub(crate) visible: u64,
    /// Pieces of the transfer function that a cell has.
    pub(crate) pieces: f64,
}

impl Survey {
    /// Looks at every cell of a mesh.
    pub(crate) fn new(mesh: &TetMesh, scalars: &[f64], plan: &Plan) -> Self {
        let sums = mesh
            .tetrahedra()
            .par_iter()
            .map(|cell| {
                let values = cell.map(|v| scalars[v.index()]);
                let [low, high] =
                    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], &s| [l.min(s), h.max(s)]);
                let is_seen = (plan.model.needs_extinction() && plan.transfer.max_extinction(low, high) > 0.0)
                    || (!plan.model.is_dark_without_extinction() && plan.transfer.max_emission(low, high) > 0.0);
                if !is_seen {
                    return [0.0; 3];
                }
                let [a, b, c, d] = cell.map(|v| mesh.positions()[v.index()]);
                let face = |u: glam::DVec3, v: glam::DVec3| u.cross(v).length();
                let area = face(b - a, c - a) + face(b - a, d - a) + face(c - a, d - a) + face(c - b, d - b);
                let pieces = plan.transfer.pieces_between(low, high).len() as f64;
                [1.0, area, area * pieces]
            })
            .reduce(|| [0.0; 3], |a, b| std::array::from_fn(|i| a[i] + b[i]));
        let [visible, area, pieces] = sums;
        Self { visible: visible as u64, pieces: if area > 0.0 { pieces / area } else { 1.0 } }
    }
}
