//! Exodus's names of element types, and where its orders of nodes are not VTK's.
//!
//! Sources: L. A. Schoof, V. R. Yarberry, "EXODUS II: A Finite Element Data Model", SAND92-2137, figure 1 (nodes of elements); the types
//! that came after it as `vtkExodusIIReader` of VTK 9.7 and the SEACAS library name them.

/// How an element becomes a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Element {
    /// VTK's number of the kind of cell.
    pub(super) vtk_type: i64,
    /// For each point of the cell the element's node, where they are not in the same order.
    order: Option<&'static [u8]>,
    /// Points of the cell.
    points: usize,
    /// Whether nodes of the element are left out because VTK has no kind with them.
    pub(super) is_reduced: bool,
}

/// VTK's empty cell, for what has no volume and as many nodes as tell what it is, or a number of them that is not known.
const EMPTY: i64 = 0;

/// Exodus has the edges between bottom and top before those of the top; VTK has them last.
const HEXAHEDRON_20: [u8; 20] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15];
/// Behind the edges Exodus has the center, then the faces -z, +z, -x, +x, -y, +y; VTK has -x, +x, -y, +y, -z, +z and the center last.
const HEXAHEDRON_27: [u8; 27] =
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15, 23, 24, 25, 26, 21, 22, 20];
const WEDGE_15: [u8; 15] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11];
/// Both have the quadrilateral faces last, and in the same order.
const WEDGE_18: [u8; 18] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11, 15, 16, 17];

impl Element {
    /// By the type's name and its number of nodes; nothing where the type is not known.
    ///
    /// The number of nodes decides within a family, since the number in the name is often left out.
    pub(super) fn of(name: &str, nodes: usize) -> Option<Self> {
        let name = name.trim().to_ascii_uppercase();
        let begins = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
        // From the most nodes to the fewest: VTK's type, its number of points, the order.
        let family: &[(i64, usize, Option<&'static [u8]>)] = if begins(&["TET"]) {
            &[(24, 10, None), (10, 4, None)]
        } else if begins(&["HEX"]) {
            &[(29, 27, Some(&HEXAHEDRON_27)), (25, 20, Some(&HEXAHEDRON_20)), (12, 8, None)]
        } else if begins(&["WED", "PRI", "PEN"]) {
            &[(32, 18, Some(&WEDGE_18)), (26, 15, Some(&WEDGE_15)), (31, 12, None), (13, 6, None)]
        } else if begins(&["PYR"]) {
            &[(27, 13, None), (14, 5, None)]
        } else if begins(&[
            "CIR", "SPH", "BAR", "TRU", "BEA", "ROD", "EDG", "LIN", "SPR", "TRI", "QUA", "SHE", "POI", "NSI",
        ]) {
            return Some(Self { vtk_type: flat_type(&name, nodes), order: None, points: nodes, is_reduced: false });
        } else {
            return None;
        };
        // What lies between two kinds may have its nodes anywhere but at the corners: 16 nodes of a hexahedron, 20 of a wedge.
        let fits = |kind: &&(i64, usize, Option<&'static [u8]>)| has_first_nodes_of(&name, nodes, kind.1);
        let &(vtk_type, points, order) = family.iter().find(fits)?;
        Some(Self { vtk_type, order, points, is_reduced: points < nodes })
    }

    /// The nodes of an element in VTK's order.
    pub(super) fn cell(&self, nodes: &[i64], cell: &mut Vec<i64>) {
        cell.clear();
        match self.order {
            Some(order) => cell.extend(order.iter().filter_map(|&node| nodes.get(usize::from(node)))),
            None => cell.extend(nodes.iter().take(self.points)),
        }
    }
}

/// VTK's number for what has no volume. Of the second order both have the nodes amid edges in the order of the edges, and the center last.
fn flat_type(name: &str, nodes: usize) -> i64 {
    let is_line = ["BAR", "TRU", "BEA", "ROD", "EDG", "LIN", "SPR"].iter().any(|prefix| name.starts_with(prefix));
    match (is_line, nodes) {
        (true, 3) => 21,
        (false, 5..) if name.starts_with("NSI") => 7,
        (false, 6) => 22,
        (false, 7) => 34,
        (false, 8) => 23,
        (false, 9) => 28,
        _ => EMPTY,
    }
}

/// Whether the first nodes of an element of `nodes` are those of the kind with `points`.
fn has_first_nodes_of(name: &str, nodes: usize, points: usize) -> bool {
    let begins = |prefix: &str| name.starts_with(prefix);
    match (nodes, points) {
        _ if nodes == points => true,
        _ if nodes < points => false,
        // Centers of the body or of faces follow the edges.
        (11 | 14 | 15, 10) => begins("TET"),
        (16 | 20 | 21, 15) => !begins("HEX") && !begins("TET"),
        (14 | 18 | 19, 13) => begins("PYR"),
        (21..=26, 20) => begins("HEX"),
        _ => points <= 8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_by_name_and_nodes() {
        for (name, nodes, vtk_type, is_reduced) in [
            ("TETRA", 4, 10, false),
            ("tet4", 4, 10, false),
            ("TETRA10", 10, 24, false),
            ("TETRA8", 8, 10, true),
            ("TETRA11", 11, 24, true),
            ("TETRA15", 15, 24, true),
            ("HEX", 8, 12, false),
            ("HEX9", 9, 12, true),
            ("HEX16", 16, 12, true),
            ("HEX", 20, 25, false),
            ("HEX27", 27, 29, false),
            ("HEX64", 64, 12, true),
            ("HEXSHELL", 8, 12, false),
            ("WEDGE", 6, 13, false),
            ("WEDGE12", 12, 31, false),
            ("PENTA15", 15, 26, false),
            ("WEDGE16", 16, 26, true),
            ("WEDGE18", 18, 32, false),
            ("WEDGE21", 21, 26, true),
            ("PYRAMID", 5, 14, false),
            ("PYRAMID13", 13, 27, false),
            ("PYRAMID14", 14, 27, true),
            ("SHELL4", 4, EMPTY, false),
            ("SHELL8", 8, 23, false),
            ("SHELL9", 9, 28, false),
            ("TRI6", 6, 22, false),
            ("BAR3", 3, 21, false),
            ("NSIDED", 6, 7, false),
            ("SPHERE", 1, EMPTY, false),
        ] {
            let element = Element::of(name, nodes).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((element.vtk_type, element.is_reduced), (vtk_type, is_reduced), "{name} {nodes}");
        }
        assert_eq!(Element::of("TETRA", 3), None);
        assert_eq!(Element::of("SUPER", 8), None);
    }

    #[test]
    fn orders_are_permutations() {
        for order in [&HEXAHEDRON_20[..], &HEXAHEDRON_27, &WEDGE_15, &WEDGE_18] {
            let mut sorted = order.to_vec();
            sorted.sort_unstable();
            assert!(sorted.iter().enumerate().all(|(index, &node)| index == usize::from(node)));
        }
    }
}
