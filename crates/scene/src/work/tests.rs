//! What is foreseen, where it is known.

use glam::DVec3;
use tetrascope_integrate::{Integration, OpticalModel, TransferFunction};
use tetrascope_mesh::TetMesh;
use tetrascope_order::OrderMethod;
use tetrascope_view::{Camera, Projection, View};

use super::*;

/// Two tetrahedra with a common face, scalars 0 to 1 in the first and up to 3 in the second; a picture that is 4 units high.
fn two_cells() -> (TetMesh, Vec<f64>, Plan) {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3], [1, 2, 3, 4]]).unwrap().mesh;
    let camera = Camera {
        eye: DVec3::new(0.0, 0.0, 9.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 4.0 },
    };
    let view = View::new(&camera, 200, 200).unwrap();
    let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &[[0.0, 1.0]]).unwrap();
    (mesh, vec![0.0, 1.0, 1.0, 1.0, 3.0], Plan::new(view, transfer, OpticalModel::DensityEmitter))
}

#[test]
fn transparent_cells_are_counted() {
    let (mesh, scalars, plan) = two_cells();
    for (extinction, transparent) in
        [(&[[0.0, 1.0]][..], 0), (&[[1.0, 0.0], [3.0, 1.0]], 1), (&[[0.0, 1.0], [1.0, 0.0]], 1), (&[[0.0, 0.0]], 2)]
    {
        let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], extinction).unwrap();
        let work = Work::of(&Plan { transfer, ..plan.clone() }, &mesh, &scalars).unwrap();
        assert_eq!((work.cells, work.transparent), (2, transparent), "{extinction:?}");
    }
}

#[test]
fn areas_and_what_is_out_of_view() {
    let (mesh, scalars, plan) = two_cells();
    let work = Work::of(&plan, &mesh, &scalars).unwrap();
    // 50 pixels a unit. Seen along z the first cell is the lower half of a unit square, the second the whole of it.
    assert!((work.fragments.estimate - 2500.0 * (0.5 + 1.0)).abs() < 1e-6, "{:?}", work.fragments);
    assert_eq!((work.fragments.sampled, work.fragments.standard_error, work.outside), (2, 0.0, 0));
    let aside = Camera {
        eye: DVec3::new(9.0, 0.0, 9.0),
        target: DVec3::new(9.0, 0.0, 0.0),
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 4.0 },
    };
    let view = View::new(&aside, 200, 200).unwrap();
    let work = Work::of(&Plan { view, ..plan }, &mesh, &scalars).unwrap();
    assert_eq!((work.outside, work.fragments.estimate, work.drawn_at_most()), (2, 0.0, 0));
}

#[test]
fn what_is_not_asked_for_has_no_memory_and_no_stage() {
    let (mesh, scalars, plan) = two_cells();
    for backend in [Backend::Cpu, Backend::Gpu, Backend::Reference] {
        let plain = Plan { backend, order: OrderMethod::None, ..plan.clone() };
        let work = Work::of(&plain, &mesh, &scalars).unwrap();
        let labels: Vec<&str> = work.buffers.iter().map(|buffer| buffer.label).collect();
        for label in ["table", "maps of isosurfaces", "gradients", "isosurfaces and light", "order"] {
            assert!(!labels.contains(&label), "{backend}: {labels:?}");
        }
        assert!(!work.stages.contains(&Stage::Tabulate) && !work.sorts_cells, "{backend}");
        let table = Plan { integration: Integration::Table3d, ..plain };
        let with = Work::of(&table, &mesh, &scalars).unwrap();
        assert_eq!(with.table.unwrap().bytes(), 64 * 64 * 64 * 16, "{backend}");
        assert!(with.stages.contains(&Stage::Tabulate), "{backend}");
    }
}
