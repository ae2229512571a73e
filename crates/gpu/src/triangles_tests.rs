//! Triangles against the classification on the CPU, and against rays cut in f64.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use tetrascope_classify::{FanVertex, Projected, Tests, Viewpoint, by_planes, project};
use tetrascope_shaders::layout::{EFFECT_CONSTANTS, Frame, LATTICE_STEP, NEGATIVE_BIT, OpticsUniform};
use tetrascope_shaders::{Constant, Program, Slot};
use tetrascope_view::View;

use crate::Gpu;
use crate::kernel::Kernel;
use crate::targets::{Display, Target, TargetPrecision, texture};
use crate::testing::{checked, contents, gpu};
use crate::triangles::{BlockToDraw, Interpolated, TrianglePath};
use crate::view::{Part, frame_of};

const SIZE: u32 = 64;
const EXTINCTION: f32 = 1.5;
const EXTINCTION_SLOPE: f32 = 1.0;

const SLOTS: &[Slot<'static>] = &[
    ("effects", "effects/none.wgsl"),
    ("volume", "integrate/average.wgsl"),
    ("model", "integrate/density_emitter.wgsl"),
];

/// A piece of the transfer function as `integrate/pieces.wgsl` has it, over scalars from -1 to 1: extinction and green are linear.
fn pieces() -> [[u32; 4]; 3] {
    let [low, high] = [EXTINCTION - EXTINCTION_SLOPE, EXTINCTION + EXTINCTION_SLOPE];
    [
        [lattice(-1.0) as u32, lattice(1.0) as u32, low.to_bits(), high.to_bits()],
        [0.9_f32.to_bits(), 0.0_f32.to_bits(), 0.2_f32.to_bits(), 3],
        [0.9_f32.to_bits(), 1.0_f32.to_bits(), 0.2_f32.to_bits(), 0.5_f32.to_bits()],
    ]
}

/// Numbers from 0 to 1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Cells one behind the other along camera axes, and an eye.
struct Scene {
    points: Vec<[i32; 4]>,
    cells: Vec<[u32; 4]>,
    /// Also the middle of an orthographic view's plane.
    eye: DVec3,
    /// Slope of a pixel, or its size.
    pixel: f64,
    is_perspective: bool,
    part: Part,
}

fn lattice(x: f64) -> i32 {
    (x / LATTICE_STEP).round() as i32
}

impl Scene {
    fn new(eye: DVec3, pixel: f64, is_perspective: bool) -> Self {
        let part = Part { origin: [0; 2], extent: [SIZE; 2] };
        Self { points: Vec::new(), cells: Vec::new(), eye, pixel, is_perspective, part }
    }

