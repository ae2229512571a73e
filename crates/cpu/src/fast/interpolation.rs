//! What a ray has inside a cell, interpolated over the triangles of the cell's fan: the ways of the literature.
//!
//! Planes give the scalars at both ends of a segment and its length exactly. Renderers on graphics hardware have them at the vertices
//! of a fan instead, where the length is 0 but for the thick vertex, and interpolate ([Shirley 1990], section 2.6). Both ways of doing
//! that start here from what the planes give. In a fan's triangle, which lies between one front and one back face, the difference of
//! nearness between both ends is the share of the thick vertex times its own difference; so whatever is 0 on the outline needs no triangle:
//! - on the screen: length `D z_f z_b`, with `D` the pixel's difference of 1/depth and `z_f`, `z_b` the depths at the thick vertex;
//! - with the perspective correction of hardware, by the depth `Z_f` of the pixel's front: what is linear is the attribute over that depth.
//!   The front scalar is then exact, the length `D Z_f z_b`, and the back scalar `s_b + D Z_f (t_b - s_b)`, with `t_b` the one at the thick
//!   vertex.
//!
//! Only scalars on the screen need the triangles themselves. Lengths are those of depth: by how much a ray is longer than straight ahead
//! every pixel knows, and the literature interpolates that too, which changes little where cells are small in the picture.

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::{DVec2, DVec3};
use tetrascope_classify::{FanVertex, Projected, ThickVertex, Viewpoint, project};
use tetrascope_scene::Interpolation;

use super::cell::Cell;
use super::record::{CellRecord, Records};
use super::sample::Sample;
use crate::geometry::PixelSpace;

/// A cell's fan for interpolation with the perspective correction of hardware.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PerspectiveFan {
    /// Depth of the back at the thick vertex, over the reference depth.
    back_depth: f32,
    /// Scalar of the back at the thick vertex, relative to the cell's reference.
    back: f32,
    /// One over the reference depth.
    inverse_depth: f32,
}

/// A cell's fan for interpolation on the screen; pixels are counted from the thick vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScreenFan {
    /// The thick vertex, from the record's reference pixel.
    center: [f32; 2],
    /// Of each triangle the lines to its two corners: positive for pixels beyond the line, counted around the fan; per column, per row. Not shared by
    /// neighbors: a thick vertex on the outline leaves a triangle without area out.
    spokes: [[[f32; 2]; 2]; 4],
    /// The front scalar's slope over each triangle.
    slopes: [[f32; 2]; 4],
    /// Number of triangles.
    count: usize,
    /// Scalar of the front at the thick vertex, relative to the cell's reference, and what the one of the back has more.
    front: f32,
    rise: f32,
    /// One over the difference of nearness at the thick vertex.
    inverse_nearness: f32,
    /// Length for a difference of nearness.
    length: f32,
}

