//! The method `cumulative` for eight rays at once, over pieces that are at hand one by one.
//!
//! A cell meets few pieces of the transfer function, so that a renderer runs through them instead of looking their
//! integrals up. What that saves against the closed form is the work in each: sums of products, and a single exponential
//! for the whole segment. Formulas and error are those of [`crate::RunningIntegrals`], here with integrals in place of
//! means: with `R` the optical depth so far, `K` the integral of color times extinction and `S = R² skew`,
//!
//! ```text
//! R + r        K + k        S + s + (R k - r K) / 2                     composition with the next piece
//! K (1 - exp(-R)) / R + 12 S h(R)      h(R) = ((1 - exp(-R)) / R - 1 + (1 - exp(-R)) / 2) / R²      light
//! ```
//!
//! and in the emitter model the same with the integral of the color over the length in place of `K`.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use super::exponential::opacity_transmittance;

/// Depth of a part of a piece from which on the whole segment is taken as shorter: it is opaque as often as one likes, and its light is a mean,
/// which does not change, while squares stay finite.
const DEEPEST: f32 = 1e6;
/// Depth of an end beyond which none is told from another: sums stay finite.
const LARGEST: f32 = 1e30;

/// Coefficients of `h` in ascending powers of the depth, `-(-1)ᵏ (k + 1) / (2 (k + 3)!)`; up to a depth of 1 the first
/// one left out is below 2e-7 of the sum.
const SERIES: [f32; 9] = {
    let mut series = [0.0; 9];
    let mut factorial = 6.0;
    let mut k = 0;
    while k < series.len() {
        let sign = if k % 2 == 0 { -1.0 } else { 1.0 };
        series[k] = (sign * (k as f64 + 1.0) / (2.0 * factorial)) as f32;
        factorial *= k as f64 + 4.0;
        k += 1;
    }
    series
};

/// The part of eight segments that lies inside one piece: what is linear along it, at its two ends in ascending order of
/// the scalar.
#[derive(Clone, Copy, Debug)]
pub struct Part<S: Simd> {
    /// Extinction, not negative.
    pub extinction: [f32x8<S>; 2],
    /// Color, not negative; up to 1e18.
    pub color: [[f32x8<S>; 3]; 2],
    /// Length, not negative; 0 in lanes whose segment has no part in the piece. The ends are then ignored.
    pub length: f32x8<S>,
}

/// Integrals over the pieces so far, in ascending order of the scalar whichever way the rays run.
///
/// `PER_LENGTH`: whether the color is radiance per length, as in the emitter model, or multiplied by the extinction, as
/// in the density emitter.
#[derive(Clone, Copy, Debug)]
pub struct Sums<S: Simd, const PER_LENGTH: bool> {
    /// What lengths are multiplied by, see [`DEEPEST`].
    scale: f32x8<S>,
    depth: f32x8<S>,
    light: [f32x8<S>; 3],
    skew: [f32x8<S>; 3],
    /// The least and the largest color; only where colors are multiplied by the extinction.
    lowest: [f32x8<S>; 3],
    highest: [f32x8<S>; 3],
}

