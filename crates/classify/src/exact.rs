//! Signs without rounding, for topology: the shading itself does not need them.

use glam::DVec3;
use robust::Coord3D;
use tetrascope_view::Viewpoint;

use crate::class::Sign;
use crate::volumes::FACES;

/// The signs of [`crate::SignedVolumes`], as exact arithmetic on the given numbers finds them.
///
/// Exact while no product of three coordinates leaves 1e-250..1e300; the direction of an orthographic view is taken as it
/// is, rounded as its caller rounded it. Perspective: Shewchuk's adaptive orient3d. Orthographic: the same filter, then
/// the determinant's 18 products as an exact expansion, since no representable point lies infinitely far away.
pub fn exact_signs(positions: &[DVec3; 4], viewpoint: Viewpoint) -> [Sign; 4] {
    FACES.map(|face| exact_face_sign(face.map(|corner| positions[corner]), viewpoint))
}

/// The exact sign of [`crate::face_volume`]: positive where the corners run clockwise as seen.
pub fn exact_face_sign(corners: [DVec3; 3], viewpoint: Viewpoint) -> Sign {
    let [p, q, r] = corners;
    match viewpoint {
        Viewpoint::Eye(eye) => Sign::of(robust::orient3d(coord(p), coord(q), coord(r), coord(eye))),
        Viewpoint::Direction(direction) => sign_along(corners, direction),
    }
}

/// The exact sign of a cell's volume; positive where 0, 1, 2 run clockwise seen from corner 3.
pub fn exact_orientation(positions: &[DVec3; 4]) -> Sign {
    let [p, q, r, s] = positions.map(coord);
    Sign::of(robust::orient3d(q, r, s, p))
}

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// The sign of `(q − p) × (r − p) · direction`.
fn sign_along([p, q, r]: [DVec3; 3], direction: DVec3) -> Sign {
    let (u, v) = (q - p, r - p);
    let (mut determinant, mut magnitude) = (0.0, 0.0);
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let (left, right) = (u[i] * v[j], u[j] * v[i]);
        determinant += direction[k] * (left - right);
        magnitude += direction[k].abs() * (left.abs() + right.abs());
    }
    // Shewchuk's bound for orient3d, (7 + 56 ε) ε with ε = 2^-53, holds here: one factor is given instead of subtracted.
    if determinant.abs() > 7.772e-16 * magnitude && magnitude > 1e-250 {
        return Sign::of(determinant);
    }
    let mut sum = Expansion::default();
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        for (s, t) in [(p, q), (q, r), (r, p)] {
            sum.add_product(s[i], t[j], direction[k]);
            sum.add_product(-s[j], t[i], direction[k]);
        }
    }
    sum.sign()
}

/// An exact sum of floats: nonoverlapping parts of ascending magnitude, none of them 0 ([Shewchuk 1997], grow-expansion).
struct Expansion {
    /// 18 products of three factors have four parts each.
    parts: [f64; 72],
    count: usize,
}

impl Default for Expansion {
    fn default() -> Self {
        Self { parts: [0.0; 72], count: 0 }
    }
}

impl Expansion {
    fn add_product(&mut self, x: f64, y: f64, z: f64) {
        let (high, low) = two_product(x, y);
        for factor in [low, high] {
            let (high, low) = two_product(factor, z);
            self.add(low);
            self.add(high);
        }
    }

    fn add(&mut self, value: f64) {
        let mut carry = value;
        let mut kept = 0;
        for i in 0..self.count {
            let (sum, error) = two_sum(carry, self.parts[i]);
            if error != 0.0 {
                self.parts[kept] = error;
                kept += 1;
            }
            carry = sum;
        }
        if carry != 0.0 {
            self.parts[kept] = carry;
            kept += 1;
        }
        self.count = kept;
    }

    fn sign(&self) -> Sign {
        Sign::of(if self.count == 0 { 0.0 } else { self.parts[self.count - 1] })
    }
}

/// A product as its rounded value and its error (fused multiply-add is exact before its one rounding).
fn two_product(x: f64, y: f64) -> (f64, f64) {
    let product = x * y;
    (product, x.mul_add(y, -product))
}

/// A sum as its rounded value and its error (Knuth).
fn two_sum(x: f64, y: f64) -> (f64, f64) {
    let sum = x + y;
    let y_seen = sum - x;
    (sum, (x - (sum - y_seen)) + (y - y_seen))
}
