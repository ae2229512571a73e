//! How much the two ends of a segment count, for an extinction and a color that are linear along it.
//!
//! Let `a` and `b` be the extinction at the front and at the back, times the length: the *optical depths of the ends*.
//! With `T(u) = exp(-(a u + (b - a) u² / 2))`, the transmittance of the share `u` of the segment next to the eye,
//!
//! ```text
//! psi  = ∫ T du        psi1 = ∫ u T du        zeta = T(1) = exp(-(a + b) / 2)        alpha = 1 - zeta
//! density emitter:   front = 1 - psi       back = psi - zeta      front + back = alpha
//! emitter:           front = psi - psi1    back = psi1            front + back = psi
//! ```
//!
//! Sources: [Williams 1998] for the closed forms, here with the scaled error function and Dawson's
//! integral so that nothing overflows; [Moreland 2004] for `psi` as the one function that both weights of the
//! density emitter need. Derivation of the series for thin segments: [`series`].
//!
//! # Which form where
//!
//! | `(a + b) / 2` | f64 | f32 |
//! | --- | --- | --- |
//! | up to 1 | series | series |
//! | above | closed form | closed form in f64, rounded |
//!
//! The switch is on the optical depth, which is free of scales, and never on `b - a`: the series needs no division by
//! it, and the closed form keeps its digits down to the last bit of difference.
//!
//! # Errors
//!
//! Measured in the tests over optical depths from 1e-12 to 1e6 and all ratios of the ends, as the largest error of a
//! weight divided by the sum of both (`alpha` or `psi`):
//!
//! | function | promised | measured |
//! | --- | --- | --- |
//! | [`weights_f64`] | 1e-12 | 1.4e-16 against 150 digits, 1.5e-14 against quadrature |
//! | [`emitter_weights_f64`] | 1e-12 | 3.2e-16 against 150 digits, 1.5e-14 against quadrature |
//! | [`weights_f32`] | 3e-7 | 1.2e-7 |
//! | [`emitter_weights_f32`] | 3e-7 | 8.9e-8 |
//!
//! Weights are never negative, and those of the density emitter never exceed 1. Infinite optical depth gives opacity 1
//! with all weight on the front.

use crate::series;
use crate::special::{Scaled, dawson, erfcx};

#[cfg(test)]
#[path = "weights_tests.rs"]
pub(crate) mod tests;

/// What the values at the two ends of a segment are multiplied by, and what is let through from behind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weights<T> {
    /// Weight of the value at the front; dimensionless, 0 to 1.
    pub front: T,
    /// Weight of the value at the back; dimensionless, 0 to 1.
    pub back: T,
    /// Share of the light from behind that passes, 0 to 1.
    pub transmittance: T,
}

/// Density emitter: the color of a segment is `front * color_front + back * color_back`, with `front + back` its
/// opacity.
///
/// `tau_front`, `tau_back`: extinction at the ends times the length; not negative, infinity allowed. Error below 1e-12
/// of the opacity. NaN gives NaN.
pub fn weights_f64(tau_front: f64, tau_back: f64) -> Weights<f64> {
    let tau = 0.5 * tau_front + 0.5 * tau_back;
    if tau <= series::TAU_MAX_F64 {
        return series::density_emitter_f64(tau_front, tau_back);
    }
    if !tau.is_finite() {
        return without_depth(tau, 1.0);
    }
    let Moments { psi, transmittance, .. } = moments(tau_front, tau_back);
    Weights { front: 1.0 - psi, back: psi - transmittance, transmittance }
}

/// [`weights_f64`] in 32 bits: error below 3e-7 of the opacity.
pub fn weights_f32(tau_front: f32, tau_back: f32) -> Weights<f32> {
    if 0.5 * tau_front + 0.5 * tau_back <= series::TAU_MAX_F32 {
        return series::density_emitter_f32(tau_front, tau_back);
    }
    rounded(weights_f64(f64::from(tau_front), f64::from(tau_back)))
}

/// Emitter: the color of a segment is `length * (front * emission_front + back * emission_back)`.
///
/// `tau_front`, `tau_back` as in [`weights_f64`]. Both weights are 1/2 where nothing is absorbed, and go to 0 with a
/// growing optical depth. Error below 1e-12 of their sum. NaN gives NaN.
pub fn emitter_weights_f64(tau_front: f64, tau_back: f64) -> Weights<f64> {
    let tau = 0.5 * tau_front + 0.5 * tau_back;
    if tau <= series::TAU_MAX_F64 {
        return series::emitter_f64(tau_front, tau_back);
    }
    if !tau.is_finite() {
        return without_depth(tau, 0.0);
    }
    let Moments { psi, psi1, transmittance } = moments(tau_front, tau_back);
    Weights { front: psi - psi1, back: psi1, transmittance }
}

/// [`emitter_weights_f64`] in 32 bits: error below 3e-7 of the sum of the weights.
pub fn emitter_weights_f32(tau_front: f32, tau_back: f32) -> Weights<f32> {
    if 0.5 * tau_front + 0.5 * tau_back <= series::TAU_MAX_F32 {
        return series::emitter_f32(tau_front, tau_back);
    }
    rounded(emitter_weights_f64(f64::from(tau_front), f64::from(tau_back)))
}

/// What infinite depth leaves of the front; NaN throughout if the depth is NaN.
fn without_depth(tau: f64, front: f64) -> Weights<f64> {
    if tau.is_nan() {
        Weights { front: tau, back: tau, transmittance: tau }
    } else {
        Weights { front, back: 0.0, transmittance: 0.0 }
    }
}

fn rounded(weights: Weights<f64>) -> Weights<f32> {
    Weights { front: weights.front as f32, back: weights.back as f32, transmittance: weights.transmittance as f32 }
}

/// Integral and first moment of the transmittance along a segment, and its value at the end.
struct Moments {
    psi: f64,
    psi1: f64,
    transmittance: f64,
}

/// Closed forms, for finite optical depths above the range of the series (below it they cancel).
fn moments(a: f64, b: f64) -> Moments {
    let transmittance = (-(0.5 * a + 0.5 * b)).exp();
    let slope = b - a;
    if slope == 0.0 {
        let psi = -(-a).exp_m1() / a;
        return Moments { psi, psi1: (psi - transmittance) / a, transmittance };
    }
    // `a = r front`, `b = r back`, and `front² - back²` is the optical depth up to its sign: that turns the exponential
    // before the second error function into the transmittance, which cannot overflow.
    let r = core::f64::consts::SQRT_2 * slope.abs().sqrt();
    let (front, back) = (a / r, b / r);
    let (at_front, at_back, scale, step): (Scaled, Scaled, f64, f64) = if slope > 0.0 {
        const SQRT_PI: f64 = 1.772_453_850_905_516;
        (erfcx(front), erfcx(back), SQRT_PI, -0.5 * SQRT_PI * r)
    } else {
        (dawson(front), dawson(back), 2.0, r)
    };
    let mut psi = at_front.value;
    // `a psi + slope psi1 = alpha`, with `1 - a psi` written by what is left of the functions beside their asymptotes:
    // `alpha - a psi` itself is a small difference of large numbers.
    let mut alpha_minus_a_psi = at_front.rest;
    if transmittance > 0.0 {
        psi -= transmittance * at_back.value;
        alpha_minus_a_psi += transmittance * (step * at_back.value - at_back.rest);
    }
    psi = (psi * (scale / r)).clamp(transmittance, 1.0);
    Moments { psi, psi1: (alpha_minus_a_psi / slope).clamp(0.0, 0.5 * psi), transmittance }
}
