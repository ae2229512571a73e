//! Transmittance and opacity of any optical depth.

use core::f32::consts::LOG2_E;

use fearless_simd::{Simd, f32x8, prelude::*, u32x8};

use crate::series::{EXP_M1_F32, EXP_TERMS};

/// `exp(-x)` for `x` from 0 to infinity. Relative error up to 2 units in the last place; 0 beyond 87.7, where the result
/// has no normal number.
#[inline(always)]
pub fn exp_negative<S: Simd>(simd: S, x: f32x8<S>) -> f32x8<S> {
    let Scaled { scale, excess } = scaled(simd, x);
    excess.mul_add(scale, scale)
}

/// `(1 - exp(-tau), exp(-tau))` from one exponential. The opacity is good relative to itself however thin the segment.
#[inline(always)]
pub fn opacity_transmittance<S: Simd>(simd: S, tau: f32x8<S>) -> (f32x8<S>, f32x8<S>) {
    let Scaled { scale, excess } = scaled(simd, tau);
    // Up to half a power of two `scale` is 1, and the opacity is minus the excess with all its digits.
    let opacity = (-excess).mul_add(scale, 1.0 - scale);
    (opacity, excess.mul_add(scale, scale))
}

/// `exp(-x) = scale (1 + excess)`, where `scale` is a power of two and the excess between -0.3 and 0.42.
struct Scaled<S: Simd> {
    scale: f32x8<S>,
    excess: f32x8<S>,
}

#[inline(always)]
fn scaled<S: Simd>(simd: S, x: f32x8<S>) -> Scaled<S> {
    /// From here on the power of two is the one whose bits are all zero, the number 0.
    const LARGEST: f32 = 88.0;
    /// The bias of exponents, plus a number so large that its last bit counts ones: adding it rounds to an integer, and
    /// leaves the biased exponent in the low bits. The high bits go when those are shifted to their place.
    const SHIFT: f32 = 12_582_912.0 + 127.0;
    /// ln 2 in two parts. The first has 9 bits, so that its product with an exponent is exact.
    const LN_2_HIGH: f32 = 355.0 / 512.0;
    #[expect(clippy::cast_possible_truncation, reason = "32 bits are the purpose")]
    const LN_2_LOW: f32 = (core::f64::consts::LN_2 - 355.0 / 512.0) as f32;

    let x = x.min(LARGEST);
    let shifted = x.mul_add(-LOG2_E, SHIFT);
    let scale = (shifted.bitcast::<u32x8<S>>() << 23).bitcast::<f32x8<S>>();
    let exponent = shifted - SHIFT;
    let rest = exponent.mul_add(-LN_2_LOW, exponent.mul_add(-LN_2_HIGH, -x));
    let mut sum = f32x8::splat(simd, EXP_M1_F32[EXP_TERMS - 1]);
    for &coefficient in EXP_M1_F32[..EXP_TERMS - 1].iter().rev() {
        sum = sum.mul_add(rest, coefficient);
    }
    Scaled { scale, excess: sum * rest }
}
