//! From a block's segments to light: the integration methods on eight lanes.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::cell::LocalPiece;
use super::fan::Fan;
use super::model::{Model, at};
use super::sample::{Light, Sample};

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
