//! Isosurfaces and light in the reference, where the answer is known.

use glam::DVec3;
use tetrascope_integrate::{
    Integration, Isosurface, Isosurfaces, OpticalModel, Phong, SurfaceShading, TableSettings, TransferFunction,
};
use tetrascope_mesh::{Cells, Dataset, StructuredBlock, TetMesh, decompose, rings_sample};
use tetrascope_scene::{IsosurfaceMethod, IsosurfacePlan, Lighting, Mixing, Plan, PlanError, Silent};
use tetrascope_view::{Camera, LinearImage, Projection, View};

use crate::{RenderError, reference};

const COLOR: [f64; 3] = [0.9, 0.5, 0.25];
const BACK_COLOR: [f64; 3] = [0.125, 0.25, 0.75];

/// A cube of `n` cells a side with its lowest corner at the origin, and a field on it.
fn cube(n: usize, cell: f64, field: impl Fn(DVec3) -> f64) -> (TetMesh, Vec<f64>) {
    let side = n + 1;
    let at = |i: usize| DVec3::new((i % side) as f64, (i / side % side) as f64, (i / side / side) as f64) * cell;
    let points: Vec<DVec3> = (0..side.pow(3)).map(at).collect();
    let scalars = points.iter().map(|&p| field(p)).collect();
    let block = StructuredBlock { dims: [side; 3], first_point: 0, hidden_points: Vec::new() };
    let cells = Cells::Structured(vec![block]);
    (decompose(&Dataset { points, cells, ..Dataset::default() }).unwrap().mesh, scalars)
}

/// Along an axis at the middle of such a cube; the pixels are half a cell wide, and their centers lie on the grid's points,
/// edges and faces. `along` is a unit vector.
fn on_the_grid(n: usize, cell: f64, along: DVec3) -> View {
    let pixels = 2 * n as u32 + 3;
    let middle = DVec3::splat(0.5 * n as f64 * cell);
    let camera = Camera {
        eye: middle - along * (3.0 * n as f64 * cell),
        target: middle,
        up: if along.y == 0.0 { DVec3::Y } else { DVec3::Z },
        projection: Projection::Orthographic { height: f64::from(pixels) * 0.5 * cell },
    };
    View::new(&camera, pixels, pixels).unwrap()
}

fn surface(value: f64, opacity: f64) -> Isosurface {
    Isosurface { value, color: COLOR, back_color: BACK_COLOR, opacity, shading: SurfaceShading::None }
}

/// A plan with a homogeneous volume of one color.
fn plan_of(view: View, extinction: f64, model: OpticalModel, surfaces: &[Isosurface]) -> Plan {
    let transfer = TransferFunction::new(&[[0.0, 0.2, 0.4, 0.6]], &[[0.0, extinction]]).unwrap();
    let surfaces = Isosurfaces::new(surfaces.to_vec()).unwrap();
    let isosurfaces = Some(IsosurfacePlan { surfaces, method: IsosurfaceMethod::Exact });
    Plan { isosurfaces, ..Plan::new(view, transfer, model) }
}

fn surfaces_alone(view: View, surfaces: &[Isosurface]) -> Plan {
    plan_of(view, 0.0, OpticalModel::DensityEmitter, surfaces)
}

fn draw((mesh, scalars): &(TetMesh, Vec<f64>), plan: &Plan) -> LinearImage {
    reference::render(mesh, scalars, plan, &Silent).unwrap().image
}

/// Which pixels the mesh covers; not those whose rays touch it in a point that rounding gives a length of 1e-16.
fn covered(cube: &(TetMesh, Vec<f64>), view: View) -> Vec<bool> {
    let mut plan = plan_of(view, 1.0, OpticalModel::DensityEmitter, &[surface(0.0, 0.0)]);
    plan.isosurfaces = None;
    draw(cube, &plan).pixels().iter().map(|pixel| pixel[3] > 1e-9).collect()
}

