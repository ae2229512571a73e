//! Deeper segments: split into equal parts thin enough for the series, composed from front to back.
//!
//! Extinction and color stay linear on a part. With `T` the transmittance up to a part that begins at the share `u` of
//! the segment, its front color counts `1 - u` times for the front of the whole and `u` times for the back.
//!
//! Of a very deep segment only the part next to the eye is split, up to an optical depth beyond which next to nothing
//! is seen. So the number of parts is bounded and no lane needs a path of its own.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::exponential::{exp_negative, opacity_transmittance};
use super::thin;
use crate::series::TAU_MAX_F32;
use crate::weights::Weights;

/// Optical depth up to which a segment is followed. What lies beyond sends [`BEYOND`] of its light, and counts at most
/// 7 times that much, where the extinction falls to zero right behind.
const VISIBLE_DEPTH: f32 = 18.0;
/// `exp(-VISIBLE_DEPTH)`.
const BEYOND: f32 = 1.523e-8;
/// With so many parts none exceeds an optical depth of 1.11, wherever the extinction is gathered; the series is good to
/// 3e-8 there.
const MOST_PARTS: u32 = 32;

/// Kept out of the loops that call it: it would fill their instruction cache for the rare case.
#[inline(never)]
pub(super) fn density_emitter<S: Simd>(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Weights<f32x8<S>> {
    simd.vectorize(
        #[inline(always)]
        || {
            let visible = Visible::new(simd, tau_front, tau_back);
            let mut back = Sum::new(simd);
            visible.for_each_part(
                simd,
                #[inline(always)]
                |start, end, seen, position, share| {
                    let one = thin::density_emitter(simd, start, end);
                    back.add(seen * (one.front + one.back).mul_add(position, one.back * share));
                },
            );
            let (opacity, transmittance) = opacity_transmittance(simd, visible.optical_depth);
            // What is seen from beyond the stretch lies right behind it.
            let beyond = visible.is_cut.select(f32x8::splat(simd, BEYOND), f32x8::splat(simd, 0.0));
            let back = (back.value + beyond) * visible.stretch;
            // No cancellation: transmittance falls, so the front has at least a third of the whole.
            let split = Weights { front: opacity - back, back, transmittance };
            with_thin_lanes(tau_front, tau_back, thin::density_emitter(simd, tau_front, tau_back), split)
        },
    )
}

/// Likewise for the emitter.
#[inline(never)]
pub(super) fn emitter<S: Simd>(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Weights<f32x8<S>> {
    simd.vectorize(
        #[inline(always)]
        || {
            let visible = Visible::new(simd, tau_front, tau_back);
            let (mut sum, mut back) = (Sum::new(simd), Sum::new(simd));
            visible.for_each_part(
                simd,
                #[inline(always)]
                |start, end, seen, position, share| {
                    let one = thin::emitter(simd, start, end);
                    let seen = seen * share;
                    let whole = one.front + one.back;
                    sum.add(seen * whole);
                    back.add(seen * whole.mul_add(position, one.back * share));
                },
            );
            let (_, transmittance) = opacity_transmittance(simd, visible.optical_depth);
            let sum = sum.value * visible.stretch;
            let back = back.value * visible.stretch * visible.stretch;
            let split = Weights { front: sum - back, back, transmittance };
            with_thin_lanes(tau_front, tau_back, thin::emitter(simd, tau_front, tau_back), split)
        },
    )
}

/// Takes the series itself where it suffices: a thin lane does not depend on its neighbors.
#[inline(always)]
fn with_thin_lanes<S: Simd>(
    tau_front: f32x8<S>,
    tau_back: f32x8<S>,
    thin: Weights<f32x8<S>>,
    split: Weights<f32x8<S>>,
) -> Weights<f32x8<S>> {
    let is_split = (tau_front + tau_back).simd_gt(2.0 * TAU_MAX_F32);
    Weights {
        front: is_split.select(split.front, thin.front),
        back: is_split.select(split.back, thin.back),
        transmittance: is_split.select(split.transmittance, thin.transmittance),
    }
}

/// A sum that keeps what rounding takes off: dozens of equal parts would round the same way. Source: [Kahan 1965].
struct Sum<S: Simd> {
    value: f32x8<S>,
    lost: f32x8<S>,
}

impl<S: Simd> Sum<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        Self { value: f32x8::splat(simd, 0.0), lost: f32x8::splat(simd, 0.0) }
    }

    #[inline(always)]
    fn add(&mut self, term: f32x8<S>) {
        let term = term - self.lost;
        let next = self.value + term;
        self.lost = (next - self.value) - term;
        self.value = next;
    }
}

