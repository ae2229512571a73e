//! Rings of cells, through the public doors: what is reported, and what each remedy makes of it.

use std::f64::consts::TAU;

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{
    Backend, Camera, CpuRenderer, CycleRemedy, OpticalModel, OrderMethod, Plan, Projection, ReadOptions, Silent,
    TransferFunction, View, Volume, reference,
};
use tetrascope_tests::compare::difference;
use tetrascope_tests::shared;

/// A column of twisted sectors, each leaning over the next one like the blades of a fan: seen along its axis, two of the three cells of
/// every sector form one ring.
fn column(count: u32) -> (TetMesh, Vec<f64>) {
    let mut points = Vec::new();
    for level in 0..2 {
        for i in 0..count {
            let angle = (f64::from(i) - f64::from(level) / 3.0) / f64::from(count) * TAU;
            points.push(DVec3::new(angle.cos(), angle.sin(), f64::from(level)));
        }
    }
    points.extend([DVec3::ZERO, DVec3::Z]);
    let (low, high) = (2 * count, 2 * count + 1);
    let mut cells = Vec::new();
    for i in 0..count {
        let next = (i + 1) % count;
        let [a, b, c, d] = [i, next, count + i, count + next];
        cells.extend([[low, a, b, high], [high, a, b, c], [high, b, c, d]]);
    }
    let scalars = points.iter().map(|p| (2.0 * p.x).sin() + p.y * p.z).collect();
    (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars)
}

#[test]
fn a_ring_of_neighbors_is_cut() {
    for count in [6, 12] {
        let (mesh, scalars) = column(count);
        let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
        for (eye, projection) in [
            (DVec3::new(0.1, 0.2, 6.0), Projection::Perspective { fov_y: 0.5 }),
            (DVec3::new(0.1, 0.2, 6.0), Projection::Orthographic { height: 2.5 }),
            (DVec3::new(0.05, -0.03, 0.7), Projection::Perspective { fov_y: 1.8 }),
        ] {
            let camera = Camera { eye, target: DVec3::new(0.0, 0.01, 0.0), up: DVec3::Y, projection };
            let color = [[-2.0, 0.9, 0.1, 0.1], [0.0, 0.1, 0.8, 0.3], [2.0, 0.1, 0.2, 0.9]];
            let transfer = TransferFunction::new(&color, &[[-2.0, 4.0], [2.0, 1.0]]).unwrap();
            let plan = Plan {
                order: OrderMethod::Mpvo,
                ..Plan::new(View::new(&camera, 90, 90).unwrap(), transfer, OpticalModel::DensityEmitter)
            };
            let exact = reference::render(&mesh, &scalars, &plan, &Silent).unwrap().image;
            let draw = |cycles| renderer.render(&Plan { cycles, ..plan.clone() }, &Silent).unwrap();
            let (reported, cut) = (draw(CycleRemedy::Report), draw(CycleRemedy::Cut));
            // The eye at 6 has the ring before it; from inside the column it is partly behind the eye.
            if eye.z > 1.0 {
                assert_eq!(reported.counts.cyclic, 2 * u64::from(count));
                assert!(cut.counts.drawn > reported.counts.drawn, "nothing was cut");
                assert!(difference(&reported.image, &exact, 1e-5, &[]).beyond > 0, "the ring is not seen");
            }
            assert_eq!(reported.counts.cyclic, cut.counts.cyclic, "rings as they are found");
            let found = difference(&cut.image, &exact, 1e-5, &[]);
            println!("column of {count}, eye at {eye}: {} parts, {:.1e}", cut.counts.drawn, found.largest);
            assert!(found.largest <= 1e-5, "{count} sectors, eye at {eye}: {found:?}");
        }
    }
}