    fn add(&mut self, corners: [DVec3; 4], scalars: [f64; 4]) {
        let first = self.points.len() as u32;
        for (corner, scalar) in corners.iter().zip(scalars) {
            self.points.push([lattice(corner.x), lattice(corner.y), lattice(corner.z), lattice(scalar)]);
        }
        let (corners, _) = self.corners([first, first + 1, first + 2, first + 3]);
        let volume = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]);
        let negative = if volume < 0.0 { NEGATIVE_BIT } else { 0 };
        self.cells.push([first, first + 1, first + 2, (first + 3) | negative]);
    }

    /// Corners and scalars.
    fn corners(&self, cell: [u32; 4]) -> ([DVec3; 4], [f64; 4]) {
        let points = cell.map(|vertex| self.points[(vertex & !NEGATIVE_BIT) as usize]);
        let place = |p: [i32; 4]| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])) * LATTICE_STEP;
        (points.map(place), points.map(|p| f64::from(p[3]) * LATTICE_STEP))
    }

    fn frame(&self) -> Frame {
        let half = 0.5 * f64::from(SIZE) * self.pixel;
        let view = View {
            eye: self.eye,
            right: DVec3::X,
            up: DVec3::NEG_Y,
            forward: DVec3::Z,
            half_width: half,
            half_height: half,
            is_perspective: self.is_perspective,
            width: SIZE,
            height: SIZE,
        };
        frame_of(&view, self.part, 0.0, self.cells.len() as u32, self.points.len() as u32)
    }

    /// Points from the frame's base.
    fn projected(&self) -> Vec<[i32; 4]> {
        let frame = self.frame();
        let base = [frame.right[3], frame.down[3], frame.forward[3], 0];
        self.points.iter().map(|point| [0, 1, 2, 3].map(|axis| point[axis] - base[axis])).collect()
    }

    fn viewpoint(&self) -> Viewpoint {
        if self.is_perspective { Viewpoint::Eye(self.eye) } else { Viewpoint::Direction(DVec3::Z) }
    }

    /// A cell as the CPU projects it, with the corners' numbers put back in order.
    fn project(&self, cell: [u32; 4]) -> (Projected, [usize; 4]) {
        let (mut corners, mut scalars) = self.corners(cell);
        let mut order = [0, 1, 2, 3];
        if cell[3] & NEGATIVE_BIT != 0 {
            corners.swap(2, 3);
            scalars.swap(2, 3);
            order.swap(2, 3);
        }
        (project(&corners, &scalars, order, self.viewpoint()), order)
    }

    /// Light of a pixel, rgb and transmittance: rays cut at the faces.
    fn trace(&self, x: u32, y: u32) -> [f64; 4] {
        let center = DVec2::new(f64::from(x), f64::from(y)) + 0.5 - f64::from(SIZE) / 2.0;
        let across = center * self.pixel;
        let (start, ray) = if self.is_perspective {
            (self.eye, across.extend(1.0))
        } else {
            (self.eye + across.extend(0.0), DVec3::Z)
        };
        let mut light = [0.0, 0.0, 0.0, 1.0];
        for &cell in &self.cells {
            let (p, s) = self.corners(cell);
            let [ab, ac, ad] = [p[1] - p[0], p[2] - p[0], p[3] - p[0]];
            let volume = ab.cross(ac).dot(ad);
            let sign = volume.signum();
            let normals = [(ac - ab).cross(ad - ab), ad.cross(ac), ab.cross(ad), ac.cross(ab)].map(|n| n * sign);
            let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
            for (face, normal) in normals.iter().enumerate() {
                let through = p[usize::from(face == 0)] - start;
                let depth = normal.dot(through) / normal.dot(ray);
                if normal.dot(ray) < 0.0 { enter = enter.max(depth) } else { leave = leave.min(depth) }
            }
            if enter >= leave {
                continue;
            }
            let gradient =
                -(normals[1] * (s[1] - s[0]) + normals[2] * (s[2] - s[0]) + normals[3] * (s[3] - s[0])) / volume.abs();
            let middle = s[0] + gradient.dot(start + ray * (0.5 * (enter + leave)) - p[0]);
            let extinction = f64::from(EXTINCTION) + f64::from(EXTINCTION_SLOPE) * middle;
            let through = (-extinction * (leave - enter) * ray.length()).exp();
            for (channel, color) in [0.9, 0.5 + 0.5 * middle, 0.2].into_iter().enumerate() {
                light[channel] += light[3] * color * (1.0 - through);
            }
            light[3] *= through;
        }
        light
    }
}

/// Buffers of a scene.
struct Uploaded {
    frame: wgpu::Buffer,
    points: wgpu::Buffer,
    drawn: wgpu::Buffer,
    totals: wgpu::Buffer,
    picture: wgpu::Buffer,
    pieces: wgpu::Buffer,
    optics: wgpu::Buffer,
}

impl Uploaded {
    fn new(gpu: &Gpu, scene: &Scene) -> Self {
        Self {
            frame: gpu.uniform_of("frame", &scene.frame()),
            points: gpu.storage_of("points", &scene.projected()),
            drawn: gpu.storage_of("drawn", &scene.cells),
            totals: gpu.storage_of("totals", &[scene.cells.len() as u32, 0, 0, 0]),
            picture: gpu.storage("picture", u64::from(SIZE * SIZE) * 16),
            pieces: gpu.storage_of("pieces", &pieces()),
            optics: gpu.uniform_of("optics", &OpticsUniform { piece_count: 1, ..OpticsUniform::default() }),
        }
    }

