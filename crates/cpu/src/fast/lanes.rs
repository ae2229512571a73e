//! Eight pixels at a time: four columns by two rows.

use fearless_simd::{Simd, f32x8, f64x8, mask32x8, prelude::*};

use super::record::{CarefulCell, CellRecord};
use crate::geometry::{ClipCell, IN_PLANE, PixelSpace};

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

    /// Gives every listed block's number and sample.
    #[inline(always)]
    pub(crate) fn each<S: Simd, const PERSPECTIVE: bool>(
        &self,
        simd: S,
        record: &CellRecord,
        mut visit: impl FnMut(usize, Sample<S>),
    ) {
        for item in &self.items[..self.count.min(MAX_BLOCKS)] {
            visit(item.block as usize, item.sample::<S, PERSPECTIVE>(simd, record));
        }
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
    fn sample<S: Simd, const PERSPECTIVE: bool>(&self, simd: S, record: &CellRecord) -> Sample<S> {
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
        let (front, back, length) = if PERSPECTIVE {
            // One division serves both ends.
            let (at_entry, at_exit) = (entry + 1.0, exit + 1.0);
            let inverse = f32x8::splat(simd, 1.0) / (at_entry * at_exit);
            (front * (inverse * at_exit), back * (inverse * at_entry), nearness * inverse)
        } else {
            (front, back, nearness)
        };
        let (front, back) = (front.max(low).min(high), back.max(low).min(high));
        Sample { front, back, length, nearness, place: [columns, rows], covered }
    }
}

/// Pixel centers of a block's lanes, counted from the middle of the picture. Exact.
#[inline(always)]
pub(crate) fn lanes_from<S: Simd>(simd: S, [x, y]: [u32; 2], space: &PixelSpace) -> [f32x8<S>; 2] {
    let [u, w] = [PixelSpace::center(x, space.size[0]), PixelSpace::center(y, space.size[1])];
    [f32x8::from_slice(simd, &LANE_COLUMN) + u as f32, f32x8::from_slice(simd, &LANE_ROW) + w as f32]
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

/// What a cell has in the block at `(x, y)`, in f64: scalars from `reference`, depths between, nearness.
#[inline(always)]
fn careful_lanes<S: Simd>(
    simd: S,
    cell: &ClipCell,
    reference: f64,
    space: &PixelSpace,
    [x, y]: [u32; 2],
) -> Option<[[f32; LANES]; 4]> {
    let from = |first: u32, offsets: &[f32; LANES], size: u32| {
        let first = PixelSpace::center(first, size);
        f64x8::load_array(simd, offsets.map(|offset| first + f64::from(offset)))
    };
    let (u, w) = (from(x, &LANE_COLUMN, space.size[0]), from(y, &LANE_ROW, space.size[1]));
    let splat = |value: f64| f64x8::splat(simd, value);
    let (mut enter, mut leave) = (splat(0.0), splat(f64::INFINITY));
    for face in &cell.faces {
        let (n, p) = (face.normal, face.point);
        // As in `ClipCell::span`.
        let across = splat(n.x) * u + splat(n.y) * w;
        let (room, speed) = if space.is_perspective {
            (splat(n.x * p.x + n.y * p.y + n.z * p.z), across + n.z)
        } else {
            (splat(n.x) * (splat(p.x) - u) + splat(n.y) * (splat(p.y) - w) + n.z * p.z, splat(n.z))
        };
        // One of the two is the same in all lanes, and rarely anything near zero.
        let may_run_in_face = if space.is_perspective {
            (n.x * p.x + n.y * p.y + n.z * p.z).abs()
                <= IN_PLANE * ((n.x * p.x).abs() + (n.y * p.y).abs() + (n.z * p.z).abs())
        } else {
            n.z.abs() <= IN_PLANE * n.abs().element_sum()
        };
        if may_run_in_face {
            return careful_pixels(cell, reference, space, [x, y]);
        }
        let depth = room / speed;
        let leaves = speed.simd_gt(splat(0.0));
        let enters = speed.simd_lt(splat(0.0));
        leave = leaves.select(leave.min(depth), leave);
        enter = enters.select(enter.max(depth), enter);
        // Parallel to the face and outside.
        let misses = speed.simd_eq(splat(0.0)) & room.simd_lt(splat(0.0));
        leave = misses.select(splat(f64::NEG_INFINITY), leave);
    }
    let covered = enter.simd_lt(leave) & leave.simd_lt(splat(f64::INFINITY));
    if !covered.any_true() {
        return None;
    }
    let (enter, leave) = (covered.select(enter, splat(0.0)), covered.select(leave, splat(0.0)));
    let scalar_at = |depth: f64x8<S>| {
        let from_anchor = if space.is_perspective {
            [u * depth - cell.anchor.x, w * depth - cell.anchor.y, depth - cell.anchor.z]
        } else {
            [u - cell.anchor.x, w - cell.anchor.y, depth - cell.anchor.z]
        };
        let g = cell.gradient;
        let scalar = splat(g.x) * from_anchor[0]
            + splat(g.y) * from_anchor[1]
            + splat(g.z) * from_anchor[2]
            + cell.scalar_at_anchor;
        (scalar.max(cell.scalar_range[0]).min(cell.scalar_range[1]) - reference).to_f32s()
    };
    let length = leave - enter;
    let nearness = if space.is_perspective { covered.select(length / (enter * leave), splat(0.0)) } else { length };
    Some([scalar_at(enter), scalar_at(leave), length.to_f32s(), nearness.to_f32s()])
}

/// Eight numbers in 32 bits.
trait ToF32s {
    fn to_f32s(self) -> [f32; LANES];
}

impl<S: Simd> ToF32s for f64x8<S> {
    #[inline(always)]
    fn to_f32s(self) -> [f32; LANES] {
        let mut wide = [0.0_f64; LANES];
        self.store_slice(&mut wide);
        wide.map(|x| x as f32)
    }
}

/// [`careful_lanes`] pixel by pixel, for rays that may run in a face.
#[cold]
fn careful_pixels(cell: &ClipCell, reference: f64, space: &PixelSpace, [x, y]: [u32; 2]) -> Option<[[f32; LANES]; 4]> {
    let mut lanes = [[0.0; LANES]; 4];
    let mut any = false;
    for lane in 0..LANES {
        let (column, row) = (x + lane as u32 % BLOCK_WIDTH, y + lane as u32 / BLOCK_WIDTH);
        let (u, w) = (PixelSpace::center(column, space.size[0]), PixelSpace::center(row, space.size[1]));
        if let Some(span) = cell.span(space.is_perspective, u, w) {
            let length = span.depth[1] - span.depth[0];
            let nearness = if space.is_perspective { length / (span.depth[0] * span.depth[1]) } else { length };
            let values = [span.scalar[0] - reference, span.scalar[1] - reference, length, nearness];
            for (lanes, value) in lanes.iter_mut().zip(values) {
                lanes[lane] = value as f32;
            }
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
    let [front, back, length, nearness] = careful_lanes(simd, &cell.clip, record.scalar_reference, space, [x, y])?
        .map(|lane| f32x8::load_array(simd, lane));
    let covered = length.simd_gt(f32x8::splat(simd, 0.0));
    Some(Sample { front, back, length, nearness, place: [columns(simd, record, x), rows(simd, record, y)], covered })
}
