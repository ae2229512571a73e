//! Look-ups in pre-integration tables.
//!
//! Entries next to each other along the front scalar are next to each other in memory, so that one load of eight floats
//! fetches two of them. For each lane the two or four loads are mixed along the back scalar and the length with all
//! eight floats in use, and the halves of the result along the front scalar at last. Then the eight lanes' entries are
//! turned into a vector for each channel. Wide gathers would fetch 32 single floats a lane instead.

use fearless_simd::{Simd, f32x4, f32x8, i32x8, prelude::*, u32x8};

use crate::{LengthAxis, Table2d, Table3d};

#[cfg(test)]
#[path = "table_tests.rs"]
mod tests;

/// The light of eight segments.
#[derive(Clone, Copy, Debug)]
pub struct TableLight<S: Simd> {
    /// Linear light, multiplied by the opacity where the model has one.
    pub rgb: [f32x8<S>; 3],
    /// 0 to 1.
    pub opacity: f32x8<S>,
}

impl Table3d {
    /// [`Table3d::look_up`] in eight lanes.
    ///
    /// - `front`, `back`: coordinates on the [`Table3d::scalar_axis`], not the scalars; beyond the axis taken as its
    ///   nearer end
    /// - `length`: in the unit of the table's domain; beyond the longest chord taken as that one
    ///
    /// The error against the 64-bit look-up at the same coordinates stays below 1e-6 of the largest entry around, with
    /// up to 33 lengths (measured 3.5e-7). The place of a length is rounded to about 1e-7 of its axis, which costs more
    /// where there are more lengths and light changes much from one to the next. A NaN gives some number or NaN in its
    /// lane.
    #[inline(always)]
    pub fn look_up_lanes<S: Simd>(&self, simd: S, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> TableLight<S> {
        let scalars = self.settings().scalars;
        let n = scalars as usize;
        let (front, back) = (Cells::new(simd, front, scalars), Cells::new(simd, back, scalars));
        let nodes = Cells::new(simd, self.length_coordinate(simd, length), self.settings().lengths);
        let size = scalars as i32;
        let first: [u32; 8] = ((nodes.below * size + back.below) * size + front.below).bitcast::<u32x8<S>>().into();
        let [fronts, backs, lengths]: [[f32; 8]; 3] = [front.share.into(), back.share.into(), nodes.share.into()];

        let entries = self.entries();
        let mut light = [0.0; 32];
        for lane in 0..8 {
            let first = first[lane] as usize;
            // All eight corners, so that their bounds are checked once.
            let corners = &entries[first..first + n * n + n + 2];
            let near = both_backs(simd, corners, n, backs[lane]);
            let far = both_backs(simd, &corners[n * n..], n, backs[lane]);
            store(&mut light, lane, mixed_fronts(mixed(near, far, lengths[lane]), fronts[lane]));
        }
        let TableLight { rgb, opacity } = channels(simd, &light);
        // Mixing two entries of 1 may round up.
        TableLight { rgb, opacity: opacity.min(1.0) }
    }

    /// Where lengths lie on their axis.
    #[inline(always)]
    fn length_coordinate<S: Simd>(&self, simd: S, length: f32x8<S>) -> f32x8<S> {
        const FIRST_OCTAVE: f32 = 1.0 / 1024.0;
        const OCTAVES: f32 = 10.0;
        const OCTAVES_PER_BIT: f32 = 1.0 / (1 << 23) as f32;

        let nodes = self.length_nodes();
        #[expect(clippy::cast_possible_truncation, reason = "32 bits are the purpose")]
        let per_length = (1.0 / nodes.max) as f32;
        let share = (length * per_length).max(0.0).min(1.0);
        match nodes.axis {
            LengthAxis::Linear => share * (nodes.count - 1) as f32,
            LengthAxis::Logarithmic => {
                // The difference first: as a float it keeps more digits than the bits themselves would.
                let bits: i32x8<S> = share.bitcast::<i32x8<S>>() - FIRST_OCTAVE.to_bits() as i32;
                let octaves: f32x8<S> = bits.to_float();
                let per_bit = f32x8::splat(simd, OCTAVES_PER_BIT * ((nodes.count - 2) as f32 / OCTAVES));
                let resolved = octaves.mul_add(per_bit, f32x8::splat(simd, 1.0));
                share.simd_ge(FIRST_OCTAVE).select(resolved, share * (1.0 / FIRST_OCTAVE))
            }
        }
    }
}

impl Table2d {
    /// [`Table2d::look_up`] in eight lanes.
    ///
    /// - `front`, `back`: coordinates on the [`Table2d::scalar_axis`], not the scalars; beyond the axis taken as its
    ///   nearer end
    /// - `length`: in the unit of the table's domain
    ///
    /// The error against the 64-bit look-up at the same coordinates stays below 1e-6 of the largest entry around,
    /// scaled to the length. A NaN gives some number or NaN in its lane.
    #[inline(always)]
    pub fn look_up_lanes<S: Simd>(&self, simd: S, front: f32x8<S>, back: f32x8<S>, length: f32x8<S>) -> TableLight<S> {
        let scalars = self.scalars();
        let n = scalars as usize;
        let (front, back) = (Cells::new(simd, front, scalars), Cells::new(simd, back, scalars));
        let first: [u32; 8] = (back.below * scalars as i32 + front.below).bitcast::<u32x8<S>>().into();
        let [fronts, backs]: [[f32; 8]; 2] = [front.share.into(), back.share.into()];

        let entries = self.entries();
        let mut light = [0.0; 32];
        for lane in 0..8 {
            let first = first[lane] as usize;
            let both = both_backs(simd, &entries[first..first + n + 2], n, backs[lane]);
            store(&mut light, lane, mixed_fronts(both, fronts[lane]));
        }
        let TableLight { rgb, opacity } = channels(simd, &light);

        #[expect(clippy::cast_possible_truncation, reason = "32 bits are the purpose")]
        let factor = length * self.per_length() as f32;
        let scaled = opacity * factor;
        let is_opaque = scaled.simd_gt(1.0);
        let whole = f32x8::splat(simd, 1.0);
        // Where the opacity is 0 it is not above 1, and the quotient is not taken.
        let factor = is_opaque.select(whole / opacity, factor);
        TableLight { rgb: rgb.map(|channel| channel * factor), opacity: is_opaque.select(whole, scaled) }
    }
}

/// Eight positions between the samples of an axis.
struct Cells<S: Simd> {
    /// The sample at or below, such that there is one above.
    below: i32x8<S>,
    /// Share of the one above, 0 to 1.
    share: f32x8<S>,
}

impl<S: Simd> Cells<S> {
    #[inline(always)]
    fn new(simd: S, coordinate: f32x8<S>, count: u32) -> Self {
        let coordinate = coordinate.max(0.0).min((count - 1) as f32);
        // Limited as integers too, whatever a NaN has become.
        let below: i32x8<S> = coordinate.to_int();
        let below = below.max(i32x8::splat(simd, 0)).min(i32x8::splat(simd, count as i32 - 2));
        let whole: f32x8<S> = below.to_float();
        Self { below, share: coordinate - whole }
    }
}

/// The first two entries, mixed with the two a row further.
#[inline(always)]
fn both_backs<S: Simd>(simd: S, corners: &[[f32; 4]], row: usize, share: f32) -> f32x8<S> {
    let lower = f32x8::from_slice(simd, corners[..2].as_flattened());
    let upper = f32x8::from_slice(simd, corners[row..row + 2].as_flattened());
    mixed(lower, upper, share)
}

#[inline(always)]
fn mixed<S: Simd>(lower: f32x8<S>, upper: f32x8<S>, share: f32) -> f32x8<S> {
    (upper - lower).mul_add(share, lower)
}

#[inline(always)]
fn mixed_fronts<S: Simd>(both: f32x8<S>, share: f32) -> f32x4<S> {
    let (lower, upper) = both.split();
    (upper - lower).mul_add(share, lower)
}

#[inline(always)]
fn store<S: Simd>(light: &mut [f32; 32], lane: usize, entry: f32x4<S>) {
    entry.store_slice(&mut light[4 * lane..4 * lane + 4]);
}

/// From eight entries to four channels.
#[inline(always)]
fn channels<S: Simd>(simd: S, light: &[f32; 32]) -> TableLight<S> {
    let low = f32x4::load_four_interleaved(simd, &light[..16]);
    let high = f32x4::load_four_interleaved(simd, &light[16..]);
    let [red, green, blue, opacity]: [f32x8<S>; 4] =
        core::array::from_fn(|channel| low[channel].combine(high[channel]));
    TableLight { rgb: [red, green, blue], opacity }
}
