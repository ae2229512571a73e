//! Which of two tetrahedra hides part of the other.

use glam::DVec3;
use tetrascope_view::Viewpoint;

use super::ROUNDING;
use crate::signs::{eye_side, side_of};

/// How two tetrahedra lie, seen from the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relation {
    /// No ray passes through the inside of both.
    Apart,
    /// A ray does, and meets the first one first.
    Front,
    /// A ray does, and meets the second one first.
    Behind,
    /// They penetrate each other, by more than rounding.
    Entangled,
}

/// How two tetrahedra lie; both must have a volume. Exact.
///
/// - `scale`: the largest coordinate, of which [`ROUNDING`] is how far they may penetrate each other
pub(super) fn relation(viewpoint: Viewpoint, a: &[DVec3; 4], b: &[DVec3; 4], scale: f64) -> Relation {
    if are_seen_apart(viewpoint, a, b) {
        return Relation::Apart;
    }
    let eye_on_the_side_of_a =
        separating(a, b).map(|(plane, a_side)| eye_side(plane, viewpoint) * a_side).or_else(|| {
            let (point, outward) = nearly_separating(a, b, scale * ROUNDING)?;
            let height = eye_height(viewpoint, point, outward);
            Some(i8::from(height < 0.0) - i8::from(height > 0.0))
        });
    match eye_on_the_side_of_a {
        None => Relation::Entangled,
        Some(1) => Relation::Front,
        Some(-1) => Relation::Behind,
        // Seen edge-on, a plane between them parts them on the screen.
        Some(_) => Relation::Apart,
    }
}

/// How far the eye is in front of a plane, in any unit; only the sign is of use where it is infinitely far away.
pub(super) fn eye_height(viewpoint: Viewpoint, point: DVec3, normal: DVec3) -> f64 {
    match viewpoint {
        Viewpoint::Eye(eye) => normal.dot(eye - point),
        Viewpoint::Direction(direction) => -normal.dot(direction),
    }
}

/// Lowest and highest.
fn range(sides: impl Iterator<Item = i8>) -> [i8; 2] {
    sides.fold([1, -1], |[low, high], side| [low.min(side), high.max(side)])
}

/// The side that all of one are on (or in the plane) while all of the other are on the other side; `None` if it is not so, or if all
/// are in the plane, as they are where it is none.
fn parted([low_a, high_a]: [i8; 2], [low_b, high_b]: [i8; 2]) -> Option<i8> {
    if low_a == 0 && high_a == 0 && low_b == 0 && high_b == 0 {
        None
    } else if high_a <= 0 && low_b >= 0 {
        Some(-1)
    } else if low_a >= 0 && high_b <= 0 {
        Some(1)
    } else {
        None
    }
}

/// Whether no ray from the eye passes through the inside of both. Exact.
///
/// Seen from the eye they are convex cones. If a plane through the eye parts two of them, so does one through two of their corners: the normals
/// of such planes form a cone too, and on an edge of it two of the conditions hold with equality.
fn are_seen_apart(viewpoint: Viewpoint, a: &[DVec3; 4], b: &[DVec3; 4]) -> bool {
    let corner = |i: usize| if i < 4 { a[i] } else { b[i - 4] };
    (0..8).any(|i| {
        (i + 1..8).any(|j| {
            let (p, q) = (corner(i), corner(j));
            let sides = |of: &[DVec3; 4]| range(of.iter().map(|&r| eye_side([p, q, r], viewpoint)));
            let of_a = sides(a);
            of_a[0] * of_a[1] >= 0 && parted(of_a, sides(b)).is_some()
        })
    })
}

/// A plane with one tetrahedron on one side and the other on the other, and the side of the first. Exact.
///
/// If there is one, there is one through three of their corners, for the same reason.
fn separating(a: &[DVec3; 4], b: &[DVec3; 4]) -> Option<([DVec3; 3], i8)> {
    triples(a, b).find_map(|plane| {
        let of_a = range(a.iter().map(|&r| side_of(plane, r)));
        if of_a[0] * of_a[1] < 0 {
            return None;
        }
        Some((plane, parted(of_a, range(b.iter().map(|&r| side_of(plane, r))))?))
    })
}

/// Like [`separating`], to within `tolerance`: a point of the plane and its normal, away from the first.
///
/// Parts of a mesh that meet without common corners penetrate each other by the rounding of their coordinates.
fn nearly_separating(a: &[DVec3; 4], b: &[DVec3; 4], tolerance: f64) -> Option<(DVec3, DVec3)> {
    triples(a, b).find_map(|[p, q, r]| {
        let normal = (q - p).cross(r - p).try_normalize()?;
        let range = |of: &[DVec3; 4]| {
            of.iter()
                .map(|&x| normal.dot(x - p))
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)])
        };
        let ([low_a, high_a], [low_b, high_b]) = (range(a), range(b));
        if high_a <= tolerance && low_b >= -tolerance {
            Some((p, normal))
        } else if low_a >= -tolerance && high_b <= tolerance {
            Some((p, -normal))
        } else {
            None
        }
    })
}

/// All threes of the corners of both.
fn triples(a: &[DVec3; 4], b: &[DVec3; 4]) -> impl Iterator<Item = [DVec3; 3]> {
    let corners = [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]];
    (0..8)
        .flat_map(move |i| (i + 1..8).flat_map(move |j| (j + 1..8).map(move |k| [corners[i], corners[j], corners[k]])))
}

/// Where a tetrahedron is seen, roughly: a ball around it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    /// From an eye its direction, of length 1; else its center on a plane across the rays.
    center: DVec3,
    /// From an eye the sine of the angle under which its radius is seen, 1 from inside; else the radius.
    radius: f64,
    is_on_a_sphere: bool,
}

impl Ball {
    pub(super) fn new(viewpoint: Viewpoint, corners: &[DVec3; 4]) -> Self {
        let center = (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25;
        let radius = corners.iter().map(|&p| p.distance(center)).fold(0.0, f64::max);
        match viewpoint {
            Viewpoint::Eye(eye) => {
                let (direction, distance) = (center - eye).normalize_and_length();
                let radius = if radius < distance { radius / distance } else { 1.0 };
                Self { center: direction, radius, is_on_a_sphere: true }
            }
            Viewpoint::Direction(direction) => {
                let across = center - direction * (center.dot(direction) / direction.length_squared());
                Self { center: across, radius, is_on_a_sphere: false }
            }
        }
    }

    /// Whether a ray may meet both.
    pub(super) fn meets(&self, other: &Self) -> bool {
        // Rounding of these few operations is below 1e-15 of the numbers in them.
        const MARGIN: f64 = 1e-12;
        if !self.is_on_a_sphere {
            let reach = (self.radius + other.radius) * (1.0 + MARGIN) + MARGIN * self.center.length();
            return self.center.distance_squared(other.center) <= reach * reach;
        }
        let cosine = |sine: f64| (1.0 - sine * sine).max(0.0).sqrt();
        let cosine_of_sum = cosine(self.radius) * cosine(other.radius) - self.radius * other.radius;
        // The cosine of a right angle's neighbors is known to the root of rounding only.
        self.radius >= 1.0 || other.radius >= 1.0 || self.center.dot(other.center) >= cosine_of_sum - 1e-7
    }
}
