//! The light between all pairs of scalar samples for one length: a slice of a pre-integration table.
//!
//! Pairs that lie the same number of samples apart have steps of the same length between them, so that each is a run of
//! successive steps, and the runs share their steps. A slice of `n` by `n` pairs takes `2 n²` steps, each exact, and
//! five compositions an entry; from scratch the pairs would have `n³ / 3` steps.
//!
//! Source: [Lum 2004] for building from shared parts; the sliding window is ours and needs no inverse.

use crate::window::{Monoid, for_each_run};
use crate::{Isosurfaces, OpticalModel, RgbaAssoc, Segment, TransferFunction, exact};

/// What isosurfaces do in a table.
///
/// A segment crosses those between the ranks of its ends ([`Isosurfaces::rank`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceRole {
    /// They shine and hide with their color and opacity, without light on them: a surface is a peak of no width.
    ///
    /// Source: [Röttger 2000], appendix.
    Included,
    /// The integral ends at the first of them, whatever its opacity; the surface itself is left out.
    ///
    /// Source: [Röttger 2000], section 10.
    Stop,
}

/// What a slice is made of.
pub(crate) struct Pairs<'a> {
    pub(crate) transfer: &'a TransferFunction,
    pub(crate) model: OpticalModel,
    /// Ascending, at least two.
    pub(crate) scalars: &'a [f64],
    pub(crate) surfaces: Option<(&'a Isosurfaces, SurfaceRole)>,
}

/// A stretch of a ray, and whether it is the last that counts.
#[derive(Clone, Copy)]
struct Stretch {
    light: RgbaAssoc,
    is_end: bool,
}

impl Monoid for Stretch {
    const NEUTRAL: Self = Self { light: RgbaAssoc::TRANSPARENT, is_end: false };

    fn then(self, next: Self) -> Self {
        if self.is_end { self } else { Self { light: self.light.over(next.light), is_end: next.is_end } }
    }
}

impl Pairs<'_> {
    /// Calls with the indices of the samples at the front and at the back, and the light between them, for all pairs
    /// that lie `apart` samples apart, in both directions.
    ///
    /// Exact but for rounding, which grows with the number of steps: below 1e-12 (test `slices_are_exact`).
    pub(crate) fn for_each_apart(&self, apart: usize, length: f64, mut pair: impl FnMut(usize, usize, RgbaAssoc)) {
        let scalars = self.scalars;
        if apart == 0 {
            for (i, &scalar) in scalars.iter().enumerate() {
                pair(i, i, self.step(scalar, scalar, length).light);
            }
            return;
        }
        let step_length = length / apart as f64;
        let rising = scalars.windows(2).map(|ends| self.step(ends[0], ends[1], step_length));
        let mut low = 0;
        for_each_run(rising, apart, |run| {
            pair(low, low + apart, run.light);
            low += 1;
        });
        // The other way the ray meets the highest sample first.
        let falling = scalars.windows(2).rev().map(|ends| self.step(ends[1], ends[0], step_length));
        let mut high = scalars.len();
        for_each_run(falling, apart, |run| {
            high -= 1;
            pair(high, high - apart, run.light);
        });
    }

    /// A segment without shortcuts, cut at the surfaces it crosses.
    fn step(&self, front: f64, back: f64, length: f64) -> Stretch {
        let part = |scalar_front, scalar_back, chord_length| {
            exact(self.transfer, self.model, &Segment { scalar_front, scalar_back, chord_length })
        };
        let Some((surfaces, role)) = self.surfaces else {
            return Stretch { light: part(front, back, length), is_end: false };
        };
        let range = surfaces.between(front, back);
        if range.is_empty() {
            return Stretch { light: part(front, back, length), is_end: false };
        }

        let rises = front < back;
        let per_scalar = length / (back - front);
        let crossed = &surfaces.as_slice()[range];
        let (mut light, mut scalar) = (RgbaAssoc::TRANSPARENT, front);
        for step in 0..crossed.len() {
            let surface = &crossed[if rises { step } else { crossed.len() - 1 - step }];
            // The ranks differ, so the value lies between the ends and no length is negative.
            light = light.over(part(scalar, surface.value, (surface.value - scalar) * per_scalar));
            if role == SurfaceRole::Stop {
                return Stretch { light, is_end: true };
            }
            let color = if rises { surface.back_color } else { surface.color };
            let opacity = surface.opacity;
            light = light.over(RgbaAssoc { rgb: color.map(|channel| channel * opacity), opacity });
            scalar = surface.value;
        }
        Stretch { light: light.over(part(scalar, back, (back - scalar) * per_scalar)), is_end: false }
    }
}

/// An entry of a table: rounded to 32 bits, and what exceeds the largest number there becomes that number.
#[expect(clippy::cast_possible_truncation, reason = "32 bits are the purpose")]
pub(crate) fn entry(light: RgbaAssoc) -> [f32; 4] {
    let [red, green, blue] = light.rgb;
    [red, green, blue, light.opacity].map(|value| (value as f32).min(f32::MAX))
}

/// The light that a weighted sum of entries is; the weights are not negative and add up to 1.
pub(crate) fn weighted(entries: &[[f32; 4]], weights: impl Iterator<Item = (usize, f64)>) -> RgbaAssoc {
    let mut sum = [0.0; 4];
    for (index, weight) in weights {
        for (sum, &value) in sum.iter_mut().zip(&entries[index]) {
            *sum += weight * f64::from(value);
        }
    }
    // The weights may round to a little more than 1.
    RgbaAssoc { rgb: [sum[0], sum[1], sum[2]], opacity: sum[3].clamp(0.0, 1.0) }
}
