//! A peak of the transfer function that is narrower than a cell's range of scalars.
//!
//! Along a ray on which the scalar runs through the whole peak the optical depth is the peak's area over the scalar's slope along
//! the ray, however thin the peak is. The exact integration sees it; the ways that look at two ends or at a mean do not.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Integration, Projection, View};
use tetrascope_tests::meshes::{grid, hexahedra};
use tetrascope_tests::pictures::{Renderer, WHITE, Worst, plan};

/// Where the peak is: between the cells' corners.
const AT: f64 = 0.5371;

/// A tent of this half width whose optical depth is 2 where the scalar has a slope of one.
fn tent(half_width: f64) -> Vec<[f64; 2]> {
    vec![[AT - half_width, 0.0], [AT, 2.0 / half_width], [AT + half_width, 0.0]]
}

/// A unit cube of `n` layers whose scalar is z.
fn slab(n: usize) -> Vec<(TetMesh, Vec<f64>)> {
    let cell = 1.0 / n as f64;
    [grid([n; 3], DVec3::ZERO, cell), hexahedra([n; 3], DVec3::ZERO, cell)]
        .into_iter()
        .map(|made| {
            let mesh = made.mesh;
            let scalars = mesh.positions().iter().map(|&p| mesh.frame().to_world(p).z).collect();
            (mesh, scalars)
        })
        .collect()
}

/// From above, a little aside, so that every ray enters through the top and leaves through the bottom.
fn views() -> [View; 2] {
    let camera = |projection| Camera {
        eye: DVec3::new(0.62, 0.55, 3.0),
        target: DVec3::new(0.48, 0.51, 0.0),
        up: DVec3::Y,
        projection,
    };
    [Projection::Perspective { fov_y: 0.15 }, Projection::Orthographic { height: 0.5 }]
        .map(|projection| View::new(&camera(projection), 24, 20).unwrap())
}

/// Tolerance: the peak's ends are f32 about the cell's reference scalar, some 6e-8 of the cell's range; a peak of half width
/// w loses or gains up to 6e-8 / w of its area of 2, so 2e-5 for the narrowest of 1e-2 / 2, and the color follows.
#[test]
fn exact_sees_peaks_narrower_than_a_cell() {
    for (layers, half_width, within) in
        [(1, 0.05, 5e-6), (1, 5e-3, 2e-5), (3, 5e-3, 2e-5), (1, 5e-4, 1e-4), (5, 5e-4, 1e-4)]
    {
        let mut worst = Worst::new(format!("peak of half width {half_width:e} in {layers} layers"), within);
        for (mesh, scalars) in slab(layers) {
            for view in views() {
                let plan = plan(view, WHITE, &tent(half_width));
                for renderer in Renderer::EXACT {
                    let image = renderer.draw(&mesh, &scalars, &plan);
                    for (i, pixel) in image.pixels().iter().enumerate() {
                        let (x, y) = (i as u32 % view.width, i as u32 / view.width);
                        let direction = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).direction;
                        let expected = -(-2.0 / direction.normalize().z.abs()).exp_m1();
                        let error = pixel.iter().map(|c| (f64::from(*c) - expected).abs()).fold(0.0, f64::max);
                        worst.note(error, || format!("{renderer:?}, pixel ({x}, {y}): {} not {expected}", pixel[3]));
                    }
                }
            }
        }
        worst.finish();
    }
}

/// One tetrahedron: scalar 1 at the corner towards the eye and 0 on the opposite face, seen along the gradient and aslant.
#[test]
fn exact_sees_a_peak_in_one_tetrahedron() {
    let corners = [
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::new(2.0, -0.6, 0.0),
        DVec3::new(-0.5, 1.7, 0.0),
        DVec3::new(0.1, 0.05, 1.3),
    ];
    let mesh = TetMesh::from_tetrahedra(&corners, &[[0, 1, 2, 3]]).unwrap().mesh;
    let scalars = [0.0, 0.0, 0.0, 1.0];
    // The scalar's slope is one over the height, so the depth through the peak is 2 times the height.
    let mut worst = Worst::new("peak in one tetrahedron", 2e-5);
    for eye in [DVec3::new(0.1, 0.05, 6.0), DVec3::new(0.6, -0.3, 6.0)] {
        let camera = Camera {
            eye,
            target: DVec3::new(0.1, 0.05, 0.6),
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 0.3 },
        };
        let view = View::new(&camera, 15, 15).unwrap();
        let expected = -(-2.0 * 1.3 / view.forward.z.abs()).exp_m1();
        let plan = plan(view, WHITE, &tent(5e-3));
        for renderer in Renderer::EXACT {
            let image = renderer.draw(&mesh, &scalars, &plan);
            for (i, pixel) in image.pixels().iter().enumerate() {
                worst.note((f64::from(pixel[3]) - expected).abs(), || format!("{renderer:?}, pixel {i}: {}", pixel[3]));
            }
        }
    }
    worst.finish();
}

/// A step up and down between two floats a little apart: a box of area 2.
#[test]
fn exact_sees_a_box_with_vertical_sides() {
    let mut worst = Worst::new("box in a slab", 2e-5);
    let (low, high) = (0.531, 0.541);
    let extinction = [[low, 0.0], [low, 2.0 / (high - low)], [high, 2.0 / (high - low)], [high, 0.0]];
    for layers in [1, 2] {
        for (mesh, scalars) in slab(layers) {
            for view in views() {
                for renderer in Renderer::EXACT {
                    let image = renderer.draw(&mesh, &scalars, &plan(view, WHITE, &extinction));
                    for (i, pixel) in image.pixels().iter().enumerate() {
                        let (x, y) = (i as u32 % view.width, i as u32 / view.width);
                        let direction = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).direction;
                        let expected = -(-2.0 / direction.normalize().z.abs()).exp_m1();
                        worst.note((f64::from(pixel[3]) - expected).abs(), || format!("{renderer:?}, ({x}, {y})"));
                    }
                }
            }
        }
    }
    worst.finish();
}

/// A known defect of the cheaper ways, which documents them and shows that the tests above could fail: in a slab of one
/// layer of cubes every pixel has a depth of 2 or more, opacity 0.86, and they show nothing there, or all.
#[test]
fn average_and_vertex_miss_peaks_between_corners() {
    for (mesh, scalars) in slab(1) {
        for view in views() {
            let plan = plan(view, WHITE, &tent(5e-3));
            for renderer in [
                Renderer::Fast(Integration::Average),
                Renderer::Reference(Integration::Average),
                Renderer::Fast(Integration::Vertex),
            ] {
                let image = renderer.draw(&mesh, &scalars, &plan);
                let wrong = image.pixels().iter().filter(|p| (f64::from(p[3]) - 0.866).abs() > 0.1).count();
                assert!(wrong as f64 > 0.9 * image.pixels().len() as f64, "{renderer:?}: only {wrong} pixels wrong");
            }
        }
    }
}
