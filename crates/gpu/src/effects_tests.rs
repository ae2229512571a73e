//! Effects on the device against their formulas in 64 bits.

use std::sync::Arc;

use tetrascope_integrate::surface::{IsosurfaceMap, SmoothMaps};
use tetrascope_integrate::{OpticalModel, Phong, RgbaAssoc, Segment, TransferFunction};
use tetrascope_scene::{IsosurfacePlan, Mixing};
use tetrascope_shaders::Program;
use tetrascope_shaders::layout::{Frame, UNIT};
use tetrascope_view::View;

use super::*;
use crate::kernel::Kernel;
use crate::testing::{checked, contents, gpu};

const PIXEL: f64 = 0.004;
const START: f64 = 1.5;
const EYE: DVec3 = DVec3::new(0.1, -0.2, -3.0);
const RANGE: [f64; 2] = [-0.9, 0.9];
const UNITS: ScalarUnit = ScalarUnit { factor: 1.0, range: RANGE, middle: 0.0 };

/// Numbers that look random, the same every time.
struct Dice(u64);

impl Dice {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }

    fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    fn color(&mut self) -> [f64; 3] {
        [(); 3].map(|()| f64::from(self.between(0.0, 1.0) as f32))
    }
}

/// As `TestSegment` of the shader.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct TestSegment {
    vertices: [u32; 4],
    scalars: [f32; 2],
    depth: [f32; 2],
    center: [f32; 2],
    length: f32,
    reference: i32,
}

/// Cells, gradients at their points, and rays through them.
#[derive(Default)]
struct Scene {
    points: Vec<[i32; 4]>,
    gradients: Vec<[f32; 4]>,
    segments: Vec<TestSegment>,
    rays: Vec<[u32; 2]>,
    is_perspective: bool,
}

fn axes() -> [DVec3; 3] {
    let right = DVec3::new(0.6, 0.64, 0.48);
    let down = DVec3::new(-0.8, 0.48, 0.36);
    [right, down, right.cross(down)]
}

fn frame(is_perspective: bool) -> Frame {
    let axis = |axis: DVec3| [axis.x, axis.y, axis.z, 0.0].map(|x| (x * UNIT).round() as i32);
    let [right, down, forward] = axes().map(axis);
    let slope = if is_perspective { PIXEL as f32 } else { 0.0 };
    Frame {
        right,
        down,
        forward,
        eye: [EYE.x as f32, EYE.y as f32, EYE.z as f32, START as f32],
        slope: [slope, slope, PIXEL as f32, PIXEL as f32],
        is_perspective: u32::from(is_perspective),
        ..Frame::default()
    }
}