    fn named(&self) -> Vec<crate::kernel::Named<'_>> {
        vec![
            ("frame", self.frame.as_entire_binding()),
            ("points", self.points.as_entire_binding()),
            ("totals", self.totals.as_entire_binding()),
            ("picture", self.picture.as_entire_binding()),
            ("pieces", self.pieces.as_entire_binding()),
            ("optics", self.optics.as_entire_binding()),
        ]
    }
}

/// A picture of a scene in blocks of `cells` cells, back to front.
fn draw(gpu: &Gpu, scene: &Scene, interpolated: Interpolated, precision: TargetPrecision, cells: u32) -> Vec<[f32; 4]> {
    checked(gpu, || {
        let path = TrianglePath::new(gpu, interpolated, SLOTS, &[], precision, cells).unwrap();
        let target = Target::new(gpu, [SIZE; 2], precision).unwrap();
        let uploaded = Uploaded::new(gpu, scene);
        let mut encoder = gpu.encoder("test");
        let blocks = (scene.cells.len() as u32).div_ceil(cells);
        for number in (0..blocks).rev() {
            let first = number * cells;
            let block = gpu.uniform_of("block", &[first, cells, 0, 0]);
            // Every block gathers its own cells.
            let end = (first + cells).min(scene.cells.len() as u32);
            let drawn = gpu.storage_of("drawn", &scene.cells[first as usize..end as usize]);
            let mut resources = uploaded.named();
            resources.push(("block", block.as_entire_binding()));
            resources.push(("drawn", drawn.as_entire_binding()));
            let place =
                BlockToDraw { cells, is_first: number + 1 == blocks, is_last: number == 0, extent: scene.part.extent };
            path.record(gpu, &mut encoder, &resources, &target, place);
        }
        contents(gpu, encoder, &uploaded.picture, (SIZE * SIZE) as usize)
    })
}

/// The largest difference of any channel from the rays.
fn worst(scene: &Scene, picture: &[[f32; 4]]) -> f64 {
    let mut worst = 0.0_f64;
    for (place, pixel) in picture.iter().enumerate() {
        let [columns, rows] = scene.part.extent;
        let (x, y) = (place as u32 % columns, place as u32 / columns);
        if y >= rows {
            break;
        }
        let traced = scene.trace(scene.part.origin[0] + x, scene.part.origin[1] + y);
        for (found, expected) in pixel.iter().zip(traced) {
            let difference = (f64::from(*found) - expected).abs();
            assert!(difference.is_finite(), "pixel {place} is {pixel:?}");
            worst = worst.max(difference);
        }
    }
    worst
}

fn random_cell(random: &mut Random, center: DVec3, size: f64) -> ([DVec3; 4], [f64; 4]) {
    let corner = |random: &mut Random| {
        center + size * DVec3::new(random.within(-1., 1.), random.within(-1., 1.), random.within(-1., 1.))
    };
    let corners = [0; 4].map(|_| corner(random));
    (corners, [0; 4].map(|_| random.within(-0.5, 0.5)))
}

/// Cells one behind the other from `nearest` depth on.
fn layers(eye: DVec3, pixel: f64, is_perspective: bool, nearest: f64, size: f64, count: usize) -> Scene {
    let mut random = Random(7);
    let mut scene = Scene::new(eye, pixel, is_perspective);
    for layer in 0..count {
        let depth = nearest + size * (1.0 + 2.0 * layer as f64);
        let center = DVec3::new(random.within(-0.3, 0.3) * size, random.within(-0.3, 0.3) * size, depth);
        let (corners, scalars) = random_cell(&mut random, center, size);
        scene.add(corners, scalars);
    }
    scene
}

