//! Running integrals over the scalar.

use fearless_simd::{Simd, f32x8, prelude::*};
use tetrascope_integrate::lanes::cumulative::{Part, Sums};

use super::{CellOptics, Method, met, value};
use crate::fast::cell::LocalPiece;
use crate::fast::model::Model;
use crate::fast::sample::{Light, Sample};

/// Exact opacity, and light with a correction for what the segment hides of itself:
/// [`tetrascope_integrate::RunningIntegrals`]. `PER_LENGTH` for the emitter model.
///
/// The integrals are run through piece by piece, since a cell meets few.
pub(crate) struct Cumulative<const PER_LENGTH: bool>;

impl<const PER_LENGTH: bool> Method for Cumulative<PER_LENGTH> {
    const NEEDS_PIECES: bool = true;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        if let Some(sharp) = cell.sharp {
            return sharp.shade(simd, sample);
        }
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let rises = sample.front.simd_le(sample.back);
        let low = sample.front.min(sample.back);
        let high = sample.front.max(sample.back);
        let mut sums = Sums::<S, PER_LENGTH>::new(simd);
        if let [piece] = cell.pieces {
            sums.add(simd, &part(simd, piece, low, high, sample.length));
        } else {
            let is_flat = high.simd_le(low);
            let inverse = one / is_flat.select(one, high - low);
            let last = cell.pieces.len() - 1;
            for index in met(simd, cell.pieces, sample.covered, low, high) {
                let piece = &cell.pieces[index];
                let (start, end) = (f32x8::splat(simd, piece.start), f32x8::splat(simd, piece.end));
                let from = low.max(start).min(end);
                let to = high.max(start).min(end);
                // As in `exact`: a flat segment lies in one piece as a whole.
                let reaches = if index == last { high.simd_ge(start) } else { high.simd_ge(start) & high.simd_lt(end) };
                let reaches = if index == 0 { reaches | high.simd_lt(start) } else { reaches };
                let share = is_flat.select(reaches.select(one, zero), (to - from) * inverse);
                let length = sample.length * share;
                if length.simd_gt(zero).any_true() {
                    sums.add(simd, &part(simd, piece, from, to, length));
                }
            }
        }
        let (rgb, opacity) = sums.finish(simd, rises);
        Light { rgb, opacity }
    }
}

/// The part of a segment between two scalars of a piece.
#[inline(always)]
fn part<S: Simd>(simd: S, piece: &LocalPiece, from: f32x8<S>, to: f32x8<S>, length: f32x8<S>) -> Part<S> {
    let (extinction_from, color_from) = value(simd, piece, from);
    let (extinction_to, color_to) = value(simd, piece, to);
    Part { extinction: [extinction_from, extinction_to], color: [color_from, color_to], length }
}
