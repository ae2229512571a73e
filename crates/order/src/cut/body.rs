//! A cell or a piece of one: the corners of a convex body, and what cut it.

use glam::DVec3;
use tetrascope_view::Viewpoint;

use crate::CutPlane;

/// A cell, or what planes have left of it.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// The cell's number in its run.
    pub(super) member: usize,
    /// What cut it.
    pub(super) planes: Vec<CutPlane>,
    pub(super) corners: Vec<Corner>,
}

/// A corner of a convex body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: DVec3,
    /// The faces that it lies on, as bits: the four of the cell, then one a plane. Two corners make an edge if they have two of them
    /// in common.
    faces: u64,
}

/// Planes that fit beside the faces of a cell.
pub(super) const MOST_PLANES: usize = 60;

/// The parts of a body on both sides of a plane; a side with nothing on it has none.
#[derive(Debug)]
pub(super) struct Parts {
    /// Where the normal comes from, and where it points.
    pub(super) behind: Option<Body>,
    pub(super) before: Option<Body>,
}

impl Body {
    pub(super) fn whole(member: usize, corners: &[DVec3; 4]) -> Self {
        let corners = (0..4).map(|i| Corner { at: corners[i], faces: 0b1111 ^ 1 << i }).collect();
        Self { member, planes: Vec::new(), corners }
    }

    /// How far it reaches behind a plane and in front of it; the normal has length 1.
    pub(super) fn reach(&self, plane: &CutPlane) -> [f64; 2] {
        self.corners
            .iter()
            .map(|corner| plane.normal.dot(corner.at - plane.point))
            .fold([0.0; 2], |[behind, before], height| [f64::max(behind, -height), f64::max(before, height)])
    }

    /// Divides it by a plane whose normal has length 1. What reaches beyond the plane by no more than `tolerance` is not cut off.
    ///
    /// # Panics
    /// In debug builds, if there are [`MOST_PLANES`] already.
    pub(super) fn divide(self, plane: &CutPlane, tolerance: f64) -> Parts {
        let [behind, before] = self.reach(plane);
        if behind <= tolerance || before <= tolerance {
            let is_behind = behind >= before;
            let (kept, none) = (Some(self), None);
            return if is_behind { Parts { behind: kept, before: none } } else { Parts { behind: none, before: kept } };
        }
        debug_assert!(self.planes.len() < MOST_PLANES, "more planes than bits");
        let in_plane = 1_u64 << (4 + self.planes.len());
        let heights: Vec<f64> = self.corners.iter().map(|corner| plane.normal.dot(corner.at - plane.point)).collect();
        let part = |plane: CutPlane, keeps: &dyn Fn(f64) -> bool| {
            let planes = self.planes.iter().copied().chain([plane]).collect();
            Body {
                member: self.member,
                planes,
                corners: self
                    .corners
                    .iter()
                    .zip(&heights)
                    .filter(|&(_, &h)| h.abs() > tolerance && keeps(h))
                    .map(|(&c, _)| c)
                    .collect(),
            }
        };
        let turned = CutPlane { normal: -plane.normal, ..*plane };
        let (mut behind, mut before) = (part(*plane, &|h| h < 0.0), part(turned, &|h| h > 0.0));
        let mut add = |corner: Corner| {
            behind.corners.push(corner);
            before.corners.push(corner);
        };
        for (i, (a, &height_a)) in self.corners.iter().zip(&heights).enumerate() {
            if height_a.abs() <= tolerance {
                add(Corner { faces: a.faces | in_plane, ..*a });
                continue;
            }
            for (b, &height_b) in self.corners[i + 1..].iter().zip(&heights[i + 1..]) {
                let common = a.faces & b.faces;
                let is_crossed = height_a * height_b < 0.0 && height_b.abs() > tolerance;
                if is_crossed && common.count_ones() >= 2 {
                    let at = a.at.lerp(b.at, height_a / (height_a - height_b));
                    add(Corner { at, faces: common | in_plane });
                }
            }
        }
        Parts { behind: Some(behind), before: Some(before) }
    }
}

/// Whether no ray from the eye passes through the inside of both, but for a strip no wider than `tolerance` times two.
///
/// As for whole cells: a plane through the eye and two corners parts them, if any does.
pub(super) fn are_seen_apart(viewpoint: Viewpoint, a: &Body, b: &Body, tolerance: f64) -> bool {
    let seen = |body: &Body| -> Vec<DVec3> {
        let from_eye = |corner: &Corner| match viewpoint {
            Viewpoint::Eye(eye) => corner.at - eye,
            Viewpoint::Direction(_) => corner.at,
        };
        body.corners.iter().map(from_eye).collect()
    };
    let (a, b) = (seen(a), seen(b));
    let all: Vec<DVec3> = a.iter().chain(&b).copied().collect();
    all.iter().enumerate().any(|(i, &p)| {
        all[i + 1..].iter().any(|&q| {
            let (point, normal) = match viewpoint {
                Viewpoint::Eye(_) => (DVec3::ZERO, p.cross(q)),
                Viewpoint::Direction(direction) => (p, direction.cross(q - p)),
            };
            let Some(normal) = normal.try_normalize() else { return false };
            let is_within = |of: &[DVec3], sign: f64| of.iter().all(|&r| sign * normal.dot(r - point) <= tolerance);
            is_within(&a, 1.0) && is_within(&b, -1.0) || is_within(&a, -1.0) && is_within(&b, 1.0)
        })
    })
}