/// What the vertices of all fans carry: twelve times two vectors a cell; and the records.
fn vertices(gpu: &Gpu, scene: &Scene) -> (Vec<[[f32; 4]; 24]>, Vec<[u32; 4]>) {
    checked(gpu, || {
        let constants = [("NEAR_SHARE", Constant::F32(1e-2))];
        let fans = Program::compose("triangles/fans.wgsl", &[], &constants).unwrap();
        let check = Program::compose("test/triangles_vertices.wgsl", &[], &constants).unwrap();
        let (fans, check) = (Kernel::new(gpu, &fans, "fans_of_block"), Kernel::new(gpu, &check, "vertices_of_fans"));
        let uploaded = Uploaded::new(gpu, scene);
        let count = scene.cells.len();
        let records = gpu.storage("fans", 16 * count as u64);
        let arguments = gpu.storage("arguments", 16);
        let found = gpu.storage("found", 24 * 16 * count as u64);
        let block = gpu.uniform_of("block", &[0, count as u32, 0, 0]);
        let mut resources = uploaded.named();
        resources.push(("drawn", uploaded.drawn.as_entire_binding()));
        resources.push(("block", block.as_entire_binding()));
        resources.push(("fans", records.as_entire_binding()));
        resources.push(("arguments", arguments.as_entire_binding()));
        resources.push(("found", found.as_entire_binding()));
        let mut encoder = gpu.encoder("test");
        let groups = (count as u32).div_ceil(256);
        fans.run_alone(&mut encoder, &fans.bind(gpu, &resources), groups);
        check.run_alone(&mut encoder, &check.bind(gpu, &resources), groups);
        let flat: Vec<[f32; 4]> = contents(gpu, encoder, &found, 24 * count);
        let told: Vec<u32> = contents(gpu, gpu.encoder("test"), &arguments, 4);
        assert_eq!(told, [12, count as u32, 0, 0]);
        let records = contents(gpu, gpu.encoder("test"), &records, count);
        (flat.chunks_exact(24).map(|chunk| chunk.try_into().unwrap()).collect(), records)
    })
}

