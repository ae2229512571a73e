//! Segments by fans: as fans in f64 have them, right where they must be, and as wrong as the literature's are.

use fearless_simd::{Simd, dispatch, prelude::*};
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;
use tetrascope_classify::{FanVertex, Viewpoint, project};
use tetrascope_integrate::{Isosurface, Isosurfaces, OpticalModel, SurfaceShading, TransferFunction};
use tetrascope_mesh::{CellId, TetMesh, decompose, rings_sample};
use tetrascope_order::OrderMethod;
use tetrascope_scene::{Interpolation, IsosurfaceMethod, IsosurfacePlan, Lighting, Plan, PlanError, Silent};
use tetrascope_view::{Camera, LinearImage, Projection, View};

use super::CpuRenderer;
use super::blocks::Blocks;
use super::cover::{BlockRange, CoverList};
use super::record::{Listed, Records};
use super::sample::{BLOCK_HEIGHT, BLOCK_WIDTH, LANES};
use super::setup::SetUp;
use crate::RenderError;
use crate::geometry::{PixelSpace, Points};

/// Pixels a side, whose blocks a list of covers holds.
const SIDE: u32 = 31;

/// Ways that are not exact.
const WAYS: [Interpolation; 2] = [Interpolation::Perspective, Interpolation::Screen];

/// One tetrahedron and its field.
#[derive(Clone, Copy, Debug)]
struct Tetrahedron {
    corners: [DVec3; 4],
    scalars: [f64; 4],
}

/// What a pixel's ray has inside a cell: scalars where it enters and leaves, and how much deeper that is.
type Segment = [f64; 3];

/// From this eye towards the origin, around which a sphere of radius 1 fills the picture.
fn towards_origin(eye: DVec3) -> View {
    let fov_y = 2.0 * (1.1 / eye.length()).atan();
    let camera = Camera { eye, target: DVec3::ZERO, up: DVec3::Y, projection: Projection::Perspective { fov_y } };
    View::new(&camera, SIDE, SIDE).unwrap()
}

impl Tetrahedron {
    fn volume(&self) -> f64 {
        let [a, b, c, d] = self.corners;
        (b - a).cross(c - a).dot(d - a) / 6.0
    }

    /// The segments of all pixels as the renderer has them, row by row; `None` for a cell that is drawn in f64, or that lies between pixels.
    fn segments(&self, view: &View, interpolation: Interpolation) -> Option<Vec<Option<Segment>>> {
        let mesh = TetMesh::from_tetrahedra(&self.corners, &[[0, 1, 2, 3]]).unwrap().mesh;
        let renderer = CpuRenderer::new(&mesh, &self.scalars).unwrap();
        let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &[[0.0, 1.0]]).unwrap();
        let plan = Plan { interpolation, ..Plan::new(*view, transfer, OpticalModel::DensityEmitter) };
        let (origin, scale) = (renderer.frame.origin, renderer.frame.scale);
        let space = PixelSpace::new(&view.in_frame(origin, scale), scale);
        let mut points = Points::default();
        points.project(&space, &renderer.positions, &renderer.scalars);
        let outline = points.pixel_box(&space, [0, 1, 2, 3])?;
        let setup = SetUp {
            renderer: &renderer,
            points: &points,
            space: &space,
            outlines: &[outline.map(|p| p as u16)],
            optics: &renderer.optics(&plan, &Isosurfaces::default()),
            with_fans: false,
            sharpness: None,
            longest_depth: space.world_per_depth,
            interpolation,
            effects: None,
            gradients: &[],
            pieces: &[],
            in_ring: &[],
        };
        let mut records = Records::default();
        setup.fill(0, &[CellId(0)], &mut records);
        let record = *records.cells.first()?;
        if record.entry_count == 0 {
            return None;
        }
        let mut segments = dispatch!(renderer.level, simd => segments_of(simd, &records, &space));
        for [front, back, length] in segments.iter_mut().flatten() {
            let scalar =
                |relative: f64| (relative + record.scalar_reference) / renderer.scalar_factor + renderer.scalar_base;
            (*front, *back, *length) = (scalar(*front), scalar(*back), *length * record.length);
        }
        Some(segments)
    }

    /// The same by the vertices of the fan, in f64, with the definition of the interpolation and nothing else; `None` beside the fan.
    fn fan_segment(&self, view: &View, interpolation: Interpolation, [x, y]: [u32; 2]) -> Option<Segment> {
        let Self { mut corners, mut scalars } = *self;
        if self.volume() < 0.0 {
            corners.swap(0, 1);
            scalars.swap(0, 1);
        }
        let projected = project(&corners, &scalars, [0, 1, 2, 3], Viewpoint::Eye(view.eye));
        let thick = projected.thick?;
        let depth = |p: DVec3| (p - view.eye).dot(view.forward);
        let on_screen =
            |from_eye: DVec3| DVec2::new(from_eye.dot(view.right), from_eye.dot(view.up)) / from_eye.dot(view.forward);
        let vertex = |vertex: FanVertex| match vertex {
            FanVertex::Thick => {
                let length = depth(thick.far) - depth(thick.near);
                (on_screen(thick.ray), depth(thick.near), [thick.scalar_front, thick.scalar_back, length])
            }
            FanVertex::Corner(i) => {
                (on_screen(corners[i] - view.eye), depth(corners[i]), [scalars[i], scalars[i], 0.0])
            }
        };
        let place = on_screen(view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).direction);
        projected.fan.triangles().find_map(|triangle| {
            let vertices = triangle.map(vertex);
            let [a, b, c] = vertices.map(|(place, ..)| place);
            let area = (b - a).perp_dot(c - a);
            let shares =
                [(b - place).perp_dot(c - place), (c - place).perp_dot(a - place), (a - place).perp_dot(b - place)]
                    .map(|part| part / area);
            if !shares.iter().all(|share| *share >= -1e-9) {
                return None;
            }
            let mut weights = shares;
            if interpolation == Interpolation::Perspective {
                for (weight, (_, depth, _)) in weights.iter_mut().zip(&vertices) {
                    *weight /= depth;
                }
            }
            let sum: f64 = weights.iter().sum();
            Some(
                [0, 1, 2]
                    .map(|i| weights.iter().zip(&vertices).map(|(w, (.., values))| w * values[i]).sum::<f64>() / sum),
            )
        })
    }
}

