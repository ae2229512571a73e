//! Eight pixels at a time: four columns by two rows, what their rays have inside a cell, and the light of it.

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

use crate::geometry::PixelSpace;

/// Pixels a block.
pub(crate) const LANES: usize = 8;
/// Columns of a block.
pub(crate) const BLOCK_WIDTH: u32 = 4;
/// Rows of a block.
pub(crate) const BLOCK_HEIGHT: u32 = 2;

/// Column and row of every lane within its block.
pub(crate) const LANE_COLUMN: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0];
pub(crate) const LANE_ROW: [f32; LANES] = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];

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
    /// Depth where the rays enter and leave, in pixel space, from [`PixelSpace::start`].
    pub(crate) depth: [f32x8<S>; 2],
    /// Columns and rows of the lanes, counted from the record's reference pixel.
    pub(crate) place: [f32x8<S>; 2],
    /// Which lanes the cell covers.
    pub(crate) covered: mask32x8<S>,
}

/// What a cell sends to the eye in each lane, and how much it hides.
#[derive(Clone, Copy)]
pub(crate) struct Light<S: Simd> {
    /// Linear, premultiplied.
    pub(crate) rgb: [f32x8<S>; 3],
    /// And not the transmittance: next to 1 that has no digits for what a thin cell hides, and equal layers would all round the same way.
    pub(crate) opacity: f32x8<S>,
}

impl<S: Simd> Light<S> {
    /// The opacity of two lights, one behind the other.
    #[inline(always)]
    pub(crate) fn opacity_with(&self, other: &Self) -> f32x8<S> {
        (1.0 - self.opacity).mul_add(other.opacity, self.opacity)
    }
}

/// Pixel centers of a block's lanes, counted from the middle of the picture. Exact.
#[inline(always)]
pub(crate) fn lanes_from<S: Simd>(simd: S, [x, y]: [u32; 2], space: &PixelSpace) -> [f32x8<S>; 2] {
    let [u, w] = [PixelSpace::center(x, space.size[0]), PixelSpace::center(y, space.size[1])];
    [f32x8::from_slice(simd, &LANE_COLUMN) + u as f32, f32x8::from_slice(simd, &LANE_ROW) + w as f32]
}
