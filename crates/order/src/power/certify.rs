//! Whether heights order a mesh: every interior face tested, no answer rounded.

use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord3D, orient3d};
use tetrascope_mesh::FaceAdjacency;

use super::double::{Double, ROUNDING};
use super::lifted::face_pairs;
use crate::Cells;

/// What is proven about the heights of a mesh, by counting its interior faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PowerCertificate {
    /// Faces between two cells.
    pub faces: usize,
    /// Faces across which the lift is not convex, or not provably: from some eyes their two cells come in the wrong order.
    pub violated: usize,
    /// Faces whose two cells lie on the same side: the mesh overlaps itself there and no heights help.
    pub folded: usize,
    /// Faces of a cell without volume.
    pub flat: usize,
    /// Cells so thin that their affine function is not known to the last digit of an f64.
    pub imprecise: usize,
    /// Cells at the boundary that may come in the wrong order with another one across a gap; 0 for a convex mesh, which has no gaps;
    /// `None` where nobody has asked.
    pub gaps: Option<usize>,
}

impl PowerCertificate {
    /// Whether any two cells that share a face come in the right order, from every eye and along every direction.
    ///
    /// On a convex mesh that is every pair of cells. Elsewhere nothing is said about cells that see each other through a
    /// gap, a hole or the outside: [`Self::is_exact_across_gaps`] does.
    pub fn is_exact(&self) -> bool {
        self.violated == 0 && self.folded == 0 && self.flat == 0 && self.imprecise == 0
    }

    /// Whether any two cells that one ray passes through come in the right order, through whatever is between them, from every
    /// eye and along every direction. Cells that overlap have no right order.
    pub fn is_exact_across_gaps(&self) -> bool {
        self.is_exact() && self.gaps == Some(0)
    }

    fn and(self, other: Self) -> Self {
        Self {
            faces: self.faces + other.faces,
            violated: self.violated + other.violated,
            folded: self.folded + other.folded,
            flat: self.flat + other.flat,
            imprecise: self.imprecise + other.imprecise,
            gaps: None,
        }
    }
}

/// Tests every interior face of a mesh whose points have these heights.
///
/// Never calls a face convex that is not: a filter in f64 settles nearly all faces, one of twice the precision the rest,
/// and what it leaves open (convexities below 1e-30 of what cancels) counts as violated. The volumes' signs are exact.
/// Valid while no product of three coordinates and a height leaves 1e-250..1e300.
pub(super) fn certify(cells: Cells<'_>, adjacency: &FaceAdjacency, heights: &[f64]) -> PowerCertificate {
    let judge = |points: [tetrascope_mesh::VertexId; 5]| {
        let mut one = PowerCertificate { faces: 1, ..PowerCertificate::default() };
        let [near, far] = [3, 4].map(|apex| {
            let [a, b, c, d] = [0, 1, 2, apex].map(|k| coord(cells.positions[points[k].index()]));
            orient3d(a, b, c, d)
        });
        if near == 0.0 || far == 0.0 {
            one.flat = 1;
        } else if (near > 0.0) == (far > 0.0) {
            one.folded = 1;
        } else {
            let positions = points.map(|p| cells.positions[p.index()]);
            one.violated = usize::from(!is_convex(positions, points.map(|p| heights[p.index()]), far > 0.0));
        }
        one
    };
    face_pairs(cells, adjacency)
        .map(|pairs| pairs.map(judge).fold(PowerCertificate::default(), PowerCertificate::and))
        .reduce(PowerCertificate::default, PowerCertificate::and)
}

/// Whether some face is not provably convex under the heights: [`certify`] that ends at the first.
pub(super) fn is_any_violated(cells: Cells<'_>, adjacency: &FaceAdjacency, heights: &[f64]) -> bool {
    face_pairs(cells, adjacency).any(|mut pairs| {
        pairs.any(|points| {
            let positions = points.map(|p| cells.positions[p.index()]);
            let [a, b, c, _, far] = positions.map(coord);
            let far = orient3d(a, b, c, far);
            !is_convex(positions, points.map(|p| heights[p.index()]), far > 0.0)
        })
    })
}

pub(super) fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// Shewchuk's bound for the sign of a four by four determinant of differences: (16 + 224 ε) ε times the permanent,
/// ε = 2⁻⁵³. Source: [Shewchuk 1997], the bound of InSphere, whose fourth column
/// is a sum of squares and rounds more.
const ROUNDING_F64: f64 = 1.7764e-15;

/// Below this, products may have lost digits to underflow.
const SMALLEST: f64 = 1e-250;

/// Whether the lift is provably convex across a face; the last two points are the corners on its two sides, and
/// `is_far_below` is whether [`orient3d`] of the face and the last is positive, that is, of the face and the one before negative.
///
/// That is whether the last point's height lies above the affine function of the other four, wherever it is.
pub(super) fn is_convex(positions: [DVec3; 5], heights: [f64; 5], is_far_below: bool) -> bool {
    // The affine dependency of the five points, by Cramer's rule; the weight of points[3] has the sign of `orient3d`
    // of the face and points[4], negated by the order of the factors.
    let sign = if is_far_below { -1.0 } else { 1.0 };
    let p: [DVec3; 4] = std::array::from_fn(|k| positions[k] - positions[4]);
    let h: [f64; 4] = std::array::from_fn(|k| heights[k] - heights[4]);
    const MINORS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [1, 0, 2]];
    let (mut convexity, mut permanent) = (0.0, 0.0);
    for (minor, height) in MINORS.iter().zip(h) {
        let [u, v, w] = minor.map(|k| p[k]);
        convexity += u.dot(v.cross(w)) * height;
        let [u, v, w] = [u.abs(), v.abs(), w.abs()];
        let cross = DVec3::new(v.y * w.z + v.z * w.y, v.z * w.x + v.x * w.z, v.x * w.y + v.y * w.x);
        permanent += u.dot(cross) * height.abs();
    }
    // Not "or": NaN and infinity are not proven.
    if !(permanent.is_finite() && permanent > SMALLEST) {
        return false;
    }
    if convexity.abs() > ROUNDING_F64 * permanent {
        return convexity * sign > 0.0;
    }
    let p: [[Double; 3]; 4] =
        std::array::from_fn(|k| std::array::from_fn(|i| Double::difference(positions[k][i], positions[4][i])));
    let h: [Double; 4] = std::array::from_fn(|k| Double::difference(heights[k], heights[4]));
    let mut convexity = Double::from(0.0);
    for (minor, height) in MINORS.iter().zip(h) {
        convexity = convexity + determinant(minor.map(|k| p[k])) * height;
    }
    convexity.high * sign > ROUNDING * permanent
}

/// `u · (v × w)`.
pub(super) fn determinant([u, v, w]: [[Double; 3]; 3]) -> Double {
    let minor = |i: usize, j: usize| v[i] * w[j] - v[j] * w[i];
    u[0] * minor(1, 2) + u[1] * minor(2, 0) + u[2] * minor(0, 1)
}
