//! Where the samples of pre-integration tables lie, and where between them a value falls.

use crate::{LengthAxis, TableDomain, TableSettings};

/// The axis of a table's scalars: both of them, front and back, have the same.
///
/// A scalar has the coordinate `(scalar - start) * per_scalar`, which is 0 at the first sample and one less than the
/// number of samples at the last. Coordinates beyond are taken as those of the nearer end by every look-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalarAxis {
    /// The scalar of the first sample.
    pub start: f64,
    /// Samples per unit of the scalar; 0 where all samples have one scalar, so that every coordinate is 0.
    pub per_scalar: f64,
}

impl ScalarAxis {
    /// An axis of `count` samples from the lowest to the highest scalar of a domain.
    pub(crate) fn new(domain: &TableDomain, count: u32) -> Self {
        let [lo, hi] = domain.scalars;
        let per_scalar = f64::from(count - 1) / (hi - lo);
        // A range of a single float or of a few next to zero has no finite number of samples per scalar.
        Self { start: lo, per_scalar: if per_scalar.is_finite() { per_scalar } else { 0.0 } }
    }

    /// Where a scalar lies on the axis: 0 for the first sample, 1 for the second; not limited to the axis.
    #[inline]
    pub fn coordinate(&self, scalar: f64) -> f64 {
        (scalar - self.start) * self.per_scalar
    }
}

/// The scalars of an axis' samples, ascending, both ends of the domain met exactly.
pub(crate) fn scalar_samples(domain: &TableDomain, count: u32) -> Vec<f64> {
    let [lo, hi] = domain.scalars;
    let last = count - 1;
    let at = |i: u32| if i == last { hi } else { (lo + (hi - lo) * (f64::from(i) / f64::from(last))).min(hi) };
    (0..count).map(at).collect()
}

/// The octaves below the longest chord that a logarithmic axis resolves.
const OCTAVES: f64 = 10.0;
/// Where those begin, as a share of the longest chord.
const FIRST_OCTAVE: f64 = 1.0 / 1024.0;
/// The number of octaves between two 64-bit floats is the difference of their bits, read as integers, times this.
const OCTAVES_PER_BIT: f64 = 1.0 / (1u64 << 52) as f64;

/// The axis of a table's lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LengthNodes {
    pub(crate) max: f64,
    pub(crate) count: u32,
    pub(crate) axis: LengthAxis,
}

impl LengthNodes {
    pub(crate) fn new(domain: &TableDomain, settings: &TableSettings) -> Self {
        // Two nodes are the ends, however the others would be spaced.
        let axis = if settings.lengths == 2 { LengthAxis::Linear } else { settings.length_axis };
        Self { max: domain.max_length, count: settings.lengths, axis }
    }

    /// The length of a node: 0 for the first, the longest chord for the last.
    pub(crate) fn length(&self, node: u32) -> f64 {
        let share = match self.axis {
            LengthAxis::Linear => f64::from(node) / f64::from(self.count - 1),
            LengthAxis::Logarithmic if node == 0 => 0.0,
            LengthAxis::Logarithmic => {
                let octaves = OCTAVES * f64::from(node - 1) / f64::from(self.count - 2);
                FIRST_OCTAVE * octaves.floor().exp2() * (1.0 + octaves.fract())
            }
        };
        self.max * share
    }

    /// Where a length lies on the axis, from 0 to the last node; longer chords lie on the last node. NaN stays NaN.
    #[inline]
    pub(crate) fn coordinate(&self, length: f64) -> f64 {
        let share = (length / self.max).clamp(0.0, 1.0);
        match self.axis {
            LengthAxis::Linear => share * f64::from(self.count - 1),
            LengthAxis::Logarithmic if share >= FIRST_OCTAVE => {
                // The exponent and, linear in each octave, the mantissa.
                let bits = share.to_bits() - FIRST_OCTAVE.to_bits();
                1.0 + bits as f64 * (OCTAVES_PER_BIT * (f64::from(self.count - 2) / OCTAVES))
            }
            LengthAxis::Logarithmic => share / FIRST_OCTAVE,
        }
    }
}

