//! A mesh's chord along a ray, known without looking at its cells.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use tetrascope::mesh::TetMesh;
use tetrascope::view::{Ray, View};

/// The triangles between the mesh and the outside, in world coordinates, wound so that their normals point out.
pub fn boundary(mesh: &TetMesh) -> Vec<[DVec3; 3]> {
    boundary_faces(mesh).into_iter().map(|face| face.map(|v| world(mesh, v))).collect()
}

/// The same triangles as point indices, in a fixed order.
pub fn boundary_faces(mesh: &TetMesh) -> Vec<[u32; 3]> {
    let mut seen: HashMap<[u32; 3], Option<[u32; 3]>> = HashMap::new();
    for tet in mesh.tetrahedra() {
        for face in [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]] {
            let face = face.map(|c: usize| tet[c].0);
            let mut key = face;
            key.sort_unstable();
            // Seen twice: inside.
            seen.entry(key).and_modify(|t| *t = None).or_insert(Some(face));
        }
    }
    let mut faces: Vec<[u32; 3]> = seen.into_values().flatten().collect();
    faces.sort_unstable();
    faces
}

/// World coordinates of a point of a mesh.
pub fn world(mesh: &TetMesh, point: u32) -> DVec3 {
    mesh.frame().to_world(mesh.positions()[point as usize])
}

/// How near to an edge of a triangle, relative to the triangle, a ray counts as meeting the edge: far above rounding here and
/// in the renderers (some 1e-12), and still a strip that hardly any pixel falls into.
const AT_EDGE: f64 = 1e-9;
/// The same relative to the distance of the ray's start: some ulps.
const ROUNDING: f64 = 4e-15;

/// Length of the part of a ray (from its start on) inside a closed boundary: where it comes out counts, where it goes in
/// counts against.
///
/// `None` if it passes so near an edge of a triangle that rounding decides on which side, or runs in a triangle's plane.
/// The start may lie on the boundary: triangles through it count nothing.
pub fn chord(boundary: &[[DVec3; 3]], ray: &Ray) -> Option<f64> {
    let forward = ray.direction.normalize();
    let (right, up) = forward.any_orthonormal_pair();
    let mut sum = 0.0;
    for triangle in boundary {
        let from_start = triangle.map(|p| p - ray.origin);
        let size = (triangle[1] - triangle[0]).length().max((triangle[2] - triangle[0]).length());
        // Before the ray, which is the origin; `right`, `up`, `forward` is right-handed, so that a triangle that runs
        // counterclockwise has its outer side ahead.
        let [a, b, c] = from_start.map(|p| DVec2::new(right.dot(p), up.dot(p)));
        let depths = from_start.map(|p| forward.dot(p));
        if depths.iter().all(|&d| d <= 1e-9 * size) {
            continue;
        }
        let reach = from_start.iter().fold(0.0_f64, |m, p| m.max(p.length()));
        let rounding = ROUNDING * reach;
        let (low, high) = (a.min(b).min(c) - rounding, a.max(b).max(c) + rounding);
        if low.x > 0.0 || low.y > 0.0 || high.x < 0.0 || high.y < 0.0 {
            continue;
        }
        let sides = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)];
        let total: f64 = sides.iter().sum();
        let limit = AT_EDGE * total.abs() + rounding * (b - a).length().max((c - a).length());
        if total.abs() <= limit {
            // Edge-on, and the ray may be in it.
            return None;
        }
        let turn = total.signum();
        if sides.iter().any(|s| s * turn < -limit) {
            continue;
        }
        let depth = (sides[0] * depths[0] + sides[1] * depths[1] + sides[2] * depths[2]) / total;
        if depth <= 1e-9 * size {
            continue;
        }
        if sides.iter().any(|s| s * turn <= limit) {
            return None;
        }
        sum += depth * turn;
    }
    Some(sum)
}

/// The chord of every pixel's ray, row after row.
pub fn chords(boundary: &[[DVec3; 3]], view: &View) -> Vec<Option<f64>> {
    let pixels = (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y)));
    pixels.map(|(x, y)| chord(boundary, &view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5))).collect()
}

/// Length of a ray, from its start on, inside an axis-aligned box: zero if it misses.
pub fn chord_of_box(lowest: DVec3, highest: DVec3, ray: &Ray) -> f64 {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        if direction == 0.0 {
            if origin < lowest[axis] || origin > highest[axis] {
                return 0.0;
            }
            continue;
        }
        let [s, t] = [(lowest[axis] - origin) / direction, (highest[axis] - origin) / direction];
        enter = enter.max(s.min(t));
        leave = leave.min(s.max(t));
    }
    (leave - enter).max(0.0) * ray.direction.length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::meshes::grid;

    /// Both ways to know a chord agree on a box, from outside, from a corner and from inside.
    #[test]
    fn chords_of_a_box() {
        let mesh = grid([2, 1, 1], DVec3::ZERO, 1.0).mesh;
        let triangles = boundary(&mesh);
        assert_eq!(triangles.len(), 20);
        let direction = DVec3::new(0.31, 0.12, -1.0);
        for origin in [DVec3::new(0.6, 0.3, 4.0), DVec3::new(0.5, 0.2, 1.0), DVec3::new(0.7, 0.6, 0.4)] {
            let ray = Ray { origin, direction };
            let expected = chord_of_box(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), &ray);
            let found = chord(&triangles, &ray).unwrap();
            assert!((found - expected).abs() < 1e-12, "{origin}: {found} instead of {expected}");
        }
        let corner = Ray { origin: DVec3::new(0.0, 0.0, 1.0), direction: DVec3::new(0.3, 0.2, -1.0) };
        assert!((chord(&triangles, &corner).unwrap() - DVec3::new(0.3, 0.2, 1.0).length()).abs() < 1e-12);
        assert!(chord(&triangles, &Ray { origin: DVec3::new(1.0, 0.5, 3.0), direction: DVec3::NEG_Z }).is_none());
    }
}
