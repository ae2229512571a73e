//! Which blocks a record's planes cover, and with which chords, in f32.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::record::CellRecord;
use super::sample::{BLOCK_HEIGHT, BLOCK_WIDTH, LANE_COLUMN, LANE_ROW, LANES, Sample};
use crate::geometry::PixelSpace;

/// Blocks of a tile that a cell may cover: a rectangle of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockRange {
    /// Column and row of the first block's first pixel.
    pub(crate) pixel: [u32; 2],
    /// Number of the first block in the tile.
    pub(crate) first: u32,
    /// Blocks a row of the rectangle, and its rows.
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    /// Blocks a row of the tile.
    pub(crate) stride: u32,
}

/// Most blocks of a tile.
pub(crate) const MAX_BLOCKS: usize = 128;

/// The blocks that a cell covers, found before they are shaded.
///
/// About half of the blocks in a cell's rectangle are empty, and no predictor can tell which; a branch there would cost
/// more than the test. So the blocks are tested and listed without a branch, and the list is shaded without one.
pub(crate) struct CoverList {
    count: usize,
    items: Box<[Cover; MAX_BLOCKS]>,
}

/// One covered block.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Cover {
    entry: [f32; LANES],
    exit: [f32; LANES],
    /// Column and row of the first lane, counted from the record's reference pixel.
    place: [f32; 2],
    block: u32,
}

impl CoverList {
    pub(crate) fn new() -> Self {
        let nothing = Cover { entry: [0.0; LANES], exit: [0.0; LANES], place: [0.0; 2], block: 0 };
        Self { count: 0, items: Box::new([nothing; MAX_BLOCKS]) }
    }

    /// Lists the blocks that a record's planes cover.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(&mut self, simd: S, record: &CellRecord, range: BlockRange) {
        match record.entry_count {
            1 => self.find_with::<S, 1>(simd, record, range),
            2 => self.find_with::<S, 2>(simd, record, range),
            _ => self.find_with::<S, 3>(simd, record, range),
        }
    }

    #[inline(always)]
    fn find_with<S: Simd, const ENTRIES: usize>(&mut self, simd: S, record: &CellRecord, range: BlockRange) {
        let lane_columns = f32x8::from_slice(simd, &LANE_COLUMN);
        let lane_rows = f32x8::from_slice(simd, &LANE_ROW);
        let [nearest, farthest] = [record.nearness_range[1], record.nearness_range[0]].map(|n| f32x8::splat(simd, n));
        let x = range.pixel[0] as i32 - i32::from(record.pixel[0]);
        let y = range.pixel[1] as i32 - i32::from(record.pixel[1]);
        let (mut column, mut row) = (0, 0);
        self.count = 0;
        for _ in 0..range.columns * range.rows {
            let place = [(x + (column * BLOCK_WIDTH) as i32) as f32, (y + (row * BLOCK_HEIGHT) as i32) as f32];
            let (columns, rows) = (lane_columns + place[0], lane_rows + place[1]);
            let p = over(simd, &record.planes[0], columns, rows);
            let q = over(simd, &record.planes[1], columns, rows);
            let r = over(simd, &record.planes[2], columns, rows);
            let s = over(simd, &record.planes[3], columns, rows);
            let (entry, exit) = match ENTRIES {
                1 => (p, q.max(r).max(s)),
                2 => (p.min(q), r.max(s)),
                _ => (p.min(q).min(r), s),
            };
            let (entry, exit) = (entry.min(nearest), exit.max(farthest));
            // Written in any case; the next one overwrites it unless it counts.
            let item = &mut self.items[self.count & (MAX_BLOCKS - 1)];
            entry.store_slice(&mut item.entry);
            exit.store_slice(&mut item.exit);
            item.place = place;
            item.block = range.first + row * range.stride + column;
            self.count += usize::from(entry.simd_gt(exit).any_true());
            column += 1;
            let wraps = u32::from(column == range.columns);
            row += wraps;
            column *= 1 - wraps;
        }
    }

    /// Number of listed blocks.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.count.min(MAX_BLOCKS)
    }

    /// A listed block's number and sample.
    #[inline(always)]
    pub(crate) fn get<S: Simd>(
        &self,
        simd: S,
        index: usize,
        record: &CellRecord,
        space: &PixelSpace,
    ) -> (usize, Sample<S>) {
        let item = &self.items[index & (MAX_BLOCKS - 1)];
        (item.block as usize, item.sample(simd, record, space))
    }
}

/// A plane's values in the lanes.
#[inline(always)]
fn over<S: Simd>(simd: S, plane: &[f32; 3], columns: f32x8<S>, rows: f32x8<S>) -> f32x8<S> {
    let at_row = f32x8::splat(simd, plane[2]).mul_add(rows, f32x8::splat(simd, plane[0]));
    f32x8::splat(simd, plane[1]).mul_add(columns, at_row)
}

impl Cover {
    #[inline(always)]
    fn sample<S: Simd>(&self, simd: S, record: &CellRecord, space: &PixelSpace) -> Sample<S> {
        let columns = f32x8::from_slice(simd, &LANE_COLUMN) + self.place[0];
        let rows = f32x8::from_slice(simd, &LANE_ROW) + self.place[1];
        let (entry, exit) = (f32x8::from_slice(simd, &self.entry), f32x8::from_slice(simd, &self.exit));
        let covered = entry.simd_gt(exit);
        // Lanes outside get harmless numbers: no ray there comes near a zero denominator.
        let zero = f32x8::splat(simd, 0.0);
        let entry = covered.select(entry, zero);
        let exit = covered.select(exit, zero);
        let [per_column, per_row, slope] = record.scalar;
        let across = f32x8::splat(simd, per_column).mul_add(columns, f32x8::splat(simd, per_row) * rows);
        let slope = f32x8::splat(simd, -slope);
        let front = slope.mul_add(entry, across);
        let back = slope.mul_add(exit, across);
        let [low, high] = record.scalar_range;
        let nearness = entry - exit;
        let depth = f32x8::splat(simd, record.depth);
        let (front, back, length, depth) = if space.is_perspective {
            // One division serves both ends.
            let (at_entry, at_exit) = (entry + 1.0, exit + 1.0);
            let inverse = f32x8::splat(simd, 1.0) / (at_entry * at_exit);
            let [nearer, farther] = [inverse * at_exit, inverse * at_entry];
            // The reference's depth and what is to be added to it: from far away the sum would lose what tells cells apart.
            let from_eye = -(depth + space.start as f32);
            let depths = [(from_eye * entry).mul_add(nearer, depth), (from_eye * exit).mul_add(farther, depth)];
            (front * nearer, back * farther, nearness * inverse, depths)
        } else {
            (front, back, nearness, [depth - entry, depth - exit])
        };
        let (front, back) = (front.max(low).min(high), back.max(low).min(high));
        Sample { front, back, length, nearness, depth, place: [columns, rows], covered }
    }
}