fn check_fans(scene: &Scene, what: &str) {
    let Some(gpu) = gpu() else { return };
    let (vertices, records) = vertices(&gpu, scene);
    let mut worst = [0.0_f64; 3];
    let mut same = 0;
    for ((cell, vertices), record) in scene.cells.iter().zip(&vertices).zip(&records) {
        let (projected, order) = scene.project(*cell);
        let (corners, scalars) = scene.corners(*cell);
        let triangles = record[0] >> 18 & 7;
        let Some(thick) = projected.thick else {
            assert!(triangles == 0 || triangles == 7, "{what}: a fan of no area");
            continue;
        };
        assert!(triangles != 7, "{what}: a fan was expected of {corners:?}");
        let largest = projected.volumes.a.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
        if projected.volumes.six_volume <= 1e-6 * largest * 0.1 {
            continue;
        }
        let is_clear = projected.volumes.a.iter().all(|a| *a == 0.0 || a.abs() > 1e-5 * largest);
        let class = by_planes(Tests::from_code((record[0] & 127) as usize).signs()).class;
        if is_clear {
            assert_eq!(class, projected.class, "{what}: {corners:?}");
            let pair = |i: usize, j: usize| (i.min(j), i.max(j));
            let expected: BTreeSet<_> = projected
                .fan
                .triangles()
                .map(|[_, i, j]| {
                    let (FanVertex::Corner(i), FanVertex::Corner(j)) = (i, j) else { panic!("no corner") };
                    pair(order[i], order[j])
                })
                .collect();
            let ring = |place: u32| (record[0] >> (8 + 2 * place) & 3) as usize;
            let found: BTreeSet<_> = (0..triangles).map(|t| pair(ring(t), ring(t + 1))).collect();
            assert_eq!(found, expected, "{what}: {corners:?}");
            same += 1;
        }
        // The thick vertex comes first.
        let [nearness, difference, front, back] = vertices[0].map(f64::from);
        let [_, _, depth, reference] = vertices[1].map(f64::from);
        let (over_front, over_back, length) = if scene.is_perspective {
            let (enter, leave) = (1.0 + nearness, 1.0 + nearness - difference);
            let stretch = thick.ray.length() / thick.ray.z;
            (front / enter, back / leave, depth * difference / (enter * leave) * stretch)
        } else {
            (front, back, difference)
        };
        let range = scalars.iter().fold(0.0_f64, |m, s| m.max((s - scalars[0]).abs()));
        let size = corners.iter().fold(0.0_f64, |m, p| m.max(p.distance(corners[0])));
        // Where the signs differ, the chord may have moved along a short edge; its length and the scalars have not.
        if is_clear {
            worst[0] = worst[0].max((over_front + reference - thick.scalar_front).abs() / range);
            worst[1] = worst[1].max((over_back + reference - thick.scalar_back).abs() / range);
        }
        worst[2] = worst[2].max((length - thick.chord_length).abs() / size);
        // Corners project where they are.
        for number in 0..3 * triangles as usize {
            if number % 3 == 0 {
                continue;
            }
            let corner = (record[0] >> (8 + 2 * (number / 3 + number % 3 - 1)) & 3) as usize;
            let p = corners[corner] - scene.eye;
            let over = if scene.is_perspective { p.truncate() / p.z } else { p.truncate() } / scene.pixel;
            let [x, y, ..] = vertices[2 * number + 1].map(f64::from);
            let frame = scene.frame();
            let center = |pixel: i32| f64::from(pixel) + 0.5 - f64::from(SIZE) / 2.0;
            let expected = over - DVec2::new(center(frame.columns[0]), center(frame.rows[0]));
            let distance = DVec2::new(x, y).distance(expected);
            assert!(distance < 1e-5 * (10.0 + expected.length()), "{what}: {x} {y} is not {expected}");
            assert!(vertices[2 * number][1] == 0.0);
        }
    }
    println!(
        "{what}: scalars {:e} {:e}, length {:e}, {same} clear of {}",
        worst[0],
        worst[1],
        worst[2],
        vertices.len()
    );
    assert!(same > vertices.len() / 4, "{what}");
    assert!(worst.iter().all(|w| *w < 2e-5), "{what}: {worst:?}");
}

fn random_scene(eye: DVec3, pixel: f64, is_perspective: bool, size: f64) -> Scene {
    let mut random = Random(3);
    let mut scene = Scene::new(eye, pixel, is_perspective);
    for _ in 0..600 {
        let center = DVec3::new(random.within(-0.5, 0.5), random.within(-0.5, 0.5), random.within(-0.5, 0.5));
        let (corners, scalars) = random_cell(&mut random, center, size);
        scene.add(corners, scalars);
    }
    scene
}

#[test]
fn fans_of_random_cells() {
    check_fans(&random_scene(DVec3::new(0.1, -0.2, -3.0), 0.01, true, 0.2), "near");
    check_fans(&random_scene(DVec3::new(3.0, -2.0, -3000.0), 1e-5, true, 0.2), "far");
    check_fans(&random_scene(DVec3::new(0.1, -0.2, -1.5), 0.01, true, 1e-4), "small");
    check_fans(&random_scene(DVec3::new(0.1, -0.2, -3.0), 0.02, false, 0.2), "orthographic");
}