fn rgba(rgb: [f64; 3], opacity: f64) -> [f32; 4] {
    let [r, g, b] = rgb.map(|channel| channel as f32);
    [r, g, b, opacity as f32]
}

fn times(color: [f64; 3], factor: f64) -> [f64; 3] {
    color.map(|channel| channel * factor)
}

/// Rounding of what becomes f32 in the end, with a few operations in f64 before.
fn assert_near(found: [f32; 4], expected: [f32; 4], what: &str) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-7 * (1.0 + b.abs()), "{what}: {found:?}, expected {expected:?}");
    }
}

/// A surface across all rays covers what the mesh covers, each pixel once and to the last bit, from both sides; also where it lies
/// in the grid's planes and the rays run through its points and edges.
#[test]
fn surface_across_the_rays_has_no_hole_and_no_seam() {
    for (n, cell) in [(4, 0.25), (7, 0.1)] {
        let cube = cube(n, cell, |p| p.z);
        let on_a_plane = cube.1[(n + 1) * (n + 1) * 2];
        for (along, color) in [(DVec3::Z, BACK_COLOR), (-DVec3::Z, COLOR)] {
            let view = on_the_grid(n, cell, along);
            let inside = covered(&cube, view);
            assert_eq!(inside.iter().filter(|inside| **inside).count(), 4 * n * n);
            for value in [on_a_plane, 0.3, 1.0 / 3.0, 2.0 * cell, 0.999 * cell] {
                for opacity in [1.0, 0.35] {
                    let picture = draw(&cube, &surfaces_alone(view, &[surface(value, opacity)]));
                    for (found, &inside) in picture.pixels().iter().zip(&inside) {
                        let expected = if inside { rgba(times(color, opacity), opacity) } else { [0.0; 4] };
                        assert_eq!(*found, expected, "value {value}, opacity {opacity}, {n} cells a side");
                    }
                }
            }
        }
    }
}

/// A scalar on the value of a surface counts as above it: of surfaces in the mesh's boundary the one at the highest scalar is
/// there and the one at the lowest is not, from wherever they are seen.
#[test]
fn surface_in_the_boundary_is_there_or_not_as_a_whole() {
    for (n, cell) in [(4, 0.25), (7, 0.1)] {
        let cube = cube(n, cell, |p| p.z);
        let highest = *cube.1.last().unwrap();
        for along in [DVec3::Z, -DVec3::Z] {
            let view = on_the_grid(n, cell, along);
            let is_seen = |value: f64| {
                let picture = draw(&cube, &surfaces_alone(view, &[surface(value, 1.0)]));
                picture.pixels().iter().map(|pixel| pixel[3] == 1.0).collect::<Vec<bool>>()
            };
            assert_eq!(is_seen(highest), covered(&cube, view));
            assert!(is_seen(0.0).iter().all(|seen| !seen));
        }
    }
}

/// Rays that run in a surface do not cross it, however their scalars round.
#[test]
fn surface_along_the_rays_is_not_seen() {
    for (n, cell) in [(4, 0.25), (7, 0.1), (9, 1.0 / 3.0)] {
        let cube = cube(n, cell, |p| p.x);
        let values: Vec<f64> = (1..n).map(|i| cube.1[i]).collect();
        for along in [DVec3::Z, -DVec3::Z, DVec3::Y, -DVec3::Y] {
            let surfaces: Vec<Isosurface> = values.iter().map(|&value| surface(value, 0.5)).collect();
            let picture = draw(&cube, &surfaces_alone(on_the_grid(n, cell, along), &surfaces));
            for pixel in picture.pixels() {
                assert_eq!(*pixel, [0.0; 4], "{n} cells a side along {along}");
            }
        }
    }
}