/// How a cell's samples are interpolated, where they are not as the planes have them.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Interpolated<'a> {
    Perspective(&'a PerspectiveFan),
    Screen(&'a ScreenFan),
}

/// A cell's fan, and its thick vertex.
struct Shape {
    projected: Projected,
    thick: ThickVertex,
    corners: [DVec3; 4],
    scalars: [f64; 4],
    /// Depth of the record's reference.
    depth: f64,
}

impl Shape {
    /// That of a cell before the eye in a perspective view; `None` if its outline has no area, or for a cell that is drawn in f64.
    fn new(cell: &Cell, record: &CellRecord, space: &PixelSpace) -> Option<Self> {
        if record.entry_count == 0 || !space.is_perspective {
            return None;
        }
        let &Cell { mut corners, mut scalars, is_positive, .. } = cell;
        let mut ids = [0_u32, 1, 2, 3];
        if !is_positive {
            corners.swap(2, 3);
            scalars.swap(2, 3);
            ids.swap(2, 3);
        }
        let projected = project(&corners, &scalars, ids, Viewpoint::Eye(DVec3::ZERO));
        let depth = record.length / space.world_per_depth;
        projected.thick.map(|thick| Self { projected, thick, corners, scalars, depth })
    }
}

impl PerspectiveFan {
    /// That of a cell and the record that it became; `None` where the planes' way is taken.
    pub(crate) fn new(cell: &Cell, record: &CellRecord, space: &PixelSpace) -> Option<Self> {
        let Shape { thick, depth, .. } = Shape::new(cell, record, space)?;
        Some(Self {
            back_depth: (thick.far.z / depth) as f32,
            back: (thick.scalar_back - record.scalar_reference) as f32,
            inverse_depth: (1.0 / depth) as f32,
        })
    }

    #[inline(always)]
    fn apply<S: Simd>(&self, simd: S, record: &CellRecord, mut sample: Sample<S>) -> Sample<S> {
        // The front's depth over the reference depth, from their difference, which far cells need.
        let from_reference = sample.depth[0] - record.depth;
        let front_depth = from_reference.mul_add(f32x8::splat(simd, self.inverse_depth), f32x8::splat(simd, 1.0));
        // The clamp is for rounding alone.
        let share = (sample.nearness * front_depth).max(0.0).min(1.0);
        sample.back = share.mul_add(f32x8::splat(simd, self.back) - sample.back, sample.back);
        sample.length = share * self.back_depth;
        sample
    }
}

impl ScreenFan {
    /// That of a cell and the record that it became; `None` where the planes' way is taken.
    pub(crate) fn new(cell: &Cell, record: &CellRecord, space: &PixelSpace) -> Option<Self> {
        let Shape { projected, thick, corners, scalars, depth } = Shape::new(cell, record, space)?;
        let on_screen = |p: DVec3| p.truncate() / p.z;
        let center = on_screen(thick.ray);
        let reference = DVec2::from([0, 1].map(|i| PixelSpace::center(u32::from(record.pixel[i]), space.size[i])));
        // From the volumes, where the difference of two depths would cancel.
        let at_thick = projected.screen_attributes(FanVertex::Thick, &corners, &scalars, DVec3::ZERO, DVec3::Z)?;
        let nearness = depth * at_thick.dq;
        if !(nearness > 0.0 && nearness.is_finite()) {
            return None;
        }
        let mut fan = Self {
            center: (center - reference).to_array().map(|x| x as f32),
            spokes: [[[0.0; 2]; 2]; 4],
            slopes: [[0.0; 2]; 4],
            count: 0,
            front: (thick.scalar_front - record.scalar_reference) as f32,
            rise: (thick.scalar_back - thick.scalar_front) as f32,
            inverse_nearness: (1.0 / nearness) as f32,
            length: ((thick.near.z / depth) * (thick.far.z / depth)) as f32,
        };
        for [_, i, j] in projected.fan.triangles() {
            let (FanVertex::Corner(i), FanVertex::Corner(j)) = (i, j) else { continue };
            let (to_p, to_q) = (on_screen(corners[i]) - center, on_screen(corners[j]) - center);
            let area = to_p.perp_dot(to_q);
            if area == 0.0 || !area.is_finite() || fan.count == 4 {
                continue;
            }
            let side = |spoke: DVec2| [-spoke.y, spoke.x].map(|x| (x * area.signum()) as f32);
            fan.spokes[fan.count] = [side(to_p), side(to_q)];
            // The slope g with g . to_p and g . to_q the differences of the scalar.
            let (dp, dq) = (scalars[i] - thick.scalar_front, scalars[j] - thick.scalar_front);
            let slope = DVec2::new(dp * to_q.y - dq * to_p.y, dq * to_p.x - dp * to_q.x) / area;
            // Finite, so that no product is NaN; what lies beyond is cut to the cell's range anyway.
            fan.slopes[fan.count] = slope.to_array().map(|x| x.clamp(-1e30, 1e30) as f32);
            fan.count += 1;
        }
        Some(fan)
    }

    #[inline(always)]
    fn apply<S: Simd>(&self, simd: S, record: &CellRecord, mut sample: Sample<S>) -> Sample<S> {
        let zero = f32x8::splat(simd, 0.0);
        let (x, y) = (sample.place[0] - self.center[0], sample.place[1] - self.center[1]);
        // Pixels that rounding puts beside all triangles keep what they have.
        let mut front = sample.front;
        for triangle in 0..self.count {
            let [begin, end] = self.spokes[triangle];
            let begins = linear(simd, begin, [x, y], 0.0).simd_ge(zero);
            // On the line between two triangles both have one scalar.
            let ends = linear(simd, end, [x, y], 0.0).simd_le(zero);
            front = (begins & ends).select(linear(simd, self.slopes[triangle], [x, y], self.front), front);
        }
        let share = (sample.nearness * self.inverse_nearness).max(0.0).min(1.0);
        let back = share.mul_add(f32x8::splat(simd, self.rise), front);
        // In a triangle that is all but a line the slope is steep, and what rounding does to it large.
        let [low, high] = record.scalar_range;
        (sample.front, sample.back) = (front.max(low).min(high), back.max(low).min(high));
        sample.length = sample.nearness * self.length;
        sample
    }
}

impl Records {
    /// Adds the fans of the records that a cell has become, from `first` on, where segments are not as the planes have them.
    ///
    /// Pieces of cells, and cells that are drawn in f64, have none and keep the exact way; those that reach the plane of the eye are
    /// among the latter.
    pub(crate) fn add_fans_of_segments(
        &mut self,
        interpolation: Interpolation,
        cell: &Cell,
        first: usize,
        space: &PixelSpace,
    ) {
        let cells = &self.cells[first..];
        match interpolation {
            Interpolation::Exact => {}
            Interpolation::Perspective => {
                self.perspective.extend(cells.iter().map(|record| PerspectiveFan::new(cell, record, space)));
            }
            Interpolation::Screen => self.screen.extend(cells.iter().map(|record| ScreenFan::new(cell, record, space))),
        }
    }
}

impl Interpolated<'_> {
    /// A sample of the planes, interpolated.
    #[inline(always)]
    pub(crate) fn apply<S: Simd>(self, simd: S, record: &CellRecord, sample: Sample<S>) -> Sample<S> {
        match self {
            Self::Perspective(fan) => fan.apply(simd, record, sample),
            Self::Screen(fan) => fan.apply(simd, record, sample),
        }
    }
}

/// A function that is linear on the screen.
#[inline(always)]
fn linear<S: Simd>(simd: S, [per_column, per_row]: [f32; 2], [x, y]: [f32x8<S>; 2], at_origin: f32) -> f32x8<S> {
    let at_row = f32x8::splat(simd, per_row).mul_add(y, f32x8::splat(simd, at_origin));
    f32x8::splat(simd, per_column).mul_add(x, at_row)
}
