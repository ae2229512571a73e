//! The function psi by a table, and the integration method that needs nothing else.
//!
//! Where extinction and color are linear between the ends of a segment, one function of the two optical depths of the
//! ends gives its light ([`crate::weights`]): `psi`, the mean transmittance. [Moreland 2004] tabulates it over
//! `gamma = tau / (1 + tau)` of both ends, which maps all depths to 0..1, and looks it up at the values of the transfer
//! function at the ends: *partial pre-integration*, since the table depends on no transfer function.

use std::sync::OnceLock;

use crate::weights::{Weights, weights_f64};
use crate::{
    Deviation, MethodError, OpticalModel, RgbaAssoc, Segment, TableDomain, TransferFunction, deviation, opacity_2d,
};

#[cfg(test)]
#[path = "psi_table_tests.rs"]
mod tests;

/// Samples along the axis of depths.
pub(crate) const DEPTHS: usize = 129;
/// Samples along the axis of balances.
pub(crate) const BALANCES: usize = 65;
/// What an entry of all ones stands for is 1.
pub(crate) const ENTRY_SCALE: u16 = u16::MAX;

/// A table of psi, the mean transmittance of a segment with a linear extinction; the same for all transfer functions.
///
/// # What is stored
///
/// Not psi itself. The light of a segment is its opacity times a mean color, and the opacity has a closed form; only
/// the *share* of the front in that mean, `(1 - psi) / opacity`, needs a table. Of it, the share that a thin segment
/// has, `(2 tau_front + tau_back) / (3 (tau_front + tau_back))`, is taken off. With `tau` the mean of both depths, the
/// axes are
///
/// ```text
/// depth     1 - 1 / sqrt(1 + tau / 2)                  0 without depth, 1 at infinity
/// balance   sqrt(tau_front / (tau_front + tau_back))   0 if all depth is at the back, 1 if all is at the front
/// ```
///
/// with samples at both ends of each, bilinear between; entries are 16 bits for 0 to 1. Both weights then add up to the
/// opacity whatever the table holds, thin segments are exact, and infinity is a sample and not a limit that the last
/// cell of the table leaves out: psi falls as the root of the depth, which is linear along this axis and vertical along
/// Moreland's.
///
/// Largest error of a weight, relative to the opacity, by the segment's optical depth:
///
/// | table | bytes | below 0.01 | to 1 | to 30 | to 1e4 | above |
/// | --- | --- | --- | --- | --- | --- | --- |
/// | share, 129 × 65 (this one) | 16,770 | 9e-6 | 2e-5 | 6e-5 | 1.2e-4 | 5.1e-4 |
/// | psi over gamma, 512 × 512, samples at i / 512, f32 | 1,048,576 | 9e-4 | 4e-5 | 6e-5 | 4.7e-2 | 5.5e-2 |
/// | psi over gamma, 128 × 128, samples at i / 128, f32 | 65,536 | 4e-3 | 6e-4 | 9e-4 | 0.10 | 0.11 |
///
/// measured from an optical depth of 1e-4 to 1e12 (test `the_share_is_better_than_psi_itself`); towards 0 the error of
/// the tables of psi grows without bound. The 16 bits are 8e-6 of ours.
#[derive(Debug)]
pub struct PsiTable {
    /// What the front's share exceeds that of a thin segment by: `[depth][balance]`.
    excess: Box<[[u16; BALANCES]; DEPTHS]>,
}

impl PsiTable {
    /// Samples along the axis of depths.
    pub const DEPTHS: usize = DEPTHS;
    /// Samples along the axis of balances.
    pub const BALANCES: usize = BALANCES;

