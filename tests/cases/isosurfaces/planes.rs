//! Planes: with the scalar z, a surface is a plane in a box, and every pixel is known.
//!
//! Values lie between the layers of the grid, exactly on them, and beside them by less than f32 can tell.

use glam::DVec3;
use tetrascope::mesh::TetMesh;
use tetrascope::{Camera, Projection, View};
use tetrascope_tests::meshes::{Random, grid, hexahedra};
use tetrascope_tests::pictures::{Renderer, Worst, random_camera};
use tetrascope_tests::surfaces::{place, points, ray_of, surfaces_alone, white};

/// Cells a side.
const CELLS: usize = 4;

fn view(eye: DVec3, target: DVec3, up: DVec3, projection: Projection, side: u32) -> View {
    View::new(&Camera { eye, target, up, projection }, side, side).unwrap()
}

/// A grid as cubes of five and of six tetrahedra, its scalar z.
fn boxes(origin: DVec3, cell: f64) -> Vec<(&'static str, TetMesh, Vec<f64>)> {
    [("five", grid([CELLS; 3], origin, cell)), ("six", hexahedra([CELLS; 3], origin, cell))]
        .into_iter()
        .map(|(name, made)| {
            let scalars = points(&made.mesh).iter().map(|p| p.z).collect();
            (name, made.mesh, scalars)
        })
        .collect()
}

/// Whether a ray meets the plane of a height inside of a box; `None` near the box's sides.
fn meets(view: &View, pixel: usize, height: f64, [low, high]: [DVec3; 2]) -> Option<bool> {
    let ray = ray_of(view, pixel);
    let along = (height - ray.origin.z) / ray.direction.z;
    if !along.is_finite() || along <= 0.0 {
        return Some(false);
    }
    let at = ray.origin + ray.direction * along;
    let margin = 1e-6 * (high - low).max_element();
    let inside = |m: f64| (0..2).all(|axis| at[axis] > low[axis] + m && at[axis] < high[axis] - m);
    if inside(margin) {
        Some(true)
    } else if inside(-margin) {
        None
    } else {
        Some(false)
    }
}

/// Every pixel shows the plane's opacity, once, or nothing.
fn check(mesh: &TetMesh, scalars: &[f64], view: View, value: f64, bounds: [DVec3; 2], name: &str, worst: &mut Worst) {
    for opacity in [1.0, 0.375] {
        let plan = surfaces_alone(view, vec![white(value, opacity)]);
        for renderer in Renderer::EXACT {
            let image = renderer.draw(mesh, scalars, &plan);
            for (i, pixel) in image.pixels().iter().enumerate() {
                let Some(meets) = meets(&view, i, value, bounds) else { continue };
                let expected = if meets { opacity } else { 0.0 };
                let error = pixel.iter().map(|c| (f64::from(*c) - expected).abs()).fold(0.0, f64::max);
                worst.note(error, || {
                    format!(
                        "{name}, value {value}, opacity {opacity}, {renderer:?}, pixel {:?}: {} instead of {expected}",
                        place(&view, i),
                        pixel[3]
                    )
                });
            }
        }
    }
}

fn heights(cell: f64, low: f64) -> Vec<f64> {
    [0.5, 1.0, 1.0 + 1e-9, 1.0 - 1e-9, 1.0 + 1e-7, 2.0, 2.73, 3.0, 4.0 - 1e-9]
        .into_iter()
        .map(|h| low + h * cell)
        .collect()
}

#[test]
fn plane_down_the_axis() {
    let mut worst = Worst::new("plane of a grid, down the axis", 1e-6);
    let bounds = [DVec3::ZERO, DVec3::splat(CELLS as f64)];
    let middle = DVec3::splat(2.0);
    for (name, mesh, scalars) in boxes(DVec3::ZERO, 1.0) {
        for height in heights(1.0, 0.0) {
            for (side, size) in [(33, 4.125), (32, 4.0), (17, 5.1)] {
                for eye in [DVec3::new(2.0, 2.0, 9.0), DVec3::new(2.0, 2.0, -6.0)] {
                    for projection in
                        [Projection::Orthographic { height: size }, Projection::Perspective { fov_y: 0.7 }]
                    {
                        let view = view(eye, middle, DVec3::Y, projection, side);
                        check(&mesh, &scalars, view, height, bounds, name, &mut worst);
                    }
                }
            }
        }
    }
    worst.finish();
}