/// Through a closed surface every ray goes in and out, so that colors alternate and their number is even.
#[test]
fn closed_surface_is_entered_as_often_as_left() {
    let dataset = rings_sample(9);
    let scalars = dataset.point_arrays[0].component(0);
    let sample = (decompose(&dataset).unwrap().mesh, scalars);
    // Two of them are scalars of inner points.
    let values = [0.0, 0.1234, sample.1[557], sample.1[666]];
    let orthographic = Projection::Orthographic { height: 2.2 };
    for (eye, projection) in [
        (DVec3::new(2.0, 1.4, 2.5), Projection::Perspective { fov_y: 0.6 }),
        (DVec3::new(0.0, 0.0, 3.0), orthographic),
        (DVec3::new(3.0, 0.0, 0.0), orthographic),
    ] {
        let up = if eye.x == 0.0 { DVec3::Y } else { DVec3::Z };
        let view = View::new(&Camera { eye, target: DVec3::ZERO, up, projection }, 63, 63).unwrap();
        for value in values {
            let picture = draw(&sample, &surfaces_alone(view, &[surface(value, 0.5)]));
            let mut seen = 0;
            for pixel in picture.pixels() {
                // From outside the scalar falls.
                let twice: [f64; 3] = std::array::from_fn(|i| 0.5 * COLOR[i] + 0.25 * BACK_COLOR[i]);
                let four_times: [f64; 3] = std::array::from_fn(|i| 1.25 * twice[i]);
                match pixel[3] {
                    0.0 => assert_eq!(*pixel, [0.0; 4]),
                    0.75 => assert_near(*pixel, rgba(twice, 0.75), "in and out"),
                    // The linear pieces of the surface are not convex everywhere.
                    _ => assert_near(*pixel, rgba(four_times, 0.9375), "in and out twice"),
                }
                seen += usize::from(pixel[3] > 0.0);
            }
            assert!(seen > 400, "value {value} from {eye}: {seen} pixels");
        }
    }
}

/// Homogeneous volume in front of a surface and behind it, in every optical model.
#[test]
fn volume_in_front_and_behind() {
    const EXTINCTION: f64 = 1.7;
    let (n, cell, value) = (4, 0.25, 0.3);
    let cube = cube(n, cell, |p| p.z);
    let view = on_the_grid(n, cell, DVec3::Z);
    let volume = [0.2, 0.4, 0.6];
    for model in OpticalModel::ALL {
        // Light for one of color and transmittance.
        let layer = |length: f64| {
            let transmittance = if model.needs_extinction() { (-EXTINCTION * length).exp() } else { 1.0 };
            let light = match model {
                OpticalModel::DensityEmitter => 1.0 - transmittance,
                OpticalModel::Emitter => (1.0 - transmittance) / EXTINCTION,
                OpticalModel::Absorption => 0.0,
                OpticalModel::Emission => length,
            };
            (light, transmittance)
        };
        let ((front, through), (back, out)) = (layer(value), layer(1.0 - value));
        for opacity in [1.0, 0.4, 0.0] {
            let rgb: [f64; 3] = std::array::from_fn(|i| {
                volume[i] * front + through * (opacity * BACK_COLOR[i] + (1.0 - opacity) * volume[i] * back)
            });
            let expected = rgba(rgb, 1.0 - through * (1.0 - opacity) * out);
            let plan = plan_of(view, EXTINCTION, model, &[surface(value, opacity)]);
            let picture = draw(&cube, &plan);
            assert_near(picture.pixel(5, 5), expected, &format!("{model}, opacity {opacity}, on an edge"));
            assert_near(picture.pixel(4, 6), expected, &format!("{model}, opacity {opacity}"));
        }
    }
}

