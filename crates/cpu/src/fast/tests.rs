//! What the fast renderer does and leaves out: counts, memory of transfer functions, early ends, careful cells.

use glam::DVec3;
use tetrascope_integrate::{Isosurfaces, OpticalModel, TransferFunction};
use tetrascope_mesh::TetMesh;
use tetrascope_scene::{Plan, Silent};
use tetrascope_view::{Camera, Projection, View};

use super::{CpuRenderer, KEPT};

/// A row of small tetrahedra along -z, whose scalar is their number.
fn row(count: u32) -> (TetMesh, Vec<f64>) {
    let shape = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1.0)];
    let points: Vec<DVec3> =
        (0..count).flat_map(|i| shape.map(|p| p - DVec3::new(0.3, 0.3, 1.2 * f64::from(i)))).collect();
    let cells: Vec<[u32; 4]> = (0..count).map(|i| [0, 1, 2, 3].map(|v| 4 * i + v)).collect();
    let scalars = (0..count).flat_map(|i| [f64::from(i); 4]).collect();
    (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars)
}

fn plan(extinction: &[[f64; 2]]) -> Plan {
    let camera = Camera {
        eye: DVec3::new(0.03, 0.07, 6.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.4 },
    };
    let transfer = TransferFunction::new(&[[0.0, 0.9, 0.5, 0.1], [9.0, 0.1, 0.5, 0.9]], extinction).unwrap();
    Plan::new(View::new(&camera, 40, 40).unwrap(), transfer, OpticalModel::DensityEmitter)
}

#[test]
fn what_cannot_be_seen_is_left_out_and_counted() {
    let (mesh, scalars) = row(10);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    // Cells 0 to 4 are transparent.
    let mut transparent = plan(&[[4.0, 0.0], [5.0, 1.0]]);
    let counts = renderer.render(&transparent, &Silent).unwrap().counts;
    assert_eq!((counts.cells, counts.transparent, counts.outside, counts.drawn), (10, 5, 0, 5));
    // The eye between cell 6 and cell 7: what lies behind it is outside.
    transparent.view.eye.z = -1.2 * 7.0 + 1.1;
    let counts = renderer.render(&transparent, &Silent).unwrap().counts;
    assert_eq!((counts.transparent, counts.outside, counts.drawn), (5, 2, 3));
}

#[test]
fn two_transfer_functions_are_remembered_and_no_more() {
    let (mesh, scalars) = row(4);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let plans = [0.5, 1.0, 2.0].map(|rho| plan(&[[0.0, rho]]));
    let none = Isosurfaces::default();
    let first = renderer.optics(&plans[0], &none);
    let _second = renderer.optics(&plans[1], &none);
    assert!(std::sync::Arc::ptr_eq(&first, &renderer.optics(&plans[0], &none)), "made anew though it was remembered");
    let _third = renderer.optics(&plans[2], &none);
    assert_eq!(renderer.optics.lock().unwrap().len(), KEPT);
    assert!(std::sync::Arc::ptr_eq(&first, &renderer.optics(&plans[0], &none)), "the least recently used goes first");
}

#[test]
fn an_opaque_block_ends_early_within_the_error_promised() {
    let (mesh, scalars) = row(10);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let mut opaque = plan(&[[0.0, 30.0]]);
    let full = renderer.render(&opaque, &Silent).unwrap();
    opaque.termination = 1e-3;
    let ended = renderer.render(&opaque, &Silent).unwrap();
    assert!(ended.counts.fragments < full.counts.fragments, "{} fragments", ended.counts.fragments);
    for (a, b) in full.image.pixels().iter().zip(ended.image.pixels()) {
        for (a, b) in a.iter().zip(b) {
            // The largest color behind is 0.9.
            assert!((a - b).abs() <= 1e-3, "{a} {b}");
        }
    }
}

#[test]
fn only_cells_with_a_face_on_edge_or_at_the_eye_are_drawn_carefully() {
    let (mesh, scalars) = row(3);
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let mut plan = plan(&[[0.0, 1.0]]);
    assert_eq!(renderer.render(&plan, &Silent).unwrap().counts.careful, 0);
    // In the plane of the middle cell's face z = 0 of its own: exactly edge-on, and the cell behind is seen past it.
    plan.view.eye = DVec3::new(5.0, 0.02, -1.2);
    (plan.view.forward, plan.view.right) = (DVec3::NEG_X, DVec3::NEG_Z);
    assert_eq!(renderer.render(&plan, &Silent).unwrap().counts.careful, 1);
    // Inside the first cell.
    plan.view.eye = DVec3::new(0.0, 0.0, 0.1);
    (plan.view.forward, plan.view.right) = (DVec3::NEG_Z, DVec3::X);
    let inside = renderer.render(&plan, &Silent).unwrap();
    assert!(inside.counts.careful >= 1);
    assert!(inside.image.pixels().iter().all(|p| p[3] > 0.0), "the eye's own cell covers the picture");
}
