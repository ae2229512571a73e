//! Pictures whose pixels sort by themselves: right on every mesh, with every method, in whatever order cells come.

use glam::DVec3;
use proptest::prelude::*;
use tetrascope_integrate::{Integration, Isosurface, Isosurfaces, OpticalModel, SurfaceShading, TransferFunction};
use tetrascope_mesh::{Dataset, TetMesh, decompose, rings_sample};
use tetrascope_order::{CycleRemedy, OrderMethod};
use tetrascope_scene::{Counts, IsosurfaceMethod, IsosurfacePlan, Lighting, Mixing, Plan, PlanError, Silent};
use tetrascope_view::{Camera, LinearImage, Projection, View};

use super::CpuRenderer;
use super::held::LISTED;
use crate::reference;

/// In any channel, between f32 and f64 or between two orders of the same f32 lights: as the issue of pictures asks, some ten times what
/// is measured.
const CLOSE: f32 = 1e-5;

type Sample = (TetMesh, Vec<f64>);

/// Numbers between 0 and 1 that follow from a seed.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A cube from -1 to 1 whose inner points are moved by up to `jitter` of a cell in each direction: convex.
fn grid(cells: usize, jitter: f64, seed: u64) -> Sample {
    let mut dataset = rings_sample(cells);
    let (side, mut random) = (cells + 1, random(seed));
    for (index, point) in dataset.points.iter_mut().enumerate() {
        let place = [index % side, index / side % side, index / side / side];
        let moved = place.map(|i| {
            let free = if (1..cells).contains(&i) { jitter * (2.0 * random() - 1.0) } else { 0.0 };
            (i as f64 + free) / cells as f64 * 2.0 - 1.0
        });
        *point = DVec3::from(moved);
    }
    let scalars = dataset.points.iter().map(|&p| field(p)).collect();
    (decompose(&Dataset { point_arrays: Vec::new(), ..dataset }).unwrap().mesh, scalars)
}

fn field(p: DVec3) -> f64 {
    0.5 + 0.4 * (2.3 * p.x + 0.3).sin() * (1.9 * p.y - 0.2).cos() + 0.2 * p.z
}

/// One tetrahedron of any shape in each of the cubes of a grid, with gaps between.
fn soup(cubes: usize, seed: u64) -> Sample {
    let mut random = random(seed);
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for cube in 0..cubes.pow(3) {
        let place = [cube % cubes, cube / cubes % cubes, cube / cubes / cubes];
        let first = points.len() as u32;
        for _ in 0..4 {
            points.push(DVec3::from(place.map(|i| (i as f64 + 0.98 * random()) / cubes as f64 * 2.0 - 1.0)));
        }
        cells.push([0, 1, 2, 3].map(|i| first + i));
    }
    let scalars = points.iter().map(|_| random()).collect();
    (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars)
}

/// A column of twisted sectors that lean over one another like the blades of a fan: seen along its axis two of the three cells of every
/// sector form one ring.
fn fan() -> Sample {
    let count = 6_u32;
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    for level in 0..2 {
        for i in 0..count {
            let angle = (f64::from(i) - f64::from(level) / 3.0) / f64::from(count) * std::f64::consts::TAU;
            points.push(DVec3::new(angle.cos(), angle.sin(), f64::from(level)));
        }
    }
    points.extend([DVec3::ZERO, DVec3::Z]);
    let (low, high) = (2 * count, 2 * count + 1);
    for i in 0..count {
        let next = (i + 1) % count;
        let [a, b, c, d] = [i, next, count + i, count + next];
        cells.extend([[low, a, b, high], [high, a, b, c], [high, b, c, d]]);
    }
    let scalars = (0..points.len()).map(|i| (i as f64 * 0.37).fract()).collect();
    (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars)
}

/// The same cells numbered otherwise.
fn shuffled((mesh, scalars): &Sample, seed: u64) -> Sample {
    let mut random = random(seed);
    let mut cells: Vec<[u32; 4]> = mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect();
    for last in (1..cells.len()).rev() {
        cells.swap(last, (random() * (last + 1) as f64) as usize);
    }
    let frame = mesh.frame();
    let points: Vec<DVec3> = mesh.positions().iter().map(|&p| p * frame.scale + frame.origin).collect();
    (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars.clone())
}