impl Scene {
    /// One ray through each of so many cells of their own, from a first to a last share of what the cell has of it.
    fn random(dice: &mut Dice, cells: usize, is_perspective: bool) -> Self {
        let mut scene = Self { is_perspective, ..Self::default() };
        for _ in 0..cells {
            let middle = dice.vector(0.3);
            let corners = [(); 4].map(|()| middle + dice.vector(0.25));
            let volume = (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0]));
            if volume.abs() > 1e-3 {
                let scalars = [(); 4].map(|()| dice.between(RANGE[0], RANGE[1]));
                scene.add(dice, corners, scalars);
            }
        }
        scene
    }

    fn add(&mut self, dice: &mut Dice, corners: [DVec3; 4], scalars: [f64; 4]) {
        let first = self.points.len() as u32;
        for (corner, scalar) in corners.iter().zip(scalars) {
            let [x, y, z] = corner.to_array().map(|x| (x / LATTICE_STEP).round() as i32);
            self.points.push([x, y, z, UNITS.to_lattice(scalar)]);
            // Not all around: where they cancel, the sum has no direction to compare.
            let g = DVec3::new(1.0, -2.0, 0.5) + dice.vector(1.0);
            self.gradients.push([g.x as f32, g.y as f32, g.z as f32, 0.0]);
        }
        let vertices = [first, first + 1, first + 2 | 1 << 31, first + 3 | 1 << 31];
        let corners = self.corners(vertices);
        let inside = corners.iter().zip([0.2, 0.3, 0.1, 0.4]).map(|(c, share)| *c * share).sum::<DVec3>() - EYE;
        let depth = if self.is_perspective { inside.z } else { 1.0 };
        let center = [inside.x / depth / PIXEL, inside.y / depth / PIXEL].map(|x| x as f32);
        let reference = self.points[first as usize][3];
        let mut segment = TestSegment { vertices, center, reference, ..TestSegment::default() };
        // The ray against the four faces: where the shares of the corners change their signs.
        let mut span = [0.0_f64, 10.0];
        let (at_eye, far) = (self.shares(&segment, -START), self.shares(&segment, 1.0 - START));
        for corner in 0..4 {
            let slope = far[corner] - at_eye[corner];
            let depth = -at_eye[corner] / slope;
            if slope > 0.0 { span[0] = span[0].max(depth) } else { span[1] = span[1].min(depth) }
        }
        segment.depth = span.map(|depth| (depth - START) as f32);
        segment.scalars = span.map(|depth| {
            let shares = self.shares(&segment, depth - START);
            let scalar = |corner: usize| f64::from(self.points[first as usize + corner][3] - reference) * LATTICE_STEP;
            (0..4).map(|corner| shares[corner] * scalar(corner)).sum::<f64>() as f32
        });
        segment.length = (span[1] - span[0]) as f32;
        self.rays.push([self.segments.len() as u32, 1]);
        self.segments.push(segment);
    }

    fn corners(&self, vertices: [u32; 4]) -> [DVec3; 4] {
        vertices.map(|v| {
            let [x, y, z, _] = self.points[(v & !(1 << 31)) as usize].map(f64::from);
            DVec3::new(x, y, z) * LATTICE_STEP
        })
    }

    /// How much each corner counts where a segment's ray is at a depth.
    fn shares(&self, segment: &TestSegment, depth: f64) -> [f64; 4] {
        let from_eye = depth + START;
        let [x, y] = segment.center.map(|x| f64::from(x) * PIXEL);
        let spread = if self.is_perspective { from_eye } else { 1.0 };
        let place = EYE + DVec3::new(x * spread, y * spread, from_eye);
        let [a, b, c, d] = self.corners(segment.vertices);
        let volume = (b - a).dot((c - a).cross(d - a));
        let p = place - a;
        let b_share = p.dot((c - a).cross(d - a)) / volume;
        let c_share = p.dot((d - a).cross(b - a)) / volume;
        let d_share = p.dot((b - a).cross(c - a)) / volume;
        [1.0 - b_share - c_share - d_share, b_share, c_share, d_share]
    }

    fn scalar_bounds(&self, segment: &TestSegment) -> [i32; 2] {
        let scalars = segment.vertices.map(|v| self.points[(v & !(1 << 31)) as usize][3]);
        [scalars.into_iter().min().unwrap(), scalars.into_iter().max().unwrap()]
    }
}

fn surface(dice: &mut Dice, value: f64, opacity: f64, shading: SurfaceShading) -> Isosurface {
    Isosurface { value, color: dice.color(), back_color: dice.color(), opacity, shading }
}

fn plan(surfaces: Vec<Isosurface>, method: IsosurfaceMethod, lighting: Option<Lighting>) -> Plan {
    let [right, down, forward] = axes();
    let (half_width, half_height) = (1.0, 1.0);
    let view = View {
        eye: EYE,
        right,
        up: -down,
        forward,
        half_width,
        half_height,
        is_perspective: true,
        width: 8,
        height: 8,
    };
    let transfer = TransferFunction::new(&[[0.0; 4]], &[[0.0; 2]]).unwrap();
    let mut plan = Plan::new(view, transfer, OpticalModel::DensityEmitter);
    if !surfaces.is_empty() {
        plan.isosurfaces = Some(IsosurfacePlan { surfaces: Isosurfaces::new(surfaces).unwrap(), method });
    }
    plan.lighting = lighting;
    plan
}

fn lighting(direction: Option<DVec3>, volume: bool, shininess: f64) -> Lighting {
    Lighting { phong: Phong { ambient: 0.25, diffuse: 0.625, specular: 0.375, shininess }, direction, volume }
}

