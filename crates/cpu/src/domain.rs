//! What a field has on a mesh.

use tetrascope_mesh::TetMesh;

/// Lowest and highest scalar of the points that tetrahedra use; `None` if there is no tetrahedron.
pub(crate) fn scalar_range(mesh: &TetMesh, scalars: &[f64]) -> Option<[f64; 2]> {
    mesh.tetrahedra()
        .iter()
        .flatten()
        .map(|vertex| scalars[vertex.index()])
        .map(|scalar| [scalar, scalar])
        .reduce(|[low, high], [scalar, _]| [low.min(scalar), high.max(scalar)])
}
