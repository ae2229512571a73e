//! Signs without rounding: on which side of a plane is a point, or the eye.

use glam::DVec3;
use robust::{Coord, Coord3D};
use tetrascope_view::Viewpoint;

/// The sign of `(a - p) · ((b - p) × (c - p))`: which side of the plane through `a`, `b`, `c` the point `p` is on.
///
/// Exact ([Shewchuk 1997]) while no product of three coordinates leaves 1e-250..1e300.
#[inline]
pub(crate) fn side_of(plane @ [a, b, c]: [DVec3; 3], p: DVec3) -> i8 {
    // The filter of `robust::orient3d`, here so that it is inlined: nearly all signs are settled by it.
    let [a, b, c] = [a - p, b - p, c - p];
    let (bc, ca, ab) = (b.x * c.y, c.x * a.y, a.x * b.y);
    let (cb, ac, ba) = (c.x * b.y, a.x * c.y, b.x * a.y);
    let determinant = a.z * (bc - cb) + b.z * (ca - ac) + c.z * (ab - ba);
    let permanent =
        a.z.abs() * (bc.abs() + cb.abs()) + b.z.abs() * (ca.abs() + ac.abs()) + c.z.abs() * (ab.abs() + ba.abs());
    if determinant.abs() > 7.772e-16 * permanent && permanent > 1e-250 {
        return sign(determinant);
    }
    exact_side_of(plane, p)
}

#[cold]
fn exact_side_of(plane: [DVec3; 3], p: DVec3) -> i8 {
    sign(signed_volume(plane, p))
}

/// The number whose sign [`side_of`] gives: six times a volume, of which the sign is exact and the rest nearly so.
#[inline]
pub(crate) fn signed_volume([a, b, c]: [DVec3; 3], p: DVec3) -> f64 {
    // Faces share points, and planes across axes hold many: the adaptive predicate takes its longest way to these
    // zeros.
    if p == a || p == b || p == c || (0..3).any(|i| a[i] == p[i] && b[i] == p[i] && c[i] == p[i]) {
        return 0.0;
    }
    robust::orient3d(coord(a), coord(b), coord(c), coord(p))
}

/// The side of the plane through three points that the eye is on; in a parallel view it lies infinitely far against the
/// direction. 0 where the plane is seen edge-on. The signs are those of [`side_of`].
#[inline]
pub(crate) fn eye_side(points: [DVec3; 3], viewpoint: Viewpoint) -> i8 {
    let [a, b, c] = points;
    if a == b || b == c || c == a {
        return 0;
    }
    match viewpoint {
        Viewpoint::Eye(eye) => side_of(points, eye),
        Viewpoint::Direction(direction) => side_along(points, direction),
    }
}

/// 1, 0 or -1; 0 for NaN too.
#[inline]
pub(crate) fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}

fn coord(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// The sign of `direction · ((b - a) × (c - a))`.
fn side_along([a, b, c]: [DVec3; 3], direction: DVec3) -> i8 {
    // Along an axis, where many faces are seen edge-on, two coordinates decide.
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        if direction[i] == 0.0 && direction[j] == 0.0 {
            let [a, b, c] = [a, b, c].map(|p| Coord { x: p[i], y: p[j] });
            return sign(robust::orient2d(a, b, c)) * sign(direction[k]);
        }
    }
    let (u, v) = (b - a, c - a);
    let (mut determinant, mut magnitude) = (0.0, 0.0);
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let (left, right) = (u[i] * v[j], u[j] * v[i]);
        determinant += direction[k] * (left - right);
        magnitude += direction[k].abs() * (left.abs() + right.abs());
    }
    // Shewchuk's bound for the same determinant of four points, (7 + 56 ε) ε with ε = 2⁻⁵³: here one factor less is
    // rounded.
    if determinant.abs() > 7.772e-16 * magnitude && magnitude > 1e-250 {
        return sign(determinant);
    }
    // The differences are expanded, so that what is summed are products of given numbers.
    let mut parts = Vec::with_capacity(72);
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        for (s, t) in [(a, b), (b, c), (c, a)] {
            add_product(&mut parts, s[i], t[j], direction[k]);
            add_product(&mut parts, -s[j], t[i], direction[k]);
        }
    }
    sign(parts.last().copied().unwrap_or(0.0))
}

/// Adds a product of three to an exact sum: nonoverlapping parts, ascending in magnitude, none of them 0.
fn add_product(parts: &mut Vec<f64>, x: f64, y: f64, z: f64) {
    let (high, low) = two_product(x, y);
    for factor in [low, high] {
        let (high, low) = two_product(factor, z);
        add(parts, low);
        add(parts, high);
    }
}

/// Grow-expansion of [Shewchuk 1997], which drops the parts that become 0.
fn add(parts: &mut Vec<f64>, value: f64) {
    let mut carry = value;
    parts.retain_mut(|part| {
        let sum = carry + *part;
        let part_seen = sum - carry;
        let error = (carry - (sum - part_seen)) + (*part - part_seen);
        carry = sum;
        *part = error;
        error != 0.0
    });
    if carry != 0.0 {
        parts.push(carry);
    }
}

/// A product as its rounded value and its error.
fn two_product(x: f64, y: f64) -> (f64, f64) {
    let product = x * y;
    (product, x.mul_add(y, -product))
}
