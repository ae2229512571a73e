//! What a renderer needs per ray, for eight rays at once in 32 bits: weights, opacities, look-ups in tables and maps, light.
//!
//! The functions are generic over the processor's level and meant to be inlined into a loop that
//! [`fearless_simd::dispatch!`] compiles for each. Optical depths are not negative, infinity included; an unused lane is best
//! given zeros, since the thickest lane decides the path. What a NaN gives is not said, but it stays in its lane. Look-ups are
//! methods of their tables: [`crate::Table3d::look_up_lanes`] and its like.
//!
//! # Errors
//!
//! Measured against the 64-bit forms over optical depths from 1e-12 to 1e6 and all ratios of the ends, with fused
//! multiplication and without:
//!
//! | function | relative to | promised | measured, fused | without |
//! | --- | --- | --- | --- | --- |
//! | [`exp_negative`] | itself | 2 ulp | 1.2 ulp | 1.2 ulp |
//! | [`opacity_transmittance`] | the opacity | 3e-7 | 1.1e-7 | 1.3e-7 |
//! | [`density_emitter_weights`] | the opacity | 3e-7 | 1.3e-7 | 1.3e-7 |
//! | [`emitter_weights`] | their sum | 3e-7 | 2.4e-7 | 2.4e-7 |
//! | [`partial_weights`] | the opacity | 6e-4 | 5.0e-4 | 5.0e-4 |
//! | [`cumulative`], against 64 bits | the opacity, the length | 4e-6 | 7.4e-7 | 7.4e-7 |
//!
//! Transmittances of the weights are good to 3e-7 of 1, and from an optical depth of 1 on to a few units in the last
//! place. A lane with an optical depth up to 1 gives the same bits whatever its neighbors hold.
//!
//! Results below the smallest normal number may be 0.

pub mod cumulative;
mod exponential;
mod maps;
mod partial;
mod phong;
mod split;
mod table;
mod thin;

#[cfg(test)]
mod surface_tests;
#[cfg(test)]
mod tests;

pub use exponential::{exp_negative, opacity_transmittance};
pub use partial::partial_weights;
pub use phong::phong;
pub use table::TableLight;

use fearless_simd::{Simd, f32x8, prelude::*};

use crate::series::TAU_MAX_F32;
use crate::weights::Weights;

/// [`crate::weights::weights_f32`] in eight lanes: what the colors at the front and at the back are multiplied by in
/// the density emitter model.
///
/// By the series where all lanes have an optical depth up to 1, the case in nearly all cells of a fine mesh; else the
/// segments are split into up to 32 parts that do, as many as the thickest lane needs.
#[inline(always)]
pub fn density_emitter_weights<S: Simd>(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Weights<f32x8<S>> {
    if (tau_front + tau_back).simd_gt(2.0 * TAU_MAX_F32).any_true() {
        split::density_emitter(simd, tau_front, tau_back)
    } else {
        thin::density_emitter(simd, tau_front, tau_back)
    }
}

/// [`crate::weights::emitter_weights_f32`] in eight lanes: what the emissions at the front and at the back, times the
/// length, are multiplied by in the emitter model.
#[inline(always)]
pub fn emitter_weights<S: Simd>(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Weights<f32x8<S>> {
    if (tau_front + tau_back).simd_gt(2.0 * TAU_MAX_F32).any_true() {
        split::emitter(simd, tau_front, tau_back)
    } else {
        thin::emitter(simd, tau_front, tau_back)
    }
}
