//! Which side of a surface is seen, what it hides, and what has no part in it.

use glam::DVec3;
use tetrascope::{
    Camera, CpuRenderer, Isosurface, OpticalModel, Plan, Projection, Silent, SurfaceShading, TransferFunction, View,
};
use tetrascope_tests::meshes::{Random, Tets, grid};
use tetrascope_tests::pictures::{Renderer, Worst, largest, mean_opacity, plan, random_camera};
use tetrascope_tests::surfaces::{points, surfaces_alone, white, with_surfaces};

use super::spheres::{sample, view_from};

const COLOR: &[[f64; 4]] = &[[-0.6, 0.9, 0.1, 0.2], [0.3, 0.1, 0.8, 0.3], [1.0, 1.0, 0.9, 0.1]];
const EXTINCTION: &[[f64; 2]] = &[[-0.6, 0.5], [0.2, 2.0], [1.0, 0.3]];

/// The side that faces rising scalars has `color`.
#[test]
fn side_follows_the_direction_of_view() {
    let mesh = grid([3; 3], DVec3::ZERO, 1.0).mesh;
    let scalars: Vec<f64> = points(&mesh).iter().map(|p| p.z).collect();
    let surface =
        Isosurface { color: [0.75, 0.5, 0.25], back_color: [0.125, 0.25, 1.0], opacity: 0.5, ..white(1.4, 1.0) };
    for (eye, color) in [(9.0, surface.color), (-6.0, surface.back_color)] {
        for projection in [Projection::Orthographic { height: 2.5 }, Projection::Perspective { fov_y: 0.25 }] {
            let camera = Camera { eye: DVec3::new(1.5, 1.5, eye), target: DVec3::splat(1.5), up: DVec3::Y, projection };
            let view = View::new(&camera, 20, 20).unwrap();
            // Whatever the model, a surface shows its color.
            for model in OpticalModel::ALL {
                let plan = Plan { model, ..with_surfaces(&plan(view, &[[0.0; 4]], &[[0.0, 0.0]]), vec![surface]) };
                for renderer in Renderer::EXACT {
                    for pixel in renderer.draw(&mesh, &scalars, &plan).pixels() {
                        for c in 0..3 {
                            assert!(
                                (f64::from(pixel[c]) - 0.5 * color[c]).abs() < 1e-6,
                                "{renderer:?}, {model}, {pixel:?}"
                            );
                        }
                        assert!((pixel[3] - 0.5).abs() < 1e-6);
                    }
                }
            }
        }
    }
}

/// An opaque sphere: what is inside of it, where scalars are lower, is nobody's business.
#[test]
fn opaque_surface_hides_what_is_behind() {
    let (mesh, scalars) = sample(10);
    let view = view_from(6.0, 60);
    let inner_color: &[[f64; 4]] = &[[0.09, 0.0, 0.0, 9.0], [0.09, 0.5, 0.5, 0.5], [1.0, 0.2, 0.6, 0.1]];
    let other_color: &[[f64; 4]] = &[[0.09, 9.0, 0.0, 0.0], [0.09, 0.5, 0.5, 0.5], [1.0, 0.2, 0.6, 0.1]];
    let inside_out = |color| {
        let extinction = [[0.09, 5.0], [0.09, 0.4], [1.0, 0.8]];
        with_surfaces(&plan(view, color, &extinction), vec![white(0.1, 1.0), white(-0.3, 1.0)])
    };
    for renderer in Renderer::EXACT {
        let draw = |color| renderer.draw(&mesh, &scalars, &inside_out(color));
        let center = |image: &tetrascope::LinearImage| image.pixel(30, 30);
        let (one, other) = (draw(inner_color), draw(other_color));
        assert!((center(&one)[3] - 1.0).abs() < 1e-6);
        let differing =
            one.pixels().iter().zip(other.pixels()).filter(|(p, q)| (0..4).any(|c| (p[c] - q[c]).abs() > 1e-5));
        let count = differing.count();
        println!("hidden, {renderer:?}: {count} pixels differ");
        // Where centroids put a cell behind the surface before those in front of it, it shows.
        let allowed = if renderer.sorts_per_pixel() { 0 } else { 4 };
        assert!(count <= allowed, "{renderer:?}: {count} pixels show what is hidden");
    }
}

