//! Faces of cells that touch, and overlap by no more than rounding.
//!
//! A point on an edge or a face of another cell, a hanging node, lies off it by a last digit. Where it lies inside that cell, a ray enters
//! the one cell before it leaves the other, by 1e-16: exactly speaking there is no gap, no exit in front of an entry and so no arrow,
//! though nearly all of either cell lies on its own side of both faces. Which pairs these are does not depend on the view, and which is in
//! front is as for a shared face: the one on the eye's side.

use glam::DVec3;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::signs::{eye_side, side_of, signed_volume};

/// Two boundary faces in one plane but for rounding, with their cells on either side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    faces: [CellSide; 2],
}

/// A boundary face and the cell that it belongs to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellSide {
    pub(crate) points: [DVec3; 3],
    /// The cell's other point.
    pub(crate) apex: DVec3,
    pub(crate) cell: CellId,
    /// The side of the face that its cell is on.
    pub(crate) cell_side: i8,
}

/// Share of the largest coordinate within which points count as in a plane: some dozen roundings of what made them.
const ROUNDING: f64 = 1e-13;

impl Touch {
    /// Two faces, if they touch and it takes rounding to say so. Those that touch exactly, or are apart, have exact relations.
    ///
    /// - `largest`: coordinate of the mesh
    pub(crate) fn of(a: &CellSide, b: &CellSide, largest: f64) -> Option<Self> {
        let pairs = [(a, b), (b, a)];
        let is_flat =
            pairs.iter().all(|(plane, other)| other.points.iter().all(|&p| is_near(plane.points, p, largest)));
        if !is_flat || pairs.iter().any(|(plane, other)| is_behind(plane, other)) {
            return None;
        }
        // Sheets thinner than rounding say nothing: their cells are on both sides.
        let are_apart = pairs.iter().all(|(plane, other)| {
            plane.cell_side * side_of(plane.points, other.apex) < 0
                && !is_near(plane.points, other.apex, largest)
                && !is_near(plane.points, plane.apex, largest)
        });
        (are_apart && share_area(&a.points, &b.points, largest)).then_some(Self { faces: [*a, *b] })
    }

    /// The cell in front and the one behind, where a view sees the one from within and the other from outside.
    pub(crate) fn arrow(&self, viewpoint: Viewpoint) -> Option<(CellId, CellId)> {
        let [a, b] = self.faces;
        let [on_a, on_b] = self.faces.map(|face| eye_side(face.points, viewpoint) * face.cell_side);
        match (on_a, on_b) {
            (1, -1) => Some((a.cell, b.cell)),
            (-1, 1) => Some((b.cell, a.cell)),
            _ => None,
        }
    }
}

/// Whether all of a face lies in another's plane or beyond it, seen from the other's cell. Exact.
fn is_behind(plane: &CellSide, other: &CellSide) -> bool {
    other.points.iter().all(|&p| side_of(plane.points, p) * plane.cell_side <= 0)
}

/// Whether a point lies in a plane but for rounding.
fn is_near(plane: [DVec3; 3], p: DVec3, largest: f64) -> bool {
    let [a, b, c] = plane;
    signed_volume(plane, p).abs() <= ROUNDING * largest * (b - a).cross(c - a).length()
}

/// Whether two triangles in one plane have more than a rim in common: no edge has all of the other on its far side.
fn share_area(a: &[DVec3; 3], b: &[DVec3; 3], largest: f64) -> bool {
    [(a, b), (b, a)].iter().all(|(triangle, other)| {
        let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
        [[0, 1], [1, 2], [2, 0]].iter().all(|&[i, j]| {
            // Across the edge, towards the third point.
            let across = normal.cross(triangle[j] - triangle[i]);
            let rounding = ROUNDING * largest * across.length();
            other.iter().any(|&p| across.dot(p - triangle[i]) > rounding)
        })
    })
}
