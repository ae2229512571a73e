//! Isosurfaces in a block of pixels: which the rays cross, and their light between the parts of the volume.
//!
//! A segment is cut where its scalar crosses a surface, volume is integrated in front of, between and behind the surfaces, and all is
//! composed in the order along the ray. Nothing is extracted.
//!
//! Which surfaces are crossed follows from ranks: on which side of each surface the two ends of a segment lie. The rank at the
//! entry is that of the exit before, where one cell begins at the depth at which the last one ended: so each surface
//! is met exactly once on the way from one side to the other, whatever rounding does to the scalars at the joint. There is nothing to
//! thicken, and no pixel is drawn twice.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};
use tetrascope_integrate::SurfaceShading;
use tetrascope_integrate::lanes::phong;

use super::cell::CellPieces;
use super::effects::{Lamp, LocalSurface};
use super::gradient::CellGradient;
use super::maps::Maps;
use super::methods::CellOptics;
use super::record::CellRecord;
use super::sample::{LANES, Light, Sample};
use crate::geometry::PixelSpace;

/// Where the rays of a block last left a cell with surfaces.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Joint {
    /// Depth in pixel space, from [`PixelSpace::start`].
    depth: [f32; LANES],
    /// How far it may be off.
    slack: [f32; LANES],
    /// Number of surfaces not above the scalar there; with maps, its texel.
    rank: [f32; LANES],
}

impl Joint {
    /// No cell yet: at no depth.
    pub(crate) const NONE: Self = Self { depth: [f32::NEG_INFINITY; LANES], slack: [0.0; LANES], rank: [0.0; LANES] };

    /// A joint where rays enter a cell, at ranks that are known.
    #[inline(always)]
    pub(crate) fn told<S: Simd>(sample: &Sample<S>, rank: [f32; LANES]) -> Self {
        let mut joint = Self { rank, ..Self::NONE };
        sample.depth[0].store_slice(&mut joint.depth);
        joint
    }

    /// The rank at the front: that of the exit before where the two are one place, else the cell's own. Remembers the exit that is farthest: where the
    /// eye lies in a face but for rounding, either cell of the face may come first, and what the ray has of one of them is next to nothing.
    #[inline(always)]
    pub(crate) fn carry<S: Simd>(
        &mut self,
        simd: S,
        sample: &Sample<S>,
        slack: f32x8<S>,
        [front, back]: [f32x8<S>; 2],
    ) -> f32x8<S> {
        let load = |lanes: &[f32; LANES]| f32x8::from_slice(simd, lanes);
        let (depth, slack_before, rank) = (load(&self.depth), load(&self.slack), load(&self.rank));
        let most_slack = slack.max(slack_before);
        let is_joint = (sample.depth[0] - depth).abs().simd_le(most_slack);
        let covered = sample.covered & sample.depth[1].simd_ge(depth - most_slack);
        covered.select(sample.depth[1], depth).store_slice(&mut self.depth);
        covered.select(slack, slack_before).store_slice(&mut self.slack);
        covered.select(back, rank).store_slice(&mut self.rank);
        is_joint.select(rank, front)
    }
}

/// What a block needs to know of the cell that it draws with its effects.
#[derive(Clone, Copy)]
pub(crate) struct CellWithEffects<'a> {
    pub(crate) record: &'a CellRecord,
    /// The surfaces that may cut it, ascending.
    pub(crate) surfaces: &'a [LocalSurface],
    /// Their place among all surfaces.
    pub(crate) range: CellPieces,
    pub(crate) slack: f32,
    /// How they are drawn where not by analysis.
    pub(crate) maps: Option<&'a Maps>,
    /// Both where anything is lit.
    pub(crate) gradient: Option<&'a CellGradient>,
    /// For surfaces that are lit flat, where the other one is interpolated.
    pub(crate) flat_gradient: Option<&'a CellGradient>,
    pub(crate) lamp: Option<&'a Lamp>,
    pub(crate) space: &'a PixelSpace,
}

/// The rays of a block: where they are, and from where they are seen.
#[derive(Clone, Copy)]
pub(crate) struct Rays<S: Simd> {
    /// Pixel centers from the middle of the picture, in pixel space.
    across: [f32x8<S>; 2],
    /// Towards the eye, in the camera's axes, of length 1.
    to_eye: [f32x8<S>; 3],
    is_perspective: bool,
    /// Depth that depths count from.
    start: f32,
}

