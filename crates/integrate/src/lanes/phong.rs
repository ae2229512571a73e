//! Phong's model in eight lanes.

use core::f32::consts::LN_2;

use fearless_simd::{Simd, f32x8, prelude::*, u32x8};

use super::exp_negative;
use crate::Phong;

/// [`Phong::intensities`] in eight lanes: `[body, highlight]`.
///
/// - `gradient`: of any length that a finite float can have; zero, infinite or not a number gives `ambient` alone
/// - `to_eye`, `to_light`: of length 1
///
/// The body is good to 1e-6 of `ambient + diffuse` (measured 1.8e-7), the highlight to 1e-6 of `specular` times `1 +
/// shininess` (4.1e-7): a sharp highlight magnifies the rounding of the directions. Below a shininess of 1 that holds
/// but for the highlight's edges, which are steep. Coefficients beyond 32 bits become the largest number.
#[inline(always)]
pub fn phong<S: Simd>(
    simd: S,
    phong: &Phong,
    gradient: [f32x8<S>; 3],
    to_eye: [f32x8<S>; 3],
    to_light: [f32x8<S>; 3],
) -> [f32x8<S>; 2] {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let (ambient, specular) = (f32x8::splat(simd, narrow(phong.ambient)), narrow(phong.specular));

    // As in 64 bits: the largest component becomes 1, so that no square overflows.
    let largest = gradient[0].abs().max(gradient[1].abs()).max(gradient[2].abs());
    let scaled = [gradient[0] / largest, gradient[1] / largest, gradient[2] / largest];
    let squared_length = dot(scaled, scaled);
    let length = squared_length.sqrt();
    let to_eye_cosine = dot(scaled, to_eye) / length;
    let to_light_cosine = dot(scaled, to_light) / length;
    let facing = to_eye_cosine.simd_lt(zero).select(-to_light_cosine, to_light_cosine);
    let is_lit = squared_length.simd_ge(one) & facing.simd_gt(zero);

    let body = is_lit.select(facing.mul_add(narrow(phong.diffuse), ambient), ambient);
    if specular == 0.0 || !is_lit.any_true() {
        return [body, zero];
    }
    let mirrored = (2.0 * facing * to_eye_cosine.abs() - dot(to_light, to_eye)).max(zero).min(one);
    [body, is_lit.select(power(simd, mirrored, narrow(phong.shininess)) * specular, zero)]
}

/// `base` to a power, for a base from 0 to 1 and an exponent from 0 to the largest float. Good to 3e-7 of 1 (measured
/// 8.3e-8); 0 to the power 0 is 1. Bases without a normal number count as 0.
#[inline(always)]
pub(super) fn power<S: Simd>(simd: S, base: f32x8<S>, exponent: f32) -> f32x8<S> {
    let normal = base.max(f32x8::splat(simd, f32::MIN_POSITIVE));
    let value = exp_negative(simd, minus_log(simd, normal) * exponent);
    let smallest = if exponent == 0.0 { 1.0 } else { 0.0 };
    base.simd_lt(f32x8::splat(simd, f32::MIN_POSITIVE)).select(f32x8::splat(simd, smallest), value)
}

/// `-ln x` for a normal number up to 1. Relative error a few units in the last place; 0 at 1.
///
/// `x = 2^k m` with `m` from `sqrt(1/2)` to `sqrt(2)`, and `ln m = 2 artanh s` with `s = (m - 1) / (m + 1)`, whose
/// series up to the ninth power leaves out 3e-9 of itself.
#[inline(always)]
fn minus_log<S: Simd>(simd: S, x: f32x8<S>) -> f32x8<S> {
    const SQRT_HALF: u32 = 0x3f35_04f3;
    const ONE: u32 = 0x3f80_0000;
    let shifted = x.bitcast::<u32x8<S>>() + (ONE - SQRT_HALF);
    let exponent: f32x8<S> = f32x8::float_from(shifted >> 23) - 127.0;
    let mantissa = ((shifted & 0x007f_ffff) + SQRT_HALF).bitcast::<f32x8<S>>();
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let square = s * s;
    let mut series = f32x8::splat(simd, 1.0 / 9.0);
    for coefficient in [1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0] {
        series = series.mul_add(square, coefficient);
    }
    // The small part last: near 1 it is all there is.
    let log = (2.0 * s).mul_add(series * square, 2.0 * s);
    -exponent.mul_add(LN_2, log)
}

#[inline(always)]
fn dot<S: Simd>(a: [f32x8<S>; 3], b: [f32x8<S>; 3]) -> f32x8<S> {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

#[expect(clippy::cast_possible_truncation, reason = "32 bits are the purpose")]
fn narrow(number: f64) -> f32 {
    number.min(f64::from(f32::MAX)) as f32
}
