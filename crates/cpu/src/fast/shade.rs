//! From a block's segments to light: the integration methods on eight lanes.

use fearless_simd::{Simd, f32x8, prelude::*};
use tetrascope_integrate::lanes::{density_emitter_weights, emitter_weights, opacity_transmittance};

use super::fan::Fan;
use super::lanes::Sample;
use super::optics::LocalPiece;

/// What a cell sends to the eye in each lane, and how much it lets through.
#[derive(Clone, Copy)]
pub(crate) struct Light<S: Simd> {
    /// Linear, premultiplied.
    pub(crate) rgb: [f32x8<S>; 3],
    pub(crate) transmittance: f32x8<S>,
}

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
fn at<S: Simd>(simd: S, [value, slope]: [f32; 2], distance: f32x8<S>) -> f32x8<S> {
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
        let tau_front = at(simd, piece.extinction, front) * length;
        let tau_back = at(simd, piece.extinction, back) * length;
        let weights = density_emitter_weights(simd, tau_front, tau_back);
        let rgb = mix(simd, piece, [front, back], [weights.front, weights.back]);
        Light { rgb, transmittance: weights.transmittance }
    }

    #[inline(always)]
    fn constant<S: Simd>(simd: S, extinction: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        let (opacity, transmittance) = opacity_transmittance(simd, extinction * length);
        Light { rgb: times(color, opacity), transmittance }
    }
}

impl Model for Emitter {
    const EMITS: bool = true;
    const ABSORBS: bool = true;

    #[inline(always)]
    fn linear<S: Simd>(simd: S, piece: &LocalPiece, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> Light<S> {
        let tau_front = at(simd, piece.extinction, front) * length;
        let tau_back = at(simd, piece.extinction, back) * length;
        let weights = emitter_weights(simd, tau_front, tau_back);
        let rgb = mix(simd, piece, [front, back], [weights.front * length, weights.back * length]);
        Light { rgb, transmittance: weights.transmittance }
    }

    #[inline(always)]
    fn constant<S: Simd>(simd: S, extinction: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        let tau = extinction * length;
        let weights = emitter_weights(simd, tau, tau);
        let weight = (weights.front + weights.back) * length;
        Light { rgb: times(color, weight), transmittance: weights.transmittance }
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
    fn constant<S: Simd>(simd: S, extinction: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        Light { rgb: color, transmittance: opacity_transmittance(simd, extinction * length).1 }
    }
}

impl Model for Emission {
    const EMITS: bool = true;
    const ABSORBS: bool = false;

    #[inline(always)]
    fn linear<S: Simd>(simd: S, piece: &LocalPiece, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> Light<S> {
        let half = length * 0.5;
        Light { rgb: mix(simd, piece, [front, back], [half, half]), transmittance: f32x8::splat(simd, 1.0) }
    }

    #[inline(always)]
    fn constant<S: Simd>(simd: S, _: f32x8<S>, color: [f32x8<S>; 3], length: f32x8<S>) -> Light<S> {
        Light { rgb: times(color, length), transmittance: f32x8::splat(simd, 1.0) }
    }
}

/// What a method knows of a cell's optics.
#[derive(Clone, Copy)]
pub(crate) struct CellOptics<'a> {
    /// The pieces of the transfer function that the cell meets, ascending; at least one.
    pub(crate) pieces: &'a [LocalPiece],
    /// Its fan of triangles, where the method asks for fans; `None` if its outline has no area.
    pub(crate) fan: Option<&'a Fan>,
}

/// An integration method.
pub(crate) trait Method {
    /// Whether [`CellOptics::pieces`] is looked at.
    const NEEDS_PIECES: bool;

    /// The light of a block's segments through a cell.
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S>;
}

/// Cut at the control points, then closed form.
pub(crate) struct Exact;

impl Method for Exact {
    const NEEDS_PIECES: bool = true;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        if let [piece] = cell.pieces {
            let start = f32x8::splat(simd, piece.start);
            return M::linear(simd, piece, sample.front - start, sample.back - start, sample.length);
        }
        cut::<S, M>(simd, cell.pieces, sample)
    }
}

/// The pieces in ascending order; where the scalar falls along the ray, each one lies in front of those before.
#[inline(always)]
fn cut<S: Simd, M: Model>(simd: S, pieces: &[LocalPiece], sample: &Sample<S>) -> Light<S> {
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let rises = sample.front.simd_le(sample.back);
    let low = sample.front.min(sample.back);
    let high = sample.front.max(sample.back);
    let is_flat = high.simd_le(low);
    let inverse = one / is_flat.select(one, high - low);
    let mut light = Light { rgb: [zero; 3], transmittance: one };
    let last = pieces.len() - 1;
    for (index, piece) in pieces.iter().enumerate() {
        let (start, end) = (f32x8::splat(simd, piece.start), f32x8::splat(simd, piece.end));
        let from = low.max(start).min(end);
        let to = high.max(start).min(end);
        // A flat segment lies in one piece as a whole, in the upper one when it lies on a cut.
        let reaches = if index == last { high.simd_ge(start) } else { high.simd_ge(start) & high.simd_lt(end) };
        let reaches = if index == 0 { reaches | high.simd_lt(start) } else { reaches };
        let share = is_flat.select(reaches.select(one, zero), (to - from) * inverse);
        let length = sample.length * share;
        if !length.simd_gt(zero).any_true() {
            continue;
        }
        let (from, to) = (from - start, to - start);
        let next = M::linear(simd, piece, rises.select(from, to), rises.select(to, from), length);
        for c in 0..3 {
            let behind = light.transmittance.mul_add(next.rgb[c], light.rgb[c]);
            let before = next.transmittance.mul_add(light.rgb[c], next.rgb[c]);
            light.rgb[c] = rises.select(behind, before);
        }
        light.transmittance *= next.transmittance;
    }
    light
}

/// Extinction and color of a piece at a scalar.
#[inline(always)]
fn value<S: Simd>(simd: S, piece: &LocalPiece, scalar: f32x8<S>) -> (f32x8<S>, [f32x8<S>; 3]) {
    let distance = scalar - f32x8::splat(simd, piece.start);
    let [start, slope] = piece.color;
    let mut color = [distance; 3];
    for c in 0..3 {
        color[c] = at(simd, [start[c], slope[c]], distance);
    }
    (at(simd, piece.extinction, distance), color)
}

/// The transfer function at the mean of the two scalars ([Marroquim 2006], section 2 and eq. (1)).
pub(crate) struct Average;

impl Method for Average {
    const NEEDS_PIECES: bool = true;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        let mean = (sample.front + sample.back) * 0.5;
        let (mut extinction, mut color) = value(simd, &cell.pieces[0], mean);
        for piece in &cell.pieces[1..] {
            let is_here = mean.simd_ge(f32x8::splat(simd, piece.start));
            if is_here.any_true() {
                let (rho, kappa) = value(simd, piece, mean);
                extinction = is_here.select(rho, extinction);
                for c in 0..3 {
                    color[c] = is_here.select(kappa[c], color[c]);
                }
            }
        }
        M::constant(simd, extinction, color, sample.length)
    }
}

/// Color and opacity at the vertices, interpolated over the fan's triangles ([Shirley 1990], sections 2.5 and 2.6).
pub(crate) struct Vertex;

impl Method for Vertex {
    const NEEDS_PIECES: bool = false;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        match cell.fan {
            Some(fan) => fan.shade(simd, sample),
            None => Light { rgb: [f32x8::splat(simd, 0.0); 3], transmittance: f32x8::splat(simd, 1.0) },
        }
    }
}