/// From `eye` at the origin, with an angle that keeps the picture full.
fn from(eye: DVec3) -> View {
    let fov_y = 2.0 * (1.4 / eye.length()).atan();
    view(eye, Projection::Perspective { fov_y: fov_y.min(1.2) })
}

fn view(eye: DVec3, projection: Projection) -> View {
    let camera = Camera { eye, target: DVec3::new(0.01, 0.02, 0.03), up: DVec3::Y, projection };
    View::new(&camera, 45, 41).unwrap()
}

/// Seen through, so that every layer shows.
fn plan(view: View, order: OrderMethod) -> Plan {
    let transfer = TransferFunction::new(
        &[[0.0, 0.9, 0.2, 0.1], [0.4, 0.1, 0.8, 0.3], [0.8, 0.1, 0.2, 0.9]],
        &[[0.0, 0.4], [0.3, 2.0], [0.5, 0.1], [1.0, 3.0]],
    )
    .unwrap();
    Plan { order, ..Plan::new(view, transfer, OpticalModel::DensityEmitter) }
}

fn surface(value: f64, opacity: f64, shading: SurfaceShading) -> Isosurface {
    Isosurface { value, color: [0.9, 0.5, 0.25], back_color: [0.125, 0.25, 0.75], opacity, shading }
}

fn with_surfaces(plan: Plan, surfaces: &[Isosurface], method: IsosurfaceMethod) -> Plan {
    let surfaces = Isosurfaces::new(surfaces.to_vec()).unwrap();
    Plan { isosurfaces: Some(IsosurfacePlan { surfaces, method }), ..plan }
}

fn draw((mesh, scalars): &Sample, plan: &Plan) -> (LinearImage, Counts) {
    let rendered = CpuRenderer::new(mesh, scalars).unwrap().render(plan, &Silent).unwrap();
    (rendered.image, rendered.counts)
}

fn draw_slowly((mesh, scalars): &Sample, plan: &Plan) -> LinearImage {
    reference::render(mesh, scalars, plan, &Silent).unwrap().image
}

/// Largest difference in any channel, and in how many pixels one is more than [`CLOSE`].
fn difference(a: &LinearImage, b: &LinearImage) -> (f32, usize) {
    let pixels = a.pixels().iter().zip(b.pixels());
    let worst = |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let all: Vec<f32> = pixels.map(worst).collect();
    (all.iter().copied().fold(0.0, f32::max), all.iter().filter(|&&d| d > CLOSE).count())
}

fn assert_close(a: &LinearImage, b: &LinearImage, what: &str) {
    assert!(b.pixels().iter().filter(|p| p[3] > 0.01).count() > 50, "{what}: something is seen");
    let (worst, count) = difference(a, b);
    assert!(worst <= CLOSE, "{what}: off by {worst:e}, {count} pixels");
}

fn views() -> [View; 4] {
    [
        from(DVec3::new(2.0, 1.4, 2.5)),
        from(DVec3::new(0.21, 0.13, 0.4)),
        view(DVec3::new(-1.5, 2.0, 1.0), Projection::Orthographic { height: 3.0 }),
        view(DVec3::new(0.0, 0.0, 4.0), Projection::Orthographic { height: 2.5 }),
    ]
}

fn wide_window() -> OrderMethod {
    OrderMethod::KBuffer { window: 100_000 }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn per_pixel_is_the_reference(seed in 1..1_000_u64, eye in prop::array::uniform3(-3.0..3.0_f64)) {
        let eye = DVec3::from(eye);
        prop_assume!(eye.length() > 0.1);
        for sample in [grid(5, 0.2, seed), soup(5, seed), fan()] {
            for method in [OrderMethod::PerPixel, wide_window()] {
                let plan = plan(from(eye), method);
                let (picture, counts) = draw(&sample, &plan);
                let (worst, _) = difference(&picture, &draw_slowly(&sample, &plan));
                prop_assert!(worst <= CLOSE, "{method}: off by {worst:e}");
                prop_assert_eq!(counts.sorted, counts.fragments);
                prop_assert!(counts.most_held > 0 && counts.most_held <= counts.fragments);
            }
        }
    }
}

