//! Every type of element with a volume: right side out, with each point where VTK has it.

use tetrascope_mesh::{CellKind, decompose};

use super::element_types::element_type;
use super::middles::middles;
use super::synthetic::{Mesh, View, file, read, styles};
use super::tests::cells;
use crate::ReadOptions;

/// Corners of the reference elements, as the Gmsh manual draws them, on integers.
const TETRAHEDRON: &[[f64; 3]] = &[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
const HEXAHEDRON: &[[f64; 3]] =
    &[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [1., 1., 1.], [0., 1., 1.]];
const WEDGE: &[[f64; 3]] = &[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.]];
const PYRAMID: &[[f64; 3]] = &[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0.5, 0.5, 1.]];

/// The nodes between corners in Gmsh's order: each amid those that it lists.
const TETRAHEDRON_MIDS: &[&[usize]] = &[&[0, 1], &[1, 2], &[2, 0], &[3, 0], &[2, 3], &[1, 3]];
const HEXAHEDRON_MIDS: &[&[usize]] = &[
    &[0, 1],
    &[0, 3],
    &[0, 4],
    &[1, 2],
    &[1, 5],
    &[2, 3],
    &[2, 6],
    &[3, 7],
    &[4, 5],
    &[4, 7],
    &[5, 6],
    &[6, 7],
    &[0, 3, 2, 1],
    &[0, 1, 5, 4],
    &[0, 4, 7, 3],
    &[1, 2, 6, 5],
    &[2, 3, 7, 6],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];
const WEDGE_MIDS: &[&[usize]] = &[
    &[0, 1],
    &[0, 2],
    &[0, 3],
    &[1, 2],
    &[1, 4],
    &[2, 5],
    &[3, 4],
    &[3, 5],
    &[4, 5],
    &[0, 1, 4, 3],
    &[0, 3, 5, 2],
    &[1, 2, 5, 4],
];
const PYRAMID_MIDS: &[&[usize]] =
    &[&[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 4], &[2, 3], &[2, 4], &[3, 4], &[0, 1, 2, 3]];

