//! Regular grids seen straight down an axis: rays run along faces and edges and through vertices of every cell.
//!
//! A pixel whose center projects onto the outline may show all or nothing, since its ray runs in the boundary; every other
//! one shows the full depth. Tools that decide for each cell alone leave such pixels dark, or draw them twice.

use glam::DVec3;
use tetrascope::{Camera, Decomposition, Integration, Projection, View};
use tetrascope_tests::chords::chord_of_box;
use tetrascope_tests::meshes::{grid, hexahedra};
use tetrascope_tests::pictures::{Renderer, WHITE, Worst, plan};

const CELLS: usize = 4;
/// A depth of 1.2 through the grid.
const EXTINCTION: f64 = 0.3;

/// The six axis directions with an up direction.
fn axes() -> impl Iterator<Item = (DVec3, DVec3)> {
    [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::X), (DVec3::Z, DVec3::Y)]
        .into_iter()
        .flat_map(|(axis, up)| [(axis, up), (-axis, up)])
}

/// Both ways to cut the cubes, about the world's origin and far from it.
fn grids() -> Vec<(String, Decomposition, DVec3)> {
    let mut made = Vec::new();
    for place in [DVec3::ZERO, DVec3::new(5e5, 5e6, 1024.0)] {
        let lowest = place - 0.5 * CELLS as f64;
        made.push((format!("structured at {place}"), grid([CELLS; 3], lowest, 1.0), place));
        made.push((format!("hexahedra at {place}"), hexahedra([CELLS; 3], lowest, 1.0), place));
    }
    made
}

/// Compares a view of a grid with the chord of its box. Inside of the outline nothing is left out.
fn check_grid(grid: &Decomposition, center: DVec3, view: View, place: &str, worst: &mut Worst) {
    let half = 0.5 * CELLS as f64;
    for renderer in Renderer::EXACT.into_iter().chain([Renderer::Fast(Integration::Average)]) {
        let scalars = vec![0.0; grid.mesh.positions().len()];
        let image = renderer.draw(&grid.mesh, &scalars, &plan(view, WHITE, &[[0.0, EXTINCTION]]));
        for y in 0..view.height {
            for x in 0..view.width {
                let mut ray = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
                ray.origin -= center;
                // The smallest and the largest chord of a box that is a little smaller or larger decide who is on the outline.
                let opacity = |grown: f64| {
                    let chord = chord_of_box(DVec3::splat(-half - grown), DVec3::splat(half + grown), &ray);
                    -(-EXTINCTION * chord).exp_m1()
                };
                let (inner, outer) = (opacity(-1e-7), opacity(1e-7));
                let found = f64::from(image.pixel(x, y)[3]);
                let is_on_outline = outer - inner > 1e-3;
                let error = if is_on_outline {
                    // All or nothing.
                    (found - outer).abs().min(found.abs())
                } else {
                    (found - inner).abs()
                };
                worst.note(error, || {
                    format!(
                        "{place}, {renderer:?}, pixel ({x}, {y}): {found} instead of {inner}, outline {is_on_outline}"
                    )
                });
            }
        }
    }
}

#[test]
fn regular_grids_down_an_axis_have_no_dark_pixels_in_parallel_views() {
    // f32 transmittances of up to 8 cells a ray: 8 half ulps, and planes without slope. 1e-7 for the outline's margin.
    let mut worst = Worst::new("grid down an axis, parallel", 2e-6);
    for (name, grid, center) in grids() {
        for (axis, up) in axes() {
            // Pixels a cell: centers on vertices, edges and faces alike; 1 makes both grids the same.
            for (side, per_cell) in [(9, 2.0), (5, 1.0), (4, 1.0), (17, 4.0), (24, 4.0), (13, 3.0)] {
                let height = f64::from(side) / per_cell;
                let camera = Camera {
                    eye: center - axis * 8.0,
                    target: center,
                    up,
                    projection: Projection::Orthographic { height },
                };
                let view = View::new(&camera, side, side).unwrap();
                let place = format!("{name} along {axis}, {side} pixels, {per_cell} a cell");
                check_grid(&grid, center, view, &place, &mut worst);
            }
        }
    }
    worst.finish();
}

