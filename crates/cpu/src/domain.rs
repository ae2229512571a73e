//! What a table of the integration has to cover for a mesh and a field.

use tetrascope_integrate::TableDomain;
use tetrascope_mesh::{TetMesh, chord_lengths};

/// Scalars and chord lengths that rays through a mesh have.
///
/// - `scalars`: one a point of the mesh, finite where a tetrahedron uses it
///
/// Points that no tetrahedron uses do not count. Lengths are the world's. `None` if no tetrahedron has a volume that f64
/// can hold: then there is no segment to look up.
pub(crate) fn table_domain(mesh: &TetMesh, scalars: &[f64]) -> Option<TableDomain> {
    let lengths = chord_lengths(mesh)?;
    Some(TableDomain { scalars: scalar_range(mesh, scalars)?, mean_length: lengths.mean, max_length: lengths.longest })
}

/// Lowest and highest scalar of the points that tetrahedra use; `None` if there is no tetrahedron.
pub(crate) fn scalar_range(mesh: &TetMesh, scalars: &[f64]) -> Option<[f64; 2]> {
    mesh.tetrahedra()
        .iter()
        .flatten()
        .map(|vertex| scalars[vertex.index()])
        .map(|scalar| [scalar, scalar])
        .reduce(|[low, high], [scalar, _]| [low.min(scalar), high.max(scalar)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn only_points_in_use_count() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(1e3), DVec3::ONE];
        let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3], [1, 2, 3, 5]]).unwrap().mesh;
        let domain = table_domain(&mesh, &[2.0, -1.0, 0.5, 3.0, f64::NAN, 0.0]).unwrap();
        assert_eq!(domain.scalars, [-1.0, 3.0]);
        assert!((domain.max_length - 2.0_f64.sqrt()).abs() < 1e-15, "{domain:?}");
        assert!(domain.mean_length > 0.0 && domain.mean_length < domain.max_length, "{domain:?}");
        let empty = mesh.retain(|_| false);
        assert_eq!(table_domain(&empty, &[0.0; 6]), None);
    }
}
