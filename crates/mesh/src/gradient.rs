//! Gradients of a scalar at the points of a mesh.

use glam::DVec3;

use crate::{TetMesh, VertexId};

/// The gradient of a field at every point: the mean of the constant gradients of the tetrahedra around it, weighted by
/// their volumes.
///
/// - `scalars`: one a point of the mesh; where one is missing or not finite, the tetrahedra there do not take part
///
/// One vector a point, in field units per world length. Exact but for rounding where the field is linear, also in
/// slivers: a tetrahedron adds its gradient times its volume, which needs no division by a small number. Points that
/// no such tetrahedron uses get zero.
pub fn vertex_gradients(mesh: &TetMesh, scalars: &[f64]) -> Vec<DVec3> {
    let scale = mesh.frame().scale;
    let mut gradients = point_gradients(mesh.positions(), mesh.tetrahedra(), scalars);
    for gradient in &mut gradients {
        *gradient /= scale;
    }
    gradients
}

/// [`vertex_gradients`] of tetrahedra that are no [`TetMesh`]: their corners may go round either way.
///
/// In field units per unit of the positions.
pub fn point_gradients(positions: &[DVec3], tetrahedra: &[[VertexId; 4]], scalars: &[f64]) -> Vec<DVec3> {
    // In units of a power of two near the largest scalar, so that differences of huge values stay finite.
    let largest = scalars.iter().filter(|s| s.is_finite()).fold(0.0_f64, |largest, s| largest.max(s.abs()));
    let unit = if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 };
    let scalar = |vertex: usize| scalars.get(vertex).map_or(f64::NAN, |s| s / unit);

    // Per point: the sum of gradient × 6 volume, and of 6 volume.
    let mut sums = vec![(DVec3::ZERO, 0.0); positions.len()];
    for tetrahedron in tetrahedra {
        let corners = tetrahedron.map(|v| positions[v.index()]);
        let values = tetrahedron.map(|v| scalar(v.index()));
        if !values.iter().all(|s| s.is_finite()) {
            continue;
        }
        let [a, b, c] = [1, 2, 3].map(|n| corners[n] - corners[0]);
        let [da, db, dc] = [1, 2, 3].map(|n| values[n] - values[0]);
        let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
        let gradient_times_volume6 = bc * da + ca * db + ab * dc;
        let volume6 = a.dot(bc);
        // Both turn their sign with the order of the corners.
        let sign = volume6.signum();
        for vertex in tetrahedron {
            let (gradients, volumes) = &mut sums[vertex.index()];
            *gradients += gradient_times_volume6 * sign;
            *volumes += volume6 * sign;
        }
    }
    let mean = |(gradients, volumes): (DVec3, f64)| {
        if volumes > 0.0 { gradients / volumes * unit } else { DVec3::ZERO }
    };
    sums.into_iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CellId, decompose, rings_sample};

    #[test]
    fn linear_fields_have_their_gradient_at_every_scale() {
        let gradient = DVec3::new(1.5, -2.0, 0.25);
        for (scale, offset) in [(1.0, 0.0), (1e-9, 0.0), (1e20, 0.0), (1.0, 5e3), (1e200, 0.0)] {
            let mut dataset = rings_sample(6);
            for point in &mut dataset.points {
                *point = *point * scale + DVec3::splat(offset);
            }
            let scalars: Vec<f64> = dataset.points.iter().map(|p| gradient.dot(*p / scale) + 3.0).collect();
            let mesh = decompose(&dataset).expect("the sample is good").mesh;
            for found in vertex_gradients(&mesh, &scalars) {
                let error = (found * scale - gradient).length();
                // Rounding of the coordinates alone moves it by ulp(offset) / (size of a cell).
                assert!(error < 1e-11 + offset * 1e-14, "{found} at scale {scale}: {error}");
            }
        }
    }

    #[test]
    fn points_without_a_finite_cell_get_zero() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::splat(9.0)];
        let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3], [1, 2, 3, 4]]).expect("two tetrahedra").mesh;
        let found = vertex_gradients(&mesh, &[f64::NAN, 0.0, 0.0, 0.0, 2.0, 1.0]);
        assert_eq!(found[0], DVec3::ZERO);
        assert_eq!(found[5], DVec3::ZERO);
        assert!((found[4] - DVec3::ONE).length() < 1e-14, "{}", found[4]);
        assert_eq!(mesh.corners(CellId(0)).len(), 4);
    }

    #[test]
    fn huge_scalars_stay_finite() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).expect("a tetrahedron").mesh;
        let found = vertex_gradients(&mesh, &[-8e307, 8e307, -8e307, -8e307]);
        assert!((found[0] / 1.6e308 - DVec3::X).length() < 1e-14, "{}", found[0]);
    }
}