#[test]
fn fans_of_degenerate_cells() {
    // Corners on few places of a grid, seen along an axis or from a place of the grid: classes 3 and 4, and cells without area.
    for (eye, is_perspective) in [(DVec3::new(0.0, 0.0, -1.0), false), (DVec3::new(0.0, 0.0, -1.0), true)] {
        let mut random = Random(11);
        let mut scene = Scene::new(eye, 0.05, is_perspective);
        let place = |random: &mut Random| (random.within(-1.0, 2.0).floor()) * 0.25;
        while scene.cells.len() < 600 {
            let corners = [0; 4].map(|_| DVec3::new(place(&mut random), place(&mut random), place(&mut random)));
            scene.add(corners, [0; 4].map(|_| random.within(-0.5, 0.5)));
        }
        check_fans(&scene, "grid");
        // The same, but for a step of the lattice.
        for point in &mut scene.points {
            for axis in 0..3 {
                point[axis] += random.within(-1.4, 1.4).round() as i32;
            }
        }
        let cells = std::mem::take(&mut scene.cells);
        for cell in cells {
            let (corners, scalars) = scene.corners(cell);
            let mut one = Scene::new(eye, 0.05, is_perspective);
            one.add(corners, scalars);
            scene.cells.push([cell[0], cell[1], cell[2], (cell[3] & !NEGATIVE_BIT) | (one.cells[0][3] & NEGATIVE_BIT)]);
        }
        let Some(gpu) = gpu() else { return };
        // Classes may differ here and thin cells are nothing but rounding; all numbers are finite and within the cell.
        for (cell, found) in scene.cells.iter().zip(vertices(&gpu, &scene).0) {
            let (corners, _) = scene.corners(*cell);
            let size = corners.iter().fold(0.0_f64, |m, p| m.max(p.distance(corners[0])));
            for vector in found.chunks_exact(2) {
                assert!(vector[0].iter().all(|x| x.is_finite()) && f64::from(vector[0][1]) <= 4.0 * size, "{vector:?}");
            }
        }
    }
}

fn check_pictures(scene: &Scene, what: &str) {
    let Some(gpu) = gpu() else { return };
    for (precision, tolerance) in [(TargetPrecision::ThirtyTwo, 3e-4), (TargetPrecision::Sixteen, 1e-2)] {
        if !precision.is_supported(&gpu) {
            println!("skipped: 32-bit blending");
            continue;
        }
        for cells in [100, 2] {
            let picture = draw(&gpu, scene, Interpolated::Rays, precision, cells);
            let lit = picture.iter().filter(|pixel| pixel[3] < 0.99).count();
            let worst = worst(scene, &picture);
            println!("{what}, {precision:?}, blocks of {cells}: {worst:e}, {lit} pixels");
            assert!(lit > 200, "{what}: {lit} pixels");
            assert!(worst < tolerance, "{what}, {precision:?}: {worst}");
        }
    }
}

#[test]
fn pictures_agree_with_rays() {
    check_pictures(&layers(DVec3::new(0.02, 0.03, -1.0), 0.01, true, -0.8, 0.1, 6), "perspective");
    check_pictures(&layers(DVec3::new(0.02, 0.03, -1.0), 0.004, false, -0.8, 0.1, 6), "orthographic");
    check_pictures(&layers(DVec3::new(0.02, 0.03, -300.0), 1.7e-5, true, -0.5, 0.1, 5), "far");
}

#[test]
fn pictures_of_many_layers_agree_with_rays() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(5);
    let mut scene = Scene::new(DVec3::new(0.0, 0.0, -1.0), 0.01, true);
    for layer in 0..500 {
        let (mut corners, scalars) = random_cell(&mut random, DVec3::ZERO, 0.4);
        for corner in &mut corners {
            corner.z = -0.6 + 0.002 * (f64::from(layer) + corner.z);
        }
        scene.add(corners, scalars);
    }
    for (precision, cells, tolerance) in [
        (TargetPrecision::ThirtyTwo, 500, 3e-4),
        (TargetPrecision::Sixteen, 500, 1e-2),
        (TargetPrecision::Sixteen, 64, 1e-2),
    ] {
        if precision.is_supported(&gpu) {
            let worst = worst(&scene, &draw(&gpu, &scene, Interpolated::Rays, precision, cells));
            println!("{precision:?}, blocks of {cells}: {worst:e}");
            assert!(worst < tolerance, "{precision:?}: {worst}");
        }
    }
}

