//! How fast a transfer function changes within a cell, held against what 32 bits know of a scalar.

use tetrascope_integrate::{OpticalModel, TransferFunction};

/// What a scalar in 32 bits may be off by, relative to the range of its cell: half a step next to 1.
const STEP: f64 = 1.0 / 33_554_432.0;

/// What the light of a cell may be off by before it is to be found in 64 bits. A bound: what is found is a tenth of it or less, as the errors of
/// entry and exit, and of both flanks of a peak, hardly ever all count.
const MOST: f64 = 1e-4;

/// The total variation of a transfer function's extinction, light included, over any range of scalars.
///
/// Where a scalar is off by `e` of its range, every step and every slope that a segment passes moves by `e` of the segment's length: the optical depth is
/// off by no more than `e` times the length times the variation passed. A peak a millionth of a cell's range wide is met or missed.
#[derive(Clone, Debug)]
pub struct Sharpness {
    /// Where pieces begin, ascending; the first is minus infinity.
    starts: Vec<f64>,
    /// Of all that lies below each start, the step there included.
    before: Vec<f64>,
    /// Per scalar, within each piece.
    slopes: Vec<f64>,
}

impl Sharpness {
    /// Of a transfer function, over its scalars.
    pub fn new(transfer: &TransferFunction, model: OpticalModel) -> Self {
        let pieces = transfer.pieces();
        let largest = |[a, b]: [[f64; 3]; 2]| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max);
        let weigh = |extinction: [f64; 2], color: [[f64; 3]; 2]| {
            let change = (extinction[0] - extinction[1]).abs();
            match model {
                OpticalModel::Absorption => change,
                OpticalModel::Emission => largest(color),
                OpticalModel::Emitter => change + largest(color),
                // Color shows where it is dense.
                OpticalModel::DensityEmitter => change + extinction[0].max(extinction[1]) * largest(color),
            }
        };
        let (mut before, mut slopes, mut sum) = (Vec::new(), Vec::new(), 0.0);
        for (index, piece) in pieces.iter().enumerate() {
            if let Some(last) = index.checked_sub(1).map(|last| &pieces[last]) {
                sum += weigh([last.extinction[1], piece.extinction[0]], [last.color[1], piece.color[0]]);
            }
            before.push(sum);
            let width = piece.end - piece.start;
            let inside = weigh(piece.extinction, piece.color);
            slopes.push(if width.is_finite() && width > 0.0 { inside / width } else { 0.0 });
            sum += if width.is_finite() { inside } else { 0.0 };
        }
        Self { starts: pieces.iter().map(|piece| piece.start).collect(), before, slopes }
    }

    /// The variation between two scalars, the lower one first.
    pub fn between(&self, low: f64, high: f64) -> f64 {
        let variation = self.up_to(high) - self.up_to(low);
        // Beyond what f64 holds there is no difference: it may be anything.
        if variation.is_nan() { f64::INFINITY } else { variation.max(0.0) }
    }

    fn up_to(&self, scalar: f64) -> f64 {
        // A step counts for what begins on it.
        let piece = self.starts.partition_point(|&start| start <= scalar).saturating_sub(1);
        let inside = scalar - self.starts[piece];
        self.before[piece] + if inside.is_finite() { inside * self.slopes[piece] } else { 0.0 }
    }

    /// Whether 32 bits may be off by more than 1e-4 in a cell of these scalars with a chord of this length, in the unit of one over the extinction.
    pub fn is_beyond_32_bits(&self, low: f64, high: f64, chord: f64) -> bool {
        self.between(low, high) * chord * STEP > MOST
    }

    /// Whether a chord in 32 bits may be off by more than 1e-4 of the optical depth: where rays leave at an outline, a depth that is off by `e` of the cell's
    /// is `e` of it seen or not seen, however long the chord is.
    ///
    /// - `extinction`: the highest there
    /// - `depth`: of the cell along the rays, in the unit of one over the extinction
    pub fn is_chord_beyond_32_bits(extinction: f64, depth: f64) -> bool {
        extinction * depth * STEP > MOST
    }

    /// Whether any cell whose chords are no longer than this may be beyond 32 bits.
    pub fn may_be_beyond_32_bits(&self, chord: f64) -> bool {
        self.is_beyond_32_bits(f64::NEG_INFINITY, f64::INFINITY, chord)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variation_of_a_peak_and_a_step() {
        let transfer = TransferFunction::new(
            &[[0.0, 1.0, 1.0, 1.0]],
            &[[0.0, 0.0], [1.0, 4.0], [2.0, 0.0], [3.0, 0.0], [3.0, 5.0]],
        )
        .unwrap();
        let sharp = Sharpness::new(&transfer, OpticalModel::DensityEmitter);
        for (low, high, expected) in [
            (-1.0, 4.0, 13.0),
            (0.0, 1.0, 4.0),
            (0.5, 1.5, 4.0),
            (2.0, 2.9, 0.0),
            (2.9, 3.0, 5.0),
            (3.5, 9.0, 0.0),
            (1.0, 1.0, 0.0),
        ] {
            assert!((sharp.between(low, high) - expected).abs() < 1e-12, "{low} {high}: {}", sharp.between(low, high));
        }
        assert!(!sharp.may_be_beyond_32_bits(1.0));
        assert!(!Sharpness::is_chord_beyond_32_bits(5.0, 100.0) && Sharpness::is_chord_beyond_32_bits(5.0, 1e3));
        assert!(sharp.may_be_beyond_32_bits(1e4) && !sharp.is_beyond_32_bits(2.0, 2.9, 1e4));
    }

    #[test]
    fn colors_count_where_they_are_dense() {
        let transfer =
            TransferFunction::new(&[[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.5, 0.0]], &[[0.0, 2.0], [1.0, 2.0]]).unwrap();
        let between = |model| Sharpness::new(&transfer, model).between(0.0, 1.0);
        assert_eq!(between(OpticalModel::DensityEmitter), 1.0);
        assert_eq!(between(OpticalModel::Emission), 0.5);
        assert_eq!(between(OpticalModel::Absorption), 0.0);
    }
}