fn program(effects: &Effects, carries_joints: bool) -> Program {
    let mut slots = effects.slots();
    slots.push(("volume", "test/volume_grey.wgsl"));
    Program::compose("test/effects.wgsl", &slots, &effects.constants(carries_joints)).unwrap_or_else(|e| panic!("{e}"))
}

/// Light and crossings of all rays.
fn drawn(gpu: &Gpu, scene: &Scene, effects: &Effects, carries_joints: bool) -> Vec<([f32; 4], u32)> {
    checked(gpu, || {
        let kernel = Kernel::new(gpu, &program(effects, carries_joints), "shade_rays");
        let rays = scene.rays.len();
        let buffers = [
            ("points", gpu.storage_of("points", &scene.points)),
            ("gradients", gpu.storage_of("gradients", &scene.gradients)),
            ("segments", gpu.storage_of("segments", &scene.segments)),
            ("rays", gpu.storage_of("rays", &scene.rays)),
            ("lights", gpu.storage("lights", rays as u64 * 16)),
            ("counts", gpu.storage("counts", rays as u64 * 4)),
            ("frame", gpu.uniform_of("frame", &frame(scene.is_perspective))),
        ];
        let mut resources = effects.resources();
        resources.extend(buffers.iter().map(|(name, buffer)| (*name, buffer.as_entire_binding())));
        let group = kernel.bind(gpu, &resources);
        let mut encoder = gpu.encoder("test");
        kernel.run_alone(&mut encoder, &group, (rays as u32).div_ceil(64));
        let lights: Vec<[f32; 4]> = contents(gpu, encoder, &buffers[4].1, rays);
        let counts: Vec<u32> = contents(gpu, gpu.encoder("test"), &buffers[5].1, rays);
        lights.into_iter().zip(counts).collect()
    })
}

/// What the shaders are to give, in 64 bits.
struct Twin<'a> {
    scene: &'a Scene,
    plan: &'a Plan,
    effects: &'a Effects,
}

