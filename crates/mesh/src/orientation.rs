//! On which side a tetrahedron's fourth point lies, decided exactly.

use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Sign of a tetrahedron's volume `dot(v1 - v0, cross(v2 - v0, v3 - v0)) / 6`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sign {
    Negative,
    Zero,
    Positive,
}

/// Shewchuk's bound for the rounding of a 3 by 3 determinant of differences: (7 + 56 ε) ε times the permanent, ε = 2⁻⁵³.
/// Source: [Shewchuk 1997], section 4.3.
const ROUNDING: f64 = (7.0 + 56.0 * HALF_ULP) * HALF_ULP;
const HALF_ULP: f64 = f64::EPSILON / 2.0;

/// How far rounded local coordinates can move the determinant, relative to (largest coordinate) × (largest difference)².
///
/// A local coordinate is off by 2⁻⁵³ of itself at most, a difference of two by 2⁻⁵² of the largest coordinate. The
/// determinant has nine entries, each with a cofactor of at most twice the largest difference squared: 18 × 2⁻⁵², and
/// a little for the second order.
const INPUT: f64 = 20.0 * f64::EPSILON;

/// The same where a point was added: a weighted mean of at most a few dozen points, with weights whose absolute sum is
/// at most 7 (body centers), so it is off by at most some tens of half ulps.
const INPUT_ADDED: f64 = 64.0 * INPUT;

/// Points in world and local coordinates.
pub(crate) struct Space<'a> {
    /// World coordinates of the dataset's points.
    pub(crate) world: &'a [DVec3],
    /// Local coordinates of these and of the added points.
    pub(crate) local: &'a [DVec3],
    /// The frame's scale.
    pub(crate) scale: f64,
}

impl Space<'_> {
    /// The sign of a tetrahedron's volume.
    ///
    /// A floating-point filter in local coordinates decides nearly all. What it leaves open is decided exactly, both for
    /// the world coordinates (as the file has them) and for the local ones (as the renderers have them); where rounding
    /// to the local frame changes the answer, or where an added point takes part, the volume is below what the
    /// coordinates resolve, and it counts as zero. So a set that is flat in the file is never kept, and one that is kept
    /// has a positive volume in local coordinates too.
    pub(crate) fn sign(&self, t: [u32; 4]) -> Sign {
        if t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3] {
            return Sign::Zero;
        }
        let [v0, v1, v2, v3] = t.map(|v| self.local[v as usize]);
        let (a, b, c) = (v1 - v0, v2 - v0, v3 - v0);
        let determinant = a.dot(b.cross(c));
        let (aa, ba, ca) = (a.abs(), b.abs(), c.abs());
        let permanent =
            aa.dot(DVec3::new(ba.y * ca.z + ba.z * ca.y, ba.z * ca.x + ba.x * ca.z, ba.x * ca.y + ba.y * ca.x));
        let largest_difference = aa.max(ba).max(ca).max_element();
        let largest = v0.abs().max(v1.abs()).max(v2.abs()).max(v3.abs()).max_element();
        let has_added = t.iter().any(|&v| v as usize >= self.world.len());
        let input = if has_added { INPUT_ADDED } else { INPUT };
        let bound = ROUNDING * permanent + input * largest * largest_difference * largest_difference;
        if determinant > bound {
            Sign::Positive
        } else if determinant < -bound {
            Sign::Negative
        } else if has_added {
            Sign::Zero
        } else {
            self.exact_sign(t)
        }
    }

    #[cold]
    fn exact_sign(&self, t: [u32; 4]) -> Sign {
        let local = sign_of(t.map(|v| self.local[v as usize]));
        // The scale is a power of two, so the division is exact, and it keeps the predicate's products of three
        // differences far from overflow: two different floats in a mesh of this size are at most 2⁵⁴ sizes from the
        // world's origin. Only coordinates some 2⁻³⁰⁰ of the mesh's size could underflow, and count as zero then.
        let world = sign_of(t.map(|v| self.world[v as usize] / self.scale));
        if local == world { local } else { Sign::Zero }
    }
}

fn sign_of(corners: [DVec3; 4]) -> Sign {
    let [v0, v1, v2, v3] = corners.map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    // orient3d(a, b, c, d) has the sign of dot(a - d, cross(b - d, c - d)).
    let determinant = orient3d(v1, v2, v3, v0);
    if determinant > 0.0 {
        Sign::Positive
    } else if determinant < 0.0 {
        Sign::Negative
    } else {
        Sign::Zero
    }
}
