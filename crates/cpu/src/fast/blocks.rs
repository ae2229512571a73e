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
    /// A cell to be drawn in f64.
    careful: Option<&'a CarefulCell>,
    interpolated: Option<Interpolated<'a>>,
    range: BlockRange,
    space: &'a PixelSpace,
    count: usize,
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
        let careful = (record.entry_count == 0).then(|| &records.careful[record.careful as usize]);
        let count = if careful.is_some() {
            (range.rows * range.columns) as usize
        } else {
            covers.find(simd, record, range);
            covers.len()
        };
        Self { record, careful, interpolated, range, space, count }
    }

    /// How many there are to be visited.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// A block's number and sample; `None` for one that the cell does not cover after all.
    #[inline(always)]
    pub(crate) fn get<S: Simd>(&self, simd: S, covers: &CoverList, index: usize) -> Option<(usize, Sample<S>)> {
        match self.careful {
            Some(careful) => sample_carefully(simd, careful, self.record, self.space, self.range, index as u32),
            None => {
                let (block, sample) = covers.get(simd, index, self.record, self.space);
                match self.interpolated {
                    None => Some((block, sample)),
                    Some(interpolated) => Some((block, interpolated.apply(simd, self.record, sample))),
                }
            }
        }
    }
}

/// The number and the sample of a cell's block that is drawn in f64, out of line: few are.
#[inline(never)]
fn sample_carefully<S: Simd>(
    simd: S,
    cell: &CarefulCell,
    record: &CellRecord,
    space: &PixelSpace,
    range: BlockRange,
    index: u32,
) -> Option<(usize, Sample<S>)> {
    simd.vectorize(
        #[inline(always)]
        || {
            let (column, row) = (index % range.columns, index / range.columns);
            let place = [range.pixel[0] + column * BLOCK_WIDTH, range.pixel[1] + row * BLOCK_HEIGHT];
            let sample = careful_sample(simd, cell, record, space, place)?;
            Some(((range.first + row * range.stride + column) as usize, sample))
        },
    )
}