impl Twin<'_> {
    fn ray(&self, ray: [u32; 2]) -> (RgbaAssoc, u32) {
        let mut light = RgbaAssoc::TRANSPARENT;
        let mut crossings = 0;
        for segment in &self.scene.segments[ray[0] as usize..(ray[0] + ray[1]) as usize] {
            let next = if self.effects.maps.is_some() {
                self.looked_up(segment, &mut crossings)
            } else {
                self.cut(segment, &mut crossings)
            };
            light = light.over(next);
        }
        (light, crossings)
    }

    fn cut(&self, segment: &TestSegment, crossings: &mut u32) -> RgbaAssoc {
        let [low, high] = self.scene.scalar_bounds(segment);
        let tolerance = 1e-5 * f64::from(high - low) * LATTICE_STEP + 2e-6;
        let local = |surface: &Isosurface| Isosurface {
            value: f64::from(UNITS.to_lattice(surface.value) - segment.reference) * LATTICE_STEP - tolerance,
            ..*surface
        };
        let surfaces = Isosurfaces::new(self.effects.drawn.as_slice().iter().map(local).collect()).unwrap();
        let [scalar_front, scalar_back] = segment.scalars.map(f64::from);
        let whole = Segment { scalar_front, scalar_back, chord_length: f64::from(segment.length) };
        let intensity = self.volume_intensity(segment);
        surfaces.compose(
            surfaces.ranks(&whole),
            &whole,
            |part| grey(part, intensity),
            |crossing| {
                *crossings += 1;
                let [front, back] = segment.depth.map(f64::from);
                let depth = front + (back - front) * crossing.share;
                let [body, highlight] = self.intensities(segment, depth, crossing.surface.shading);
                crossing.color.map(|channel| channel * body + highlight)
            },
        )
    }

    fn looked_up(&self, segment: &TestSegment, crossings: &mut u32) -> RgbaAssoc {
        let Some(IsosurfaceMethod::Map { size, mixing }) = self.effects.key.method else { panic!("maps") };
        let surfaces = &self.effects.key.surfaces;
        let reference = f64::from(segment.reference) * LATTICE_STEP;
        let [scalar_front, scalar_back] = segment.scalars.map(|scalar| f64::from(scalar) + reference);
        let length = f64::from(segment.length);
        let [front, back] = segment.scalars.map(f64::from);
        let local = Segment { scalar_front: front, scalar_back: back, chord_length: length };
        let volume = grey(&local, self.volume_intensity(segment));
        let whole = Segment { scalar_front, scalar_back, chord_length: length };
        let at = |depth: f32| self.intensities(segment, f64::from(depth), surfaces.shading());
        let lit = |light: RgbaAssoc, [body, highlight]: [f64; 2]| RgbaAssoc {
            rgb: light.rgb.map(|channel| channel * body + highlight * light.opacity),
            ..light
        };
        let [depth_front, depth_back] = segment.depth;
        if mixing == Mixing::Stopped && surfaces.shading() != SurfaceShading::Smooth {
            let near = IsosurfaceMap::new(surfaces, RANGE, size).unwrap().look_up(&whole);
            *crossings += u32::from(near.opacity > 0.0);
            return volume.over(lit(near, at(depth_front)));
        }
        let maps = SmoothMaps::new(surfaces, RANGE, size).unwrap();
        let (near, far) = (maps.front().look_up(&whole), maps.back().look_up(&whole));
        *crossings += u32::from(near.opacity + far.opacity > 0.0);
        let (near, far) = (lit(near, at(depth_front)), lit(far, at(depth_back)));
        if mixing == Mixing::Stopped { volume.over(near.over(far)) } else { near.over(volume.over(far)) }
    }

    fn volume_intensity(&self, segment: &TestSegment) -> f64 {
        if !self.plan.lighting.is_some_and(|lighting| lighting.volume) {
            return 1.0;
        }
        let [front, back] = segment.depth.map(f64::from);
        self.intensities(segment, 0.5 * (front + back), SurfaceShading::Smooth).iter().sum()
    }

    fn intensities(&self, segment: &TestSegment, depth: f64, shading: SurfaceShading) -> [f64; 2] {
        let Some(lighting) = self.plan.lighting.filter(|_| shading != SurfaceShading::None) else { return [1.0, 0.0] };
        let point = |v: u32| (v & !(1 << 31)) as usize;
        let gradient = if shading == SurfaceShading::Flat {
            let [a, b, c, d] = self.scene.corners(segment.vertices);
            let scalars = segment.vertices.map(|v| f64::from(self.scene.points[point(v)][3]));
            let (b, c, d) = (b - a, c - a, d - a);
            let volume = b.dot(c.cross(d));
            (c.cross(d) * (scalars[1] - scalars[0])
                + d.cross(b) * (scalars[2] - scalars[0])
                + b.cross(c) * (scalars[3] - scalars[0]))
                / volume
        } else {
            let shares = self.scene.shares(segment, depth).map(|share| share.max(0.0));
            let gradient = |v: u32| DVec3::from_slice(&self.scene.gradients[point(v)].map(f64::from)[..3]);
            let sum: DVec3 = segment.vertices.iter().zip(shares).map(|(&v, share)| gradient(v) * share).sum();
            in_view(sum)
        };
        let slope = if self.scene.is_perspective { PIXEL } else { 0.0 };
        let [x, y] = segment.center.map(|x| f64::from(x) * slope);
        let to_eye = -DVec3::new(x, y, 1.0).normalize();
        let to_light = lighting.direction.map_or(to_eye, in_view);
        lighting.phong.intensities(gradient.into(), to_eye.into(), to_light.into())
    }
}

fn in_view(direction: DVec3) -> DVec3 {
    let [right, down, forward] = axes();
    DVec3::new(right.dot(direction), down.dot(direction), forward.dot(direction))
}

/// As `test/volume_grey.wgsl`.
fn grey(part: &Segment, intensity: f64) -> RgbaAssoc {
    let opacity = part.chord_length / (1.0 + part.chord_length);
    let mean = 0.75 * part.scalar_front + 0.25 * part.scalar_back;
    let rgb = [0.5 + 0.25 * mean, 0.5 - 0.25 * mean, 0.25].map(|channel| opacity * channel * intensity);
    RgbaAssoc { rgb, opacity }
}

