//! Cut at the control points, then closed form.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{CellOptics, Method, met};
use crate::fast::cell::LocalPiece;
use crate::fast::model::Model;
use crate::fast::sample::{Light, Sample};

/// Cut at the control points, then closed form.
pub(crate) struct Exact;

impl Method for Exact {
    const NEEDS_PIECES: bool = true;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        if let Some(sharp) = cell.sharp {
            return sharp.shade(simd, sample);
        }
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
    let mut light = Light { rgb: [zero; 3], opacity: zero };
    let last = pieces.len() - 1;
    for index in met(simd, pieces, sample.covered, low, high) {
        let piece = &pieces[index];
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
        let (through_light, through_next) = (one - light.opacity, one - next.opacity);
        for c in 0..3 {
            let behind = through_light.mul_add(next.rgb[c], light.rgb[c]);
            let before = through_next.mul_add(light.rgb[c], next.rgb[c]);
            light.rgb[c] = rises.select(behind, before);
        }
        light.opacity = light.opacity_with(&next);
    }
    light
}
