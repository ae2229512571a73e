//! What the cells of a scene ask of an integration: how many pieces of the transfer function they see.

use rayon::prelude::*;
use tetrascope_mesh::TetMesh;
use tetrascope_scene::Plan;

/// What cells are like, weighted by how many rays each is expected to meet: by its surface, a quarter of which is its mean silhouette.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Survey {
    /// Cells that the transfer function leaves visible.
    pub visible: u64,
    /// Pieces of the transfer function that a ray is expected to meet in a cell.
    pub pieces_met: f64,
    /// Pieces that the cell has.
    pub pieces: f64,
    /// The largest number of pieces of a cell.
    pub most_pieces: u32,
}

impl Survey {
    /// Looks at every cell of a mesh.
    pub fn new(mesh: &TetMesh, scalars: &[f64], plan: &Plan) -> Self {
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
                    return [0.0; 5];
                }
                let [a, b, c, d] = cell.map(|v| mesh.positions()[v.index()]);
                let face = |u: glam::DVec3, v: glam::DVec3| u.cross(v).length();
                let area = face(b - a, c - a) + face(b - a, d - a) + face(c - a, d - a) + face(c - b, d - b);
                let pieces = plan.transfer.pieces_between(low, high).len() as f64;
                // A ray's scalars span about a third of the cell's.
                let met = 1.0 + (pieces - 1.0) * MET;
                [1.0, area, area * pieces, area * met, pieces]
            })
            .reduce(|| [0.0; 5], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4].max(b[4])]);
        let [visible, area, pieces, met, most] = sums;
        let mean = |sum: f64| if area > 0.0 { sum / area } else { 1.0 };
        Self { visible: visible as u64, pieces_met: mean(met), pieces: mean(pieces), most_pieces: most as u32 }
    }
}

/// Share of a cell's control points that a ray through it passes, on average.
const MET: f64 = 0.35;