/// Draws random cells as a plan says, and gives the largest difference from the formulas.
fn compare(gpu: &Gpu, plan: &Plan, seed: u64, name: &str) -> f64 {
    let mut worst = 0.0_f64;
    for is_perspective in [true, false] {
        let scene = Scene::random(&mut Dice(seed), 3000, is_perspective);
        let effects = Effects::new(gpu, plan, UNITS, None).unwrap();
        let twin = Twin { scene: &scene, plan, effects: &effects };
        let mut all_crossings = 0;
        for (ray, (light, crossings)) in drawn(gpu, &scene, &effects, true).into_iter().enumerate() {
            let (known, known_crossings) = twin.ray(scene.rays[ray]);
            assert_eq!(crossings, known_crossings, "{name}: ray {ray}");
            all_crossings += crossings;
            let [r, g, b] = known.rgb;
            for (channel, known) in light.into_iter().zip([r, g, b, 1.0 - known.opacity]) {
                let error = (f64::from(channel) - known).abs();
                // Also if it is not a number.
                if !(error <= worst) {
                    worst = if error.is_nan() { f64::INFINITY } else { error };
                }
            }
        }
        assert!(plan.isosurfaces.is_none() || all_crossings > 1000, "{all_crossings}");
    }
    println!("{name}: {worst:.1e}");
    worst
}

fn several(seed: u64, opacity: f64, shading: [SurfaceShading; 2]) -> Vec<Isosurface> {
    let mut dice = Dice(seed);
    let values = [-0.5, -0.45, -0.1, 0.0, 0.3, 0.301, 0.62];
    let one = |(place, value)| surface(&mut dice, value, if place == 3 { 1.0 } else { opacity }, shading[place % 2]);
    values.into_iter().enumerate().map(one).collect()
}

#[test]
fn surfaces_cut_segments() {
    let Some(gpu) = gpu() else { return };
    let none = [SurfaceShading::None; 2];
    let error = compare(&gpu, &plan(several(1, 0.3, none), IsosurfaceMethod::Exact, None), 2, "cut");
    assert!(error < 2e-6, "{error}");
}

#[test]
fn surfaces_are_lit() {
    let Some(gpu) = gpu() else { return };
    let direction = Some(DVec3::new(-0.48, 0.6, -0.64));
    for shading in [
        [SurfaceShading::Flat, SurfaceShading::None],
        [SurfaceShading::Smooth; 2],
        [SurfaceShading::Smooth, SurfaceShading::Flat],
    ] {
        for (direction, shininess) in [(None, 4.0), (direction, 0.0), (direction, 8.0), (direction, 200.0)] {
            for volume in [false, true] {
                let lighting = Some(lighting(direction, volume, shininess));
                let plan = plan(several(3, 0.4, shading), IsosurfaceMethod::Exact, lighting);
                let error = compare(&gpu, &plan, 4, &format!("lit {shading:?}, {shininess}, volume {volume}"));
                // A sharp highlight magnifies the rounding of directions.
                assert!(error < 2e-6 + 2e-7 * shininess, "{error}");
            }
        }
    }
}

