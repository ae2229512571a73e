//! Eight pixels at a time: four columns by two rows.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use super::record::{CarefulCell, CellRecord};
use crate::geometry::PixelSpace;

/// Pixels a block.
pub(crate) const LANES: usize = 8;
/// Columns of a block.
pub(crate) const BLOCK_WIDTH: u32 = 4;
/// Rows of a block.
pub(crate) const BLOCK_HEIGHT: u32 = 2;

/// Column and row of every lane within its block.
const LANE_COLUMN: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0];
const LANE_ROW: [f32; LANES] = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];

/// What the rays of a block have inside a cell.
///
/// In lanes that the cell does not cover, the length is 0 and the scalars are some numbers within the cell's range.
#[derive(Clone, Copy)]
pub(crate) struct Sample<S: Simd> {
    /// Scalar where the rays enter, relative to the cell's reference.
    pub(crate) front: f32x8<S>,
    /// Scalar where the rays leave, likewise.
    pub(crate) back: f32x8<S>,
    /// Chord length in the cell's unit, but for the stretch of the ray: multiply by that.
    pub(crate) length: f32x8<S>,
    /// Difference of nearness between the two ends, relative to the record's reference depth: what is linear on the screen.
    pub(crate) nearness: f32x8<S>,
    /// Columns and rows of the lanes, counted from the record's reference pixel.
    pub(crate) place: [f32x8<S>; 2],
    /// Which lanes the cell covers.
    pub(crate) covered: mask32x8<S>,
}

/// A record's planes, spread over the lanes, for one row of blocks.
pub(crate) struct PlaneRow<'a, S: Simd> {
    record: &'a CellRecord,
    /// Values at column offset 0.
    planes: [f32x8<S>; 4],
    scalar: f32x8<S>,
    row: f32x8<S>,
}

impl<'a, S: Simd> PlaneRow<'a, S> {
    /// The planes over the blocks whose upper row is `y`.
    #[inline(always)]
    pub(crate) fn new(simd: S, record: &'a CellRecord, y: u32) -> Self {
        let row = rows(simd, record, y);
        let at_row = |plane: &[f32; 3]| f32x8::splat(simd, plane[2]).mul_add(row, f32x8::splat(simd, plane[0]));
        let planes = [
            at_row(&record.planes[0]),
            at_row(&record.planes[1]),
            at_row(&record.planes[2]),
            at_row(&record.planes[3]),
        ];
        Self { record, planes, scalar: f32x8::splat(simd, record.scalar[1]) * row, row }
    }

    /// What the cell has in the block whose left column is `x`, or `None` if nothing.
    #[inline(always)]
    pub(crate) fn sample<const PERSPECTIVE: bool>(&self, simd: S, x: u32) -> Option<Sample<S>> {
        let record = self.record;
        let column = columns(simd, record, x);
        let plane = |m: usize| f32x8::splat(simd, record.planes[m][1]).mul_add(column, self.planes[m]);
        let (p, q, r, s) = (plane(0), plane(1), plane(2), plane(3));
        let (entry, exit) = match record.entry_count {
            1 => (p, q.max(r).max(s)),
            2 => (p.min(q), r.max(s)),
            _ => (p.min(q).min(r), s),
        };
        let entry = entry.min(record.nearness_range[1]);
        let exit = exit.max(record.nearness_range[0]);
        let covered = entry.simd_gt(exit);
        if !covered.any_true() {
            return None;
        }
        // Lanes outside get harmless numbers: no ray there comes near a zero denominator.
        let zero = f32x8::splat(simd, 0.0);
        let entry = covered.select(entry, zero);
        let exit = covered.select(exit, zero);
        let across = f32x8::splat(simd, record.scalar[0]).mul_add(column, self.scalar);
        let slope = f32x8::splat(simd, -record.scalar[2]);
        let front = slope.mul_add(entry, across);
        let back = slope.mul_add(exit, across);
        let [low, high] = record.scalar_range;
        let (front, back, length) = if PERSPECTIVE {
            // One division serves both ends.
            let (at_entry, at_exit) = (entry + 1.0, exit + 1.0);
            let inverse = f32x8::splat(simd, 1.0) / (at_entry * at_exit);
            (front * (inverse * at_exit), back * (inverse * at_entry), (entry - exit) * inverse)
        } else {
            (front, back, entry - exit)
        };
        let (front, back) = (front.max(low).min(high), back.max(low).min(high));
        Some(Sample { front, back, length, nearness: entry - exit, place: [column, self.row], covered })
    }
}

/// Columns of the lanes of a block whose left column is `x`, counted from the record's reference pixel.
#[inline(always)]
fn columns<S: Simd>(simd: S, record: &CellRecord, x: u32) -> f32x8<S> {
    f32x8::from_slice(simd, &LANE_COLUMN) + (x as i32 - i32::from(record.pixel[0])) as f32
}

/// Rows of the lanes of a block whose upper row is `y`, likewise.
#[inline(always)]
fn rows<S: Simd>(simd: S, record: &CellRecord, y: u32) -> f32x8<S> {
    f32x8::from_slice(simd, &LANE_ROW) + (y as i32 - i32::from(record.pixel[1])) as f32
}

/// What a cell has in the block at `(x, y)`, in f64 and pixel by pixel.
///
/// Not inlined: it is rare, and would crowd the caller.
#[inline(never)]
pub(crate) fn careful_lanes(
    cell: &CarefulCell,
    reference: f64,
    space: &PixelSpace,
    [x, y]: [u32; 2],
) -> Option<[[f32; LANES]; 4]> {
    let mut lanes = [[0.0; LANES]; 4];
    let mut any = false;
    for lane in 0..LANES {
        let (column, row) = (x + lane as u32 % BLOCK_WIDTH, y + lane as u32 / BLOCK_WIDTH);
        let (u, w) = (PixelSpace::center(column, space.size[0]), PixelSpace::center(row, space.size[1]));
        if let Some(span) = cell.clip.span(space.is_perspective, u, w) {
            lanes[0][lane] = (span.scalar[0] - reference) as f32;
            lanes[1][lane] = (span.scalar[1] - reference) as f32;
            let length = span.depth[1] - span.depth[0];
            lanes[2][lane] = length as f32;
            lanes[3][lane] =
                if space.is_perspective { length / (span.depth[0] * span.depth[1]) } else { length } as f32;
            any = true;
        }
    }
    any.then_some(lanes)
}

/// [`careful_lanes`], as a sample.
#[inline(always)]
pub(crate) fn careful_sample<S: Simd>(
    simd: S,
    cell: &CarefulCell,
    record: &CellRecord,
    space: &PixelSpace,
    [x, y]: [u32; 2],
) -> Option<Sample<S>> {
    let [front, back, length, nearness] =
        careful_lanes(cell, record.scalar_reference, space, [x, y])?.map(|lane| f32x8::from_slice(simd, &lane));
    let covered = length.simd_gt(f32x8::splat(simd, 0.0));
    Some(Sample { front, back, length, nearness, place: [columns(simd, record, x), rows(simd, record, y)], covered })
}
