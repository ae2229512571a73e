//! How far a way to integrate is from the exact light, over many segments.

use rayon::prelude::*;

use crate::{OpticalModel, RgbaAssoc, Segment, TableDomain, TransferFunction, exact};

/// How far results are from [`exact`].
///
/// The error of one segment is the largest difference over red, green, blue and opacity, in the units of the light. One
/// that is not a number counts as infinite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Largest error of a segment.
    pub largest: f64,
    /// Square root of the mean square of the errors.
    pub root_mean_square: f64,
    /// Mean error.
    pub mean: f64,
    /// The first segment that has the largest error.
    pub worst: Segment,
}

/// Lengths go down to this share of the longest chord.
const SHORTEST: f64 = 1.0 / 500.0;
/// Segments whose errors are summed up one after the other, so that the sums do not depend on threads.
const BATCH: u32 = 1024;

/// Measures `f` against [`exact`] over segments that fill a domain.
///
/// - `domain`: the segments' scalars lie in its range; their lengths lie between 1/500 of the longest chord and that
///   chord, as many in each octave
/// - `widest`: how far apart the scalars of a segment may be, as a share of the range; 1 or more allows any two, less
///   gives those of fine cells
/// - `samples`: number of segments; 0 gives no deviation
///
/// The segments are the same in every call. The result is the same for any number of threads.
pub fn deviation(
    transfer: &TransferFunction,
    model: OpticalModel,
    domain: &TableDomain,
    widest: f64,
    samples: u32,
    f: impl Fn(&Segment) -> RgbaAssoc + Sync,
) -> Deviation {
    let batches: Vec<_> = (0..samples.div_ceil(BATCH))
        .into_par_iter()
        .map(|batch| {
            let mut sums = Sums::default();
            for index in batch * BATCH..samples.min(batch.saturating_add(1).saturating_mul(BATCH)) {
                let segment = sample(domain, widest, index);
                sums.add(error(exact(transfer, model, &segment), f(&segment)), segment);
            }
            sums
        })
        .collect();
    let all = batches.into_iter().fold(Sums::default(), Sums::joined);
    let count = f64::from(samples.max(1));
    Deviation {
        largest: all.largest,
        root_mean_square: (all.squares / count).sqrt(),
        mean: all.errors / count,
        worst: all.worst,
    }
}

/// Multiples of powers of an irrational number fill the cube evenly (Roberts 2018).
fn sample(domain: &TableDomain, widest: f64, index: u32) -> Segment {
    let fraction = |step: f64| (0.5 + f64::from(index) * step).fract();
    let [first, second, third] = [0.819_172_513, 0.671_043_607, 0.549_700_478].map(fraction);
    let second = if widest < 1.0 { (first + widest * (2.0 * second - 1.0)).clamp(0.0, 1.0) } else { second };
    let [lo, hi] = domain.scalars;
    // Not `clamp`, which panics where the range descends.
    let scalar = |share: f64| (lo + (hi - lo) * share).max(lo).min(hi);
    let chord_length = domain.max_length * SHORTEST.powf(1.0 - third);
    Segment { scalar_front: scalar(first), scalar_back: scalar(second), chord_length }
}

fn error(known: RgbaAssoc, got: RgbaAssoc) -> f64 {
    let light = known.rgb.iter().zip(got.rgb).map(|(known, got)| (known - got).abs());
    let differences = light.chain([(known.opacity - got.opacity).abs()]);
    // `f64::max` would pass over what is not a number.
    differences.fold(0.0, |largest, next| if next.is_nan() { f64::INFINITY } else { largest.max(next) })
}

#[derive(Clone, Copy, Default)]
struct Sums {
    largest: f64,
    squares: f64,
    errors: f64,
    worst: Segment,
}

impl Sums {
    fn add(&mut self, error: f64, segment: Segment) {
        if error > self.largest {
            (self.largest, self.worst) = (error, segment);
        }
        self.squares += error * error;
        self.errors += error;
    }