/// Rings across gaps and across faces, seen along -z: three sticks; a twisted column, of whose 18 cells 12 are in the ring.
#[test]
fn rings_of_real_files_are_found_and_mended() {
    let Some(folder) = shared::folder("rings of cells in files") else { return };
    for (file, members, middle, height) in [
        ("vtu/cycle_3_sticks.vtu", 3, DVec3::new(-0.5, 0.0, 0.0), 5.0),
        ("vtu/cycle_twisted_column_18.vtu", 12, DVec3::new(0.1, 0.2, 0.0), 3.0),
    ] {
        let volume = Volume::load(&folder.join("data").join(file), &ReadOptions::default()).unwrap();
        let field = volume.field(Some("s")).unwrap();
        for projection in [Projection::Perspective { fov_y: height / 9.0 }, Projection::Orthographic { height }] {
            let camera = Camera { eye: middle + DVec3::Z * 9.0, target: middle, up: DVec3::Y, projection };
            let color = [[0.0, 0.9, 0.1, 0.1], [0.5, 0.1, 0.8, 0.3], [1.0, 0.1, 0.2, 0.9]];
            let transfer = TransferFunction::new(&color, &[[0.0, 4.0], [1.0, 1.0]]).unwrap();
            let view = View::new(&camera, 240, 240).unwrap();
            let plan = Plan { order: OrderMethod::BspXmpvo, ..Plan::new(view, transfer, OpticalModel::DensityEmitter) };
            let draw = |backend, cycles| field.render(&Plan { backend, cycles, ..plan.clone() }, &Silent).unwrap();
            let exact = draw(Backend::Reference, CycleRemedy::Report).image;
            for remedy in CycleRemedy::ALL {
                let drawn = draw(Backend::Cpu, remedy);
                assert_eq!((drawn.counts.cyclic, drawn.order.rings), (members, 1), "{file}, {remedy}");
                let found = difference(&drawn.image, &exact, 1e-5, &[]);
                println!("{file}, {remedy}: largest {:.1e}, {} pixels beyond", found.largest, found.beyond);
                assert_eq!(found.beyond > 0, remedy == CycleRemedy::Report, "{file}, {remedy}: {found:?}");
            }
        }
    }
}

/// Cells that overlap cannot be cut into an order: they are reported, and their pixels are sorted.
#[test]
fn rings_that_cannot_be_cut_are_left_to_the_pixels() {
    // The tip of the second cell lies inside the first.
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.1)];
    let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3], [1, 2, 3, 4]]).unwrap().mesh;
    let volume = CpuRenderer::new(&mesh, &[0.0, 1.0, 0.3, 0.6, 0.9]).unwrap();
    let camera = Camera {
        eye: DVec3::new(3.0, 2.0, 4.0),
        target: DVec3::splat(0.25),
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.3 },
    };
    let color = [[0.0, 0.9, 0.1, 0.1], [0.5, 0.1, 0.8, 0.3], [1.0, 0.1, 0.2, 0.9]];
    let transfer = TransferFunction::new(&color, &[[0.0, 4.0], [1.0, 1.0]]).unwrap();
    let plan = Plan::new(View::new(&camera, 64, 64).unwrap(), transfer, OpticalModel::DensityEmitter);
    let draw = |order, cycles| volume.render(&Plan { order, cycles, ..plan.clone() }, &Silent).unwrap();
    let sorted = draw(OrderMethod::PerPixel, CycleRemedy::Report);
    for order in [OrderMethod::Mpvo, OrderMethod::BspXmpvo] {
        for (cycles, left) in [(CycleRemedy::Report, 1), (CycleRemedy::Cut, 1), (CycleRemedy::PerPixel, 1)] {
            let drawn = draw(order, cycles);
            assert_eq!(
                (drawn.counts.cyclic, drawn.order.rings, drawn.order.rings_left),
                (2, 1, left),
                "{order}, {cycles}"
            );
            assert_eq!(drawn.counts.sorted > 0, cycles != CycleRemedy::Report, "{order}, {cycles}");
            let found = difference(&drawn.image, &sorted.image, 1e-6, &[]);
            assert!(cycles == CycleRemedy::Report || found.beyond == 0, "{order}, {cycles}: {found:?}");
        }
    }
}