/// Several surfaces in one cell, in the order in which they are met; those of one value as well.
#[test]
fn surfaces_are_met_in_order() {
    let cube = cube(1, 1.0, |p| p.z);
    let colors = [[0.25, 0.5, 0.75], [0.5, 1.0, 0.0], [1.0, 0.0, 0.125]];
    let values = [0.25, 0.5, 0.5];
    let surfaces: Vec<Isosurface> = colors
        .iter()
        .zip(values)
        .map(|(&color, value)| Isosurface { color, back_color: times(color, 0.5), ..surface(value, 0.5) })
        .collect();
    for (along, shown, factor) in [(DVec3::Z, [0, 1, 2], 0.5), (-DVec3::Z, [2, 1, 0], 1.0)] {
        let plan = surfaces_alone(on_the_grid(1, 1.0, along), &surfaces);
        let rgb: [f64; 3] = std::array::from_fn(|i| {
            shown.iter().rev().fold(0.0, |behind, &k| 0.5 * factor * colors[k][i] + 0.5 * behind)
        });
        assert_near(draw(&cube, &plan).pixel(2, 2), rgba(rgb, 0.875), "three layers");
    }
}

const PHONG: Phong = Phong { ambient: 0.2, diffuse: 0.5, specular: 0.3, shininess: 8.0 };

/// Phong's model as written in a textbook, with unit vectors.
fn phong(color: [f64; 3], normal: DVec3, to_eye: DVec3, to_light: DVec3) -> [f64; 3] {
    let cosine = normal.dot(to_light);
    let mirrored = 2.0 * cosine * normal - to_light;
    let highlight = if cosine > 0.0 { 0.3 * mirrored.dot(to_eye).max(0.0).powi(8) } else { 0.0 };
    color.map(|channel| channel * (0.2 + 0.5 * cosine.max(0.0)) + highlight)
}

fn lit(mut plan: Plan, direction: Option<DVec3>, volume: bool) -> Plan {
    plan.lighting = Some(Lighting { phong: PHONG, direction, volume });
    plan
}

fn shaded(surface: Isosurface, shading: SurfaceShading) -> Isosurface {
    Isosurface { shading, ..surface }
}

/// A plane has one normal, whichever gradients it comes from; a perspective ray has its own direction to the eye.
#[test]
fn plane_in_the_light() {
    let gradient = DVec3::new(0.3, -0.2, 1.0);
    // Cells far from cubes, small and far away: only directions count.
    for (scale, offset) in [(1.0, 0.0), (1e-7, 2e-7), (1e8, -3e9)] {
        let (mesh, scalars) = cube(3, scale, |p| gradient.dot(p / scale));
        let points: Vec<DVec3> = mesh.positions().iter().map(|&p| mesh.frame().to_world(p) + offset).collect();
        let cells: Vec<[u32; 4]> = mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect();
        let cube = (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars);
        let target = DVec3::splat(1.5 * scale + offset);
        let camera = |side: f64| Camera {
            eye: target + DVec3::new(1.0, 2.0, 9.0 * side) * scale,
            target,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 0.3 },
        };
        for (side, color) in [(1.0, COLOR), (-1.0, BACK_COLOR)] {
            let view = View::new(&camera(side), 9, 9).unwrap();
            for light in [None, Some(DVec3::new(0.6, 0.0, 0.8)), Some(DVec3::new(0.0, -1.0, 0.0))] {
                for shading in [SurfaceShading::Flat, SurfaceShading::Smooth] {
                    let surfaces = [shaded(surface(1.65, 1.0), shading)];
                    let picture = draw(&cube, &lit(surfaces_alone(view, &surfaces), light, false));
                    for (x, y) in [(4, 4), (2, 5), (6, 3)] {
                        let to_eye = -view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).direction.normalize();
                        let normal = gradient.normalize() * side;
                        let expected = phong(color, normal, to_eye, light.unwrap_or(to_eye));
                        // Points at a distance of 30 cells have lost 5 bits; gradients of them lose as much.
                        assert_near(picture.pixel(x, y), rgba(expected, 1.0), &format!("{shading:?} at scale {scale}"));
                    }
                }
            }
        }
    }
}

