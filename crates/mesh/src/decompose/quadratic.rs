//! How quadratic cells fall into linear ones along their mid-edge points.
//!
//! Every quadrilateral face is cut in four at its center and every triangular one in four at its mid-edge points, so
//! neighbors of any kind agree. Where the kind has no point at the center of a face or of a hexahedron, one is added.

use super::linear::{Faces, HEXAHEDRON, PYRAMID, TETRAHEDRON, WEDGE};
use super::sink::Winding;
use crate::CellKind;

/// A quadrilateral face of a quadratic cell, as slots.
pub(super) struct QuadFace {
    /// The slot of its center.
    pub(super) center: u8,
    /// Its corners, in turn.
    pub(super) corners: [u8; 4],
    /// The points amid its edges, the first between the first two corners.
    pub(super) mids: [u8; 4],
}

/// How one kind is cut. Slots below `own` are the cell's points; those from there on are added.
pub(super) struct Recipe {
    /// Number of points that the kind has.
    pub(super) own: usize,
    /// Number of slots.
    pub(super) slots: usize,
    /// Its quadrilateral faces.
    pub(super) faces: &'static [QuadFace],
    /// Whether the last slot is the center of a hexahedron.
    pub(super) has_center: bool,
    /// The linear cells: their faces, and their points as slots.
    pub(super) parts: &'static [(Faces, &'static [u8])],
    /// Whether the order of points fixes the orientation.
    pub(super) winding: Winding,
}

/// The most slots of a recipe.
pub(super) const MOST_SLOTS: usize = 27;

/// The recipe of a quadratic kind.
pub(super) fn recipe(kind: CellKind) -> Option<&'static Recipe> {
    match kind {
        CellKind::QuadraticTetrahedron => Some(&TETRAHEDRON_10),
        CellKind::QuadraticHexahedron => Some(&HEXAHEDRON_20),
        CellKind::BiquadraticQuadraticHexahedron => Some(&HEXAHEDRON_24),
        CellKind::TriquadraticHexahedron => Some(&HEXAHEDRON_27),
        CellKind::QuadraticWedge => Some(&WEDGE_15),
        CellKind::BiquadraticQuadraticWedge => Some(&WEDGE_18),
        CellKind::QuadraticLinearWedge => Some(&WEDGE_12),
        CellKind::QuadraticPyramid => Some(&PYRAMID_13),
        _ => None,
    }
}

/// The octahedron amid a quadratic tetrahedron; its points are the tetrahedron's mid-edge points in their order.
/// Coned from its point of smallest index, so the diagonal depends on the cell's indices alone.
const OCTAHEDRON: Faces =
    &[&[2, 1, 0], &[0, 4, 3], &[1, 5, 4], &[2, 3, 5], &[0, 3, 2], &[0, 1, 4], &[2, 5, 1], &[3, 4, 5]];

static TETRAHEDRON_10: Recipe = Recipe {
    own: 10,
    slots: 10,
    faces: &[],
    has_center: false,
    parts: &[
        (TETRAHEDRON, &[0, 4, 6, 7]),
        (TETRAHEDRON, &[4, 1, 5, 8]),
        (TETRAHEDRON, &[6, 5, 2, 9]),
        (TETRAHEDRON, &[7, 8, 9, 3]),
        (OCTAHEDRON, &[4, 5, 6, 7, 8, 9]),
    ],
    winding: Winding::Fixed,
};

/// Slots of hexahedra are the 27 points of the triquadratic one: corners, edges, faces (x low, x high, y low, y high,
/// z low, z high), center.
const HEXAHEDRON_FACES: &[QuadFace] = &[
    QuadFace { center: 20, corners: [0, 3, 7, 4], mids: [11, 19, 15, 16] },
    QuadFace { center: 21, corners: [1, 2, 6, 5], mids: [9, 18, 13, 17] },
    QuadFace { center: 22, corners: [0, 1, 5, 4], mids: [8, 17, 12, 16] },
    QuadFace { center: 23, corners: [3, 2, 6, 7], mids: [10, 18, 14, 19] },
    QuadFace { center: 24, corners: [0, 1, 2, 3], mids: [8, 9, 10, 11] },
    QuadFace { center: 25, corners: [4, 5, 6, 7], mids: [12, 13, 14, 15] },
];

