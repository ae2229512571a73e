//! The four signed volumes that a viewpoint makes with the faces of a cell: everything else follows from them.

use glam::DVec3;
use tetrascope_view::Viewpoint;

use crate::class::Sign;

/// The corners of the face opposite to each corner, counterclockwise seen from outside a positively oriented cell.
pub const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The signed volumes A of a cell in a view, one for each face.
///
/// Perspective: `a[m]` is six times the volume of the cell in which the eye takes the place of corner m, so that
/// `Σ a[m] = six_volume` and `Σ a[m] (p_m − eye) = 0`. Orthographic: `a[m]` is twice the area of the face opposite to m
/// as seen along the direction, and `Σ a[m] = 0`. Both: `a[m] > 0` where the face opposite to corner m faces away from the
/// eye, `< 0` where it faces the eye, 0 where it is seen edge-on. Shirley and Tuchman write `+` for faces that face the
/// eye, the opposite sign.
///
/// Rounding: relative to the largest terms 1e-15. The volumes come from the edges of a face and one vector to the eye, not
/// from three vectors to the eye, because the latter lose digits with the distance of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedVolumes {
    /// One for each corner, of the opposite face. Length cubed in perspective, length squared in orthographic views.
    pub a: [f64; 4],
    /// Six times the cell's volume; above 0 for the cells that can be drawn.
    pub six_volume: f64,
}

impl SignedVolumes {
    /// The volumes of a cell.
    ///
    /// - `positions`: finite; corner 3 sees 0, 1, 2 run clockwise (`(p1−p0) × (p2−p0) · (p3−p0) > 0`)
    /// - `ids`: what orders the corners, the same for every cell that shares a corner: vertex indices as a rule
    ///
    /// Each face is evaluated from its three corners in ascending order of `ids`. So the two cells of a face get the same
    /// magnitude with opposite signs, bit for bit, and renumbering the corners within a cell changes no bit.
    pub fn new<K: Ord + Copy>(positions: &[DVec3; 4], ids: [K; 4], viewpoint: Viewpoint) -> Self {
        let a = FACES.map(|face| {
            let (face, is_odd) = ascending(face, &ids);
            let volume = face_volume(face.map(|corner| positions[corner]), viewpoint);
            if is_odd { -volume } else { volume }
        });
        Self { a, six_volume: six_volume(positions, ids) }
    }

    /// The sign of each volume.
    pub fn signs(&self) -> [Sign; 4] {
        self.a.map(Sign::of)
    }

    /// The sum of the positive volumes, S_P.
    pub fn sum_plus(&self) -> f64 {
        self.a.iter().filter(|a| **a > 0.0).sum()
    }

    /// The negated sum of the negative volumes, S_N.
    pub fn sum_minus(&self) -> f64 {
        -self.a.iter().filter(|a| **a < 0.0).sum::<f64>()
    }
}

/// Six times the signed volume between a triangle and the eye; orthographic: twice the triangle's signed area as seen.
///
/// Positive where the corners run clockwise as the viewpoint sees them, that is where the side from which they run
/// counterclockwise is turned away. Swapping two corners negates the value but for rounding; give them in ascending order
/// of their indices wherever two values must agree.
pub fn face_volume(corners: [DVec3; 3], viewpoint: Viewpoint) -> f64 {
    let [p, q, r] = corners;
    let normal = (q - p).cross(r - p);
    match viewpoint {
        Viewpoint::Eye(eye) => normal.dot(p - eye),
        Viewpoint::Direction(direction) => normal.dot(direction),
    }
}

/// Six times the signed volume of a cell, evaluated in ascending order of `ids`.
pub fn six_volume<K: Ord + Copy>(positions: &[DVec3; 4], ids: [K; 4]) -> f64 {
    let (order, is_odd) = ascending([0, 1, 2, 3], &ids);
    let [p, q, r, s] = order.map(|corner| positions[corner]);
    let volume = (q - p).cross(r - p).dot(s - p);
    if is_odd { -volume } else { volume }
}

/// The corners in ascending order of their ids, and whether that took an odd number of swaps.
fn ascending<K: Ord, const N: usize>(mut corners: [usize; N], ids: &[K; 4]) -> ([usize; N], bool) {
    let mut is_odd = false;
    for end in (1..N).rev() {
        for i in 0..end {
            if ids[corners[i]] > ids[corners[i + 1]] {
                corners.swap(i, i + 1);
                is_odd = !is_odd;
            }
        }
    }
    (corners, is_odd)
}