impl<S: Simd, const PER_LENGTH: bool> Sums<S, PER_LENGTH> {
    /// Of no piece.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let zero = [f32x8::splat(simd, 0.0); 3];
        let one = f32x8::splat(simd, 1.0);
        Self {
            scale: one,
            depth: zero[0],
            light: zero,
            skew: zero,
            lowest: [f32x8::splat(simd, f32::MAX); 3],
            highest: zero,
        }
    }

    /// Adds the part of the segments in the next piece, whose scalars lie above all before.
    #[inline(always)]
    pub fn add(&mut self, simd: S, part: &Part<S>) {
        let zero = f32x8::splat(simd, 0.0);
        let is_inside = part.length.simd_gt(zero);
        let mut length = part.length * self.scale;
        // Half the depth that the part would have with the extinction of either end; without length there is none,
        // however large the extinction.
        let ends = part.extinction.map(|extinction| is_inside.select(extinction, zero));
        let [mut start, mut end] = ends.map(|extinction| (extinction * (length * 0.5)).min(LARGEST));
        let is_too_deep = (start + end).simd_gt(DEEPEST);
        if is_too_deep.any_true() {
            let shorter = is_too_deep.select(f32x8::splat(simd, DEEPEST) / (start + end), f32x8::splat(simd, 1.0));
            self.shorten(shorter);
            (length, start, end) = (length * shorter, start * shorter, end * shorter);
        }
        let (depth, tilt) = (start + end, end - start);
        // Of the change of color over the part: what it adds to the integral beyond the mean, and to the skew.
        let (change_in_light, change_in_skew) = if PER_LENGTH {
            (zero, length * depth * (1.0 / 12.0))
        } else {
            (tilt * (1.0 / 6.0), (depth * depth).mul_sub(5.0, tilt * tilt) * (1.0 / 60.0))
        };
        for c in 0..3 {
            let (low, high) = (part.color[0][c], part.color[1][c]);
            let (change, mean) = (high - low, (low + high) * 0.5);
            let light = change.mul_add(change_in_light, mean * if PER_LENGTH { length } else { depth });
            let mut skew = change * change_in_skew;
            if PER_LENGTH {
                // Where the extinction rises, less than half of the length lies behind half of the depth.
                skew -= light * tilt * (1.0 / 6.0);
            } else {
                self.lowest[c] = is_inside.select(self.lowest[c].min(low.min(high)), self.lowest[c]);
                self.highest[c] = is_inside.select(self.highest[c].max(low.max(high)), self.highest[c]);
            }
            let between = self.depth.mul_sub(light, depth * self.light[c]);
            self.skew[c] += between.mul_add(0.5, skew);
            self.light[c] += light;
        }
        self.depth += depth;
    }

    /// Multiplies all lengths so far, and those to come.
    #[inline(always)]
    fn shorten(&mut self, share: f32x8<S>) {
        self.scale *= share;
        self.depth *= share;
        for c in 0..3 {
            self.light[c] *= share;
            self.skew[c] *= share * share;
        }
    }

    /// Light and opacity of the segments.
    ///
    /// - `rises`: lanes whose scalar rises along the ray, so that the first piece is the nearest
    ///
    /// Without length: no light, and an opacity of exactly 0.
    #[inline(always)]
    pub fn finish(self, simd: S, rises: mask32x8<S>) -> ([f32x8<S>; 3], f32x8<S>) {
        let depth = self.depth;
        let (opacity, transmittance) = opacity_transmittance(simd, depth);
        let one = f32x8::splat(simd, 1.0);
        // Below, the quotient is one but for rounding.
        let has_depth = depth.simd_gt(1e-7);
        let divisor = has_depth.select(depth, one);
        let mean = has_depth.select(opacity / divisor, one);
        let mut series = f32x8::splat(simd, SERIES[SERIES.len() - 1]);
        for &coefficient in SERIES[..SERIES.len() - 1].iter().rev() {
            series = series.mul_add(depth, coefficient);
        }
        let closed = (opacity.mul_add(0.5, mean) - one) / (divisor * divisor);
        let tilt = depth.simd_gt(one).select(closed, series) * 12.0;
        let tilt = rises.select(tilt, -tilt);

        let mut rgb = self.light;
        for (c, channel) in rgb.iter_mut().enumerate() {
            let light = tilt.mul_add(self.skew[c], self.light[c] * mean);
            let (least, most) = if PER_LENGTH {
                // The chord of the transmittance over the mean depth, from convexity.
                let skew = rises.select(self.skew[c], -self.skew[c]);
                let chord = opacity.mul_add(self.light[c] * -0.5, self.light[c]) - mean * skew;
                (transmittance * self.light[c], chord)
            } else {
                (self.lowest[c] * opacity, self.highest[c] * opacity)
            };
            *channel = light.min(most).max(least);
        }
        (rgb, opacity)
    }
}

#[cfg(test)]
#[path = "cumulative_tests.rs"]
mod tests;
