//! A mesh's chord along a ray, known without looking at its cells.

use std::collections::HashMap;

use glam::DVec3;
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

/// How near to an edge of a triangle, relative to the triangle's size, a ray counts as meeting the edge: far above the
/// rounding here and in the renderers (some 1e-12), and still a strip that hardly any pixel falls into.
const AT_EDGE: f64 = 1e-7;

/// Length of the part of a ray (from its start on) inside a closed boundary: where it comes out counts, where it goes in
/// counts against.
///
/// `None` if it passes so near an edge of a triangle that rounding decides on which side, or runs in a triangle's plane.
/// The start may lie on the boundary: triangles through it count nothing.
pub fn chord(boundary: &[[DVec3; 3]], ray: &Ray) -> Option<f64> {
    let length = ray.direction.length();
    let mut sum = 0.0;
    for triangle in boundary {
        let [a, b, c] = *triangle;
        let normal = (b - a).cross(c - a);
        let speed = normal.dot(ray.direction);
        let size = (b - a).length().max((c - a).length()).max((c - b).length());
        // Measured from the point of the ray beside the triangle, so that a far eye costs no digits.
        let beside = (a - ray.origin).dot(ray.direction) / (length * length);
        let origin = ray.origin + beside * ray.direction;
        let t = beside + normal.dot(a - origin) / speed;
        let side = |p: DVec3, q: DVec3| ray.direction.dot((p - origin).cross(q - origin));
        let sides = [side(a, b), side(b, c), side(c, a)];
        let total: f64 = sides.iter().map(|s| s.abs()).sum();
        if total <= AT_EDGE * length * size * size {
            // Edge-on, and the ray is in its plane near the triangle.
            if beside * length > -2.0 * size {
                return None;
            }
            continue;
        }
        if t.is_nan() || t * length <= 1e-9 * size {
            continue;
        }
        let limit = AT_EDGE * total;
        if sides.iter().any(|s| s.abs() < limit)
            && (sides.iter().all(|&s| s >= -limit) || sides.iter().all(|&s| s <= limit))
        {
            return None;
        }
        if sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0) {
            sum += t * speed.signum();
        }
    }
    Some(sum * length)
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
