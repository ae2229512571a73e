//! The series for optical depths up to 1; formulas in [`crate::series`].

use fearless_simd::{Simd, f32x8, prelude::*};

use crate::series::{EXP_HALF_F32, EXP_TERMS, SERIES_F32, SERIES_F32_TERMS};
use crate::weights::Weights;

/// `g_K(y)`.
#[inline(always)]
fn row<S: Simd, const K: usize>(simd: S, y: f32x8<S>) -> f32x8<S> {
    let last = SERIES_F32_TERMS[K] - 1;
    let mut sum = f32x8::splat(simd, SERIES_F32[K][last]);
    for &coefficient in SERIES_F32[K][..last].iter().rev() {
        sum = sum.mul_add(y, coefficient);
    }
    sum
}

/// `g_0(y)`, `g_1(y)` and `P`. Rows are independent of each other, so their chains overlap.
#[inline(always)]
fn sums<S: Simd>(simd: S, y: f32x8<S>, z: f32x8<S>) -> [f32x8<S>; 3] {
    let [g0, g1] = [row::<S, 0>(simd, y), row::<S, 1>(simd, y)];
    // Powers of z in pairs: half as long a chain as one after the other.
    let z_squared = z * z;
    let low = row::<S, 3>(simd, y).mul_add(z, row::<S, 2>(simd, y));
    let high = row::<S, 5>(simd, y).mul_add(z, row::<S, 4>(simd, y));
    let high = row::<S, 6>(simd, y).mul_add(z_squared, high);
    let inner = high.mul_add(z_squared, low);
    [g0, g1, inner.mul_add(z, g1)]
}

/// `exp(-x)` for `x` from 0 to 1/2.
#[inline(always)]
fn exp_half<S: Simd>(simd: S, x: f32x8<S>) -> f32x8<S> {
    let t = x - 0.25;
    let mut sum = f32x8::splat(simd, EXP_HALF_F32[EXP_TERMS - 1]);
    for &coefficient in EXP_HALF_F32[..EXP_TERMS - 1].iter().rev() {
        sum = sum.mul_add(t, coefficient);
    }
    sum
}

#[inline(always)]
pub(super) fn density_emitter<S: Simd>(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Weights<f32x8<S>> {
    let (x, z) = (0.25 * (tau_front + tau_back), 0.25 * (tau_back - tau_front));
    let y = x * x;
    let [g0, g1, p] = sums(simd, y, z);
    let half = exp_half(simd, x);
    let mean = x * g0;
    let difference = y.mul_sub(g1, z * p);
    Weights { front: half * (mean + difference), back: half * (mean - difference), transmittance: half * half }
}

#[inline(always)]
pub(super) fn emitter<S: Simd>(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Weights<f32x8<S>> {
    let (x, z) = (0.25 * (tau_front + tau_back), 0.25 * (tau_back - tau_front));
    let [g0, _, p] = sums(simd, x * x, z);
    let half = exp_half(simd, x);
    let (mean, difference) = (z.mul_add(p, g0), x * p);
    let scale = 0.5 * half;
    Weights { front: scale * (mean + difference), back: scale * (mean - difference), transmittance: half * half }
}
