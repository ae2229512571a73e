//! Two triangles on one ray: whether there is such a ray, and which of them it meets first.

use glam::DVec3;
use tetrascope_view::Viewpoint;

use crate::signs::{eye_side, side_of};

/// A triangle that is not seen edge-on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) points: [DVec3; 3],
    /// The side of its plane that the eye is on, 1 or -1.
    pub(super) eye_side: i8,
}

const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

/// Whether a ray from the eye passes through the inside of both. Exact: a common edge or corner is no overlap.
///
/// Seen from the eye a triangle is a cone, and two cones have no inside in common if a plane through the eye parts
/// them. If there is one, there is one through an edge of either or through a corner of each. The latter need not be
/// tried where both cones lie in one half space (`is_narrow`): cut across, they are convex polygons.
pub(super) fn overlap(viewpoint: Viewpoint, a: &Seen, b: &Seen, is_narrow: bool) -> bool {
    if beyond_an_edge(viewpoint, a, b) || beyond_an_edge(viewpoint, b, a) {
        return false;
    }
    is_narrow
        || matches!(viewpoint, Viewpoint::Direction(_))
        || !a.points.iter().any(|&p| {
            b.points.iter().any(|&q| {
                let range = |seen: &Seen| {
                    let sides = seen.points.map(|r| eye_side([p, q, r], viewpoint));
                    (sides[0].min(sides[1]).min(sides[2]), sides[0].max(sides[1]).max(sides[2]))
                };
                let ((lowest_a, highest_a), (lowest_b, highest_b)) = (range(a), range(b));
                // The eye on the line through both corners gives no plane, and all signs are 0.
                let is_plane = lowest_a != 0 || highest_a != 0;
                is_plane && (lowest_a >= 0 && highest_b <= 0 || highest_a <= 0 && lowest_b >= 0)
            })
        })
}

/// Whether all of `b` is seen beyond the line of one edge of `a`.
fn beyond_an_edge(viewpoint: Viewpoint, a: &Seen, b: &Seen) -> bool {
    EDGES
        .iter()
        .any(|&[i, j]| b.points.iter().all(|&q| eye_side([a.points[i], a.points[j], q], viewpoint) * a.eye_side <= 0))
}

/// Whether some ray meets `front` before `back`, for two triangles that [`overlap`]. Exact.
///
/// Triangles in one plane count as meeting in this order. If one triangle lies on one side of the other's plane, that
/// decides. Else the corners of their overlap are looked at: corners of one that are seen inside the other, and edges
/// that are seen to cross. Triangles that pierce each other are in front of each other.
pub(super) fn is_before(viewpoint: Viewpoint, front: &Seen, back: &Seen) -> bool {
    // The sides relative to the eye: 1 on its side.
    let sides = |plane: &Seen, other: &Seen| other.points.map(|p| side_of(plane.points, p) * plane.eye_side);
    let of_back = sides(front, back);
    if of_back.iter().all(|&s| s <= 0) {
        return true;
    }
    if of_back.iter().all(|&s| s >= 0) {
        return false;
    }
    let of_front = sides(back, front);
    if of_front.iter().all(|&s| s >= 0) {
        return true;
    }
    if of_front.iter().all(|&s| s <= 0) {
        return false;
    }
    let sees = |seen: &Seen, q: DVec3| {
        EDGES.iter().all(|&[i, j]| eye_side([seen.points[i], seen.points[j], q], viewpoint) * seen.eye_side >= 0)
    };
    (0..3).any(|i| of_back[i] < 0 && sees(front, back.points[i]))
        || (0..3).any(|i| of_front[i] > 0 && sees(back, front.points[i]))
        || EDGES.iter().any(|&[i, j]| {
            EDGES.iter().any(|&[k, l]| {
                crosses_before(viewpoint, [front.points[i], front.points[j]], [back.points[k], back.points[l]])
            })
        })
}

/// Whether two edges are seen to cross, and a ray through the crossing meets the first edge first.
fn crosses_before(viewpoint: Viewpoint, [a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> bool {
    let [abc, abd, cda, cdb] = [[a, b, c], [a, b, d], [c, d, a], [c, d, b]].map(|points| eye_side(points, viewpoint));
    // All four the same way round, so that the ray meets both, and not one before and one behind the eye.
    let cross = abd != 0 && abc == -abd && cda == abd && cdb == -abd;
    // Through a and b, parallel to c and d, there is a plane with the eye on one side and c and d on the other.
    cross && side_of([a, b, d], c) == -abd
}
