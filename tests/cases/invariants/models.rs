//! The four optical models: the fast renderer against the reference, with a transfer function that is steep and has steps.
//!
//! Tolerance 1e-4 for a single picture of this transfer function: where its slope is 200 over a range of scalars of 2, a scalar
//! that is off by 1e-7 changes the extinction by 2e-5.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Integration, OpticalModel, Plan, Projection, View};
use tetrascope_tests::meshes::{Random, Tets};
use tetrascope_tests::pictures::{Renderer, Worst, largest, mean_opacity, plan, random_camera};

const WITHIN: f64 = 1e-4;

/// A smooth peak in 40 pieces, steps up and down, and a narrow tent.
fn extinction() -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = (0..=40)
        .map(|i| {
            let s = -0.9 + 0.6 * f64::from(i) / 40.0;
            [s, 6.0 * (-((s + 0.6) / 0.1).powi(2)).exp()]
        })
        .collect();
    points.extend([[0.0, 0.3], [0.0, 2.0], [0.12, 2.0], [0.12, 0.0], [0.4, 0.0], [0.41, 8.0], [0.42, 0.1], [1.0, 1.5]]);
    points
}

fn color() -> Vec<[f64; 4]> {
    let mut points: Vec<[f64; 4]> = (0..=24)
        .map(|i| {
            let s = -1.0 + 2.0 * f64::from(i) / 24.0;
            [s, 0.5 + 0.5 * (3.0 * s).sin(), 0.5 + 0.4 * (5.0 * s).cos(), 0.3 + 0.3 * s]
        })
        .collect();
    // A step in color inside of a stretch of extinction.
    points.push([1.1, 1.0, 0.0, 0.0]);
    points.push([1.1, 0.0, 0.0, 1.0]);
    points
}

/// Fast against reference with the same integration.
fn check_against_reference(mesh: &TetMesh, scalars: &[f64], plan: &Plan, place: &str, worst: &mut Worst) {
    for integration in [Integration::Exact, Integration::Average] {
        // The mean scalar of a cell falls on a step or beside it by rounding, so steps are for the exact ways alone.
        let plan = if integration == Integration::Average { without_steps(plan) } else { plan.clone() };
        let fast = Renderer::Fast(integration).draw(mesh, scalars, &plan);
        let slow = Renderer::Reference(integration).draw(mesh, scalars, &plan);
        let shown = slow.pixels().iter().filter(|p| p.iter().any(|c| *c > 0.05)).count();
        assert!(shown * 100 > slow.pixels().len(), "{place}: {shown} pixels show something");
        worst.note(largest(&fast, &slow, 0..4), || format!("{place}, {integration}, {}", plan.model));
    }
}

fn without_steps(plan: &Plan) -> Plan {
    let smooth = [[-0.9, 0.0], [-0.6, 6.0], [-0.3, 0.0], [0.0, 0.3], [0.12, 2.0], [0.4, 0.0], [0.5, 3.0], [1.0, 1.5]];
    let color: Vec<[f64; 4]> = color().into_iter().take(25).collect();
    Plan { transfer: tetrascope::TransferFunction::new(&color, &smooth).unwrap(), ..plan.clone() }
}

#[test]
fn models_that_need_no_order_agree_on_random_meshes() {
    let mut worst = Worst::new("absorption and emission against the reference", WITHIN);
    for seed in 0..6 {
        let tets = Tets::block(5, seed + 1600);
        let mesh = tets.mesh();
        for is_perspective in [false, true] {
            let camera = random_camera(&mut Random::new(seed), DVec3::ZERO, 1.0, is_perspective);
            let view = View::new(&camera, 60, 50).unwrap();
            for model in [OpticalModel::Absorption, OpticalModel::Emission] {
                let plan = Plan { model, ..plan(view, &color(), &extinction()) };
                let place = format!("seed {seed}, perspective {is_perspective}");
                check_against_reference(&mesh, &tets.scalars, &plan, &place, &mut worst);
            }
        }
    }
    worst.finish();
}

