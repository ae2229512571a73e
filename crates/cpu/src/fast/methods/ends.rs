//! The mean of both ends.

use fearless_simd::Simd;

use super::{CellOptics, Method, transfer_at};
use crate::fast::model::Model;
use crate::fast::sample::{Light, Sample};

/// Exact opacity of a linear extinction, mean of the end colors: `opacity-2d` ([Röttger 2000], section 2, on [Stein 1994]).
///
/// Where only opacity or only emission counts, `partial` is the same.
pub(crate) struct Ends;

impl Method for Ends {
    const NEEDS_PIECES: bool = true;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        let (extinction, [r, g, b]) = transfer_at(simd, cell.pieces, sample.covered, sample.front);
        let (extinction_back, [r_back, g_back, b_back]) = transfer_at(simd, cell.pieces, sample.covered, sample.back);
        let color = [(r + r_back) * 0.5, (g + g_back) * 0.5, (b + b_back) * 0.5];
        M::constant(simd, (extinction + extinction_back) * 0.5, color, sample.length)
    }
}