    fn joined(self, next: Self) -> Self {
        let first = if next.largest > self.largest { next } else { self };
        Self {
            largest: first.largest,
            worst: first.worst,
            squares: self.squares + next.squares,
            errors: self.errors + next.errors,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::average;

    fn domain() -> TableDomain {
        TableDomain { scalars: [-1.0, 3.0], mean_length: 0.1, max_length: 0.5 }
    }

    fn transfer() -> TransferFunction {
        TransferFunction::new(&[[-1.0, 1.0, 0.0, 0.0], [3.0, 0.0, 1.0, 0.5]], &[[0.0, 0.0], [2.0, 9.0]]).unwrap()
    }

    #[test]
    fn a_known_difference_is_measured() {
        let transfer = transfer();
        let model = OpticalModel::DensityEmitter;
        let with = |offset: f64| {
            let transfer = &transfer;
            deviation(transfer, model, &domain(), 1.0, 5000, move |segment| {
                let light = exact(transfer, model, segment);
                let on_the_left = segment.scalar_front < 1.0;
                RgbaAssoc { rgb: light.rgb, opacity: light.opacity + if on_the_left { offset } else { 0.0 } }
            })
        };
        assert_eq!(with(0.0), Deviation::default());
        let quarter = with(0.25);
        assert!((quarter.largest - 0.25).abs() < 1e-15);
        // Half of the scalars lie on the left, but for the discrepancy of the sequence.
        assert!((quarter.mean - 0.125).abs() < 2e-4, "{quarter:?}");
        assert!((quarter.root_mean_square - 0.25 * 0.5f64.sqrt()).abs() < 2e-4, "{quarter:?}");
        assert!(quarter.worst.scalar_front < 1.0);
        let broken = with(f64::NAN);
        assert_eq!((broken.largest, broken.mean), (f64::INFINITY, f64::INFINITY));
        assert_eq!(deviation(&transfer, model, &domain(), 1.0, 0, |_| RgbaAssoc::TRANSPARENT), Deviation::default());
    }

    #[test]
    fn the_worst_segment_has_the_largest_error() {
        let (transfer, model) = (transfer(), OpticalModel::Emitter);
        let of_average =
            deviation(&transfer, model, &domain(), 0.3, 3000, |segment| average(&transfer, model, segment));
        let worst = &of_average.worst;
        assert_eq!(error(exact(&transfer, model, worst), average(&transfer, model, worst)), of_average.largest);
        assert!((worst.scalar_front - worst.scalar_back).abs() <= 0.3 * 4.0 + 1e-15);
        assert!(of_average.mean <= of_average.root_mean_square && of_average.root_mean_square <= of_average.largest);
    }

    #[test]
    fn segments_fill_the_domain() {
        let all: Vec<_> = (0..2000).map(|index| sample(&domain(), 1.0, index)).collect();
        for segment in &all {
            assert!((-1.0..=3.0).contains(&segment.scalar_front) && (-1.0..=3.0).contains(&segment.scalar_back));
            assert!((0.001..=0.5).contains(&segment.chord_length), "{segment:?}");
        }
        // Each of 64 boxes has about its share.
        let mut counts = [0u32; 64];
        for segment in &all {
            let third = (segment.chord_length / 0.5).ln() / 500f64.ln() + 1.0;
            let shares = [(segment.scalar_front + 1.0) / 4.0, (segment.scalar_back + 1.0) / 4.0, third];
            let [i, j, k] = shares.map(|share| ((share * 4.0) as usize).min(3));
            counts[(i * 4 + j) * 4 + k] += 1;
        }
        assert!(counts.iter().all(|count| (20..=43).contains(count)), "{counts:?}");
    }

    #[test]
    fn threads_do_not_matter() {
        let (transfer, model) = (transfer(), OpticalModel::DensityEmitter);
        let by = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| deviation(&transfer, model, &domain(), 1.0, 10_000, |s| average(&transfer, model, s)))
        };
        assert_eq!(by(1), by(5));
    }
}