/// The stretch of each lane's segment that is followed.
struct Visible<S: Simd> {
    /// Of the whole segment.
    optical_depth: f32x8<S>,
    /// Length of the stretch as a share of the segment's.
    stretch: f32x8<S>,
    /// Whether the stretch is shorter than the segment.
    is_cut: <f32x8<S> as SimdBase<S>>::Mask,
    /// Extinction where the stretch begins, and its increase along it, times the stretch's length.
    first: f32x8<S>,
    increase: f32x8<S>,
    parts: u32,
}

/// The share of each segment at whose end the optical depth is [`VISIBLE_DEPTH`].
#[inline(always)]
fn visible_stretch<S: Simd>(simd: S, front: f32x8<S>, back: f32x8<S>) -> f32x8<S> {
    // Solves `front u + slope u² / 2 = depth` by the form of the quadratic formula that does not cancel, everything
    // divided by the larger end so that no square overflows.
    let larger = front.max(back).max(1.0);
    let [front, slope, depth] = [front / larger, (back - front) / larger, f32x8::splat(simd, VISIBLE_DEPTH) / larger];
    let discriminant = (2.0 * slope).mul_add(depth, front * front).max(0.0);
    (2.0 * depth) / (front + discriminant.sqrt())
}

impl<S: Simd> Visible<S> {
    #[inline(always)]
    fn new(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Self {
        // Infinity becomes a number whose weights differ from its own by less than the smallest normal number.
        let limit = f32x8::splat(simd, 0.25 * f32::MAX);
        let (front, back) = (tau_front.min(limit), tau_back.min(limit));
        let slope = back - front;
        let optical_depth = 0.5 * front + 0.5 * back;
        let is_deep = optical_depth.simd_gt(VISIBLE_DEPTH);
        let whole = f32x8::splat(simd, 1.0);
        let stretch = if is_deep.any_true() { visible_stretch(simd, front, back) } else { whole };
        let is_cut = is_deep & stretch.simd_lt(whole);
        let stretch = is_cut.select(stretch, whole);

        let first = front * stretch;
        let increase = slope * stretch * stretch;
        let last = first + increase;
        let (small, large) = (first.min(last), first.max(last));
        let mut parts = 2;
        // The deepest part is the one at the denser end.
        while parts < MOST_PARTS {
            let share = 1.0 / parts as f32;
            if !(share * (large - (0.5 * share) * (large - small))).simd_gt(TAU_MAX_F32).any_true() {
                break;
            }
            parts *= 2;
        }
        Self { optical_depth, stretch, is_cut, first, increase, parts }
    }

    /// Calls with the optical depths of each part's ends, the transmittance up to it, its position in the stretch and
    /// its share of it.
    #[inline(always)]
    fn for_each_part(&self, simd: S, mut part: impl FnMut(f32x8<S>, f32x8<S>, f32x8<S>, f32, f32)) {
        let share = 1.0 / self.parts as f32;
        let (first, increase) = (self.first * share, self.increase * (share * share));
        let mut start = first;
        for number in 0..self.parts {
            let end = increase.mul_add((number + 1) as f32, first).max(0.0);
            let position = number as f32 * share;
            // From the depth, not from the part before: a product would add up the rounding of numbers next to 1, and
            // each part would wait for the one before.
            let depth = (0.5 * position * self.increase + self.first) * position;
            part(start, end, exp_negative(simd, depth.max(0.0)), position, share);
            start = end;
        }
    }
}