#[test]
fn all_variants_are_programs() {
    let mut count = 0;
    for triangle in ["triangles/rays.wgsl", "triangles/thick.wgsl"] {
        for effects in ["none", "lit", "surfaces", "maps"].map(|name| format!("effects/{name}.wgsl")) {
            for volume in ["exact", "average", "ends", "partial", "cumulative", "table_2d", "table_3d"] {
                let volume = format!("integrate/{volume}.wgsl");
                let mut slots = SLOTS.to_vec();
                slots.retain(|(slot, _)| !["effects", "volume"].contains(slot));
                slots.extend([
                    ("triangle", triangle),
                    ("pieces", "integrate/pieces.wgsl"),
                    ("effects", &effects),
                    ("volume", &volume),
                    ("surface_visibility", "effects/visible_surfaces.wgsl"),
                    ("volume_light", "effects/volume_lit.wgsl"),
                    ("surface_light", "effects/surface_lit.wgsl"),
                    ("gradient", "effects/gradient_points.wgsl"),
                ]);
                let mut constants = EFFECT_CONSTANTS.to_vec();
                constants.extend([
                    ("CARRIES_JOINTS", Constant::Bool(false)),
                    ("MAP_PASSES", Constant::U32(0)),
                    ("MOST_LIGHT", Constant::F32(1e30)),
                    ("NEAR_SHARE", Constant::F32(1e-2)),
                ]);
                let program = Program::compose("triangles/draw.wgsl", &slots, &constants).unwrap();
                for stage in ["vertex", "fragment"] {
                    let bindings = program.bindings(stage);
                    let storage =
                        bindings.iter().filter(|b| matches!(b.kind, tetrascope_shaders::BindingKind::Storage(_)));
                    assert!(storage.count() <= 8, "{effects} {volume} {stage}: {bindings:?}");
                }
                count += 1;
            }
        }
    }
    assert_eq!(count, 56);
}

#[test]
fn parts_of_pictures_agree_with_rays() {
    let mut scene = layers(DVec3::new(0.02, 0.03, -1.0), 0.01, true, -0.8, 0.1, 6);
    scene.part = Part { origin: [19, 23], extent: [35, 30] };
    check_pictures(&scene, "part");
}

#[test]
fn pictures_from_close_up_agree_with_rays() {
    check_pictures(&layers(DVec3::new(0.0, 0.0, 0.0), 0.01, true, 0.4, 0.2, 1), "two cell sizes");
    check_pictures(&layers(DVec3::new(0.01, 0.0, -0.02), 0.04, true, 0.03, 0.2, 2), "a tenth of a cell size");
}

#[test]
fn pictures_from_inside_of_a_cell_agree_with_rays() {
    let mut scene = layers(DVec3::ZERO, 0.02, true, 0.4, 0.2, 2);
    let mut around = Scene::new(DVec3::ZERO, 0.02, true);
    let corners = [(-0.4, -0.3, -0.2), (0.5, -0.2, -0.1), (0.0, 0.5, -0.1), (0.05, 0.02, 0.3)];
    around.add(corners.map(DVec3::from), [-0.4, 0.2, 0.4, 0.1]);
    let moved = around.cells[0].map(|vertex| vertex + scene.points.len() as u32);
    scene.points.extend(&around.points);
    scene.cells.insert(0, moved);
    check_pictures(&scene, "inside");
}