/// Without light, or without shading, a surface has its color.
#[test]
fn light_needs_shading_and_shading_needs_light() {
    let cube = cube(2, 0.5, |p| p.z);
    let view = on_the_grid(2, 0.5, DVec3::Z);
    let plain = draw(&cube, &surfaces_alone(view, &[surface(0.3, 1.0)]));
    let unlit = draw(&cube, &surfaces_alone(view, &[shaded(surface(0.3, 1.0), SurfaceShading::Smooth)]));
    assert_eq!(plain, unlit);
    let unshaded = draw(&cube, &lit(surfaces_alone(view, &[surface(0.3, 1.0)]), None, false));
    assert_eq!(plain, unshaded);
}

/// On a sphere, interpolated normals are nearer to the sphere's than those of the cells.
#[test]
fn smooth_normals_follow_a_sphere() {
    let dataset = rings_sample(16);
    let scalars = dataset.point_arrays[0].component(0);
    let sample = (decompose(&dataset).unwrap().mesh, scalars);
    let camera = Camera {
        eye: DVec3::new(0.0, 0.0, 5.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 0.8 },
    };
    let view = View::new(&camera, 40, 40).unwrap();
    let off = |shading: SurfaceShading| {
        let plan = lit(surfaces_alone(view, &[shaded(surface(0.0, 1.0), shading)]), None, false);
        let picture = draw(&sample, &plan);
        let mut sum = 0.0;
        for (y, x) in (0..40).flat_map(|y| (0..40).map(move |x| (y, x))) {
            let at = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).origin.truncate() / 0.6;
            let normal = at.extend((1.0 - at.length_squared()).sqrt());
            let expected = phong(COLOR, normal, DVec3::Z, DVec3::Z);
            sum += (f64::from(picture.pixel(x, y)[0]) - expected[0]).abs();
        }
        sum / 1600.0
    };
    let (flat, smooth) = (off(SurfaceShading::Flat), off(SurfaceShading::Smooth));
    // Measured as 0.0025 and 0.021, of a brightness of about 0.8.
    assert!(smooth < 0.004 && flat < 0.03, "smooth {smooth}, flat {flat}");
}

/// A linear field has one gradient, so that the whole volume has one factor; its opacity has none.
#[test]
fn volume_in_the_light() {
    let gradient = DVec3::new(0.5, 0.0, 1.0);
    let view = on_the_grid(3, 0.5, DVec3::Z);
    let to_light = DVec3::new(0.0, 0.6, -0.8);
    for (field, normal) in [(gradient, -gradient.normalize()), (DVec3::ZERO, DVec3::ZERO)] {
        let cube = cube(3, 0.5, |p| field.dot(p));
        let mut plan = plan_of(view, 1.5, OpticalModel::DensityEmitter, &[surface(9.0, 1.0)]);
        for with_surfaces in [true, false] {
            if !with_surfaces {
                plan.isosurfaces = None;
            }
            let dark = draw(&cube, &plan);
            let bright = draw(&cube, &lit(plan.clone(), Some(to_light), true));
            let factor = if field == DVec3::ZERO { 0.2 } else { phong([1.0; 3], normal, -DVec3::Z, to_light)[0] };
            for (dark, bright) in dark.pixels().iter().zip(bright.pixels()) {
                let [r, g, b, opacity] = dark.map(f64::from);
                assert_near(*bright, rgba(times([r, g, b], factor), opacity), "lit volume");
            }
        }
    }
}

/// The reference cuts rays, whatever maps the plan asks for.
#[test]
fn maps_are_not_looked_at() {
    let cube = cube(2, 0.5, |p| p.z * p.x);
    let mut plan = plan_of(on_the_grid(2, 0.5, DVec3::Z), 1.0, OpticalModel::Emitter, &[surface(0.3, 0.5)]);
    let exact = draw(&cube, &plan);
    for mixing in [Mixing::Smooth, Mixing::Stopped] {
        plan.isosurfaces.as_mut().unwrap().method = IsosurfaceMethod::Map { size: 4, mixing };
        assert_eq!(draw(&cube, &plan), exact);
    }
}

