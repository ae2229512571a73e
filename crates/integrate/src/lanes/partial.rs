//! Weights from the table of psi, for eight rays at once.

use fearless_simd::{Simd, f32x8, prelude::*, u32x8};

use super::exponential::opacity_transmittance;
use crate::psi_table::{BALANCES, DEPTHS, ENTRY_SCALE, PsiTable};
use crate::weights::Weights;

/// [`PsiTable::weights`] in eight lanes, for any depths in one and the same time: no series, no splitting of deep
/// segments.
///
/// Each weight is off by up to 1.3e-4 of the opacity, 6e-4 beyond an optical depth of 1e4; their sum and the
/// transmittance are as good as those of [`opacity_transmittance`]. Without depth both are exactly 0. What a NaN gives is
/// not said, but it stays in its lane.
#[inline(always)]
pub fn partial_weights<S: Simd>(simd: S, tau_front: f32x8<S>, tau_back: f32x8<S>) -> Weights<f32x8<S>> {
    // Infinite depths have no balance; so deep a front counts alone as it is.
    let limit = f32x8::splat(simd, 0.25 * f32::MAX);
    let (half_front, half_back) = (tau_front.min(limit) * 0.5, tau_back.min(limit) * 0.5);
    let tau = half_front + half_back;
    let (opacity, transmittance) = opacity_transmittance(simd, tau);

    let one = f32x8::splat(simd, 1.0);
    // Without depth any balance will do.
    let part = (half_front / tau.max(f32::MIN_POSITIVE)).min(1.0);
    let depth = (one - one / tau.mul_add(0.5, one).sqrt()) * (DEPTHS - 1) as f32;
    let balance = part.sqrt() * (BALANCES - 1) as f32;
    let row = depth.min((DEPTHS - 2) as f32).floor();
    let column = balance.min((BALANCES - 2) as f32).floor();
    let (down, right) = (depth - row, balance - column);

    let corner: [u32; 8] = row.mul_add(BALANCES as f32, column).to_int::<u32x8<S>>().into();
    let entries = PsiTable::shared().entries().as_flattened();
    const LAST: usize = (DEPTHS - 1) * BALANCES - 2;
    // Neighbors along the balance in one number: half as many loads.
    let (mut near, mut far) = ([0u32; 8], [0u32; 8]);
    for lane in 0..8 {
        // The least a check can cost; indices beyond come from NaN alone.
        let first = (corner[lane] as usize).min(LAST);
        near[lane] = pair(entries, first);
        far[lane] = pair(entries, first + BALANCES);
    }
    let [near, far] = [u32x8::simd_from(simd, near), u32x8::simd_from(simd, far)];
    let low = u32x8::splat(simd, 0xffff);
    let value = [
        (near & low).to_float::<f32x8<S>>(),
        (near >> 16).to_float::<f32x8<S>>(),
        (far & low).to_float::<f32x8<S>>(),
        (far >> 16).to_float::<f32x8<S>>(),
    ];
    let above = (value[1] - value[0]).mul_add(right, value[0]);
    let below = (value[3] - value[2]).mul_add(right, value[2]);
    let excess = (below - above).mul_add(down, above);

    // The share of a thin segment, a third of one plus the front's part, and what the table adds to it.
    let share = excess.mul_add(1.0 / f32::from(ENTRY_SCALE), (part + 1.0) * (1.0 / 3.0)).min(1.0);
    let front = opacity * share;
    Weights { front, back: opacity - front, transmittance }
}

/// An entry in the low half and the next one in the high half.
#[inline(always)]
fn pair(entries: &[u16], first: usize) -> u32 {
    let both = &entries[first..first + 2];
    u32::from(both[0]) | u32::from(both[1]) << 16
}

#[cfg(test)]
#[path = "partial_tests.rs"]
mod tests;
