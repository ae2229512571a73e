//! Where VTK has the points of second-order cells.

use tetrascope_mesh::CellKind;

/// For each point of a kind behind its corners, amid which corners it lies; nothing for linear kinds.
///
/// Source: the pictures of cells in VTK's description of its file formats.
pub(super) fn middles(kind: CellKind) -> &'static [&'static [u8]] {
    match kind {
        CellKind::QuadraticTetrahedron => &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]],
        CellKind::QuadraticHexahedron | CellKind::TriquadraticHexahedron => &[
            &[0, 1],
            &[1, 2],
            &[2, 3],
            &[3, 0],
            &[4, 5],
            &[5, 6],
            &[6, 7],
            &[7, 4],
            &[0, 4],
            &[1, 5],
            &[2, 6],
            &[3, 7],
            &[0, 3, 7, 4],
            &[1, 2, 6, 5],
            &[0, 1, 5, 4],
            &[3, 2, 6, 7],
            &[0, 1, 2, 3],
            &[4, 5, 6, 7],
            &[0, 1, 2, 3, 4, 5, 6, 7],
        ],
        CellKind::QuadraticWedge | CellKind::BiquadraticQuadraticWedge => &[
            &[0, 1],
            &[1, 2],
            &[2, 0],
            &[3, 4],
            &[4, 5],
            &[5, 3],
            &[0, 3],
            &[1, 4],
            &[2, 5],
            &[0, 1, 4, 3],
            &[1, 2, 5, 4],
            &[2, 0, 3, 5],
        ],
        CellKind::QuadraticPyramid => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 4], &[1, 4], &[2, 4], &[3, 4]],
        _ => &[],
    }
}