/// Homogeneous volume: every method that covers the model has the light of the exact one, within what a table interpolates.
#[test]
fn every_integration_along_a_ray_is_drawn() {
    let cube = cube(3, 0.5, |p| p.z + 0.3 * p.x);
    let view = on_the_grid(3, 0.5, DVec3::Z);
    for model in OpticalModel::ALL {
        let mut plan = plan_of(view, 0.7, model, &[surface(0.8, 0.5)]);
        let exact = draw(&cube, &plan);
        for integration in Integration::ALL {
            if integration.needs_fan() {
                continue;
            }
            plan.integration = integration;
            let drawn = reference::render(&cube.0, &cube.1, &plan, &Silent);
            if !integration.covers(model) {
                assert!(matches!(drawn, Err(RenderError::Plan(PlanError::Method(_)))), "{integration} {model}");
                continue;
            }
            let drawn = drawn.unwrap();
            assert!(drawn.counts.crossings > 30, "{integration} {model}: {:?}", drawn.counts);
            // A two-dimensional table takes opacity as proportional to length, which no homogeneous volume has: a loose bound.
            let within = if integration == Integration::Table2d { 0.1 } else { 2e-4 };
            for (a, b) in drawn.image.pixels().iter().flatten().zip(exact.pixels().iter().flatten()) {
                assert!((a - b).abs() < within, "{integration} {model}: {a}, exactly {b}");
            }
        }
    }
}

/// A mesh of which nothing is left has nothing to look up.
#[test]
fn nothing_is_drawn_of_an_empty_mesh() {
    let (mesh, scalars) = cube(1, 1.0, |p| p.z);
    let empty = mesh.retain(|_| false);
    for integration in [Integration::Exact, Integration::Table2d, Integration::Table3d] {
        let mut plan = plan_of(on_the_grid(1, 1.0, DVec3::Z), 1.0, OpticalModel::Emitter, &[surface(0.3, 0.5)]);
        plan.integration = integration;
        let drawn = reference::render(&empty, &scalars, &plan, &Silent).unwrap();
        assert!(drawn.image.pixels().iter().flatten().all(|channel| *channel == 0.0), "{integration}");
    }
}

#[test]
fn vertex_is_refused() {
    let (mesh, scalars) = cube(1, 1.0, |p| p.z);
    let mut plan = plan_of(on_the_grid(1, 1.0, DVec3::Z), 1.0, OpticalModel::Emitter, &[surface(0.3, 0.5)]);
    plan.integration = Integration::Vertex;
    let error = reference::render(&mesh, &scalars, &plan, &Silent).unwrap_err();
    assert!(matches!(error, RenderError::IntegrationNeedsFan), "{error}");
}

/// A table smears what lies in a step of the transfer function over a sample. Cells beside it show nothing all the same, as in every other renderer.
#[test]
fn tables_show_nothing_of_cells_that_have_nothing_to_show() {
    let mut plan = plan_of(on_the_grid(2, 0.5, DVec3::Z), 0.0, OpticalModel::DensityEmitter, &[]);
    plan.isosurfaces = None;
    plan.transfer = TransferFunction::new(&[[0.0, 0.2, 0.4, 0.6]], &[[0.51, 0.0], [0.51, 40.0]]).unwrap();
    plan.tables = Some(TableSettings { scalars: 4, ..TableSettings::of(Integration::Table3d).unwrap() });
    // Two layers from left to right: scalars from 0 to 0.5, and from 0.5 to 1.
    let cube = cube(2, 0.5, |p| 1.0 - p.x);
    for integration in [Integration::Table2d, Integration::Table3d] {
        plan.integration = integration;
        let image = draw(&cube, &plan);
        let opacities = |columns: std::ops::Range<usize>| {
            let row = &image.pixels()[3 * 7..4 * 7];
            row[columns].iter().map(|p| p[3]).collect::<Vec<_>>()
        };
        assert_eq!(opacities(0..3), [0.0; 3], "{integration}");
        assert!(opacities(4..5)[0] > 0.5, "{integration}: {:?}", opacities(0..7));
    }
}