/// The volume of a segment by the plan's integration.
pub(crate) type Shade<S> = fn(S, CellOptics<'_>, &Sample<S>) -> Light<S>;

impl CellWithEffects<'_> {
    /// The rays of the block of a sample.
    #[inline(always)]
    pub(crate) fn rays<S: Simd>(&self, simd: S, sample: &Sample<S>) -> Rays<S> {
        let space = self.space;
        let [u, w] = [0, 1].map(|i| PixelSpace::center(u32::from(self.record.pixel[i]), space.size[i]) as f32);
        let across = [sample.place[0] + u, sample.place[1] + w];
        let one = f32x8::splat(simd, 1.0);
        let to_eye = if space.is_perspective {
            let [x, y] = [across[0] * space.slope[0] as f32, across[1] * space.slope[1] as f32];
            let inverse = one / x.mul_add(x, y.mul_add(y, one)).sqrt();
            [-(x * inverse), -(y * inverse), -inverse]
        } else {
            [one * 0.0, one * 0.0, -one]
        };
        Rays { across, to_eye, is_perspective: space.is_perspective, start: space.start as f32 }
    }

    /// What the light makes of a surface, or of the volume, with the field's gradient at a depth as normal: the share of the color
    /// that comes back, and the highlight.
    #[inline(always)]
    pub(crate) fn intensities<S: Simd>(
        &self,
        simd: S,
        rays: &Rays<S>,
        depth: f32x8<S>,
        shading: SurfaceShading,
    ) -> Option<[f32x8<S>; 2]> {
        let gradient = match shading {
            SurfaceShading::None => return None,
            SurfaceShading::Flat => self.flat_gradient.or(self.gradient)?,
            SurfaceShading::Smooth => self.gradient?,
        };
        Some(intensities(simd, gradient, self.lamp?, rays, depth))
    }

    /// What the light makes of the volume, by the gradient in the middle of the segment; `None` if it is not lit.
    #[inline(always)]
    fn intensities_of_volume<S: Simd>(&self, simd: S, rays: &Rays<S>, sample: &Sample<S>) -> Option<[f32x8<S>; 2]> {
        let is_lit = self.lamp.is_some_and(|lamp| lamp.volume);
        if !is_lit {
            return None;
        }
        self.intensities(simd, rays, (sample.depth[0] + sample.depth[1]) * 0.5, SurfaceShading::Smooth)
    }

    /// The volume of a whole segment, lit if it is to be.
    #[inline(always)]
    pub(crate) fn volume<S: Simd>(
        &self,
        simd: S,
        cell: CellOptics<'_>,
        sample: &Sample<S>,
        rays: &Rays<S>,
        shade: Shade<S>,
    ) -> Light<S> {
        lit(shade(simd, cell, sample), self.intensities_of_volume(simd, rays, sample))
    }

    /// Whether rays may cross surfaces here.
    #[inline(always)]
    pub(crate) fn has_surfaces(&self) -> bool {
        self.range.count > 0
    }

    /// How far the depths of a block's segments may be off. Where they come in f64 it is their last digits alone: two cells at the eye, or as
    /// thin as a sheet, are not one because both are small.
    #[inline(always)]
    pub(crate) fn slack<S: Simd>(&self, simd: S, sample: &Sample<S>) -> f32x8<S> {
        if self.record.entry_count > 0 {
            return f32x8::splat(simd, self.slack);
        }
        sample.depth[0].abs().max(sample.depth[1].abs()) * (4.0 * f32::EPSILON)
    }

    /// Ranks of both ends among all surfaces by the scalars there; with maps, their texels. For a cell with surfaces.
    #[inline(always)]
    pub(crate) fn own_ranks<S: Simd>(&self, simd: S, sample: &Sample<S>) -> [f32x8<S>; 2] {
        if let Some(maps) = self.maps {
            return maps.texels(simd, self.record, sample);
        }
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let (mut front, mut back) = (zero, zero);
        for surface in self.surfaces {
            let value = f32x8::splat(simd, surface.above);
            front += sample.front.simd_ge(value).select(one, zero);
            back += sample.back.simd_ge(value).select(one, zero);
        }
        let first = self.range.first as f32;
        [front + first, back + first]
    }

    /// Ranks of both ends among the cell's surfaces.
    #[inline(always)]
    fn ranks<S: Simd>(&self, simd: S, sample: &Sample<S>, joint: &mut Joint) -> [f32x8<S>; 2] {
        // Nothing is crossed here, and no scalar in reach of rounding to a surface is handed on.
        if !self.has_surfaces() {
            return [f32x8::splat(simd, 0.0); 2];
        }
        let own = self.own_ranks(simd, sample);
        let first = self.range.first as f32;
        let front = joint.carry(simd, sample, self.slack(simd, sample), own) - first;
        [front.max(0.0).min(self.range.count as f32), own[1] - first]
    }

    /// The light of a block, and the number of crossings. Out of line, and one for all methods: it is large, and the method is
    /// called through `shade`.
    #[inline(never)]
    pub(crate) fn shade<S: Simd>(
        &self,
        simd: S,
        cell: CellOptics<'_>,
        sample: &Sample<S>,
        joint: &mut Joint,
        shade: Shade<S>,
    ) -> (Light<S>, u64) {
        simd.vectorize(
            #[inline(always)]
            || match self.maps {
                Some(maps) if self.range.count > 0 => maps.shade(simd, cell, self, sample, joint, shade),
                _ => self.cut(simd, cell, sample, joint, shade),
            },
        )
    }

    /// The segments cut at the surfaces.
    #[inline(always)]
    fn cut<S: Simd>(
        &self,
        simd: S,
        cell: CellOptics<'_>,
        sample: &Sample<S>,
        joint: &mut Joint,
        shade: Shade<S>,
    ) -> (Light<S>, u64) {
        let rays = self.rays(simd, sample);
        let of_volume = self.intensities_of_volume(simd, &rays, sample);
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let [front_rank, back_rank] = self.ranks(simd, sample, joint);
        let front_rank = sample.covered.select(front_rank, back_rank);
        let (low_rank, high_rank) = (front_rank.min(back_rank), front_rank.max(back_rank));
        let (mut first, mut last) = (0, 0);
        let crosses = low_rank.simd_lt(high_rank);
        if crosses.any_true() {
            (first, last) = bounds(crosses, low_rank, high_rank);
        }

        let low = sample.front.min(sample.back);
        let high = sample.front.max(sample.back);
        let is_flat = high.simd_le(low);
        let inverse = one / is_flat.select(one, high - low);
        let rises = front_rank.simd_lt(back_rank) | (front_rank.simd_eq(back_rank) & sample.front.simd_le(sample.back));
        let mut light = Light { rgb: [zero; 3], opacity: zero };
        let mut crossings = 0;
        // By ascending scalar: a part of the volume, the surface above it, the next part.
        for index in first..=last {
            let bottom = if index == first { f32::MIN } else { self.surfaces[index - 1].value };
            let top = if index == last { f32::MAX } else { self.surfaces[index].value };
            let from = low.max(bottom).min(high);
            let to = high.min(top).max(low);
            let share = if first == last {
                one
            } else {
                // A segment of one scalar lies in one part, that of its exit.
                let here = back_rank.simd_eq(f32x8::splat(simd, index as f32)).select(one, zero);
                is_flat.select(here, (to - from).max(0.0) * inverse)
            };
            let length = sample.length * share;
            if length.simd_gt(zero).any_true() {
                let part = Sample { front: rises.select(from, to), back: rises.select(to, from), length, ..*sample };
                let part = match cell.sharp {
                    // The ends of the part are not what 32 bits say either.
                    Some(sharp) if first != last => {
                        let below = if index == first { f64::NEG_INFINITY } else { self.surfaces[index - 1].scalar };
                        let above = if index == last { f64::INFINITY } else { self.surfaces[index].scalar };
                        sharp.shade_between(simd, &part, [below, above])
                    }
                    _ => shade(simd, cell, &part),
                };
                let part = lit(part, of_volume);
                compose(&mut light, part, rises);
            }
            if index < last {
                let at = f32x8::splat(simd, index as f32);
                let crossed = low_rank.simd_le(at) & high_rank.simd_gt(at);
                crossings += u64::from(crossed.to_bitmask().count_ones());
                let surface = self.surface(simd, &self.surfaces[index], sample, &rays, crossed, rises);
                compose(&mut light, surface, rises);
            }
        }
        (light, crossings)
    }

    /// The light of a surface in the lanes that cross it.
    #[inline(always)]
    fn surface<S: Simd>(
        &self,
        simd: S,
        surface: &LocalSurface,
        sample: &Sample<S>,
        rays: &Rays<S>,
        crossed: mask32x8<S>,
        rises: mask32x8<S>,
    ) -> Light<S> {
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let opacity = crossed.select(f32x8::splat(simd, surface.opacity), zero);
        let [falling, rising] = surface.colors;
        let mut rgb = [opacity; 3];
        for (c, channel) in rgb.iter_mut().enumerate() {
            *channel = rises.select(f32x8::splat(simd, rising[c]), f32x8::splat(simd, falling[c])) * opacity;
        }
        if surface.shading != SurfaceShading::None {
            let across = sample.back - sample.front;
            let share = (f32x8::splat(simd, surface.value) - sample.front) / across.simd_eq(zero).select(one, across);
            let share = share.max(0.0).min(1.0);
            let depth = share.mul_add(sample.depth[1] - sample.depth[0], sample.depth[0]);
            if let Some([body, highlight]) = self.intensities(simd, rays, depth, surface.shading) {
                for channel in &mut rgb {
                    *channel = channel.mul_add(body, highlight * opacity);
                }
            }
        }
        Light { rgb, opacity }
    }
}

