//! Cells, eyes, and their light by rays that are cut in f64.

use glam::{DVec2, DVec3};
use tetrascope_classify::{Projected, Viewpoint, project};
use tetrascope_shaders::layout::{Frame, LATTICE_STEP, NEGATIVE_BIT, OpticsUniform};
use tetrascope_view::View;

use crate::Gpu;
use crate::view::{Part, frame_of};

pub(super) const SIZE: u32 = 64;
pub(super) const EXTINCTION: f32 = 1.5;
pub(super) const EXTINCTION_SLOPE: f32 = 1.0;

/// A piece of the transfer function as `integrate/pieces.wgsl` has it, over scalars from -1 to 1: extinction and green are linear.
pub(super) fn pieces() -> [[u32; 4]; 3] {
    let [low, high] = [EXTINCTION - EXTINCTION_SLOPE, EXTINCTION + EXTINCTION_SLOPE];
    [
        [lattice(-1.0) as u32, lattice(1.0) as u32, low.to_bits(), high.to_bits()],
        [0.9_f32.to_bits(), 0.0_f32.to_bits(), 0.2_f32.to_bits(), 3],
        [0.9_f32.to_bits(), 1.0_f32.to_bits(), 0.2_f32.to_bits(), 0.5_f32.to_bits()],
    ]
}

/// Numbers from 0 to 1, the same in every run.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Cells one behind the other along camera axes, and an eye.
pub(super) struct Scene {
    pub(super) points: Vec<[i32; 4]>,
    pub(super) cells: Vec<[u32; 4]>,
    /// Also the middle of an orthographic view's plane.
    pub(super) eye: DVec3,
    /// Slope of a pixel, or its size.
    pub(super) pixel: f64,
    pub(super) is_perspective: bool,
    pub(super) part: Part,
}

pub(super) fn lattice(x: f64) -> i32 {
    (x / LATTICE_STEP).round() as i32
}

impl Scene {
    pub(super) fn new(eye: DVec3, pixel: f64, is_perspective: bool) -> Self {
        let part = Part { origin: [0; 2], extent: [SIZE; 2] };
        Self { points: Vec::new(), cells: Vec::new(), eye, pixel, is_perspective, part }
    }

    pub(super) fn add(&mut self, corners: [DVec3; 4], scalars: [f64; 4]) {
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
    pub(super) fn corners(&self, cell: [u32; 4]) -> ([DVec3; 4], [f64; 4]) {
        let points = cell.map(|vertex| self.points[(vertex & !NEGATIVE_BIT) as usize]);
        let place = |p: [i32; 4]| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2])) * LATTICE_STEP;
        (points.map(place), points.map(|p| f64::from(p[3]) * LATTICE_STEP))
    }

    pub(super) fn frame(&self) -> Frame {
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
    pub(super) fn projected(&self) -> Vec<[i32; 4]> {
        let frame = self.frame();
        let base = [frame.right[3], frame.down[3], frame.forward[3], 0];
        self.points.iter().map(|point| [0, 1, 2, 3].map(|axis| point[axis] - base[axis])).collect()
    }

    pub(super) fn viewpoint(&self) -> Viewpoint {
        if self.is_perspective { Viewpoint::Eye(self.eye) } else { Viewpoint::Direction(DVec3::Z) }
    }

    /// A cell as the CPU projects it, with the corners' numbers put back in order.
    pub(super) fn project(&self, cell: [u32; 4]) -> (Projected, [usize; 4]) {
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
    pub(super) fn trace(&self, x: u32, y: u32) -> [f64; 4] {
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
pub(super) struct Uploaded {
    pub(super) frame: wgpu::Buffer,
    pub(super) points: wgpu::Buffer,
    pub(super) drawn: wgpu::Buffer,
    pub(super) totals: wgpu::Buffer,
    pub(super) picture: wgpu::Buffer,
    pub(super) pieces: wgpu::Buffer,
    pub(super) optics: wgpu::Buffer,
}

impl Uploaded {
    pub(super) fn new(gpu: &Gpu, scene: &Scene) -> Self {
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

    pub(super) fn named(&self) -> Vec<crate::kernel::Named<'_>> {
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

pub(super) fn random_cell(random: &mut Random, center: DVec3, size: f64) -> ([DVec3; 4], [f64; 4]) {
    let corner = |random: &mut Random| {
        center + size * DVec3::new(random.within(-1., 1.), random.within(-1., 1.), random.within(-1., 1.))
    };
    let corners = [0; 4].map(|_| corner(random));
    (corners, [0; 4].map(|_| random.within(-0.5, 0.5)))
}

/// Cells one behind the other from `nearest` depth on.
pub(super) fn layers(eye: DVec3, pixel: f64, is_perspective: bool, nearest: f64, size: f64, count: usize) -> Scene {
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