/// The sample at or below a coordinate, such that there is one above, and the share of the one above. Coordinates
/// beyond the axis are at its ends; of a NaN the share is NaN.
#[inline]
pub(crate) fn cell(coordinate: f64, count: u32) -> (usize, f64) {
    let last = f64::from(count - 1);
    let coordinate = coordinate.clamp(0.0, last);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a clamped number; NaN gives 0")]
    let below = (coordinate as usize).min(count as usize - 2);
    (below, coordinate - below as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes(max: f64, count: u32, axis: LengthAxis) -> LengthNodes {
        let settings = TableSettings { scalars: 2, lengths: count, length_axis: axis };
        LengthNodes::new(&TableDomain { scalars: [0.0, 1.0], mean_length: max, max_length: max }, &settings)
    }

    #[test]
    fn nodes_have_their_own_coordinates() {
        for axis in [LengthAxis::Linear, LengthAxis::Logarithmic] {
            for count in [2, 3, 4, 12, 32, 61, 64, 1024] {
                for max in [1.0, 0.3, 1e-200, 7e250] {
                    let nodes = nodes(max, count, axis);
                    let lengths: Vec<_> = (0..count).map(|node| nodes.length(node)).collect();
                    assert_eq!((lengths[0], lengths[count as usize - 1]), (0.0, max));
                    assert!(lengths.is_sorted_by(|a, b| a < b), "{axis:?} {count} {max}");
                    for (node, &length) in lengths.iter().enumerate() {
                        // A few roundings of a coordinate.
                        let error = (nodes.coordinate(length) - node as f64).abs();
                        assert!(error <= 4e-16 * f64::from(count), "{axis:?} {count} {max} {node}: {error:e}");
                    }
                    assert_eq!(nodes.coordinate(2.0 * max), f64::from(count - 1));
                    assert_eq!(nodes.coordinate(-1.0), 0.0);
                }
            }
        }
    }

    #[test]
    fn a_logarithmic_axis_has_as_many_nodes_in_every_octave() {
        let nodes = nodes(8.0, 42, LengthAxis::Logarithmic);
        for octave in 0..10u32 {
            let start = 8.0 * FIRST_OCTAVE * 2f64.powi(octave as i32);
            for quarter in 0..4u32 {
                let length = start * (1.0 + 0.25 * f64::from(quarter));
                assert_eq!(nodes.coordinate(length), f64::from(1 + 4 * octave + quarter));
            }
        }
        // Continuous where the octaves begin.
        let start = 8.0 * FIRST_OCTAVE;
        assert!((nodes.coordinate(start.next_down()) - nodes.coordinate(start)).abs() < 1e-15);
        assert_eq!(nodes.coordinate(0.5 * start), 0.5);
    }

    #[test]
    fn samples_meet_the_ends_and_a_single_scalar_has_one_coordinate() {
        for scalars in [[0.0, 1.0], [-3.0, 1e9], [-8e307, 8e307], [0.1, 0.1f64.next_up()], [5.0, 5.0], [0.0, 5e-324]] {
            let domain = TableDomain { scalars, mean_length: 1.0, max_length: 1.0 };
            for count in [2, 3, 64, 257] {
                let samples = scalar_samples(&domain, count);
                assert_eq!([samples[0], samples[count as usize - 1]], scalars);
                assert!(samples.is_sorted(), "{scalars:?}");
                let axis = ScalarAxis::new(&domain, count);
                assert!(axis.coordinate(scalars[1]).is_finite());
                if (scalars[1] - scalars[0]).abs() > 1e-3 {
                    for (i, &sample) in samples.iter().enumerate() {
                        // Rounding of the scalar, seen from the axis.
                        let rounding = 2e-16 * axis.per_scalar * sample.abs().max(scalars[0].abs());
                        assert!(
                            (axis.coordinate(sample) - i as f64).abs() <= 4.0 * rounding + 1e-13,
                            "{scalars:?} {i}"
                        );
                    }
                } else if scalars[0] == scalars[1] {
                    assert_eq!(axis.coordinate(7.0), 0.0);
                }
            }
        }
    }

    #[test]
    fn cells_always_have_a_sample_above() {
        assert_eq!(cell(0.0, 2), (0, 0.0));
        assert_eq!(cell(1.0, 2), (0, 1.0));
        assert_eq!(cell(62.25, 64), (62, 0.25));
        assert_eq!(cell(63.0, 64), (62, 1.0));
        assert_eq!(cell(1e300, 64), (62, 1.0));
        assert_eq!(cell(f64::NEG_INFINITY, 64), (0, 0.0));
        let (below, share) = cell(f64::NAN, 64);
        assert!(below == 0 && share.is_nan());
    }
}
