//! A mesh's chord along a ray, known without looking at its cells.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::view::Ray;

/// The triangles between the mesh and the outside, in world coordinates, wound so that their normals point out.
pub fn boundary(mesh: &TetMesh) -> Vec<[DVec3; 3]> {
    use std::collections::HashMap;
    let mut seen: HashMap<[u32; 3], Option<[DVec3; 3]>> = HashMap::new();
    for tet in mesh.tetrahedra() {
        for face in [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]] {
            let mut key = face.map(|c| tet[c].0);
            key.sort_unstable();
            let triangle = face.map(|c| mesh.frame().to_world(mesh.positions()[tet[c].index()]));
            // Seen twice: inside.
            seen.entry(key).and_modify(|t| *t = None).or_insert(Some(triangle));
        }
    }
    seen.into_values().flatten().collect()
}

/// Length of the part of a ray (from its start on) inside a closed boundary: where it comes out counts, where it goes in
/// counts against. `None` if it passes so near an edge of a triangle that rounding decides on which side.
pub fn chord(boundary: &[[DVec3; 3]], ray: &Ray) -> Option<f64> {
    let mut sum = 0.0;
    for &[a, b, c] in boundary {
        let normal = (b - a).cross(c - a);
        let speed = normal.dot(ray.direction);
        let t = normal.dot(a - ray.origin) / speed;
        // The ray's direction seen from the start: signed volumes with the three edges.
        let side = |p: DVec3, q: DVec3| ray.direction.dot((p - ray.origin).cross(q - ray.origin));
        let sides = [side(a, b), side(b, c), side(c, a)];
        let total: f64 = sides.iter().map(|s| s.abs()).sum();
        let inside = sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0);
        if sides.iter().any(|s| s.abs() < 1e-7 * total) && (t > 0.0) {
            let near = sides.iter().all(|&s| s >= -1e-7 * total) || sides.iter().all(|&s| s <= 1e-7 * total);
            if near {
                return None;
            }
        }
        if inside && t > 0.0 {
            sum += t * speed.signum();
        }
    }
    Some(sum * ray.direction.length())
}
