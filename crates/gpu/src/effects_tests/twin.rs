//! What the shaders of effects are to give, in 64 bits.

use glam::DVec3;
use tetrascope_integrate::surface::{IsosurfaceMap, SmoothMaps};
use tetrascope_integrate::{Isosurface, Isosurfaces, RgbaAssoc, Segment, SurfaceShading};
use tetrascope_scene::{IsosurfaceMethod, Mixing, Plan};
use tetrascope_shaders::layout::LATTICE_STEP;

use super::scene::{PIXEL, RANGE, Scene, TestSegment, UNITS, axes};
use crate::effects::Effects;

/// What the shaders are to give, in 64 bits.
pub(super) struct Twin<'a> {
    pub(super) scene: &'a Scene,
    pub(super) plan: &'a Plan,
    pub(super) effects: &'a Effects,
}

impl Twin<'_> {
    pub(super) fn ray(&self, ray: [u32; 2]) -> (RgbaAssoc, u32) {
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

    pub(super) fn cut(&self, segment: &TestSegment, crossings: &mut u32) -> RgbaAssoc {
        let [low, high] = self.scene.scalar_bounds(segment);
        let tolerance = 1e-5 * f64::from(high - low) * LATTICE_STEP + 2e-6;
        let moved_by = |by: f64| {
            let local = |surface: &Isosurface| Isosurface {
                value: f64::from(UNITS.to_lattice(surface.value) - segment.reference) * LATTICE_STEP - by,
                ..*surface
            };
            Isosurfaces::new(self.effects.drawn.as_slice().iter().map(local).collect()).unwrap()
        };
        // The tolerance says on which side an end is. It moves no surface.
        let (surfaces, sides) = (moved_by(0.0), moved_by(tolerance));
        let [scalar_front, scalar_back] = segment.scalars.map(f64::from);
        let whole = Segment { scalar_front, scalar_back, chord_length: f64::from(segment.length) };
        let intensity = self.volume_intensity(segment);
        surfaces.compose(
            sides.ranks(&whole),
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

    pub(super) fn looked_up(&self, segment: &TestSegment, crossings: &mut u32) -> RgbaAssoc {
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

    pub(super) fn volume_intensity(&self, segment: &TestSegment) -> f64 {
        if !self.plan.lighting.is_some_and(|lighting| lighting.volume) {
            return 1.0;
        }
        let [front, back] = segment.depth.map(f64::from);
        self.intensities(segment, 0.5 * (front + back), SurfaceShading::Smooth).iter().sum()
    }

    pub(super) fn intensities(&self, segment: &TestSegment, depth: f64, shading: SurfaceShading) -> [f64; 2] {
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

pub(super) fn in_view(direction: DVec3) -> DVec3 {
    let [right, down, forward] = axes();
    DVec3::new(right.dot(direction), down.dot(direction), forward.dot(direction))
}

/// As `test/volume_grey.wgsl`.
pub(super) fn grey(part: &Segment, intensity: f64) -> RgbaAssoc {
    let opacity = part.chord_length / (1.0 + part.chord_length);
    let mean = 0.75 * part.scalar_front + 0.25 * part.scalar_back;
    let rgb = [0.5 + 0.25 * mean, 0.5 - 0.25 * mean, 0.25].map(|channel| opacity * channel * intensity);
    RgbaAssoc { rgb, opacity }
}
