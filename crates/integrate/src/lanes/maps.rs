//! Look-ups in isosurface maps in eight lanes.

use fearless_simd::{Simd, f32x8, i32x8, prelude::*};

use crate::surface::{IsosurfaceMap, TexelAxis};

impl TexelAxis {
    /// [`TexelAxis::texel`] of eight coordinates `(scalar - start) * per_scalar`.
    ///
    /// Where the map is to have no gaps, take the texel at a cell's exit as the one at the entry to the next: the
    /// rounding of the coordinates then does not count.
    #[inline(always)]
    pub fn texel_lanes<S: Simd>(&self, simd: S, coordinate: f32x8<S>) -> [u32; 8] {
        let last = f32x8::splat(simd, (self.texels - 1) as f32);
        let clamped = coordinate.max(f32x8::splat(simd, 0.0)).min(last);
        let whole: [i32; 8] = i32x8::truncate_from(clamped).into();
        let mut texels = [0; 8];
        for lane in 0..8 {
            // Not negative but for what a NaN became, and look-ups take any number.
            texels[lane] = whole[lane].cast_unsigned();
        }
        texels
    }
}

impl IsosurfaceMap {
    /// [`IsosurfaceMap::at`] in eight lanes: premultiplied linear RGB, and opacity.
    #[inline(always)]
    pub fn look_up_lanes<S: Simd>(&self, simd: S, front: [u32; 8], back: [u32; 8]) -> ([f32x8<S>; 3], f32x8<S>) {
        let (size, entries) = (self.axis().texels, self.entries());
        let last = size - 1;
        let mut channels = [[0.0; 8]; 4];
        for lane in 0..8 {
            let entry = entries[(front[lane].min(last) * size + back[lane].min(last)) as usize];
            for channel in 0..4 {
                channels[channel][lane] = entry[channel];
            }
        }
        let [red, green, blue, opacity] = channels;
        ([red.simd_into(simd), green.simd_into(simd), blue.simd_into(simd)], opacity.simd_into(simd))
    }
}