#[test]
fn one_color_agrees_on_random_meshes() {
    let mut worst = Worst::new("one color against the reference", WITHIN);
    for seed in 0..6 {
        let tets = Tets::block(5, seed + 1700);
        let mesh = tets.mesh();
        for is_perspective in [false, true] {
            let camera = random_camera(&mut Random::new(seed), DVec3::ZERO, 1.0, is_perspective);
            let view = View::new(&camera, 60, 50).unwrap();
            let plan = plan(view, &[[0.0, 0.9, 0.5, 0.2]], &extinction());
            let fast = Renderer::Fast(Integration::Exact).draw(&mesh, &tets.scalars, &plan);
            let slow = Renderer::Reference(Integration::Exact).draw(&mesh, &tets.scalars, &plan);
            assert!(mean_opacity(&slow) > 0.1);
            worst.note(largest(&fast, &slow, 0..4), || format!("seed {seed}, perspective {is_perspective}"));
        }
    }
    worst.finish();
}

#[test]
fn all_models_agree_on_one_tetrahedron() {
    let mut worst = Worst::new("one tetrahedron against the reference", WITHIN);
    let mut random = Random::new(1800);
    let mut drawn = 0;
    while drawn < 40 {
        let points: Vec<DVec3> = (0..4).map(|_| random.point()).collect();
        let scalars: Vec<f64> = (0..4).map(|_| random.between(-1.2, 1.2)).collect();
        let volume = (points[1] - points[0]).dot((points[2] - points[0]).cross(points[3] - points[0])) / 6.0;
        if volume.abs() < 0.1 {
            continue;
        }
        drawn += 1;
        let mesh = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).unwrap().mesh;
        let center = points.iter().sum::<DVec3>() / 4.0;
        let camera = random_camera(&mut random, center, 0.6, drawn % 2 == 0);
        for model in OpticalModel::ALL {
            let plan = Plan { model, ..plan(View::new(&camera, 40, 40).unwrap(), &color(), &extinction()) };
            check_against_reference(&mesh, &scalars, &plan, &format!("tetrahedron {drawn}"), &mut worst);
        }
    }
    worst.finish();
}

/// Tetrahedra in slabs across the line of sight, with gaps between them: their centroids come in the right order.
#[test]
fn all_models_agree_on_a_row_of_cells() {
    let mut worst = Worst::new("row of cells against the reference", WITHIN);
    for seed in 0..10 {
        let mut random = Random::new(seed + 1900);
        let mut tets = Tets::default();
        while tets.cells.len() < 8 {
            let layer = tets.cells.len() as f64;
            let corners: Vec<DVec3> = (0..4)
                .map(|_| {
                    let p = random.point();
                    DVec3::new(1.5 * p.x, 1.5 * p.y, layer + 0.45 * p.z)
                })
                .collect();
            let volume = (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0])) / 6.0;
            if volume.abs() < 0.1 {
                continue;
            }
            let first = tets.points.len() as u32;
            tets.points.extend(corners);
            tets.scalars.extend((0..4).map(|_| random.between(-1.2, 1.2)));
            tets.cells.push([0, 1, 2, 3].map(|c| first + c));
        }
        let mesh = tets.mesh();
        for projection in [Projection::Perspective { fov_y: 0.09 }, Projection::Orthographic { height: 2.6 }] {
            // From so far away that distances from the eye come in the order of the layers: 2 * 30 * 0.1 > 2 * 1.5^2.
            for z in [-30.0, 37.0] {
                let camera = Camera { eye: DVec3::Z * z, target: DVec3::Z * 3.5, up: DVec3::Y, projection };
                for model in OpticalModel::ALL {
                    let plan = Plan { model, ..plan(View::new(&camera, 50, 50).unwrap(), &color(), &extinction()) };
                    check_against_reference(&mesh, &tets.scalars, &plan, &format!("seed {seed}, from {z}"), &mut worst);
                }
            }
        }
    }
    worst.finish();
}
