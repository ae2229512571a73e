//! Gmsh's element types, and how their points stand in VTK's order.
//!
//! Source: the list of types and the node orderings of the Gmsh reference manual (section "MSH file format", "Node ordering").
//! Nodes come as corners, edges, faces, inside; what differs from VTK is in which order the edges and faces come.

use tetrascope_mesh::CellKind;

/// What a type's number stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementType {
    /// Nodes that an element of it names.
    pub(super) nodes: usize,
    /// What becomes of it.
    pub(super) kind: CellKind,
    /// For each point of the cell the node that it is; `None` where all stay in their order.
    pub(super) order: Option<&'static [u8]>,
    /// What is not kept of it.
    pub(super) loss: Loss,
}

/// What a cell lacks that its element has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Loss {
    /// Nothing.
    None,
    /// The middle of a pyramid's base, for which the cells have no place.
    BaseCenter,
    /// All but the corners: the element is of a higher order than two, or has a point inside.
    AllButCorners,
}

/// Numbers of the types whose elements have as many nodes as each says.
pub(super) const POLYGONS: [i64; 2] = [34, 69];

/// The number of Gmsh's polyhedron, which stands for a cut through another element.
pub(super) const POLYHEDRON: i64 = 35;

const TETRAHEDRON_10: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8];
const HEXAHEDRON_20: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15];
const HEXAHEDRON_27: &[u8] =
    &[0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26];
const WEDGE_15: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11];
const WEDGE_18: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16];
const PYRAMID_13: &[u8] = &[0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12];
const CORNERS: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7];

/// What a number stands for; nothing for numbers that Gmsh does not use, and for those whose elements differ in length.
pub(super) fn element_type(number: i64) -> Option<ElementType> {
    let whole = |nodes, kind| Some(ElementType { nodes, kind, order: None, loss: Loss::None });
    let turned = |nodes, kind, order| Some(ElementType { nodes, kind, order: Some(order), loss: Loss::None });
    match number {
        4 => whole(4, CellKind::Tetrahedron),
        5 => whole(8, CellKind::Hexahedron),
        6 => whole(6, CellKind::Wedge),
        7 => whole(5, CellKind::Pyramid),
        11 => turned(10, CellKind::QuadraticTetrahedron, TETRAHEDRON_10),
        12 => turned(27, CellKind::TriquadraticHexahedron, HEXAHEDRON_27),
        13 => turned(18, CellKind::BiquadraticQuadraticWedge, WEDGE_18),
        14 => {
            let (order, loss) = (Some(PYRAMID_13), Loss::BaseCenter);
            Some(ElementType { nodes: 14, kind: CellKind::QuadraticPyramid, order, loss })
        }
        17 => turned(20, CellKind::QuadraticHexahedron, HEXAHEDRON_20),
        18 => turned(15, CellKind::QuadraticWedge, WEDGE_15),
        19 => turned(13, CellKind::QuadraticPyramid, PYRAMID_13),
        8 => whole(3, CellKind::FlatOf(21)),
        9 => whole(6, CellKind::FlatOf(22)),
        10 => whole(9, CellKind::FlatOf(28)),
        16 => whole(8, CellKind::FlatOf(23)),
        _ => match (flat_nodes(number), higher_order(number)) {
            (Some(nodes), _) => whole(nodes, CellKind::Flat),
            (None, Some((nodes, kind, corners))) => {
                Some(ElementType { nodes, kind, order: CORNERS.get(..corners), loss: Loss::AllButCorners })
            }
            (None, None) => None,
        },
    }
}

/// Nodes of the types without a volume: points, lines, triangles, quadrilaterals of all orders, what stands for an element by one
/// node alone, and the flat four-sided joint between two triangles and a quadrilateral.
fn flat_nodes(number: i64) -> Option<usize> {
    Some(match number {
        15 | 84..=89 | 132 | 133 => 1,
        1 | 67 | 70 | 134 => 2,
        2 | 68 | 135 => 3,
        3 | 26 | 138 | 140 => 4,
        27 => 5,
        28 => 6,
        62 => 7,
        63 => 8,
        20 | 64 => 9,
        21 | 65 => 10,
        66 => 11,
        22 | 39 => 12,
        23 | 24 => 15,
        36 | 40 => 16,
        52 => 18,
        41 => 20,
        25 | 53 => 21,
        54 | 57 => 24,
        37 => 25,
        55 => 27,
        42 | 58 => 28,
        56 => 30,
        59 => 32,
        38 | 43 | 60 => 36,
        61 => 40,
        44 => 45,
        47 => 49,
        45 => 55,
        48 => 64,
        46 => 66,
        49 => 81,
        50 => 100,
        51 => 121,
        _ => return None,
    })
}

/// Nodes, linear kind and corners of the types beyond the second order, and of the tetrahedron with a bubble.
fn higher_order(number: i64) -> Option<(usize, CellKind, usize)> {
    let nodes = |first: i64, list: &[usize]| usize::try_from(number - first).ok().and_then(|i| list.get(i).copied());
    let found = match number {
        29..=33 => (nodes(29, &[20, 35, 56, 22, 28])?, CellKind::Tetrahedron, 4),
        71..=75 => (nodes(71, &[84, 120, 165, 220, 286])?, CellKind::Tetrahedron, 4),
        79..=83 => (nodes(79, &[34, 40, 46, 52, 58])?, CellKind::Tetrahedron, 4),
        137 => (16, CellKind::Tetrahedron, 4),
        139 => (5, CellKind::Tetrahedron, 4),
        90 | 91 => (nodes(90, &[40, 75])?, CellKind::Wedge, 6),
        92..=98 => (nodes(92, &[64, 125, 216, 343, 512, 729, 1000])?, CellKind::Hexahedron, 8),
        99..=105 => (nodes(99, &[32, 44, 56, 68, 80, 92, 104])?, CellKind::Hexahedron, 8),
        106..=110 => (nodes(106, &[126, 196, 288, 405, 550])?, CellKind::Wedge, 6),
        111..=117 => (nodes(111, &[24, 33, 42, 51, 60, 69, 78])?, CellKind::Wedge, 6),
        118..=124 => (nodes(118, &[30, 55, 91, 140, 204, 285, 385])?, CellKind::Pyramid, 5),
        125..=131 => (nodes(125, &[21, 29, 37, 45, 53, 61, 69])?, CellKind::Pyramid, 5),
        _ => return None,
    };
    Some(found)
}
