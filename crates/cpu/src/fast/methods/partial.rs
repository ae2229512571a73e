//! Both ends weighted by the psi table.

use fearless_simd::{Simd, prelude::*};
use tetrascope_integrate::lanes::partial_weights;

use super::{CellOptics, Method, transfer_at};
use crate::fast::model::Model;
use crate::fast::sample::{Light, Sample};

/// Extinction and color linear between the values at both ends, by the psi table: density emitter only
/// ([Marroquim 2008], section 4.4, on [Moreland 2004]).
pub(crate) struct Partial;

impl Method for Partial {
    const NEEDS_PIECES: bool = true;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        let (extinction, front) = transfer_at(simd, cell.pieces, sample.covered, sample.front);
        let (extinction_back, back) = transfer_at(simd, cell.pieces, sample.covered, sample.back);
        let weights = partial_weights(simd, extinction * sample.length, extinction_back * sample.length);
        let mut rgb = front;
        for (channel, back) in rgb.iter_mut().zip(back) {
            *channel = weights.front.mul_add(*channel, weights.back * back);
        }
        Light { rgb, opacity: (weights.front + weights.back).min(1.0) }
    }
}
