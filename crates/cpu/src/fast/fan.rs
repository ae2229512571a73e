//! Fans of triangles, for the integration that is defined on them.
//!
//! Color and opacity are interpolated linearly on the screen over each triangle between the thick vertex and two corners
//! ([Shirley 1990], section 2.6). The opacity is 0 on the outline and greatest at the thick vertex, as the chord's
//! nearness is; so it is the thick vertex's opacity times the share of nearness, and only the color needs the
//! triangles.

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::{DVec2, DVec3};
use tetrascope_classify::{FanVertex, Viewpoint, project};
use tetrascope_integrate::{OpticalModel, TransferFunction, homogeneous};

use super::cell::Cell;
use super::sample::{Light, Sample};
use crate::geometry::PixelSpace;

/// A cell's fan on the screen; pixels are counted from the record's reference pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fan {
    /// Of each triangle the lines from the thick vertex to its two corners: on which side a pixel lies, as a plane, not negative beyond the
    /// line, counted around the fan. Not shared by neighbors: a thick vertex on the outline leaves a triangle without area out.
    spokes: [[Plane; 2]; 4],
    /// The three color channels over each triangle.
    colors: [[Plane; 3]; 4],
    /// Number of triangles.
    count: usize,
    /// Light at the thick vertex: color, not multiplied by opacity where the model has one.
    peak: [f32; 3],
    opacity: f32,
    /// Lowest and highest of each channel over the corners and the thick vertex: no color between them is beyond, however narrow a triangle is.
    bounds: [[f32; 2]; 3],
    /// One over the nearness of the thick vertex's chord.
    inverse_nearness: f32,
}

/// A function that is linear on the screen: at the reference pixel, per column, per row.
type Plane = [f32; 3];

/// What a fan needs to know of the frame.
pub(crate) struct FanSetUp<'a> {
    pub(crate) space: &'a PixelSpace,
    pub(crate) transfer: &'a TransferFunction,
    pub(crate) model: OpticalModel,
}

