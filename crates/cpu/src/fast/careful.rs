//! What cells that f32 cannot hold have in a block, in f64.

use super::cell::CarefulCell;
use super::record::CellRecord;
use super::sample::{BLOCK_WIDTH, LANE_COLUMN, LANE_ROW, LANES, Sample};
use crate::geometry::{IN_PLANE, PixelSpace};
use fearless_simd::{Simd, f32x8, f64x8, prelude::*};

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

/// What a cell has in the block at `(x, y)`, in f64: scalars from `reference`, depth between, nearness, depths
/// from [`PixelSpace::start`].
#[inline(always)]
fn careful_lanes<S: Simd>(
    simd: S,
    careful: &CarefulCell,
    reference: f64,
    space: &PixelSpace,
    [x, y]: [u32; 2],
) -> Option<[[f32; LANES]; 6]> {
    let cell = &careful.clip;
    let from = |first: u32, offsets: &[f32; LANES], size: u32| {
        let first = PixelSpace::center(first, size);
        f64x8::load_array(simd, offsets.map(|offset| first + f64::from(offset)))
    };
    let (u, w) = (from(x, &LANE_COLUMN, space.size[0]), from(y, &LANE_ROW, space.size[1]));
    let splat = |value: f64| f64x8::splat(simd, value);
    let (mut enter, mut leave) = (splat(0.0), splat(f64::INFINITY));
    for face in cell.faces.iter().chain(&careful.cuts) {
        let (n, p) = (face.normal, face.point);
        // As in `ClipCell::span_behind`.
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
            return careful_pixels(careful, reference, space, [x, y]);
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
    let from_start = |depth: f64x8<S>| (depth - space.start).to_f32s();
    let nearness = if space.is_perspective { covered.select(length / (enter * leave), splat(0.0)) } else { length };
    Some([
        scalar_at(enter),
        scalar_at(leave),
        length.to_f32s(),
        nearness.to_f32s(),
        from_start(enter),
        from_start(leave),
    ])
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
fn careful_pixels(
    cell: &CarefulCell,
    reference: f64,
    space: &PixelSpace,
    [x, y]: [u32; 2],
) -> Option<[[f32; LANES]; 6]> {
    let mut lanes = [[0.0; LANES]; 6];
    let mut any = false;
    for lane in 0..LANES {
        let (column, row) = (x + lane as u32 % BLOCK_WIDTH, y + lane as u32 / BLOCK_WIDTH);
        let (u, w) = (PixelSpace::center(column, space.size[0]), PixelSpace::center(row, space.size[1]));
        if let Some(span) = cell.clip.span_behind(&cell.cuts, space.is_perspective, u, w) {
            let length = span.depth[1] - span.depth[0];
            let nearness = if space.is_perspective { length / (span.depth[0] * span.depth[1]) } else { length };
            let [[enter, leave], [front, back]] = [span.depth, span.scalar];
            let values =
                [front - reference, back - reference, length, nearness, enter - space.start, leave - space.start];
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
    let [front, back, length, nearness, enter, leave] =
        careful_lanes(simd, cell, record.scalar_reference, space, [x, y])?.map(|lane| f32x8::load_array(simd, lane));
    let place = [columns(simd, record, x), rows(simd, record, y)];
    // A cell without thickness has faces that are rounding, behind all of which rays far from it may lie.
    let [left, right, top, bottom] = record.outline.map(i32::from);
    let [from_x, from_y] = record.pixel.map(i32::from);
    let within = |place: f32x8<S>, first: i32, last: i32, from: i32| {
        place.simd_ge((first - from) as f32) & place.simd_le((last - from) as f32)
    };
    let is_near = within(place[0], left, right, from_x) & within(place[1], top, bottom, from_y);
    let none = f32x8::splat(simd, 0.0);
    let (length, nearness) = (is_near.select(length, none), is_near.select(nearness, none));
    let covered = length.simd_gt(none);
    Some(Sample { front, back, length, nearness, depth: [enter, leave], place, covered })
}