/// Flat light in cells so thin that the differences of f32 alone would tilt their normals.
#[test]
fn thin_cells_keep_their_normals() {
    let Some(gpu) = gpu() else { return };
    let flat = surface(&mut Dice(20), 0.0, 1.0, SurfaceShading::Flat);
    let plan = plan(vec![flat], IsosurfaceMethod::Exact, Some(lighting(Some(DVec3::Z), false, 2.0)));
    let effects = Effects::new(&gpu, &plan, UNITS, None).unwrap();
    for thickness in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        let mut dice = Dice(21);
        let mut scene = Scene { is_perspective: true, ..Scene::default() };
        for _ in 0..1000 {
            let (first, b, c, gradient) = (dice.vector(0.3), dice.vector(0.4), dice.vector(0.4), dice.vector(0.5));
            let normal = b.cross(c);
            if normal.length() < 0.02 {
                continue;
            }
            let d = b * dice.between(0.1, 0.6) + c * dice.between(0.1, 0.4) + normal.normalize() * thickness;
            let corners = [first, first + b, first + c, first + d];
            let middle = corners.iter().sum::<DVec3>() / 4.0;
            scene.add(&mut dice, corners, corners.map(|corner| gradient.dot(corner - middle)));
            let reference = f64::from(scene.segments.last().unwrap().reference) * LATTICE_STEP;
            let segment = scene.segments.last_mut().unwrap();
            (segment.scalars, segment.length) = ([-0.5, 0.5].map(|scalar| (scalar - reference) as f32), 0.01);
        }
        let twin = Twin { scene: &scene, plan: &plan, effects: &effects };
        let mut worst = 0.0_f64;
        for (ray, (light, _)) in drawn(&gpu, &scene, &effects, true).into_iter().enumerate() {
            let known = twin.ray(scene.rays[ray]).0;
            worst = (0..3).fold(worst, |worst, c| worst.max((f64::from(light[c]) - known.rgb[c]).abs()));
        }
        println!("flat, cells {thickness} thick: {worst:.1e}");
        assert!(worst < if thickness < 5e-5 { 1e-4 } else { 1e-6 }, "{worst} in cells {thickness} thick");
    }
}

#[test]
fn volume_is_lit_without_surfaces() {
    let Some(gpu) = gpu() else { return };
    let plan = plan(Vec::new(), IsosurfaceMethod::Exact, Some(lighting(None, true, 16.0)));
    let error = compare(&gpu, &plan, 5, "lit volume");
    assert!(error < 5e-6, "{error}");
}

#[test]
fn maps_are_looked_up() {
    let Some(gpu) = gpu() else { return };
    for mixing in [Mixing::Smooth, Mixing::Stopped] {
        for shading in [SurfaceShading::None, SurfaceShading::Flat, SurfaceShading::Smooth] {
            let lighting = Some(lighting(None, false, 4.0)).filter(|_| shading != SurfaceShading::None);
            let method = IsosurfaceMethod::Map { size: 64, mixing };
            let plan = plan(several(6, 0.5, [shading; 2]), method, lighting);
            let error = compare(&gpu, &plan, 7, &format!("map {mixing:?} {shading:?}"));
            assert!(error < if shading == SurfaceShading::None { 2e-6 } else { 1e-5 }, "{error}");
        }
    }
}

/// Chains of segments whose ends round to either side of a surface.
fn chains(dice: &mut Dice, values: &[f64]) -> Scene {
    let mut scene = Scene { is_perspective: true, ..Scene::default() };
    let scalars = [-0.8, 0.8, -0.7, 0.5];
    scene.add(dice, [DVec3::ZERO, DVec3::X * 0.3, DVec3::Y * 0.3, DVec3::Z * 0.4], scalars);
    let cell = scene.segments[0];
    let reference = f64::from(cell.reference) * LATTICE_STEP;
    scene.segments.clear();
    scene.rays.clear();
    for number in 0..2000 {
        let value = values[number % values.len()] - reference;
        let first = scene.segments.len() as u32;
        // Around the value: exactly on it, or off by what rounding makes of it.
        let mut near = || value - 1.6e-5 - 2e-6 + dice.between(-3e-7, 3e-7);
        // Exits rise; entries are where rounding has them.
        let exit = near();
        let ends = [[value - 0.05, exit], [near(), exit + 2e-7], [near(), value + 0.05]];
        let mut depth = 0.5;
        for [front, back] in ends {
            let begins = depth + dice.between(-3e-7, 3e-7);
            depth += 0.1;
            let flipped = number % 2 == 1;
            let turn = |scalar: f64| (if flipped { 2.0 * value - 3.6e-5 - scalar } else { scalar }) as f32;
            let depth = [begins as f32, depth as f32];
            scene.segments.push(TestSegment { scalars: [turn(front), turn(back)], depth, length: 0.0, ..cell });
        }
        scene.rays.push([first, 3]);
    }
    scene
}