#[inline(always)]
fn segments_of<S: Simd>(simd: S, records: &Records, space: &PixelSpace) -> Vec<Option<Segment>> {
    let columns = SIDE.div_ceil(BLOCK_WIDTH);
    let range = BlockRange { pixel: [0, 0], first: 0, columns, rows: SIDE.div_ceil(BLOCK_HEIGHT), stride: columns };
    let mut covers = CoverList::new();
    let listed = Listed::new(records, &records.cells[0], 0);
    let blocks = Blocks::find(simd, listed, range, space, &mut covers);
    let mut segments = vec![None; (SIDE * SIDE) as usize];
    for index in 0..blocks.len() {
        let (block, sample) = blocks.get(simd, &covers, index).unwrap();
        let mut values = [[0.0_f32; LANES]; 3];
        for (lanes, value) in values.iter_mut().zip([sample.front, sample.back, sample.length]) {
            value.store_slice(lanes);
        }
        let covered = sample.covered.to_bitmask();
        for lane in 0..LANES {
            let x = block as u32 % columns * BLOCK_WIDTH + lane as u32 % BLOCK_WIDTH;
            let y = block as u32 / columns * BLOCK_HEIGHT + lane as u32 / BLOCK_WIDTH;
            if x < SIDE && y < SIDE && covered >> lane & 1 == 1 {
                segments[(y * SIDE + x) as usize] = Some(values.map(|lanes| f64::from(lanes[lane])));
            }
        }
    }
    segments
}

/// Two edges across each other on the axis of the view, one behind the other: the thick vertex is the middle pixel.
fn crossed_edges(distance: f64) -> Tetrahedron {
    let (near, far) = (-distance, -distance - 1.0);
    let corners = [
        DVec3::new(-0.8, 0.0, near),
        DVec3::new(0.8, 0.0, near),
        DVec3::new(0.0, -0.8, far),
        DVec3::new(0.0, 0.8, far),
    ];
    Tetrahedron { corners, scalars: [1.0, 3.0, 10.0, 20.0] }
}