const HEXAHEDRON_PARTS: &[(Faces, &[u8])] = &[
    (HEXAHEDRON, &[0, 8, 24, 11, 16, 22, 26, 20]),
    (HEXAHEDRON, &[8, 1, 9, 24, 22, 17, 21, 26]),
    (HEXAHEDRON, &[11, 24, 10, 3, 20, 26, 23, 19]),
    (HEXAHEDRON, &[24, 9, 2, 10, 26, 21, 18, 23]),
    (HEXAHEDRON, &[16, 22, 26, 20, 4, 12, 25, 15]),
    (HEXAHEDRON, &[22, 17, 21, 26, 12, 5, 13, 25]),
    (HEXAHEDRON, &[20, 26, 23, 19, 15, 25, 14, 7]),
    (HEXAHEDRON, &[26, 21, 18, 23, 25, 13, 6, 14]),
];

const fn hexahedron(own: usize) -> Recipe {
    Recipe {
        own,
        slots: 27,
        faces: HEXAHEDRON_FACES,
        has_center: true,
        parts: HEXAHEDRON_PARTS,
        winding: Winding::Fixed,
    }
}

static HEXAHEDRON_20: Recipe = hexahedron(20);
static HEXAHEDRON_24: Recipe = hexahedron(24);
static HEXAHEDRON_27: Recipe = hexahedron(27);

/// Slots of wedges are the 18 points of the biquadratic one.
const WEDGE_FACES: &[QuadFace] = &[
    QuadFace { center: 15, corners: [0, 1, 4, 3], mids: [6, 13, 9, 12] },
    QuadFace { center: 16, corners: [1, 2, 5, 4], mids: [7, 14, 10, 13] },
    QuadFace { center: 17, corners: [2, 0, 3, 5], mids: [8, 12, 11, 14] },
];

const WEDGE_PARTS: &[(Faces, &[u8])] = &[
    (WEDGE, &[0, 6, 8, 12, 15, 17]),
    (WEDGE, &[6, 1, 7, 15, 13, 16]),
    (WEDGE, &[8, 7, 2, 17, 16, 14]),
    (WEDGE, &[6, 7, 8, 15, 16, 17]),
    (WEDGE, &[12, 15, 17, 3, 9, 11]),
    (WEDGE, &[15, 13, 16, 9, 4, 10]),
    (WEDGE, &[17, 16, 14, 11, 10, 5]),
    (WEDGE, &[15, 16, 17, 9, 10, 11]),
];

const fn wedge(own: usize) -> Recipe {
    Recipe { own, slots: 18, faces: WEDGE_FACES, has_center: false, parts: WEDGE_PARTS, winding: Winding::Either }
}

static WEDGE_15: Recipe = wedge(15);
static WEDGE_18: Recipe = wedge(18);

/// Quadratic along the triangles, linear between them: four wedges.
static WEDGE_12: Recipe = Recipe {
    own: 12,
    slots: 12,
    faces: &[],
    has_center: false,
    parts: &[
        (WEDGE, &[0, 6, 8, 3, 9, 11]),
        (WEDGE, &[6, 1, 7, 9, 4, 10]),
        (WEDGE, &[8, 7, 2, 11, 10, 5]),
        (WEDGE, &[6, 7, 8, 9, 10, 11]),
    ],
    winding: Winding::Either,
};

/// Six pyramids and four tetrahedra.
static PYRAMID_13: Recipe = Recipe {
    own: 13,
    slots: 14,
    faces: &[QuadFace { center: 13, corners: [0, 1, 2, 3], mids: [5, 6, 7, 8] }],
    has_center: false,
    parts: &[
        (PYRAMID, &[0, 5, 13, 8, 9]),
        (PYRAMID, &[1, 6, 13, 5, 10]),
        (PYRAMID, &[2, 7, 13, 6, 11]),
        (PYRAMID, &[3, 8, 13, 7, 12]),
        (PYRAMID, &[9, 10, 11, 12, 4]),
        (PYRAMID, &[12, 11, 10, 9, 13]),
        (TETRAHEDRON, &[5, 10, 13, 9]),
        (TETRAHEDRON, &[6, 11, 13, 10]),
        (TETRAHEDRON, &[7, 12, 13, 11]),
        (TETRAHEDRON, &[8, 9, 13, 12]),
    ],
    winding: Winding::Fixed,
};