/// Type, corners, nodes between, the kind, its volume and number of tetrahedra.
type Case = (i64, &'static [[f64; 3]], &'static [&'static [usize]], CellKind, f64, usize);

const CASES: &[Case] = &[
    (4, TETRAHEDRON, &[], CellKind::Tetrahedron, 1.0 / 6.0, 1),
    (5, HEXAHEDRON, &[], CellKind::Hexahedron, 1.0, 6),
    (6, WEDGE, &[], CellKind::Wedge, 0.5, 3),
    (7, PYRAMID, &[], CellKind::Pyramid, 1.0 / 3.0, 2),
    (11, TETRAHEDRON, TETRAHEDRON_MIDS, CellKind::QuadraticTetrahedron, 1.0 / 6.0, 8),
    (12, HEXAHEDRON, HEXAHEDRON_MIDS, CellKind::TriquadraticHexahedron, 1.0, 48),
    (13, WEDGE, WEDGE_MIDS, CellKind::BiquadraticQuadraticWedge, 0.5, 24),
    (14, PYRAMID, PYRAMID_MIDS, CellKind::QuadraticPyramid, 1.0 / 3.0, 16),
    (17, HEXAHEDRON, HEXAHEDRON_MIDS, CellKind::QuadraticHexahedron, 1.0, 48),
    (18, WEDGE, WEDGE_MIDS, CellKind::QuadraticWedge, 0.5, 24),
    (19, PYRAMID, PYRAMID_MIDS, CellKind::QuadraticPyramid, 1.0 / 3.0, 16),
    (29, TETRAHEDRON, TETRAHEDRON_MIDS, CellKind::Tetrahedron, 1.0 / 6.0, 1),
    (92, HEXAHEDRON, HEXAHEDRON_MIDS, CellKind::Hexahedron, 1.0, 6),
    (106, WEDGE, WEDGE_MIDS, CellKind::Wedge, 0.5, 3),
    (131, PYRAMID, PYRAMID_MIDS, CellKind::Pyramid, 1.0 / 3.0, 2),
    (139, TETRAHEDRON, TETRAHEDRON_MIDS, CellKind::Tetrahedron, 1.0 / 6.0, 1),
];

fn middle(corners: &[[f64; 3]], of: &[usize]) -> [f64; 3] {
    [0, 1, 2].map(|axis| of.iter().map(|&corner| corners[corner][axis]).sum::<f64>() / of.len() as f64)
}

#[test]
fn every_element_with_a_volume() {
    for &(number, corners, mids, kind, volume, tetrahedra) in CASES {
        let nodes = element_type(number).unwrap().nodes;
        let between = mids.iter().map(|of| middle(corners, of));
        // Nodes of higher orders lie anywhere: nothing is to be seen of them.
        let places = corners.iter().copied().chain(between).chain(std::iter::repeat([9.0; 3])).take(nodes);
        let stretch = |p: [f64; 3]| [2.0 * p[0] + 0.5 * p[1], 3.0 * p[1] - p[2], p[2]];
        let mesh = Mesh {
            nodes: (1..).zip(places.map(stretch)).collect(),
            blocks: vec![(3, 1, 0, number, vec![(1, (1..=nodes.try_into().unwrap()).collect())])],
        };
        let of_element = View {
            kind: "ElementNodeData",
            name: "same",
            step: 0,
            time: 0.0,
            components: 3,
            tuples: vec![(1, Some(nodes.try_into().unwrap()), mesh.nodes.iter().flat_map(|node| node.1).collect())],
        };
        for style in styles() {
            let bytes = file(style, &mesh, std::slice::from_ref(&of_element));
            let loaded = read("e.msh", &bytes, &ReadOptions::default()).unwrap_or_else(|e| panic!("{number}: {e}"));
            let rows = cells(&loaded);
            assert_eq!(rows.kinds, [kind], "type {number}");
            let points = &loaded.dataset.points;
            let place = |slot: usize| points[rows.connectivity[slot] as usize].to_array();
            for (slot, of) in (corners.len()..rows.connectivity.len()).zip(middles(kind)) {
                let of: Vec<usize> = of.iter().map(|&corner| corner.into()).collect();
                assert_eq!(place(slot), stretch(middle(corners, &of)), "type {number}, point {slot}");
            }
            // What belongs to a node of the element came to its point.
            let same = &loaded.dataset.point_arrays[0];
            for &point in &rows.connectivity {
                let own = [0, 1, 2].map(|component| same.component(component)[point as usize]);
                assert_eq!(own, points[point as usize].to_array(), "type {number}");
            }
            let cut = decompose(&loaded.dataset).unwrap();
            let six: f64 = (0..cut.mesh.tetrahedra().len()).map(|t| six_volume(&cut.mesh, t)).sum();
            assert!((six / 6.0 - 6.0 * volume).abs() < 1e-12, "type {number}: {}", six / 6.0);
            assert_eq!((cut.counts.tetrahedra, cut.counts.inverted), (tetrahedra, 0), "type {number}");
            let is_reduced = nodes > rows.connectivity.len();
            assert_eq!(loaded.warnings.len(), 1 + usize::from(is_reduced), "type {number}: {:?}", loaded.warnings);
        }
    }
}

/// As solvers write linear fields on curved meshes: a value for each corner alone.
#[test]
fn values_of_corners_alone() {
    for &(number, corners, mids, kind, ..) in CASES.iter().filter(|case| (11..20).contains(&case.0)) {
        let nodes = element_type(number).unwrap().nodes;
        let places = corners.iter().copied().chain(mids.iter().map(|of| middle(corners, of))).take(nodes);
        let mesh = Mesh {
            nodes: (1..).zip(places).collect(),
            blocks: vec![(3, 1, 0, number, vec![(1, (1..=nodes.try_into().unwrap()).collect())])],
        };
        let tuples = vec![(1, Some(corners.len().try_into().unwrap()), corners.concat())];
        let view = View { kind: "ElementNodeData", name: "place", step: 0, time: 0.0, components: 3, tuples };
        let loaded = read("e.msh", &file(styles()[1], &mesh, &[view]), &ReadOptions::default()).unwrap();
        let place = &loaded.dataset.point_arrays[0];
        for &point in &cells(&loaded).connectivity {
            let own = [0, 1, 2].map(|component| place.component(component)[point as usize]);
            assert_eq!(own, loaded.dataset.points[point as usize].to_array(), "{kind:?}");
        }
        assert!(loaded.warnings.iter().any(|warning| warning.contains("means between")), "{:?}", loaded.warnings);
    }
}

pub(super) fn six_volume(mesh: &tetrascope_mesh::TetMesh, tetrahedron: usize) -> f64 {
    let [a, b, c, d] = mesh.tetrahedra()[tetrahedron].map(|v| mesh.frame().to_world(mesh.positions()[v.0 as usize]));
    (b - a).cross(c - a).dot(d - a)
}

#[test]
fn all_numbers_that_gmsh_uses() {
    let known: Vec<i64> = (-1..200).filter(|&number| element_type(number).is_some()).collect();
    let expected: Vec<i64> = (1..=140).filter(|number| ![34, 35, 69, 76, 77, 78, 136].contains(number)).collect();
    assert_eq!(known, expected);
    for number in known {
        let found = element_type(number).unwrap();
        assert!(found.nodes > 0 && found.order.is_none_or(|order| order.iter().all(|&n| usize::from(n) < found.nodes)));
    }
}