/// Numbers between -0.5 and 0.5 that follow from a seed.
fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// Errors of front scalar, back scalar and length over many cells of about size 1 at a distance: scalars as a share of the cell's range,
/// lengths relative to the right ones; all with their sign, in the order of the pixels.
fn signed_errors(interpolation: Interpolation, distance: f64) -> [Vec<f64>; 3] {
    let mut random = random(7);
    let mut errors = [const { Vec::new() }; 3];
    for _ in 0..800 {
        let mut point = || DVec3::new(random(), random(), random());
        let (corners, eye) = ([point(), point(), point(), point()], point());
        let cell = Tetrahedron { corners, scalars: [0.0, 1.0, 0.3, 0.7] };
        if cell.volume().abs() < 0.01 {
            continue;
        }
        let view = towards_origin(eye.normalize() * distance);
        let (Some(right), Some(found)) =
            (cell.segments(&view, Interpolation::Exact), cell.segments(&view, interpolation))
        else {
            continue;
        };
        for (right, found) in right.iter().zip(&found) {
            if let (Some(right), Some(found)) = (right, found) {
                errors[0].push(found[0] - right[0]);
                errors[1].push(found[1] - right[1]);
                errors[2].push(found[2] / right[2] - 1.0);
            }
        }
    }
    assert!(errors[0].len() > 5_000, "{} pixels", errors[0].len());
    errors
}

/// Their magnitudes, ascending.
fn errors(interpolation: Interpolation, distance: f64) -> [Vec<f64>; 3] {
    signed_errors(interpolation, distance).map(|signed| {
        let mut errors: Vec<f64> = signed.iter().map(|error| error.abs()).collect();
        errors.sort_by(f64::total_cmp);
        errors
    })
}

fn median(ascending: &[f64]) -> f64 {
    ascending[ascending.len() / 2]
}

/// At the thick vertex and at the corners every way is right.
#[test]
fn vertices_of_the_fan_have_their_own_values() {
    let camera = Camera {
        eye: DVec3::ZERO,
        target: DVec3::NEG_Z,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.8 },
    };
    let view = View::new(&camera, SIDE, SIDE).unwrap();
    let cell = crossed_edges(2.0);
    for interpolation in Interpolation::ALL {
        let segments = cell.segments(&view, interpolation).unwrap();
        let [front, back, length] = segments[(SIDE * SIDE / 2) as usize].unwrap();
        let is_right = (front - 2.0).abs() < 1e-5 && (back - 15.0).abs() < 1e-5 && (length - 1.0).abs() < 1e-6;
        assert!(is_right, "{interpolation}: {front} {back} {length}");
        // The middle row runs along the front edge: there the outermost pixels come near to its corners.
        let row = &segments[(SIDE / 2 * SIDE) as usize..][..SIDE as usize];
        let covered: Vec<Segment> = row.iter().copied().flatten().collect();
        for ([front, back, length], corner) in [(covered[0], 1.0), (covered[covered.len() - 1], 3.0)] {
            assert!(length < 0.1 && (front - corner).abs() < 0.15, "{interpolation}: {front} {back} {length}");
        }
    }
}

/// Eight corners' worth of doubt: with this cell the exact front at half of its front edge is another than that on the screen.
#[test]
fn ways_differ_as_their_definitions_do() {
    let tilted = Tetrahedron {
        corners: [
            DVec3::new(-1.0, 0.0, -2.0),
            DVec3::new(2.0, 0.0, -4.0),
            DVec3::new(0.0, -1.0, -6.0),
            DVec3::new(0.0, 1.0, -6.0),
        ],
        scalars: [0.0, 1.0, 5.0, 5.0],
    };
    let camera = Camera {
        eye: DVec3::ZERO,
        target: DVec3::NEG_Z,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 1.2 },
    };
    let view = View::new(&camera, SIDE, SIDE).unwrap();
    // The front edge goes from slope -1/2 to 1/2, its middle on the screen is a third along it: 1/depth is linear.
    let middle = |interpolation| tilted.segments(&view, interpolation).unwrap()[(SIDE * SIDE / 2) as usize].unwrap();
    for interpolation in Interpolation::ALL {
        // The thick vertex, where all are right.
        let [front, back, length] = middle(interpolation);
        let is_right =
            (front - 1.0 / 3.0).abs() < 1e-5 && (back - 5.0).abs() < 1e-5 && (length - 10.0 / 3.0).abs() < 1e-5;
        assert!(is_right, "{interpolation}: {front} {back} {length}");
    }
    // Half way on the screen from there to the corner of scalar 1, at slope 1/4: its front lies at depth 16 / 5.
    let quarter = Camera { target: DVec3::new(0.25, 0.0, -1.0), ..camera };
    let view = View::new(&quarter, SIDE, SIDE).unwrap();
    let at = |interpolation| tilted.segments(&view, interpolation).unwrap()[(SIDE * SIDE / 2) as usize].unwrap();
    let [front, ..] = at(Interpolation::Exact);
    assert!((front - 0.6).abs() < 1e-5, "{front}");
    let [front, ..] = at(Interpolation::Perspective);
    assert!((front - 0.6).abs() < 1e-5, "{front}");
    let [front, ..] = at(Interpolation::Screen);
    assert!((front - 2.0 / 3.0).abs() < 0.02 && (front - 0.6).abs() > 0.03, "{front}");
}

