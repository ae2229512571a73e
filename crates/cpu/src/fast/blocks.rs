//! The blocks of a tile that a cell covers, one after the other, whichever way the cell is drawn.

use fearless_simd::Simd;

use super::careful::careful_sample;
use super::cell::CarefulCell;
use super::cover::{BlockRange, CoverList};
use super::interpolation::Interpolated;
use super::record::{CellRecord, Listed};
use super::sample::{BLOCK_HEIGHT, BLOCK_WIDTH, Sample};
use crate::geometry::PixelSpace;

/// The blocks that a cell covers, for those who visit them.
#[derive(Clone, Copy)]
pub(crate) struct Blocks<'a> {
    record: &'a CellRecord,
    /// What is done for cells whose samples are not as planes in f32 have them. One condition for all of them, so that the loop over
    /// the blocks of all others has none.
    apart: Option<Apart<'a>>,
    range: BlockRange,
    space: &'a PixelSpace,
    count: usize,
}

/// Another way to samples.
#[derive(Clone, Copy)]
enum Apart<'a> {
    /// A cell to be drawn in f64.
    Careful(&'a CarefulCell),
    Interpolated(Interpolated<'a>),
}

impl<'a> Blocks<'a> {
    /// Those of a record within `range`; `covers` is filled for [`Self::get`].
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        simd: S,
        listed: Listed<'a>,
        range: BlockRange,
        space: &'a PixelSpace,
        covers: &mut CoverList,
    ) -> Self {
        let Listed { records, record, interpolated } = listed;
        if record.entry_count == 0 {
            let apart = Some(Apart::Careful(&records.careful[record.careful as usize]));
            return Self { record, apart, range, space, count: (range.rows * range.columns) as usize };
        }
        covers.find(simd, record, range);
        Self { record, apart: interpolated.map(Apart::Interpolated), range, space, count: covers.len() }
    }

    /// How many there are to be visited.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// A block's number and sample; `None` for one that the cell does not cover after all.
    #[inline(always)]
    pub(crate) fn get<S: Simd>(&self, simd: S, covers: &CoverList, index: usize) -> Option<(usize, Sample<S>)> {
        match self.apart {
            Some(apart) => self.get_apart(simd, covers, apart, index),
            None => Some(covers.get(simd, index, self.record, self.space)),
        }
    }

    /// [`Self::get`] out of line, for what few ask for.
    #[inline(never)]
    fn get_apart<S: Simd>(
        self,
        simd: S,
        covers: &CoverList,
        apart: Apart<'_>,
        index: usize,
    ) -> Option<(usize, Sample<S>)> {
        let Self { record, range, space, .. } = self;
        simd.vectorize(
            #[inline(always)]
            || match apart {
                Apart::Careful(cell) => {
                    let (column, row) = (index as u32 % range.columns, index as u32 / range.columns);
                    let place = [range.pixel[0] + column * BLOCK_WIDTH, range.pixel[1] + row * BLOCK_HEIGHT];
                    let sample = careful_sample(simd, cell, record, space, place)?;
                    Some(((range.first + row * range.stride + column) as usize, sample))
                }
                Apart::Interpolated(interpolated) => {
                    let (block, sample) = covers.get(simd, index, record, space);
                    Some((block, interpolated.apply(simd, record, sample)))
                }
            },
        )
    }
}