#[test]
fn per_pixel_is_the_reference_in_every_view() {
    for (name, sample) in [("grid", grid(6, 0.2, 3)), ("soup", soup(6, 4)), ("fan", fan())] {
        for (i, view) in views().into_iter().enumerate() {
            let plan = plan(view, OrderMethod::PerPixel);
            assert_close(&draw(&sample, &plan).0, &draw_slowly(&sample, &plan), &format!("{name}, view {i}"));
        }
    }
}

/// Opaque enough that segments in the wrong order would show, from where 32 bits of depth say nothing of the order of cells.
#[test]
fn far_eyes_sort_as_well() {
    for (name, sample) in [("grid", grid(6, 0.2, 3)), ("soup", soup(6, 4))] {
        for distance in [1e2, 1e4, 1e6, 1e8] {
            let eye = DVec3::new(0.5, 0.4, 0.7).normalize() * distance;
            for view in [from(eye), view(eye, Projection::Orthographic { height: 2.8 })] {
                let plan = plan(view, OrderMethod::PerPixel);
                let what = format!("{name} from {distance:e}");
                assert_close(&draw(&sample, &plan).0, &draw_slowly(&sample, &plan), &what);
            }
        }
    }
}

/// On a convex mesh without rings the order by planes is exact, so that both blend the same lights.
#[test]
fn every_method_and_model_is_as_in_an_exact_order() {
    let sample = grid(5, 0.2, 7);
    for integration in Integration::ALL {
        for model in OpticalModel::ALL.into_iter().filter(|&model| integration.covers(model)) {
            let exact = Plan { integration, model, ..plan(views()[0], OrderMethod::Mpvo) };
            let (expected, counts) = draw(&sample, &exact);
            assert_eq!((counts.sorted, counts.most_held, counts.cyclic), (0, 0, 0));
            let found = draw(&sample, &Plan { order: OrderMethod::PerPixel, ..exact }).0;
            let worst = difference(&found, &expected).0;
            let brightest = expected.pixels().iter().flatten().fold(0.0, |m: f32, &c| m.max(c));
            assert!(brightest > 0.1);
            assert!(worst <= CLOSE * brightest.max(1.0), "{integration}, {model:?}: off by {worst:e}");
        }
    }
}

/// Sides of surfaces are handed on along rays as in an exact order of cells: no pixel tells the two apart.
#[test]
fn surfaces_and_light_are_as_in_an_exact_order() {
    let sample = grid(6, 0.2, 9);
    let (none, flat, smooth) = (SurfaceShading::None, SurfaceShading::Flat, SurfaceShading::Smooth);
    let lit = Some(Lighting { volume: true, ..Lighting::default() });
    let map = IsosurfaceMethod::Map { size: 128, mixing: Mixing::Smooth };
    for (i, view) in views().into_iter().enumerate() {
        let exact = plan(view, OrderMethod::Mpvo);
        let plans = [
            ("opaque", with_surfaces(exact.clone(), &[surface(0.45, 1.0, none)], IsosurfaceMethod::Exact)),
            (
                "transparent",
                with_surfaces(exact.clone(), &[0.3, 0.5, 0.55].map(|v| surface(v, 0.4, flat)), IsosurfaceMethod::Exact),
            ),
            ("lit", Plan { lighting: lit, ..exact.clone() }),
            (
                "lit with surfaces",
                Plan {
                    lighting: lit,
                    ..with_surfaces(exact.clone(), &[surface(0.45, 0.5, smooth)], IsosurfaceMethod::Exact)
                },
            ),
            ("map", with_surfaces(exact.clone(), &[surface(0.3, 0.5, none), surface(0.5, 0.5, none)], map)),
            ("lit map", Plan { lighting: lit, ..with_surfaces(exact.clone(), &[surface(0.45, 0.5, smooth)], map) }),
        ];
        for (name, exact) in plans {
            let (expected, counts) = draw(&sample, &exact);
            assert!(exact.isosurfaces.is_none() || counts.crossings > 100, "{name}");
            for order in [OrderMethod::PerPixel, wide_window()] {
                let (found, found_counts) = draw(&sample, &Plan { order, ..exact.clone() });
                assert_close(&found, &expected, &format!("{name}, view {i}, {order}"));
                assert_eq!(found_counts.crossings, counts.crossings, "{name}, view {i}, {order}");
            }
        }
    }
}