/// Towards parallel rays all ways become one: the error falls as the distance grows.
#[test]
fn errors_fall_with_the_distance() {
    for interpolation in WAYS {
        let (near, far) = (errors(interpolation, 10.0), errors(interpolation, 1000.0));
        for (near, far) in near.iter().zip(&far) {
            for quantile in [0.5, 0.9, 0.99] {
                let at = |ascending: &[f64]| ascending[(quantile * (ascending.len() - 1) as f64) as usize];
                // Nothing there but rounding: fronts in perspective are exact.
                let rounding = 2e-6;
                assert!(
                    at(far) <= at(near) / 50.0 + rounding,
                    "{interpolation}: {:e} near, {:e} far",
                    at(near),
                    at(far)
                );
            }
        }
    }
}

/// Near a cell the errors are those that are known of such interpolation: lengths 2 % in the median on the screen ten sizes away, 1.4 % with the
/// correction by the front's depth, back scalars 0.16 % of the range.
#[test]
fn errors_near_a_cell_are_those_of_the_literature() {
    let [screen, perspective] = [Interpolation::Screen, Interpolation::Perspective].map(|way| errors(way, 10.0));
    let [on_screen, corrected] = [&screen, &perspective].map(|errors| median(&errors[2]));
    assert!((0.007..0.03).contains(&on_screen), "{on_screen}");
    assert!(corrected < 0.85 * on_screen && corrected > 0.3 * on_screen, "{corrected} against {on_screen}");
    assert!((4e-4..6e-3).contains(&median(&screen[1])), "{}", median(&screen[1]));
    assert!(median(&perspective[0]) < 1e-6, "fronts are exact: {}", median(&perspective[0]));
    let exact = errors(Interpolation::Exact, 10.0);
    assert!(exact.iter().all(|errors| errors[errors.len() - 1] == 0.0));
}

/// The back at the thick vertex lies deeper than most of the back: with the correction by the front's depth most lengths come out too long, and
/// such errors add up along a ray. On the screen the front at the thick vertex, which lies nearer than most, makes up for it.
#[test]
fn errors_with_the_correction_have_one_sign() {
    let mean = |way| {
        let lengths = &signed_errors(way, 10.0)[2];
        lengths.iter().sum::<f64>() / lengths.len() as f64
    };
    let [screen, perspective] = [Interpolation::Screen, Interpolation::Perspective].map(mean);
    assert!(perspective > 0.005 && screen.abs() < 0.5 * perspective, "{screen} {perspective}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn segments_are_those_of_fans_in_f64(
        corners in prop::array::uniform4(prop::array::uniform3(-0.6..0.6_f64)),
        scalars in prop::array::uniform4(-3.0..5.0_f64),
        eye in prop::array::uniform3(-1.0..1.0_f64),
        distance in 1.6..40.0_f64,
    ) {
        let eye = DVec3::from(eye);
        prop_assume!(eye.length() > 0.1);
        let cell = Tetrahedron { corners: corners.map(DVec3::from), scalars };
        prop_assume!(cell.volume().abs() > 1e-3);
        let view = towards_origin(eye.normalize() * distance);
        let Some(exact) = cell.segments(&view, Interpolation::Exact) else { return Ok(()) };
        let low = scalars.iter().copied().fold(f64::INFINITY, f64::min);
        let high = scalars.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let range = high - low;
        for interpolation in WAYS {
            let segments = cell.segments(&view, interpolation).unwrap();
            for (place, (exact, found)) in (0..).zip(exact.iter().zip(&segments)) {
                prop_assert_eq!(exact.is_some(), found.is_some(), "coverage is that of the planes");
                let Some([front, back, length]) = *found else { continue };
                prop_assert!(length >= 0.0);
                for scalar in [front, back] {
                    prop_assert!(scalar >= low - 1e-5 * range && scalar <= high + 1e-5 * range, "{scalar}");
                }
                // Beside the fan by rounding: so near the outline that there is nothing to compare.
                let Some(right) = cell.fan_segment(&view, interpolation, [place % SIDE, place / SIDE]) else { continue };
                let close = (front - right[0]).abs() < 2e-4 * range && (back - right[1]).abs() < 2e-4 * range
                    && (length - right[2]).abs() < 2e-5;
                prop_assert!(close, "{interpolation} at {place}: {:?} for {right:?}", [front, back, length]);
            }
        }
    }
}