#[test]
fn color_at_the_thick_vertex_is_interpolated() {
    let Some(gpu) = gpu() else { return };
    let scene = layers(DVec3::new(0.02, 0.03, -1.0), 0.01, true, -0.8, 0.2, 1);
    let precision = TargetPrecision::best(&gpu);
    let picture = draw(&gpu, &scene, Interpolated::Light, precision, 10);
    let (projected, order) = scene.project(scene.cells[0]);
    let thick = projected.thick.unwrap();
    let (corners, scalars) = scene.corners(scene.cells[0]);
    let on_screen = |p: DVec3| p.truncate() / p.z / scene.pixel;
    let center = on_screen(thick.ray);
    let color = |s: f64| [0.9, 0.5 + 0.5 * s, 0.2];
    let extinction = |s: f64| f64::from(EXTINCTION) + f64::from(EXTINCTION_SLOPE) * s;
    let mean = 0.5 * (extinction(thick.scalar_front) + extinction(thick.scalar_back));
    let opacity = 1.0 - (-mean * thick.chord_length).exp();
    let [f, b] = [color(thick.scalar_front), color(thick.scalar_back)];
    let peak = [0, 1, 2].map(|c| 0.5 * (f[c] + b[c]));
    let tolerance = if precision == TargetPrecision::ThirtyTwo { 3e-4 } else { 1e-2 };
    let mut covered = 0;
    for (place, found) in picture.iter().enumerate() {
        let at = DVec2::new((place as u32 % SIZE) as f64, (place as u32 / SIZE) as f64) + 0.5 - f64::from(SIZE) / 2.0;
        let mut expected = [0.0, 0.0, 0.0, 1.0];
        for [_, i, j] in projected.fan.triangles() {
            let (FanVertex::Corner(i), FanVertex::Corner(j)) = (i, j) else { panic!("no corner") };
            let (i, j) = (order[i], order[j]);
            let [p, q] = [i, j].map(|corner| on_screen(corners[corner] - scene.eye) - center);
            let area = p.perp_dot(q);
            let (v, w) = ((at - center).perp_dot(q) / area, p.perp_dot(at - center) / area);
            if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
                let share = 1.0 - v - w;
                let [of_p, of_q] = [i, j].map(|corner| color(scalars[corner]));
                for c in 0..3 {
                    expected[c] = (share * peak[c] + v * of_p[c] + w * of_q[c]) * share * opacity;
                }
                expected[3] = 1.0 - share * opacity;
                covered += 1;
            }
        }
        for (a, b) in found.iter().zip(expected) {
            assert!((f64::from(*a) - b).abs() < tolerance, "{place}: {found:?} is not {expected:?}");
        }
    }
    assert!(covered > 300);
}

#[test]
fn pictures_are_shown_over_a_background() {
    let Some(gpu) = gpu() else { return };
    let shown = checked(&gpu, || {
        let scene = Scene::new(DVec3::ZERO, 0.01, true);
        let uploaded = Uploaded::new(&gpu, &scene);
        let pixels: Vec<[f32; 4]> = (0..SIZE * SIZE).map(|i| [i as f32 / 4096.0, 0.1, 0.0, 0.5]).collect();
        gpu.queue.write_buffer(&uploaded.picture, 0, bytemuck::cast_slice(&pixels));
        let background = gpu.uniform_of("background", &[0.2_f32, 0.4, 1.0, 0.0]);
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let texture = texture(&gpu, "shown", [SIZE; 2], format, usage);
        let mut resources = uploaded.named();
        resources.push(("background", background.as_entire_binding()));
        let mut encoder = gpu.encoder("test");
        let display = Display::new(&gpu, format).unwrap();
        display.record(&gpu, &mut encoder, &resources, &texture.create_view(&Default::default()));
        let buffer = gpu.storage("read", u64::from(SIZE * SIZE) * 4);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE * 4), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            texture.size(),
        );
        contents::<[u8; 4]>(&gpu, encoder, &buffer, (SIZE * SIZE) as usize)
    });
    let encode = |x: f64| if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    for (place, pixel) in shown.iter().enumerate() {
        let expected = [place as f64 / 4096.0 + 0.1, 0.3, 0.5].map(|x| 255.0 * encode(x.min(1.0)));
        for (found, expected) in pixel.iter().zip(expected) {
            assert!((f64::from(*found) - expected).abs() < 1.0, "{place}: {pixel:?} is not {expected:?}");
        }
        assert_eq!(pixel[3], 255);
    }
}
