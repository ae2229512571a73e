//! Cells and rays for tests of effects, and plans.

use glam::DVec3;
use tetrascope_integrate::{Isosurface, Isosurfaces, OpticalModel, Phong, SurfaceShading, TransferFunction};
use tetrascope_scene::{IsosurfaceMethod, IsosurfacePlan, Lighting, Plan};
use tetrascope_shaders::layout::{Frame, LATTICE_STEP, UNIT};
use tetrascope_view::View;

use crate::effects::ScalarUnit;

pub(super) const PIXEL: f64 = 0.004;
pub(super) const START: f64 = 1.5;
pub(super) const EYE: DVec3 = DVec3::new(0.1, -0.2, -3.0);
pub(super) const RANGE: [f64; 2] = [-0.9, 0.9];
pub(super) const UNITS: ScalarUnit = ScalarUnit { factor: 1.0, range: RANGE, middle: 0.0 };

/// Numbers that look random, the same every time.
pub(super) struct Dice(pub(super) u64);

impl Dice {
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }

    pub(super) fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    pub(super) fn color(&mut self) -> [f64; 3] {
        [(); 3].map(|()| f64::from(self.between(0.0, 1.0) as f32))
    }
}

/// As `TestSegment` of the shader.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct TestSegment {
    pub(super) vertices: [u32; 4],
    pub(super) scalars: [f32; 2],
    pub(super) depth: [f32; 2],
    pub(super) center: [f32; 2],
    pub(super) length: f32,
    pub(super) reference: i32,
}

/// Cells, gradients at their points, and rays through them.
#[derive(Default)]
pub(super) struct Scene {
    pub(super) points: Vec<[i32; 4]>,
    pub(super) gradients: Vec<[f32; 4]>,
    pub(super) segments: Vec<TestSegment>,
    pub(super) rays: Vec<[u32; 2]>,
    pub(super) is_perspective: bool,
}

pub(super) fn axes() -> [DVec3; 3] {
    let right = DVec3::new(0.6, 0.64, 0.48);
    let down = DVec3::new(-0.8, 0.48, 0.36);
    [right, down, right.cross(down)]
}

pub(super) fn frame(is_perspective: bool) -> Frame {
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
    pub(super) fn random(dice: &mut Dice, cells: usize, is_perspective: bool) -> Self {
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

    pub(super) fn add(&mut self, dice: &mut Dice, corners: [DVec3; 4], scalars: [f64; 4]) {
        let first = self.points.len() as u32;
        for (corner, scalar) in corners.iter().zip(scalars) {
            let [x, y, z] = corner.to_array().map(|x| (x / LATTICE_STEP).round() as i32);
            self.points.push([x, y, z, UNITS.to_lattice(scalar)]);
            // Not all around: where they cancel, the sum has no direction to compare.
            let g = DVec3::new(1.0, -2.0, 0.5) + dice.vector(1.0);
            self.gradients.push([g.x as f32, g.y as f32, g.z as f32, 0.0]);
        }
        let vertices = [first, first + 1, (first + 2) | (1 << 31), (first + 3) | (1 << 31)];
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

    pub(super) fn corners(&self, vertices: [u32; 4]) -> [DVec3; 4] {
        vertices.map(|v| {
            let [x, y, z, _] = self.points[(v & !(1 << 31)) as usize].map(f64::from);
            DVec3::new(x, y, z) * LATTICE_STEP
        })
    }

    /// How much each corner counts where a segment's ray is at a depth.
    pub(super) fn shares(&self, segment: &TestSegment, depth: f64) -> [f64; 4] {
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

    pub(super) fn scalar_bounds(&self, segment: &TestSegment) -> [i32; 2] {
        let scalars = segment.vertices.map(|v| self.points[(v & !(1 << 31)) as usize][3]);
        [scalars.into_iter().min().unwrap(), scalars.into_iter().max().unwrap()]
    }
}

pub(super) fn surface(dice: &mut Dice, value: f64, opacity: f64, shading: SurfaceShading) -> Isosurface {
    Isosurface { value, color: dice.color(), back_color: dice.color(), opacity, shading }
}

pub(super) fn plan(surfaces: Vec<Isosurface>, method: IsosurfaceMethod, lighting: Option<Lighting>) -> Plan {
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

pub(super) fn lighting(direction: Option<DVec3>, volume: bool, shininess: f64) -> Lighting {
    Lighting { phong: Phong { ambient: 0.25, diffuse: 0.625, specular: 0.375, shininess }, direction, volume }
}
