//! The figures of an error between which a study can be switched, and the frontier of each.

use std::time::Duration;

use tetrascope::{ErrorFigures, PixelDifference};

/// One number for the error of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Figure {
    /// The largest error of any channel of any pixel.
    Largest,
    /// The root of the mean square over all channels of all pixels.
    RootMeanSquare,
    /// What 999 of 1000 pixels do not exceed.
    Percentile,
}

impl Figure {
    /// All figures.
    pub const ALL: [Self; 3] = [Self::Largest, Self::RootMeanSquare, Self::Percentile];

    /// A word for it, fit for a file.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Largest => "largest",
            Self::RootMeanSquare => "rms",
            Self::Percentile => "p99_9",
        }
    }

    /// What a heading says.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Largest => "largest error",
            Self::RootMeanSquare => "root mean square error",
            Self::Percentile => "99.9th percentile of the error",
        }
    }

    /// The number.
    pub const fn of(self, errors: &ErrorFigures) -> f64 {
        match self {
            Self::Largest => errors.largest,
            Self::RootMeanSquare => errors.root_mean_square,
            Self::Percentile => errors.percentile_99_9,
        }
    }

    /// What rounding may leave of it: below, an error is as good as none. The root mean square is over channels most of which round
    /// to nearly nothing, hence a tenth.
    pub fn rounding(self) -> f64 {
        let single = f64::from(PixelDifference::ROUNDING);
        if self == Self::RootMeanSquare { single / 10.0 } else { single }
    }
}

/// Which settings no other one beats in both time and error: for each, whether it is on the frontier.
///
/// - `costs`: time and error of each setting; an error that is no number beats nothing
/// - `rounding`: errors up to here are equally good, so that the fastest of these ends the frontier
///
/// One that is as fast and as right as another leaves both there.
pub fn frontier(costs: &[(Duration, f64)], rounding: f64) -> Vec<bool> {
    let error_of = |error: f64| if error.is_nan() { f64::INFINITY } else { error.max(rounding) };
    let costs: Vec<(Duration, f64)> = costs.iter().map(|&(time, error)| (time, error_of(error))).collect();
    let beats = |a: &(Duration, f64), b: &(Duration, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    costs.iter().map(|cost| cost.1.is_finite() && !costs.iter().any(|other| beats(other, cost))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(costs: &[(u64, f64)], expected: &[bool]) {
        let costs: Vec<_> = costs.iter().map(|&(ms, error)| (Duration::from_millis(ms), error)).collect();
        assert_eq!(frontier(&costs, 1e-5), expected, "{costs:?}");
    }

    #[test]
    fn a_staircase() {
        check(
            &[(1, 0.5), (2, 0.1), (3, 0.2), (4, 0.01), (4, 0.02), (9, 0.01)],
            &[true, true, false, true, false, false],
        );
    }

    #[test]
    fn below_rounding_the_fastest_ends_it() {
        check(&[(5, 2e-6), (6, 1e-6), (9, 0.0), (4, 1e-3)], &[true, false, false, true]);
    }

    #[test]
    fn equals_stay_together_and_what_is_no_number_is_not_there() {
        check(&[(3, 0.1), (3, 0.1), (1, f64::NAN), (2, f64::INFINITY)], &[true, true, false, false]);
        check(&[], &[]);
    }
}