/// A cube from -1 to 1 of so many cells a side, and a field over its points.
fn cube(cells: usize, field: impl Fn(DVec3) -> f64) -> (TetMesh, Vec<f64>) {
    let mut dataset = rings_sample(cells);
    let side = cells + 1;
    for (index, point) in dataset.points.iter_mut().enumerate() {
        *point = DVec3::from(
            [index % side, index / side % side, index / side / side].map(|i| i as f64 / cells as f64 * 2.0 - 1.0),
        );
    }
    let mesh = decompose(&dataset).unwrap().mesh;
    let scalars = dataset.points.iter().map(|&point| field(point)).collect();
    (mesh, scalars)
}

fn draw(sample: &(TetMesh, Vec<f64>), plan: &Plan) -> LinearImage {
    CpuRenderer::new(&sample.0, &sample.1).unwrap().render(plan, &Silent).unwrap().image
}

/// Length of a ray inside the cube from -1 to 1.
fn chord(view: &View, x: u32, y: u32) -> f64 {
    let ray = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let (low, high) = ((-1.0 - ray.origin) / ray.direction, (1.0 - ray.origin) / ray.direction);
    let (enter, leave) = (low.min(high).max_element(), low.max(high).min_element());
    (leave - enter).max(0.0) * ray.direction.length()
}

/// A constant field shows lengths and nothing else: chords add up to the mesh's where they are exact, and only there.
#[test]
fn a_constant_field_shows_the_error_of_lengths() {
    let sample = cube(3, |_| 0.5);
    let view = towards_origin(DVec3::new(1.7, 1.1, 2.3));
    let transfer = TransferFunction::new(&[[0.0, 1.0, 0.5, 0.25]], &[[0.0, 1.0]]).unwrap();
    let plain = Plan::new(view, transfer, OpticalModel::Emission);
    let worst = Interpolation::ALL.map(|interpolation| {
        let image = draw(&sample, &Plan { interpolation, ..plain.clone() });
        let error = |x: u32, y: u32| (f64::from(image.pixel(x, y)[0]) - chord(&view, x, y)).abs();
        (0..SIDE * SIDE).map(|i| error(i % SIDE, i / SIDE)).fold(0.0, f64::max)
    });
    let [exact, perspective, screen] = worst;
    assert!(exact < 1e-5, "{exact}");
    assert!((0.01..0.5).contains(&screen), "{screen}");
    assert!((0.005..0.5).contains(&perspective), "{perspective}");
}

/// Every cell has its own fan, those without one among them: lights that add up are the same alone and together.
#[test]
fn cells_keep_their_own_fans() {
    let (mesh, scalars) = cube(2, |p| p.x + 0.3 * p.y);
    // In the plane of faces, and inside the mesh: some cells are drawn in f64.
    for eye in [DVec3::new(0.0, 0.4, 3.0), DVec3::new(0.3, 0.2, 0.9)] {
        let view = towards_origin(eye);
        let transfer = TransferFunction::new(&[[-1.0, 0.1, 0.3, 0.2], [1.0, 0.8, 0.4, 1.0]], &[[0.0, 1.0]]).unwrap();
        for interpolation in WAYS {
            let plan = Plan { interpolation, ..Plan::new(view, transfer.clone(), OpticalModel::Emission) };
            let rendered = CpuRenderer::new(&mesh, &scalars).unwrap().render(&plan, &Silent).unwrap();
            assert!(rendered.counts.careful > 0 && rendered.counts.careful < rendered.counts.drawn);
            let mut sum = vec![[0.0_f64; 3]; (SIDE * SIDE) as usize];
            for cell in mesh.tetrahedra() {
                let corners = cell.map(|v| mesh.frame().origin + mesh.positions()[v.index()] * mesh.frame().scale);
                let alone = TetMesh::from_tetrahedra(&corners, &[[0, 1, 2, 3]]).unwrap().mesh;
                let image = draw(&(alone, cell.map(|v| scalars[v.index()]).to_vec()), &plan);
                for (sum, pixel) in sum.iter_mut().zip(image.pixels()) {
                    for (sum, channel) in sum.iter_mut().zip(pixel) {
                        *sum += f64::from(*channel);
                    }
                }
            }
            for (sum, pixel) in sum.iter().zip(rendered.image.pixels()) {
                for (sum, channel) in sum.iter().zip(pixel) {
                    assert!((sum - f64::from(*channel)).abs() < 1e-4, "{interpolation}: {sum} {channel}");
                }
            }
        }
    }
}