#[test]
fn a_surface_at_a_joint_is_met_once() {
    let Some(gpu) = gpu() else { return };
    let mut dice = Dice(11);
    let values = [-0.3, 0.1, 0.25];
    let surfaces = values.map(|value| surface(&mut dice, value, 0.5, SurfaceShading::None)).to_vec();
    let exact = Effects::new(&gpu, &plan(surfaces.clone(), IsosurfaceMethod::Exact, None), UNITS, None).unwrap();
    let scene = chains(&mut dice, &values);
    for (ray, (light, crossings)) in drawn(&gpu, &scene, &exact, true).into_iter().enumerate() {
        assert_eq!((crossings, light[3]), (1, 0.5), "ray {ray}");
    }
    let mut twice = 0;
    for (ray, (_, crossings)) in drawn(&gpu, &scene, &exact, false).into_iter().enumerate() {
        assert!(crossings >= 1, "ray {ray} misses its surface where no joint is carried");
        twice += u32::from(crossings > 1);
    }
    println!("without joints, all at the surface: {twice} of {} met twice", scene.rays.len());

    let method = IsosurfaceMethod::Map { size: 128, mixing: Mixing::Smooth };
    let maps = Effects::new(&gpu, &plan(surfaces, method, None), UNITS, None).unwrap();
    let moved: Vec<f64> = maps.surfaces().as_slice().iter().map(|surface| surface.value).collect();
    let scene = chains(&mut dice, &moved.iter().map(|value| value + 1.8e-5).collect::<Vec<_>>());
    for (ray, (light, crossings)) in drawn(&gpu, &scene, &maps, true).into_iter().enumerate() {
        // The two passes of a map multiply to it.
        assert!(crossings == 1 && (light[3] - 0.5).abs() < 1e-6, "ray {ray} with maps: {crossings}, {light:?}");
    }
    for (ray, (_, crossings)) in drawn(&gpu, &scene, &maps, false).into_iter().enumerate() {
        assert!(crossings >= 1, "ray {ray} misses its surface in a map where no joint is carried");
    }
}

#[test]
fn cells_near_a_surface_may_show_it() {
    let Some(gpu) = gpu() else { return };
    let mut dice = Dice(12);
    let values: Vec<f64> = (0..37).map(|_| dice.between(-1.1, 1.1)).collect();
    let surfaces = values.iter().map(|&value| surface(&mut dice, value, 1.0, SurfaceShading::None)).collect();
    let effects = Effects::new(&gpu, &plan(surfaces, IsosurfaceMethod::Exact, None), UNITS, None).unwrap();
    let mut ranges: Vec<[i32; 2]> = Vec::new();
    for _ in 0..2000 {
        let (low, width) = (dice.between(-0.95, 0.9), dice.between(-12.0, -1.0).exp());
        ranges.push([low, (low + width).min(0.95)].map(|scalar| UNITS.to_lattice(scalar)));
        let at = values[ranges.len() % values.len()].clamp(-0.9, 0.9) + dice.between(-6e-6, 6e-6);
        ranges.push([UNITS.to_lattice(at); 2]);
    }
    let shown: Vec<u32> = checked(&gpu, || {
        let kernel = Kernel::new(&gpu, &program(&effects, true), "ask");
        let counts = gpu.storage("counts", ranges.len() as u64 * 4);
        let asked = gpu.storage_of("ranges", &ranges);
        let mut resources = effects.resources();
        resources.push(("scalar_ranges", asked.as_entire_binding()));
        resources.push(("counts", counts.as_entire_binding()));
        let group = kernel.bind(&gpu, &resources);
        let mut encoder = gpu.encoder("test");
        kernel.run_alone(&mut encoder, &group, (ranges.len() as u32).div_ceil(64));
        contents(&gpu, encoder, &counts, ranges.len())
    });
    for (&[low, high], shown) in ranges.iter().zip(shown) {
        let [low, high] = [low, high].map(|scalar| f64::from(scalar) * LATTICE_STEP);
        let margin = 1e-4 * (high - low) + 4e-6;
        let is_near = |slack: f64| values.iter().any(|&v| v > low - margin - slack && v < high + margin + slack);
        assert!(shown == 1 || !is_near(-1e-8), "{low} {high}");
        assert!(shown == 0 || is_near(1e-8 + 1e-6 * (high - low)), "{low} {high}");
    }
}