/// [`CellWithEffects::intensities`] out of line: it is asked for at several places.
#[inline(never)]
fn intensities<S: Simd>(
    simd: S,
    gradient: &CellGradient,
    lamp: &Lamp,
    rays: &Rays<S>,
    depth: f32x8<S>,
) -> [f32x8<S>; 2] {
    simd.vectorize(
        #[inline(always)]
        || {
            let [u, w] = rays.across;
            let place = if rays.is_perspective {
                let from_eye = depth + rays.start;
                [u * from_eye, w * from_eye, depth]
            } else {
                [u, w, depth]
            };
            let gradient = gradient.at(simd, place);
            let to_light = lamp.direction.map_or(rays.to_eye, |direction| direction.map(|x| f32x8::splat(simd, x)));
            phong(simd, &lamp.phong, gradient, rays.to_eye, to_light)
        },
    )
}

/// Volume multiplied by what comes back of the light.
#[inline(always)]
fn lit<S: Simd>(mut light: Light<S>, intensities: Option<[f32x8<S>; 2]>) -> Light<S> {
    if let Some([body, highlight]) = intensities {
        for channel in &mut light.rgb {
            *channel *= body + highlight;
        }
    }
    light
}

/// Puts light behind what is there where the scalar rises along the ray, else in front of it.
#[inline(always)]
fn compose<S: Simd>(light: &mut Light<S>, next: Light<S>, rises: mask32x8<S>) {
    let (through_light, through_next) = (1.0 - light.opacity, 1.0 - next.opacity);
    for (channel, next_channel) in light.rgb.iter_mut().zip(next.rgb) {
        let behind = through_light.mul_add(next_channel, *channel);
        let before = through_next.mul_add(*channel, next_channel);
        *channel = rises.select(behind, before);
    }
    light.opacity = light.opacity_with(&next);
}

/// The lowest and the highest rank of the lanes that cross anything.
#[inline(always)]
fn bounds<S: Simd>(crosses: mask32x8<S>, low: f32x8<S>, high: f32x8<S>) -> (usize, usize) {
    let (mut lows, mut highs) = ([0.0; LANES], [0.0; LANES]);
    low.store_slice(&mut lows);
    high.store_slice(&mut highs);
    let crosses = crosses.to_bitmask();
    let (mut first, mut last) = (usize::MAX, 0);
    for lane in 0..LANES {
        if crosses >> lane & 1 == 1 {
            first = first.min(lows[lane] as usize);
            last = last.max(highs[lane] as usize);
        }
    }
    (first, last)
}
