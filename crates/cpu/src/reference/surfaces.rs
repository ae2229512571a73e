//! Isosurfaces along a segment, and light on them.

use glam::DVec3;
use tetrascope_integrate::{Isosurface, Isosurfaces, Phong, RgbaAssoc, Segment};

/// Where a segment meets a surface.
pub(super) struct Crossing<'a> {
    pub(super) surface: &'a Isosurface,
    /// 0 at the front of the segment, 1 at its back.
    pub(super) share: f64,
    /// Of the side that is seen.
    pub(super) color: [f64; 3],
}

/// The light of a segment from one rank to another, cut at the surfaces that it crosses.
pub(super) fn compose(
    surfaces: &Isosurfaces,
    [front, back]: [usize; 2],
    segment: &Segment,
    volume: impl Fn(&Segment) -> RgbaAssoc,
    mut shade: impl FnMut(&Crossing) -> [f64; 3],
) -> RgbaAssoc {
    let crossed = &surfaces.as_slice()[front.min(back)..front.max(back)];
    let rises = back > front;
    let rise = segment.scalar_back - segment.scalar_front;
    let mut light = RgbaAssoc::TRANSPARENT;
    let mut from = (segment.scalar_front, 0.0);
    for step in 0..crossed.len() {
        let surface = &crossed[if rises { step } else { crossed.len() - 1 - step }];
        // A segment of one scalar crosses a surface only as its neighbor rounds: at its front.
        let share = if rise == 0.0 { 0.0 } else { ((surface.value - segment.scalar_front) / rise).clamp(0.0, 1.0) };
        let scalar = segment.scalar_front + rise * share;
        light = light.over(volume(&part(segment, from, (scalar, share))));
        let crossing = Crossing { surface, share, color: if rises { surface.back_color } else { surface.color } };
        let color = shade(&crossing);
        light = light.over(RgbaAssoc { rgb: color.map(|c| c * surface.opacity), opacity: surface.opacity });
        if surface.opacity == 1.0 {
            return light;
        }
        from = (scalar, share);
    }
    light.over(volume(&part(segment, from, (segment.scalar_back, 1.0))))
}

fn part(segment: &Segment, from: (f64, f64), to: (f64, f64)) -> Segment {
    let chord_length = segment.chord_length * (to.1 - from.1).max(0.0);
    Segment { scalar_front: from.0, scalar_back: to.0, chord_length }
}

/// The color of a surface in the light.
pub(super) fn shade(phong: &Phong, color: [f64; 3], gradient: DVec3, to_eye: DVec3, to_light: DVec3) -> [f64; 3] {
    let [body, highlight] = intensities(phong, gradient, to_eye, to_light);
    color.map(|channel| channel * body + highlight)
}

/// The share of its color that a surface shows, and the highlight on it.
pub(super) fn intensities(phong: &Phong, gradient: DVec3, to_eye: DVec3, to_light: DVec3) -> [f64; 2] {
    let largest = gradient.abs().max_element();
    if largest == 0.0 {
        return [phong.ambient, 0.0];
    }
    let scaled = gradient / largest;
    let direction = scaled / scaled.length();
    let normal = if direction.dot(to_eye) < 0.0 { -direction } else { direction };
    let cosine = normal.dot(to_light);
    if cosine <= 0.0 {
        return [phong.ambient, 0.0];
    }
    let mirrored = normal * (2.0 * cosine) - to_light;
    let highlight = phong.specular * mirrored.dot(to_eye).max(0.0).powf(phong.shininess);
    [phong.ambient + phong.diffuse * cosine, highlight]
}