/// A scene pays for what it uses and for nothing else.
#[test]
fn variants_bind_what_they_use() {
    let Some(gpu) = gpu() else { return };
    use SurfaceShading as S;
    let map = |mixing| IsosurfaceMethod::Map { size: 2, mixing };
    let exact = IsosurfaceMethod::Exact;
    let cases: [(Vec<[S; 2]>, _, Option<bool>, &[&str]); 9] = [
        (vec![], exact, None, &[]),
        (vec![], exact, Some(false), &[]),
        (vec![], exact, Some(true), &["frame", "points", "gradients", "lamp"]),
        (vec![[S::None; 2]], exact, Some(false), &["frame", "points", "surfaces"]),
        (vec![[S::Flat; 2]], exact, None, &["frame", "points", "surfaces"]),
        (vec![[S::Flat; 2]], exact, Some(false), &["frame", "points", "surfaces", "lamp"]),
        (vec![[S::Smooth; 2]], exact, Some(false), &["frame", "points", "surfaces", "gradients", "lamp"]),
        (vec![[S::None; 2]], map(Mixing::Stopped), None, &["frame", "points", "maps"]),
        (vec![[S::Smooth; 2]], map(Mixing::Smooth), Some(false), &["frame", "points", "maps", "gradients", "lamp"]),
    ];
    for (number, (shading, method, light, known)) in cases.into_iter().enumerate() {
        let surfaces = shading.first().map_or_else(Vec::new, |&shading| several(1, 0.5, shading));
        let lighting = light.map(|volume| lighting(None, volume, 1.0));
        let effects = Effects::new(&gpu, &plan(surfaces, method, lighting), UNITS, None).unwrap();
        let bindings = program(&effects, true).bindings("shade_rays");
        let names: Vec<&str> =
            bindings.iter().filter(|binding| binding.number < 70).map(|binding| binding.name.as_str()).collect();
        assert_eq!(names, known, "case {number}");
        assert_eq!(effects.needs_gradients(), names.contains(&"gradients"), "case {number}");
        let asks = program(&effects, false).bindings("ask");
        let is_asked = asks.iter().any(|binding| binding.name == "surfaces");
        assert_eq!(is_asked, !shading.is_empty(), "case {number}");
    }
}

#[test]
fn what_is_the_same_is_kept() {
    let Some(gpu) = gpu() else { return };
    let method = IsosurfaceMethod::Map { size: 16, mixing: Mixing::Smooth };
    let dark = plan(several(1, 0.5, [SurfaceShading::Flat; 2]), method, None);
    let lit = Plan { lighting: Some(lighting(None, false, 1.0)), ..dark.clone() };
    let first = Effects::new(&gpu, &dark, UNITS, None).unwrap();
    assert!(first.is_for(&dark, UNITS) && !first.is_for(&lit, UNITS));
    let second = Effects::new(&gpu, &lit, UNITS, Some(&first)).unwrap();
    assert!(Arc::ptr_eq(first.maps.as_ref().unwrap(), second.maps.as_ref().unwrap()));

    let too_large = IsosurfaceMethod::Map { size: 4096, mixing: Mixing::Smooth };
    let plan = plan(several(1, 0.5, [SurfaceShading::None; 2]), too_large, None);
    let refused = Effects::new(&gpu, &plan, UNITS, None);
    assert!(matches!(refused, Err(GpuError::TooLarge { needed, .. }) if needed > 1 << 29), "{refused:?}");
    let method = IsosurfaceMethod::Map { size: 1, mixing: Mixing::Smooth };
    let plan = Plan { isosurfaces: Some(IsosurfacePlan { method, ..plan.isosurfaces.clone().unwrap() }), ..plan };
    assert!(matches!(Effects::new(&gpu, &plan, UNITS, None), Err(GpuError::Isosurfaces(_))));
}