/// Where no order of cells is right there is only the reference. Rounding moves surfaces by some 1e-5 of a cell there, and with them where one
/// color ends and another begins; a surface that is lost, doubled or in the wrong place shows a hundred times as much. Rays
/// along a rim may.
#[test]
fn surfaces_without_an_order_are_the_reference() {
    const MOVED: f32 = 2e-4;
    for (name, sample) in [("soup", soup(5, 2)), ("grid", grid(6, 0.2, 9))] {
        for distance in [3.0, 1e4, 1e6, 1e8] {
            let eye = DVec3::new(0.5, 0.4, 0.7).normalize() * distance;
            for opacity in [1.0, 0.4] {
                let surfaces = [0.3, 0.5, 0.6].map(|value| surface(value, opacity, SurfaceShading::None));
                let plan = with_surfaces(plan(from(eye), OrderMethod::PerPixel), &surfaces, IsosurfaceMethod::Exact);
                let (found, expected) = (draw(&sample, &plan).0, draw_slowly(&sample, &plan));
                let is_off = |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > MOVED);
                let count = found.pixels().iter().zip(expected.pixels()).filter(is_off).count();
                let worst = difference(&found, &expected).0;
                assert!(count <= 3, "{name} from {distance:e}: off by {worst:e}, {count} of 1845 pixels");
            }
        }
    }
}

#[test]
fn numbers_of_cells_do_not_matter() {
    let surfaces = [surface(0.45, 0.5, SurfaceShading::None)];
    for sample in [grid(5, 0.2, 5), soup(5, 6)] {
        let other = shuffled(&sample, 8);
        let volume = plan(views()[0], OrderMethod::PerPixel);
        for plan in [with_surfaces(volume.clone(), &surfaces, IsosurfaceMethod::Exact), volume] {
            assert_close(&draw(&sample, &plan).0, &draw(&other, &plan).0, "shuffled");
        }
    }
}

#[test]
fn window_of_one_is_the_order_of_cells() {
    let sample = grid(6, 0.2, 11);
    for view in views() {
        let by_centroid = draw(&sample, &plan(view, OrderMethod::Centroid));
        let by_window = draw(&sample, &plan(view, OrderMethod::KBuffer { window: 1 }));
        assert_eq!(by_centroid.0.pixels(), by_window.0.pixels());
        assert_eq!(by_centroid.1, by_window.1);
    }
}

/// A window that is blended many times while a tile is drawn: here the order of centroids is off by a few layers at most.
#[test]
fn window_that_flows_over_loses_nothing() {
    let sample = grid(16, 0.1, 12);
    let camera = Camera {
        eye: DVec3::new(0.0, 0.1, 30.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.06 },
    };
    let view = View::new(&camera, 32, 32).unwrap();
    let exact = draw(&sample, &plan(view, OrderMethod::Mpvo)).0;
    let wrong = draw(&sample, &plan(view, OrderMethod::Centroid)).0;
    assert!(difference(&wrong, &exact).0 > 10.0 * CLOSE, "centroids are wrong here");
    let (picture, counts) = draw(&sample, &plan(view, OrderMethod::KBuffer { window: 16 }));
    assert!(counts.most_held >= LISTED as u64, "{} held", counts.most_held);
    assert!(counts.most_held < counts.sorted, "{} of {}", counts.most_held, counts.sorted);
    assert_close(&picture, &exact, "window of 16");
}

#[test]
fn window_of_nothing_is_refused() {
    let (mesh, scalars) = fan();
    let renderer = CpuRenderer::new(&mesh, &scalars).unwrap();
    let found = renderer.render(&plan(views()[0], OrderMethod::KBuffer { window: 0 }), &Silent);
    assert_eq!(found.unwrap_err(), PlanError::EmptyWindow.into());
    let largest = renderer.render(&plan(views()[0], OrderMethod::KBuffer { window: u32::MAX }), &Silent).unwrap();
    assert_close(&largest.image, &draw_slowly(&(mesh, scalars), &plan(views()[0], OrderMethod::PerPixel)), "largest");
}

