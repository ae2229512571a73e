//! VTK's cell type numbers.
//!
//! Source: the list of cell types in VTK's public header `vtkCellType.h`, whose numbers both file formats store.

use tetrascope_mesh::CellKind;

/// The number of VTK's polyhedron, whose faces are stored apart.
pub(crate) const POLYHEDRON: i64 = 42;

/// The kind that a type number stands for.
///
/// Points, lines and faces of any order are [`CellKind::Flat`], and so is the empty cell (0). Cells with a volume that
/// are not told apart (Lagrange, Bézier, convex point sets) and numbers that VTK does not use are [`CellKind::Other`].
/// Nothing for numbers that do not fit into a byte, as VTK stores types in one.
pub(crate) fn kind_of(number: i64) -> Option<CellKind> {
    Some(match u8::try_from(number).ok()? {
        10 => CellKind::Tetrahedron,
        11 => CellKind::Voxel,
        12 => CellKind::Hexahedron,
        13 => CellKind::Wedge,
        14 => CellKind::Pyramid,
        15 => CellKind::PentagonalPrism,
        16 => CellKind::HexagonalPrism,
        24 => CellKind::QuadraticTetrahedron,
        25 => CellKind::QuadraticHexahedron,
        26 => CellKind::QuadraticWedge,
        27 => CellKind::QuadraticPyramid,
        29 => CellKind::TriquadraticHexahedron,
        31 => CellKind::QuadraticLinearWedge,
        32 => CellKind::BiquadraticQuadraticWedge,
        33 => CellKind::BiquadraticQuadraticHexahedron,
        42 => CellKind::Polyhedron,
        // 0 to 9: empty, vertices, lines, triangles, polygons, pixel, quad. 21 to 23, 28, 30, 34 to 36: second-order
        // edge, triangle, quad, biquadratic quad, quadratic-linear quad, biquadratic triangle, cubic line, quadratic
        // polygon. 51 to 54 parametric, 60 to 63 higher-order, 68 to 70 Lagrange, 75 to 77 Bézier curves and faces.
        0..=9 | 21..=23 | 28 | 30 | 34..=36 | 51..=54 | 60..=63 | 68..=70 | 75..=77 => CellKind::Flat,
        other => CellKind::Other(other),
    })
}

/// The number that [`kind_of`] takes for a kind; nothing for polyhedra and for what several numbers stand for.
pub(crate) fn number_of(kind: CellKind) -> Option<u8> {
    match kind {
        CellKind::Polyhedron | CellKind::Flat => None,
        CellKind::FlatOf(number) | CellKind::Other(number) => Some(number),
        _ => (10..=33).find(|&number| kind_of(number.into()) == Some(kind)),
    }
}

/// The number of the plain point, line or face with so many points, and of the empty cell; nothing where several have as many.
pub(crate) fn number_of_flat(points: usize) -> Option<u8> {
    [0, 1, 3, 5, 9].get(points).copied()
}

/// How many points a cell of this kind has; nothing where the number varies or is not known.
pub(crate) fn point_count_of(kind: CellKind) -> Option<usize> {
    Some(match kind {
        CellKind::Tetrahedron => 4,
        CellKind::Pyramid => 5,
        CellKind::Wedge => 6,
        CellKind::Voxel | CellKind::Hexahedron => 8,
        CellKind::PentagonalPrism | CellKind::QuadraticTetrahedron => 10,
        CellKind::HexagonalPrism | CellKind::QuadraticLinearWedge => 12,
        CellKind::QuadraticPyramid => 13,
        CellKind::QuadraticWedge => 15,
        CellKind::BiquadraticQuadraticWedge => 18,
        CellKind::QuadraticHexahedron => 20,
        CellKind::BiquadraticQuadraticHexahedron => 24,
        CellKind::TriquadraticHexahedron => 27,
        CellKind::Polyhedron | CellKind::Flat | CellKind::FlatOf(_) | CellKind::Other(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_and_their_point_counts() {
        for (number, kind, points) in [
            (10, CellKind::Tetrahedron, Some(4)),
            (11, CellKind::Voxel, Some(8)),
            (15, CellKind::PentagonalPrism, Some(10)),
            (16, CellKind::HexagonalPrism, Some(12)),
            (24, CellKind::QuadraticTetrahedron, Some(10)),
            (29, CellKind::TriquadraticHexahedron, Some(27)),
            (33, CellKind::BiquadraticQuadraticHexahedron, Some(24)),
            (POLYHEDRON, CellKind::Polyhedron, None),
            (5, CellKind::Flat, None),
            (22, CellKind::Flat, None),
            (70, CellKind::Flat, None),
            (56, CellKind::Other(56), None),
            (71, CellKind::Other(71), None),
            (250, CellKind::Other(250), None),
        ] {
            assert_eq!(kind_of(number), Some(kind), "type {number}");
            assert_eq!(point_count_of(kind), points, "type {number}");
            if kind != CellKind::Flat && kind != CellKind::Polyhedron {
                assert_eq!(number_of(kind).map(i64::from), Some(number));
            }
        }
        assert_eq!(kind_of(256), None);
        assert_eq!(kind_of(-1), None);
    }
}