#[test]
fn plane_from_aslant() {
    let mut worst = Worst::new("plane of a grid, from aslant", 1e-6);
    let bounds = [DVec3::ZERO, DVec3::splat(CELLS as f64)];
    for (name, mesh, scalars) in boxes(DVec3::ZERO, 1.0) {
        for height in heights(1.0, 0.0) {
            for seed in 0..4 {
                for is_perspective in [false, true] {
                    let camera = random_camera(&mut Random::new(seed + 9000), DVec3::splat(2.0), 2.4, is_perspective);
                    let view = View::new(&camera, 48, 40).unwrap();
                    check(
                        &mesh,
                        &scalars,
                        view,
                        height,
                        bounds,
                        &format!("{name}, seed {seed}, perspective {is_perspective}"),
                        &mut worst,
                    );
                }
            }
        }
    }
    worst.finish();
}

#[test]
fn plane_from_the_side() {
    let mut worst = Worst::new("plane of a grid, from the side", 1e-6);
    let bounds = [DVec3::ZERO, DVec3::splat(CELLS as f64)];
    for (name, mesh, scalars) in boxes(DVec3::ZERO, 1.0) {
        for height in heights(1.0, 0.0) {
            for axis in [DVec3::X, DVec3::Y] {
                let view = view(
                    DVec3::splat(2.0) + axis * 7.0,
                    DVec3::splat(2.0),
                    DVec3::Z,
                    Projection::Orthographic { height: 4.7 },
                    33,
                );
                check(&mesh, &scalars, view, height, bounds, &format!("{name} along {axis}"), &mut worst);
            }
        }
    }
    worst.finish();
}

#[test]
fn plane_at_any_scale_and_place() {
    let mut worst = Worst::new("plane of a grid, scales and places", 1e-6);
    for (scale, offset) in
        [(1e-9, DVec3::ZERO), (1e9, DVec3::ZERO), (1.0, DVec3::new(5e5, 5e6, 120.0)), (1e9, DVec3::splat(1e12))]
    {
        let bounds = [offset, offset + DVec3::splat(CELLS as f64 * scale)];
        for (name, mesh, scalars) in boxes(offset, scale) {
            for height in heights(scale, offset.z) {
                for seed in 0..2 {
                    for is_perspective in [false, true] {
                        let camera = random_camera(
                            &mut Random::new(seed + 9000),
                            offset + DVec3::splat(2.0 * scale),
                            2.4 * scale,
                            is_perspective,
                        );
                        let view = View::new(&camera, 48, 40).unwrap();
                        check(
                            &mesh,
                            &scalars,
                            view,
                            height,
                            bounds,
                            &format!(
                                "{name}, scale {scale:e}, offset {offset}, seed {seed}, perspective {is_perspective}"
                            ),
                            &mut worst,
                        );
                    }
                }
            }
        }
    }
    worst.finish();
}

#[test]
fn plane_from_far_away() {
    let mut worst = Worst::new("plane of a grid, far eyes", 1e-6);
    let bounds = [DVec3::ZERO, DVec3::splat(CELLS as f64)];
    for (name, mesh, scalars) in boxes(DVec3::ZERO, 1.0) {
        for distance in [1e2, 1e3, 1e4, 1e5] {
            for height in heights(1.0, 0.0) {
                let away = DVec3::new(0.3, -0.4, 1.0).normalize();
                let projection = Projection::Perspective { fov_y: 2.0 * (3.2_f64 / distance).atan() };
                let view = view(DVec3::splat(2.0) + away * distance, DVec3::splat(2.0), DVec3::Y, projection, 40);
                check(&mesh, &scalars, view, height, bounds, &format!("{name} from {distance:e}"), &mut worst);
            }
        }
    }
    worst.finish();
}

/// At the lowest value of the field nothing is crossed, at the highest the side of the box: the same for all pixels.
#[test]
fn plane_in_the_boundary() {
    let mut worst = Worst::new("plane in the boundary of a grid", 1e-6);
    let bounds = [DVec3::ZERO, DVec3::splat(CELLS as f64)];
    for (name, mesh, scalars) in boxes(DVec3::ZERO, 1.0) {
        for (height, expected) in [(0.0, 0.0), (4.0, 0.5)] {
            for seed in 0..4 {
                let camera = random_camera(&mut Random::new(seed + 9000), DVec3::splat(2.0), 2.4, seed % 2 == 0);
                let view = View::new(&camera, 48, 40).unwrap();
                for renderer in Renderer::EXACT {
                    let image = renderer.draw(&mesh, &scalars, &surfaces_alone(view, vec![white(height, 0.5)]));
                    for (i, pixel) in image.pixels().iter().enumerate() {
                        if meets(&view, i, height, bounds) == Some(true) {
                            let error = (f64::from(pixel[3]) - expected).abs();
                            worst.note(error, || {
                                format!("{name}, height {height}, seed {seed}, {renderer:?}, pixel {i}")
                            });
                        }
                    }
                }
            }
        }
    }
    worst.finish();
}