#[test]
fn regular_grids_down_an_axis_have_no_dark_pixels_in_perspective() {
    // As chords on random meshes, but with few cells.
    let mut worst = Worst::new("grid down an axis, perspective", 5e-6);
    for (name, grid, center) in grids() {
        for (axis, up) in axes() {
            // Outside, on the front face's vertex, on an inner vertex, on an inner edge, in the middle of a cell's face.
            for (distance, fov_y) in [(9.0, 0.6), (3.0, 1.9), (2.0, 2.0), (1.0, 1.5), (0.0, 1.5), (0.5, 2.2)] {
                for (side, shift) in [(21, 0.0), (20, 0.0), (21, 0.5)] {
                    let across = up.cross(axis) * shift;
                    let camera = Camera {
                        eye: center - axis * distance + across,
                        target: center + axis * 5.0 + across,
                        up,
                        projection: Projection::Perspective { fov_y },
                    };
                    let view = View::new(&camera, side, side).unwrap();
                    let place = format!("{name} along {axis} from {distance}, {side} pixels, {shift} aside");
                    check_grid(&grid, center, view, &place, &mut worst);
                }
            }
        }
    }
    worst.finish();
}

/// Where the slope of a column's rays equals the grid's, rays meet a vertex in every layer of cells.
#[test]
fn rays_through_vertices_of_every_layer() {
    let mut worst = Worst::new("grid, rays through vertices", 5e-6);
    for (name, grid, center) in grids() {
        // At distance 4 in front of the middle, pixels of slope 1/4 and 1/2 pass through vertices of layers.
        for (distance, slope) in [(4.0, 0.25), (4.0, 0.5), (3.0, 0.5), (6.0, 0.25)] {
            let camera = Camera {
                eye: center + DVec3::Z * distance,
                target: center,
                up: DVec3::Y,
                projection: Projection::Perspective { fov_y: 2.0 * (slope * 3.5_f64).atan() },
            };
            let view = View::new(&camera, 7, 7).unwrap();
            check_grid(&grid, center, view, &format!("{name} from {distance}, slope {slope}"), &mut worst);
        }
    }
    worst.finish();
}

/// A mesh cut in two along the very faces that rays run in: each ray of the common outline belongs to one half, so that the
/// halves' transmittances multiply to the whole's.
#[test]
fn halves_of_a_grid_add_up_to_the_whole() {
    // Two pictures' rounding on top of the whole's.
    let mut worst = Worst::new("two halves against the whole", 1e-6);
    let center = DVec3::new(2.0, 2.0, 2.0);
    let whole = grid([CELLS; 3], DVec3::ZERO, 1.0).mesh;
    for (axis, up) in axes() {
        for (is_perspective, side) in [(false, 9), (true, 9), (true, 12)] {
            let projection = if is_perspective {
                Projection::Perspective { fov_y: 0.9 }
            } else {
                Projection::Orthographic { height: 4.5 }
            };
            let camera = Camera { eye: center - axis * 7.0, target: center, up, projection };
            let plan = plan(View::new(&camera, side, side).unwrap(), WHITE, &[[0.0, EXTINCTION]]);
            for cut in 0..3 {
                let middle = |cell| whole.corners(cell).iter().map(|p| p[cut]).sum::<f64>();
                let half = |upper: bool| whole.retain(|cell| (middle(cell) > 0.0) == upper);
                for renderer in Renderer::EXACT {
                    let transmittances = [whole.clone(), half(false), half(true)].map(|mesh| {
                        let image = renderer.draw(&mesh, &vec![0.0; mesh.positions().len()], &plan);
                        image.pixels().iter().map(|p| 1.0 - f64::from(p[3])).collect::<Vec<_>>()
                    });
                    let [whole, lower, upper] = &transmittances;
                    for (i, ((whole, lower), upper)) in whole.iter().zip(lower).zip(upper).enumerate() {
                        worst.note((whole - lower * upper).abs(), || {
                            format!("along {axis}, cut {cut}, perspective {is_perspective}, {renderer:?}, pixel {i}")
                        });
                    }
                }
            }
        }
    }
    worst.finish();
}
