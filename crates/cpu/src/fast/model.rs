//! The optical models on eight lanes.

use fearless_simd::{Simd, f32x8, prelude::*};
use tetrascope_integrate::lanes::{density_emitter_weights, emitter_weights, opacity_transmittance};

use super::cell::LocalPiece;
use super::sample::Light;

/// An optical model on a segment over which extinction and color are linear.
pub(crate) trait Model {
    /// Whether light is added.
    const EMITS: bool;
    /// Whether light is taken away.
    const ABSORBS: bool;

    /// Exact: extinction and color are linear from `front` to `back`.
    fn linear<S: Simd>(simd: S, piece: &LocalPiece, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> Light<S>;

    /// The same everywhere on the segment.
    fn constant<S: Simd>(simd: S, extinction: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S>;
}

/// `dI/dt = rho (kappa - I)`.
pub(crate) struct DensityEmitter;
/// `dI/dt = kappa - rho I`.
pub(crate) struct Emitter;
/// `dI/dt = -rho I`.
pub(crate) struct Absorption;
/// `dI/dt = kappa`.
pub(crate) struct Emission;

/// `value` at its start plus slope times distance; not below zero, where rounding may put it.
#[inline(always)]
pub(crate) fn at<S: Simd>(simd: S, [value, slope]: [f32; 2], distance: f32x8<S>) -> f32x8<S> {
    f32x8::splat(simd, slope).mul_add(distance, f32x8::splat(simd, value)).max(0.0)
}

/// Sum of weights times a color that is linear over the piece: `front_weight color(front) + back_weight color(back)`.
#[inline(always)]
fn mix<S: Simd>(
    simd: S,
    piece: &LocalPiece,
    [front, back]: [f32x8<S>; 2],
    [front_weight, back_weight]: [f32x8<S>; 2],
) -> [f32x8<S>; 3] {
    // The color is a + b s, so that two sums serve all three channels.
    let sum = front_weight + back_weight;
    let moment = front_weight.mul_add(front, back_weight * back);
    // Loops and functions, not closures: those may stay calls, compiled without the vector instructions.
    let mut rgb = [sum; 3];
    let [start, slope] = &piece.color;
    for ((channel, start), slope) in rgb.iter_mut().zip(start).zip(slope) {
        *channel = f32x8::splat(simd, *slope).mul_add(moment, sum * *start).max(0.0);
    }
    rgb
}

/// Optical depths that a segment would have with the extinction of its front, and of its back, all along.
#[inline(always)]
fn end_depths<S: Simd>(simd: S, piece: &LocalPiece, [front, back]: [f32x8<S>; 2], length: f32x8<S>) -> [f32x8<S>; 2] {
    [at(simd, piece.extinction, front) * length, at(simd, piece.extinction, back) * length]
}

/// All three channels times one number.
#[inline(always)]
fn times<S: Simd>([r, g, b]: [f32x8<S>; 3], factor: f32x8<S>) -> [f32x8<S>; 3] {
    [r * factor, g * factor, b * factor]
}

impl Model for DensityEmitter {
    const EMITS: bool = true;
    const ABSORBS: bool = true;

    #[inline(always)]
    fn linear<S: Simd>(simd: S, piece: &LocalPiece, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> Light<S> {
        let [tau_front, tau_back] = end_depths(simd, piece, [front, back], length);
        let weights = density_emitter_weights(simd, tau_front, tau_back);
        let rgb = mix(simd, piece, [front, back], [weights.front, weights.back]);
        // Rounding may put the sum above one.
        Light { rgb, opacity: (weights.front + weights.back).min(1.0) }
    }

    #[inline(always)]
    fn constant<S: Simd>(simd: S, extinction: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        let (opacity, _) = opacity_transmittance(simd, extinction * length);
        Light { rgb: times(color, opacity), opacity }
    }
}

impl Model for Emitter {
    const EMITS: bool = true;
    const ABSORBS: bool = true;

    #[inline(always)]
    fn linear<S: Simd>(simd: S, piece: &LocalPiece, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> Light<S> {
        let [tau_front, tau_back] = end_depths(simd, piece, [front, back], length);
        let weights = emitter_weights(simd, tau_front, tau_back);
        let rgb = mix(simd, piece, [front, back], [weights.front * length, weights.back * length]);
        let (opacity, _) = opacity_transmittance(simd, (tau_front + tau_back) * 0.5);
        Light { rgb, opacity }
    }

    #[inline(always)]
    fn constant<S: Simd>(simd: S, extinction: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        let tau = extinction * length;
        let weights = emitter_weights(simd, tau, tau);
        let weight = (weights.front + weights.back) * length;
        Light { rgb: times(color, weight), opacity: opacity_transmittance(simd, tau).0 }
    }
}

impl Model for Absorption {
    const EMITS: bool = false;
    const ABSORBS: bool = true;

    #[inline(always)]
    fn linear<S: Simd>(simd: S, piece: &LocalPiece, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> Light<S> {
        let mean = (at(simd, piece.extinction, front) + at(simd, piece.extinction, back)) * 0.5;
        Self::constant(simd, mean, [f32x8::splat(simd, 0.0); 3], length)
    }

    #[inline(always)]
    fn constant<S: Simd>(simd: S, extinction: f32x8<S>, _: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        // Zeros and not the color: with isosurfaces, light is added in every model.
        let rgb = [f32x8::splat(simd, 0.0); 3];
        Light { rgb, opacity: opacity_transmittance(simd, extinction * length).0 }
    }
}

impl Model for Emission {
    const EMITS: bool = true;
    const ABSORBS: bool = false;

    #[inline(always)]
    fn linear<S: Simd>(simd: S, piece: &LocalPiece, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> Light<S> {
        let half = length * 0.5;
        Light { rgb: mix(simd, piece, [front, back], [half, half]), opacity: f32x8::splat(simd, 0.0) }
    }

    #[inline(always)]
    fn constant<S: Simd>(simd: S, _: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        Light { rgb: times(color, length), opacity: f32x8::splat(simd, 0.0) }
    }
}