/// One color, so that no order of cells shows: splitting cells inside changes nothing.
#[test]
fn splitting_cells_moves_no_surface() {
    for seed in 0..4 {
        let mut tets = Tets::block(2, seed + 5000);
        let mut fine = tets.clone();
        let mut random = Random::new(seed);
        for _ in 0..25 {
            let cell = fine.cells[(random.unit() * fine.cells.len() as f64) as usize];
            fine.split(&cell, &[0.1, 0.2, 0.3, 0.4]);
        }
        for is_linear in [false, true] {
            if is_linear {
                // Gradients at the points are the field's on any mesh.
                for tets in [&mut tets, &mut fine] {
                    tets.scalars = tets.points.iter().map(|p| 0.4 * p.x - 0.3 * p.y + 0.8 * p.z).collect();
                }
            }
            let shading = if is_linear { SurfaceShading::Smooth } else { SurfaceShading::None };
            let surface = |value| Isosurface { shading, ..white(value, 0.4) };
            for is_perspective in [false, true] {
                let camera = random_camera(&mut random, DVec3::ZERO, 1.0, is_perspective);
                let view = View::new(&camera, 50, 50).unwrap();
                let mut plan = surfaces_alone(view, vec![surface(-0.3), surface(0.123)]);
                plan.lighting = Some(tetrascope::Lighting::default());
                for renderer in Renderer::EXACT {
                    let coarse = renderer.draw(&tets.mesh(), &tets.scalars, &plan);
                    let split = renderer.draw(&fine.mesh(), &fine.scalars, &plan);
                    assert!(mean_opacity(&coarse) > 0.03);
                    // Rounding of positions along a ray; highlights of exponent 32 make some 100 times as much of it.
                    let found = tetrascope_tests::compare::difference(&coarse, &split, 2e-5, &[]);
                    // A ray that grazes a surface may count it or not.
                    assert!(found.beyond <= 1, "seed {seed}, linear {is_linear}, {renderer:?}: {found:?}");
                }
            }
        }
    }
}

/// The order in which surfaces are given, the number of threads, and what was drawn before change no bit.
#[test]
fn same_bits_in_any_order_and_number_of_threads() {
    let (mesh, scalars) = sample(10);
    let surfaces = vec![white(0.2, 0.5), white(-0.2, 0.25), white(0.0, 0.75), white(0.4, 0.1)];
    let base = plan(view_from(5.0, 90), COLOR, EXTINCTION);
    let reversed = surfaces.iter().rev().copied().collect();
    let (one, other) = (with_surfaces(&base, surfaces.clone()), with_surfaces(&base, reversed));
    for renderer in Renderer::EXACT {
        let first = renderer.draw(&mesh, &scalars, &one);
        assert_eq!(first, renderer.draw(&mesh, &scalars, &other), "{renderer:?}");
        for threads in [1, 2, 3] {
            let image = renderer.draw(&mesh, &scalars, &Plan { threads: Some(threads), ..one.clone() });
            assert_eq!(first, image, "{renderer:?}, {threads} threads");
        }
    }
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let draw = |plan: &Plan| renderer.render(plan, &Silent).unwrap().image;
    let first = draw(&one);
    let transfer = TransferFunction::new(COLOR, &[[0.0, 0.0]]).unwrap();
    let others = [
        base,
        with_surfaces(&one, surfaces[..2].to_vec()),
        with_surfaces(&one, surfaces.iter().map(|s| Isosurface { opacity: 1.0, ..*s }).collect()),
        Plan { transfer, ..one.clone() },
    ];
    for (i, other) in others.iter().enumerate() {
        assert_ne!(first.pixels(), draw(other).pixels(), "change {i} shows");
        assert_eq!(first, draw(&one), "after change {i}");
    }
}

/// The eye in the mesh: cells reach behind it, and surfaces stand in front.
#[test]
fn eye_inside_the_mesh() {
    let mut worst = Worst::new("surface seen from inside", 1e-5);
    let mut shown = 0;
    for seed in 0..4 {
        let tets = Tets::block(3, seed + 5200);
        let mesh = tets.mesh();
        let mut random = Random::new(seed);
        for fov_y in [1.0, 2.2] {
            let eye = random.point() * 0.4;
            let camera = Camera {
                eye,
                target: eye + random.point(),
                up: DVec3::new(0.3, 1.0, 0.2),
                projection: Projection::Perspective { fov_y },
            };
            let view = View::new(&camera, 50, 40).unwrap();
            let plan = surfaces_alone(view, vec![white(0.1, 0.5), white(-0.35, 0.5)]);
            let [fast, slow] = Renderer::EXACT.map(|renderer| renderer.draw(&mesh, &tets.scalars, &plan));
            shown += usize::from(mean_opacity(&slow) > 0.1);
            worst.note(largest(&fast, &slow, 0..4), || format!("seed {seed}, field of view {fov_y}"));
        }
    }
    assert!(shown >= 5, "surfaces show in {shown} of 8 pictures");
    worst.finish();
}