/// Along its axis the fan is one ring: only the pixels of its members are sorted, and then the picture is right.
#[test]
fn rings_are_sorted_where_they_are_drawn() {
    let sample = fan();
    let surfaces = [surface(0.45, 0.5, SurfaceShading::None)];
    for (eye, is_ring) in [(DVec3::new(0.1, 0.2, 9.0), true), (DVec3::new(9.0, 0.3, 0.4), false)] {
        let volume = plan(from(eye), OrderMethod::Mpvo);
        for reported in [with_surfaces(volume.clone(), &surfaces, IsosurfaceMethod::Exact), volume.clone()] {
            let sorted = Plan { cycles: CycleRemedy::PerPixel, ..reported.clone() };
            let per_pixel = Plan { order: OrderMethod::PerPixel, ..reported.clone() };
            let ((wrong, before), (right, counts)) = (draw(&sample, &reported), draw(&sample, &sorted));
            assert_close(&right, &draw(&sample, &per_pixel).0, "rings");
            assert_eq!(counts.cyclic > 0, is_ring);
            assert_eq!(counts.sorted > 0, is_ring);
            assert!(counts.sorted <= counts.fragments);
            if is_ring {
                assert!(difference(&wrong, &right).0 > 10.0 * CLOSE, "whole cells are wrong here");
            } else {
                assert_eq!((wrong.pixels(), before), (right.pixels(), counts), "without rings nothing changes");
            }
        }
    }
}

/// A second part of the mesh, off the fan's pixels, is blended as it comes.
#[test]
fn blocks_without_rings_are_not_sorted() {
    let (mesh, mut scalars) = fan();
    let mut cells: Vec<[u32; 4]> = mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect();
    let frame = mesh.frame();
    let mut points: Vec<DVec3> = mesh.positions().iter().map(|&p| p * frame.scale + frame.origin).collect();
    let first = points.len() as u32;
    points.extend([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * 2.0 + DVec3::new(2.0, -1.0, 0.0)));
    scalars.extend([0.1, 0.5, 0.9, 0.3]);
    cells.push([0, 1, 2, 3].map(|i| first + i));
    let sample = (TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh, scalars);
    let remedy = Plan {
        cycles: CycleRemedy::PerPixel,
        ..plan(view(DVec3::new(0.1, 0.2, 9.0), Projection::Orthographic { height: 6.0 }), OrderMethod::Mpvo)
    };
    let (picture, counts) = draw(&sample, &remedy);
    assert!(counts.sorted > 100 && counts.sorted + 100 < counts.fragments, "{} of {}", counts.sorted, counts.fragments);
    assert_close(&picture, &draw_slowly(&sample, &remedy), "two parts");
}

#[test]
fn threads_change_nothing() {
    let sample = grid(6, 0.2, 13);
    let surfaces = [surface(0.45, 0.5, SurfaceShading::None)];
    for order in [OrderMethod::PerPixel, OrderMethod::KBuffer { window: 3 }] {
        let plan = with_surfaces(plan(views()[0], order), &surfaces, IsosurfaceMethod::Exact);
        let on = |threads| draw(&sample, &Plan { threads: Some(threads), ..plan.clone() });
        let (first, counts) = on(1);
        for threads in [2, 3] {
            let (picture, others) = on(threads);
            assert_eq!((picture.pixels(), others), (first.pixels(), counts), "{order} on {threads} threads");
        }
    }
}

#[test]
fn opaque_pixels_end_within_the_error_promised() {
    let sample = grid(8, 0.2, 14);
    let transfer = TransferFunction::new(&[[0.0, 0.9, 0.2, 0.1], [1.0, 0.1, 0.8, 0.9]], &[[0.0, 15.0]]).unwrap();
    for order in [OrderMethod::PerPixel, OrderMethod::KBuffer { window: 5 }] {
        let full = Plan { transfer: transfer.clone(), ..plan(views()[0], order) };
        let expected = draw(&sample, &full).0;
        let ended = draw(&sample, &Plan { termination: 1e-3, ..full }).0;
        let worst = difference(&expected, &ended).0;
        // The largest color is 0.9.
        assert!(worst > 0.0 && worst <= 1e-3, "{order}: {worst:e}");
    }
}