/// Isosurfaces and light go through the same segments: pixels that sort by themselves see what an exact order sees.
#[test]
fn surfaces_and_light_are_drawn_in_every_order_of_cells() {
    let sample = cube(3, |p| p.x + 0.5 * p.y + 0.2 * p.z * p.z);
    let view = towards_origin(DVec3::new(2.1, 1.3, 1.9));
    let transfer = TransferFunction::new(&[[-1.0, 0.1, 0.3, 0.2], [1.0, 0.8, 0.4, 1.0]], &[[0.0, 0.3]]).unwrap();
    let surface = |value| Isosurface {
        value,
        color: [0.9, 0.2, 0.1],
        back_color: [0.1, 0.8, 0.3],
        opacity: 0.5,
        shading: SurfaceShading::Smooth,
    };
    let surfaces = Isosurfaces::new(vec![surface(-0.31), surface(0.47)]).unwrap();
    for interpolation in WAYS {
        let plan = |order| Plan {
            interpolation,
            order,
            isosurfaces: Some(IsosurfacePlan { surfaces: surfaces.clone(), method: IsosurfaceMethod::Exact }),
            lighting: Some(Lighting { volume: true, ..Lighting::default() }),
            ..Plan::new(view, transfer.clone(), OpticalModel::DensityEmitter)
        };
        let [sorted, ordered] = [OrderMethod::PerPixel, OrderMethod::BspXmpvo].map(|order| draw(&sample, &plan(order)));
        for (a, b) in sorted.pixels().iter().flatten().zip(ordered.pixels().iter().flatten()) {
            assert!((a - b).abs() < 2e-5, "{interpolation}: {a} {b}");
        }
        let exact = draw(&sample, &Plan { interpolation: Interpolation::Exact, ..plan(OrderMethod::BspXmpvo) });
        let differences =
            exact.pixels().iter().flatten().zip(ordered.pixels().iter().flatten()).map(|(a, b)| (a - b).abs());
        let worst = differences.fold(0.0, f32::max);
        assert!(worst > 1e-3, "{interpolation}: {worst:e}");
    }
}

/// Without perspective a plan that asks for fans is drawn as its planes have it, bit for bit.
#[test]
fn parallel_rays_are_exact() {
    let sample = cube(3, |p| p.x * p.y + p.z);
    let turn = DMat3::from_rotation_y(0.4);
    let camera = Camera {
        eye: turn * DVec3::new(0.0, 1.0, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 4.0 },
    };
    let transfer = TransferFunction::new(&[[-1.0, 0.1, 0.3, 0.2], [1.0, 0.8, 0.4, 1.0]], &[[0.0, 1.0]]).unwrap();
    let plain = Plan::new(View::new(&camera, 40, 40).unwrap(), transfer, OpticalModel::DensityEmitter);
    let exact = draw(&sample, &plain);
    for interpolation in WAYS {
        assert_eq!(draw(&sample, &Plan { interpolation, ..plain.clone() }), exact);
    }
}

#[test]
fn fans_of_colors_are_refused() {
    let (mesh, scalars) = cube(1, |p| p.x);
    let transfer = TransferFunction::new(&[[0.0, 1.0, 1.0, 1.0]], &[[0.0, 1.0]]).unwrap();
    let plan = Plan {
        interpolation: Interpolation::Screen,
        integration: tetrascope_integrate::Integration::Vertex,
        ..Plan::new(towards_origin(DVec3::Z * 4.0), transfer, OpticalModel::DensityEmitter)
    };
    let error = CpuRenderer::new(&mesh, &scalars).unwrap().render(&plan, &Silent).unwrap_err();
    assert!(matches!(error, RenderError::Plan(PlanError::FanWithInterpolation { .. })), "{error:?}");
}
