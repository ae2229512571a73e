//! Anything that the layout allows ends in a mesh that keeps its promises, or in an error.

use glam::DVec3;
use proptest::prelude::*;
use robust::{Coord3D, orient3d};

use crate::{CellKind, Cells, Dataset, FaceAdjacency, UnstructuredCells, check, decompose, vertex_gradients};

const KINDS: [CellKind; 18] = [
    CellKind::Tetrahedron,
    CellKind::Voxel,
    CellKind::Hexahedron,
    CellKind::Wedge,
    CellKind::Pyramid,
    CellKind::PentagonalPrism,
    CellKind::HexagonalPrism,
    CellKind::Polyhedron,
    CellKind::QuadraticTetrahedron,
    CellKind::QuadraticHexahedron,
    CellKind::QuadraticWedge,
    CellKind::QuadraticPyramid,
    CellKind::TriquadraticHexahedron,
    CellKind::BiquadraticQuadraticWedge,
    CellKind::BiquadraticQuadraticHexahedron,
    CellKind::QuadraticLinearWedge,
    CellKind::Flat,
    CellKind::Other(250),
];

/// Few different values, so that points coincide and sets are flat; and some that break naive arithmetic.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => (-3_i8..4).prop_map(f64::from),
        2 => -1.0..1.0,
        1 => prop::sample::select(vec![0.1, 1e-300, -1e300, f64::MAX, f64::MIN, 5e-324, f64::NAN, f64::INFINITY, -0.0]),
    ]
}

fn any_dataset() -> impl Strategy<Value = Dataset> {
    let points = prop::collection::vec(prop::array::uniform3(coordinate()).prop_map(DVec3::from_array), 1..40);
    let faces = prop::collection::vec(prop::collection::vec(0_u32..40, 0..6), 0..7);
    let cell = (prop::sample::select(KINDS.to_vec()), prop::collection::vec(0_u32..40, 0..30), faces);
    (points, prop::collection::vec(cell, 0..12)).prop_map(|(points, cells)| {
        let count = points.len() as u32;
        let mut layout = UnstructuredCells::default();
        for (kind, list, faces) in cells {
            layout.kinds.push(kind);
            layout.connectivity.extend(list.iter().map(|point| point % count));
            layout.offsets.push(layout.connectivity.len());
            if kind == CellKind::Polyhedron {
                let wrapped = |face: Vec<u32>| face.iter().map(|point| point % count).collect();
                layout.polyhedra.push(faces.into_iter().map(wrapped).collect());
            }
        }
        Dataset { points, cells: Cells::Unstructured(layout), ..Dataset::default() }
    })
}

proptest! {
    #[test]
    fn whatever_is_kept_is_upright_and_finite(dataset in any_dataset()) {
        let Ok(cut) = decompose(&dataset) else { return Ok(()) };
        let mesh = &cut.mesh;
        for tetrahedron in mesh.tetrahedra() {
            let corners = tetrahedron.map(|v| mesh.positions()[v.index()]);
            prop_assert!(corners.iter().all(|p| p.is_finite()));
            let [a, b, c, d] = corners.map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
            prop_assert!(orient3d(b, c, d, a) > 0.0, "{:?}", corners);
        }
        let counts = &cut.counts;
        prop_assert_eq!(counts.tetrahedra, mesh.tetrahedra().len() + counts.no_volume);
        let left_out = counts.flat + counts.unknown.values().sum::<usize>() + counts.malformed + counts.non_finite;
        prop_assert!(left_out < counts.cell_count());
        let scalars = cut.point_scalars(&vec![1.0; dataset.points.len()]);
        prop_assert!(scalars.iter().all(|s| (s - 1.0).abs() < 1e-14));
        let report = check(&cut, &FaceAdjacency::new(mesh.tetrahedra()));
        prop_assert!(report.connected_parts >= 1 && report.bounds_world.is_some());
        prop_assert_eq!(vertex_gradients(mesh, &scalars).len(), mesh.positions().len());
    }
}
