//! Planes, and what they make of a boundary face.

use glam::DVec3;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::signs::{eye_side, side_of, sign, signed_volume};

/// A boundary face. Its three points span a plane, since its cell has a volume.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) points: [DVec3; 3],
    /// Points of one place have one number.
    pub(super) numbers: [u32; 3],
    pub(super) cell: CellId,
    /// The side of the face that its cell is on, 1 or -1, in the sense of `side_of`.
    pub(super) cell_side: i8,
}

/// A whole boundary face, or a convex piece of one.
#[derive(Clone, Debug)]
pub(super) struct Fragment {
    pub(super) face: u32,
    /// The corners of a piece, in their turn. Empty for a whole face.
    pub(super) corners: Vec<DVec3>,
}

/// A plane that divides fragments.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plane {
    /// All points with this coordinate; greater ones are on side 1.
    Axis { axis: usize, at: f64 },
    /// That of a boundary face.
    Face(u32),
}

/// Where a fragment is.
#[derive(Clone, Debug)]
pub(super) enum Place {
    On,
    Positive,
    Negative,
    Across,
}

/// Within this share of a plane's largest numbers a corner that was computed counts as on the plane: a dozen roundings.
const ROUNDING: f64 = 1e-13;

impl Plane {
    /// The side of a point that a face has. Exact.
    fn side(self, faces: &[Face], point: DVec3) -> i8 {
        match self {
            Self::Axis { axis, at } => i8::from(point[axis] > at) - i8::from(point[axis] < at),
            Self::Face(face) => side_of(faces[face as usize].points, point),
        }
    }

    /// The side of the eye. Exact.
    pub(super) fn eye_side(self, faces: &[Face], viewpoint: Viewpoint) -> i8 {
        match (self, viewpoint) {
            (Self::Axis { .. }, Viewpoint::Eye(eye)) => self.side(faces, eye),
            (Self::Axis { axis, .. }, Viewpoint::Direction(direction)) => sign(-direction[axis]),
            (Self::Face(face), _) => eye_side(faces[face as usize].points, viewpoint),
        }
    }

    /// Something proportional to the distance, signed, and how large the numbers were that it was made from.
    fn distance(self, faces: &[Face], point: DVec3) -> (f64, f64) {
        match self {
            Self::Axis { axis, at } => (point[axis] - at, at.abs().max(point[axis].abs())),
            Self::Face(face) => {
                let points = faces[face as usize].points;
                let [a, b, c] = points;
                let normal = (b - a).cross(c - a).length();
                let largest = a.abs().max(b.abs()).max(c.abs()).max(point.abs()).max_element();
                (signed_volume(points, point), normal * largest)
            }
        }
    }

    /// Where a fragment is. Exact for a whole face, and for a piece of a face that does not cross the plane.
    ///
    /// A piece has corners that were rounded. One that lies on one side but for [`ROUNDING`] is not split again, so
    /// that corners on several planes make no slivers.
    pub(super) fn place(self, faces: &[Face], fragment: &Fragment) -> Place {
        let whole = place_of(faces[fragment.face as usize].points.map(|p| self.side(faces, p)));
        match whole {
            Place::Across if !fragment.corners.is_empty() => match place_of(self.corner_sides(faces, fragment)) {
                // The face crosses the plane somewhere else; the piece is thinner than rounding. Either side is right.
                Place::On => Place::Positive,
                place => place,
            },
            place => place,
        }
    }

    /// Sides of the corners of a piece.
    fn corner_sides(self, faces: &[Face], fragment: &Fragment) -> impl Iterator<Item = i8> {
        fragment.corners.iter().map(move |&corner| {
            let (distance, largest) = self.distance(faces, corner);
            if distance.abs() <= ROUNDING * largest { 0 } else { sign(distance) }
        })
    }

    /// The parts on the positive and on the negative side of a fragment that is [`Place::Across`].
    pub(super) fn split(self, faces: &[Face], fragment: &Fragment) -> [Fragment; 2] {
        let points = &faces[fragment.face as usize].points;
        let is_whole = fragment.corners.is_empty();
        let corners: &[DVec3] = if is_whole { points } else { &fragment.corners };
        let sides: Vec<i8> = if is_whole {
            points.iter().map(|&p| self.side(faces, p)).collect()
        } else {
            self.corner_sides(faces, fragment).collect()
        };
        let mut parts =
            [1, -1].map(|_| Fragment { face: fragment.face, corners: Vec::with_capacity(corners.len() + 1) });
        for (i, (&corner, &side)) in corners.iter().zip(&sides).enumerate() {
            for (part, own) in parts.iter_mut().zip([1, -1]) {
                if side != -own {
                    part.corners.push(corner);
                }
            }
            let next = (i + 1) % corners.len();
            if side * sides[next] < 0 {
                let cut = self.cut(faces, corner, corners[next]);
                parts.iter_mut().for_each(|part| part.corners.push(cut));
            }
        }
        parts
    }

    /// Where the plane meets the line between two points on different sides.
    fn cut(self, faces: &[Face], from: DVec3, to: DVec3) -> DVec3 {
        let [start, end] = [from, to].map(|p| self.distance(faces, p).0);
        let mut cut = from.lerp(to, (start / (start - end)).clamp(0.0, 1.0));
        if let Self::Axis { axis, at } = self {
            cut[axis] = at;
        }
        cut
    }
}

fn place_of(sides: impl IntoIterator<Item = i8>) -> Place {
    let (mut positive, mut negative) = (false, false);
    for side in sides {
        positive |= side > 0;
        negative |= side < 0;
    }
    match (positive, negative) {
        (false, false) => Place::On,
        (true, false) => Place::Positive,
        (false, true) => Place::Negative,
        (true, true) => Place::Across,
    }
}
