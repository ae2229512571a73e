//! Planes in 16 bits never tell another side than exact arithmetic.

use glam::DVec3;
use proptest::prelude::*;
use robust::{Coord3D, orient3d};
use tetrascope_mesh::{CellId, FaceAdjacency};
use tetrascope_view::Viewpoint;

use crate::mpvo_tests::{grid, place};
use crate::sides::{FaceSides, Relation};
use crate::*;

/// Asks of every face from the points.
fn assert_exact(cells: Cells<'_>, eye: DVec3) {
    let adjacency = FaceAdjacency::new(cells.tetrahedra);
    let sides = FaceSides::new(cells, &adjacency);
    let mut bytes = vec![0; sides.len()];
    sides.relations(cells, Viewpoint::Eye(eye), &mut bytes, |relation| relation.front | relation.behind << 4);
    for (cell, (tetrahedron, byte)) in cells.tetrahedra.iter().zip(bytes).enumerate() {
        let mut expected = Relation { front: 0, behind: 0 };
        for corner in (0..4).filter(|&corner| adjacency.table()[cell][corner] != FaceAdjacency::NONE) {
            let mut face = *tetrahedron;
            face[corner..].rotate_left(1);
            let [p, q, r, apex] = face.map(|v| cells.positions[v.index()]);
            let side = |point: DVec3| {
                let [p, q, r, point] = [p, q, r, point].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
                orient3d(p, q, r, point)
            };
            let agreement = side(apex).signum() * side(eye);
            expected.front |= u8::from(agreement < 0.0) << corner;
            expected.behind |= u8::from(agreement > 0.0) << corner;
        }
        assert_eq!(Relation { front: byte & 0x0f, behind: byte >> 4 }, expected, "cell {cell} from {eye}");
    }
}

proptest! {
    #[test]
    fn sides_are_those_of_exact_arithmetic(
        cells in 1..5_usize, shear in place(0.4), near in 0..64_usize, away in place(1.0), scale in -60..60_i32,
        size in -30..30_i32,
    ) {
        let scaled = 10.0_f64.powi(size);
        let mesh = grid(cells, |p| (p + DVec3::new(shear.x * p.y, shear.y * p.z, shear.z * p.x * p.y)) * scaled);
        // From afar, from a point, and from just beside one: there all planes through the point are within rounding.
        let point = mesh.positions()[near % mesh.positions().len()];
        for eye in [away * 10.0 * scaled, point, point + away * scaled * 2.0_f64.powi(scale.min(10)), point + away * scaled * 1e-4] {
            assert_exact((&mesh).into(), eye);
        }
    }
}

/// Slivers, a mesh far from the origin, and points that are there twice have no plane in 16 bits that could be trusted.
#[test]
fn degenerate_meshes_are_exact() {
    let mesh = grid(3, |p| DVec3::new(p.x, p.y * 1e-9, p.z.min(2.0)));
    for eye in [DVec3::splat(4.0), DVec3::new(0.5, 1e-9, 0.3), DVec3::new(-1.0, 2e-10, 1.0)] {
        let cells: Cells<'_> = (&mesh).into();
        let all: Vec<CellId> = (0..cells.tetrahedra.len() as u32).map(CellId).collect();
        let order = Mpvo::new(cells).order(cells, Viewpoint::Eye(eye), &all);
        assert_eq!(order.front_to_back.len(), all.len());
        if order.cycles.is_empty() {
            assert_eq!(misordered_faces(cells, Viewpoint::Eye(eye), &order.front_to_back), 0);
        }
    }
    let far = grid(3, |p| p * DVec3::new(1.0, 1e-5, 3.0) + 1e7);
    for eye in [DVec3::splat(1e7), DVec3::new(1e7 + 1.5, 1e7 + 1e-5, 1e7 + 0.7), DVec3::ZERO] {
        assert_exact((&far).into(), eye);
    }
}
