//! The transfer function at the mean scalar.

use fearless_simd::Simd;

use super::{CellOptics, Method, transfer_at};
use crate::fast::model::Model;
use crate::fast::sample::{Light, Sample};

/// The transfer function at the mean of the two scalars ([Marroquim 2006], section 2 and eq. (1)).
pub(crate) struct Average;

impl Method for Average {
    const NEEDS_PIECES: bool = true;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        let (extinction, color) = transfer_at(simd, cell.pieces, sample.covered, (sample.front + sample.back) * 0.5);
        M::constant(simd, extinction, color, sample.length)
    }
}
