//! How many pixels cells cover, estimated from some of them, and how many lie outside of the view.

use glam::{DVec2, DVec3};
use tetrascope_mesh::{TetMesh, VertexId};
use tetrascope_view::View;

/// Cells that are looked at: the standard error of a sum over them is about a hundredth where cells are alike.
const SAMPLE: usize = 1 << 13;

/// Pairs of a pixel and a cell that shows something, estimated: nothing of the picture is computed.
///
/// The areas of silhouettes on the screen, of cells in even steps through the mesh. What lies behind an opaque pixel counts as
/// if it were drawn; cells that reach behind the eye are left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fragments {
    /// The estimate.
    pub estimate: f64,
    /// Its standard error, from how much the cells differ that were looked at; 0 where all were.
    pub standard_error: f64,
    /// Cells that were looked at.
    pub sampled: u64,
}

/// How many cells lie outside of the view as a whole, and how many fragments the others may have.
///
/// - `cells`: those that show anything
pub(super) fn survey(view: &View, mesh: &TetMesh, cells: &[[VertexId; 4]]) -> (u64, Fragments) {
    let frame = mesh.frame();
    let local = view.in_frame(frame.origin, frame.scale);
    // Right, up and forward, the first two in pictures' half widths and heights: those of depth 1 with perspective.
    let in_view: Vec<DVec3> = mesh
        .positions()
        .iter()
        .map(|&position| {
            let from_eye = position - local.eye;
            let across =
                DVec2::new(from_eye.dot(local.right) / local.half_width, from_eye.dot(local.up) / local.half_height);
            across.extend(from_eye.dot(local.forward))
        })
        .collect();
    let corners = |cell: &[VertexId; 4]| cell.map(|v| in_view[v.index()]);
    let outside = cells.iter().filter(|cell| is_outside(local.is_perspective, corners(cell))).count();

    let half_size = DVec2::new(f64::from(view.width), f64::from(view.height)) * 0.5;
    let step = cells.len().div_ceil(SAMPLE).max(1);
    let areas: Vec<f64> = cells
        .iter()
        .step_by(step)
        .map(|cell| area(local.is_perspective, corners(cell)) * half_size.x * half_size.y)
        .collect();
    let (count, sampled) = (cells.len() as f64, areas.len() as f64);
    let mean = areas.iter().sum::<f64>() / sampled.max(1.0);
    let variance = areas.iter().map(|area| (area - mean).powi(2)).sum::<f64>() / (sampled - 1.0).max(1.0);
    let standard_error = if step == 1 { 0.0 } else { count * (variance / sampled).sqrt() };
    (outside as u64, Fragments { estimate: mean * count, standard_error, sampled: areas.len() as u64 })
}

/// Whether all corners lie behind the eye or beyond one side of the picture.
fn is_outside(is_perspective: bool, corners: [DVec3; 4]) -> bool {
    let beyond =
        |side: &dyn Fn(DVec3) -> f64| corners.iter().all(|&p| side(p) > if is_perspective { p.z } else { 1.0 });
    corners.iter().all(|p| p.z <= 0.0) || beyond(&|p| p.x) || beyond(&|p| -p.x) || beyond(&|p| p.y) || beyond(&|p| -p.y)
}

/// What a cell that reaches behind the eye is taken to cover, a quarter of the picture: its silhouette has no end.
const AT_THE_EYE: f64 = 1.0;

/// The part of a silhouette that lies in the picture, whose sides are 2 long: half of what its four faces cover, as rays meet two of them.
fn area(is_perspective: bool, corners: [DVec3; 4]) -> f64 {
    if corners.iter().any(|p| p.z <= 0.0) {
        return AT_THE_EYE;
    }
    let [a, b, c, d] = corners.map(|p| if is_perspective { p.truncate() / p.z } else { p.truncate() });
    let face = |p: DVec2, q: DVec2, r: DVec2| 0.5 * (q - p).perp_dot(r - p).abs();
    let silhouette = 0.5 * (face(a, b, c) + face(a, b, d) + face(a, c, d) + face(b, c, d));
    let (low, high) = (a.min(b).min(c).min(d), a.max(b).max(c).max(d));
    // Of its box, the share in the picture.
    let inside = (high.min(DVec2::ONE) - low.max(DVec2::NEG_ONE)).max(DVec2::ZERO);
    let sides = high - low;
    let share = if sides.x > 0.0 && sides.y > 0.0 { inside.x * inside.y / (sides.x * sides.y) } else { 0.0 };
    silhouette * share
}