impl FanSetUp<'_> {
    /// The fan of a cell all of which lies in front of the eye; `None` if its outline has no area.
    ///
    /// - `pixel`: center of the reference pixel
    /// - `depth`: the record's reference depth
    pub(crate) fn fan(&self, cell: &Cell, pixel: DVec2, depth: f64) -> Option<Fan> {
        let &Cell { mut corners, mut scalars, is_positive, .. } = cell;
        let mut ids = [0_u32, 1, 2, 3];
        if !is_positive {
            corners.swap(2, 3);
            scalars.swap(2, 3);
            ids.swap(2, 3);
        }
        let is_perspective = self.space.is_perspective;
        let viewpoint = if is_perspective { Viewpoint::Eye(DVec3::ZERO) } else { Viewpoint::Direction(DVec3::Z) };
        let projected = project(&corners, &scalars, ids, viewpoint);
        let thick = projected.thick?;
        let on_screen = |p: DVec3| if is_perspective { p.truncate() / p.z } else { p.truncate() };
        let center = on_screen(if is_perspective { thick.ray } else { thick.near });
        let chord =
            if is_perspective { thick.chord_length * thick.ray.z / thick.ray.length() } else { thick.chord_length };
        let nearness = if is_perspective { depth * chord / (thick.near.z * thick.far.z) } else { chord };
        if !(nearness > 0.0 && nearness.is_finite()) {
            return None;
        }
        // Color and opacity at the thick vertex as `tetrascope_integrate::thick_vertex` has them.
        let length = chord * self.space.ray_stretch(center.x, center.y);
        let [front, back] = [thick.scalar_front, thick.scalar_back].map(|s| self.value(cell, s));
        let extinction = 0.5 * (front.0 + back.0);
        let color = [0, 1, 2].map(|c| 0.5 * (front.1[c] + back.1[c]));
        let light = homogeneous(self.model, extinction, color, length);
        // Where color is multiplied by opacity, the color itself is interpolated; else light that is 0 on the outline.
        let has_color = self.model == OpticalModel::DensityEmitter;
        let peak = if has_color { color } else { light.rgb };
        let mut fan = Fan {
            spokes: [[[0.0; 3]; 2]; 4],
            colors: [[[0.0; 3]; 3]; 4],
            count: 0,
            peak: peak.map(|x| x as f32),
            opacity: light.opacity as f32,
            bounds: peak.map(|x| [x as f32; 2]),
            inverse_nearness: (1.0 / nearness) as f32,
        };
        if !has_color {
            return Some(fan);
        }
        let colors = scalars.map(|s| self.value(cell, s).1);
        for color in &colors {
            for ([low, high], channel) in fan.bounds.iter_mut().zip(color) {
                (*low, *high) = (low.min(*channel as f32), high.max(*channel as f32));
            }
        }
        for [_, i, j] in projected.fan.triangles() {
            let (FanVertex::Corner(i), FanVertex::Corner(j)) = (i, j) else { continue };
            let (p, q) = (on_screen(corners[i]), on_screen(corners[j]));
            let (p_color, q_color) = (colors[i], colors[j]);
            let (to_p, to_q) = (p - center, q - center);
            let area = to_p.perp_dot(to_q);
            if area == 0.0 || !area.is_finite() || fan.count == 4 {
                continue;
            }
            let from_center = pixel - center;
            let side = |spoke: DVec2| {
                let turn = area.signum();
                [spoke.perp_dot(from_center) * turn, -spoke.y * turn, spoke.x * turn].map(|x| x as f32)
            };
            let planes = [0, 1, 2].map(|c| {
                // The gradient g with g . to_p and g . to_q the differences of color.
                let (dp, dq) = (p_color[c] - peak[c], q_color[c] - peak[c]);
                let gradient = DVec2::new(dp * to_q.y - dq * to_p.y, dq * to_p.x - dp * to_q.x) / area;
                [peak[c] + gradient.dot(from_center), gradient.x, gradient.y].map(|x| x as f32)
            });
            // A triangle as narrow as f64's last digits: no pixel is in it.
            if !planes.iter().flatten().all(|x| x.is_finite()) {
                continue;
            }
            fan.spokes[fan.count] = [side(to_p), side(to_q)];
            fan.colors[fan.count] = planes;
            fan.count += 1;
        }
        Some(fan)
    }

    /// Extinction and color at a scalar of a cell; few pieces of the transfer function come into question.
    fn value(&self, cell: &Cell, scalar: f64) -> (f64, [f64; 3]) {
        let first = cell.pieces.first as usize;
        let pieces = &self.transfer.pieces()[first..first + cell.pieces.count as usize];
        let piece = pieces.iter().rev().find(|piece| piece.start <= scalar).unwrap_or(&pieces[0]);
        (piece.extinction_at(scalar), piece.color_at(scalar))
    }
}

impl Fan {
    /// The light of a block.
    #[inline(always)]
    pub(crate) fn shade<S: Simd>(&self, simd: S, sample: &Sample<S>) -> Light<S> {
        // The clamp is for rounding alone.
        let share = (sample.nearness * self.inverse_nearness).min(1.0);
        let opacity = share * self.opacity;
        let [r, g, b] = self.peak;
        let mut color = [f32x8::splat(simd, r), f32x8::splat(simd, g), f32x8::splat(simd, b)];
        if self.count == 0 {
            return Light { rgb: [color[0] * share, color[1] * share, color[2] * share], opacity };
        }
        for triangle in 0..self.count {
            let [begin, end] = &self.spokes[triangle];
            let begins = plane(simd, begin, sample).simd_ge(f32x8::splat(simd, 0.0));
            // On the line between two triangles both have one color.
            let ends = plane(simd, end, sample).simd_le(f32x8::splat(simd, 0.0));
            let inside = begins & ends;
            for ((channel, over), [low, high]) in color.iter_mut().zip(&self.colors[triangle]).zip(&self.bounds) {
                let between = plane(simd, over, sample).max(*low).min(*high);
                *channel = inside.select(between, *channel);
            }
        }
        Light { rgb: [color[0] * opacity, color[1] * opacity, color[2] * opacity], opacity }
    }
}

/// A plane's values in the lanes.
#[inline(always)]
fn plane<S: Simd>(simd: S, [at_reference, per_column, per_row]: &Plane, sample: &Sample<S>) -> f32x8<S> {
    let [column, row] = sample.place;
    let at_row = f32x8::splat(simd, *per_row).mul_add(row, f32x8::splat(simd, *at_reference));
    f32x8::splat(simd, *per_column).mul_add(column, at_row)
}