    /// The table, computed at the first call.
    pub fn shared() -> &'static Self {
        static TABLE: OnceLock<PsiTable> = OnceLock::new();
        TABLE.get_or_init(Self::new)
    }

    fn new() -> Self {
        let mut excess = Box::new([[0; BALANCES]; DEPTHS]);
        for (row, entries) in excess.iter_mut().enumerate() {
            let root = 1.0 - row as f64 / (DEPTHS - 1) as f64;
            for (column, entry) in entries.iter_mut().enumerate() {
                let balance = column as f64 / (BALANCES - 1) as f64;
                let value = share(2.0 * (1.0 / (root * root) - 1.0), balance * balance) - thin_share(balance * balance);
                // The conversion clamps what rounding puts below zero.
                *entry = (value * f64::from(ENTRY_SCALE)).round() as u16;
            }
        }
        Self { excess }
    }

    /// Its own error: the light of [`partial`] against [`crate::exact`], on segments whose extinction and color are linear,
    /// as it takes them to be; see [`deviation()`].
    ///
    /// - `deepest`: largest optical depth of a segment; positive and finite
    ///
    /// # Errors
    ///
    /// [`MethodError::TableDomain`] for another depth.
    pub fn deviation(&self, deepest: f64, samples: u32) -> Result<Deviation, MethodError> {
        let transfer =
            TransferFunction::new(&[[0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0]], &[[0.0, 0.0], [1.0, deepest]])
                .ok()
                .filter(|_| deepest > 0.0)
                .ok_or(MethodError::TableDomain {
                    what: "optical depth",
                    value: deepest,
                    expected: "give a positive, finite number",
                })?;
        let domain = TableDomain { scalars: [0.0, 1.0], mean_length: 0.1, max_length: 1.0 };
        let model = OpticalModel::DensityEmitter;
        Ok(deviation(&transfer, model, &domain, 1.0, samples, |segment| partial(&transfer, model, segment)))
    }

    /// The mean transmittance of a segment, 0 to 1; exactly 1 without depth.
    ///
    /// `tau_front`, `tau_back`: extinction at the ends times the length; not negative, infinity allowed. The error is
    /// that of the table times the opacity, so that it vanishes with the depth. NaN gives NaN.
    pub fn psi(&self, tau_front: f64, tau_back: f64) -> f64 {
        1.0 - self.weights(tau_front, tau_back).front
    }

    /// [`crate::weights::weights_f64`] from the table: `front + back` is the opacity but for rounding, each weight is off
    /// by the table's error.
    pub fn weights(&self, tau_front: f64, tau_back: f64) -> Weights<f64> {
        let tau = 0.5 * tau_front + 0.5 * tau_back;
        let (opacity, transmittance) = (-(-tau).exp_m1(), (-tau).exp());
        let front = opacity * self.front_share(tau_front, tau);
        Weights { front, back: opacity - front, transmittance }
    }

    /// `front / (front + back)` of the weights, from the depth at the front and the mean of both.
    fn front_share(&self, tau_front: f64, tau: f64) -> f64 {
        if tau.is_nan() {
            return tau;
        }
        // Infinite depths have no balance, and need none: the front hides all.
        if tau.is_infinite() {
            return 1.0;
        }
        // Without depth any balance will do.
        let part = if tau > 0.0 { 0.5 * tau_front / tau } else { 0.0 };
        let depth = (1.0 - 1.0 / (1.0 + 0.5 * tau).sqrt()) * (DEPTHS - 1) as f64;
        let balance = part.min(1.0).sqrt() * (BALANCES - 1) as f64;
        let (row, column) = ((depth as usize).min(DEPTHS - 2), (balance as usize).min(BALANCES - 2));
        let (down, right) = (depth - row as f64, balance - column as f64);
        let [above, below] = [0, 1].map(|next| {
            let [left, right_entry] = [0, 1].map(|side| f64::from(self.excess[row + next][column + side]));
            left + (right_entry - left) * right
        });
        // At great depths the share is 1, and the sum may round to more.
        (thin_share(part) + (above + (below - above) * down) / f64::from(ENTRY_SCALE)).min(1.0)
    }

    /// The entries, `[depth][balance]`: 16 bits for 0 to 1.
    pub fn entries(&self) -> &[[u16; BALANCES]; DEPTHS] {
        &self.excess
    }
}

/// The front's share of the light of a thin segment, whose front has the given part of both depths.
fn thin_share(part: f64) -> f64 {
    (1.0 + part) / 3.0
}

/// The front's share at any depth, infinity included.
fn share(tau: f64, part: f64) -> f64 {
    if tau == 0.0 {
        return thin_share(part);
    }
    if tau.is_infinite() {
        return 1.0;
    }
    let weights = weights_f64(2.0 * tau * part, 2.0 * tau * (1.0 - part));
    weights.front / (weights.front + weights.back)
}

/// The light of a segment whose extinction and color are linear between their values at its ends.
///
/// Exact but for the table's error where the transfer function is linear over the segment's scalars; a peak between the
/// ends is missed and one at an end counts for the whole. No cut at control points, no integral over the scalar: two
/// look-ups and one in [`PsiTable`].
///
/// Absorption and emission need no psi and are those of [`opacity_2d`]. The emitter's two weights are no function of
/// psi alone; [`crate::Integration::check`] refuses it, and here it takes the mean of both end colors, `psi` times:
/// right where the color is constant.
///
/// Source: [Moreland 2004]; [Marroquim 2008], section 4.4, for its use in cell projection.
pub fn partial(transfer: &TransferFunction, model: OpticalModel, segment: &Segment) -> RgbaAssoc {
    if matches!(model, OpticalModel::Absorption | OpticalModel::Emission) {
        return opacity_2d(transfer, model, segment);
    }
    let Segment { scalar_front, scalar_back, chord_length } = *segment;
    if chord_length == 0.0 {
        return RgbaAssoc::TRANSPARENT;
    }
    let depths = [scalar_front, scalar_back].map(|scalar| transfer.extinction(scalar) * chord_length);
    let weights = PsiTable::shared().weights(depths[0], depths[1]);
    let (front, back) = if model == OpticalModel::Emitter {
        let half = 0.5 * chord_length * (1.0 - weights.front);
        (half, half)
    } else {
        (weights.front, weights.back)
    };
    let [near, far] = [scalar_front, scalar_back].map(|scalar| transfer.color(scalar));
    let rgb = core::array::from_fn(|channel| front * near[channel] + back * far[channel]);
    RgbaAssoc { rgb, opacity: -(-(0.5 * depths[0] + 0.5 * depths[1])).exp_m1() }
}
