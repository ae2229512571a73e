//! Where a time and an error are on the chart, and the lines behind them.

use std::fmt::Write;
use std::time::Duration;

use tetrascope::PixelDifference;

use crate::text::error_text;
use crate::{Figure, Outcome, Study};

/// The whole chart, in units that a browser scales.
pub(super) const WIDTH: f64 = 960.0;
pub(super) const HEIGHT: f64 = 640.0;
/// Where the plot begins.
pub(super) const LEFT: f64 = 76.0;
pub(super) const RIGHT: f64 = WIDTH - 20.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = HEIGHT - 140.0;

/// From numbers to places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    figure: Figure,
    /// Milliseconds at the left and at the right end, as logarithms to base 10.
    times: [f64; 2],
    /// Errors at the bottom and at the top, likewise; whole numbers.
    errors: [f64; 2],
    /// Whether errors lie below the bottom or above the top.
    is_beyond: [bool; 2],
}

impl Axes {
    /// Axes on which every setting has its place.
    pub(super) fn of(study: &Study, figure: Figure) -> Self {
        // A hundredth of what rounding leaves: smaller errors say nothing, and 0 has no logarithm.
        let least = figure.rounding() / 100.0;
        let errors = || study.outcomes.iter().map(|outcome| figure.of(&outcome.errors));
        let positive = || errors().filter(|error| error.is_finite() && *error > least);
        let lowest = positive().fold(f64::INFINITY, f64::min).min(figure.rounding());
        let highest = positive().fold(0.0, f64::max).max(figure.rounding() * 10.0);
        let has_less = errors().any(|error| error <= least);
        let bottom = if has_less { least.log10().round() } else { lowest.log10().floor() };
        let times = || study.outcomes.iter().flat_map(|outcome| [outcome.frame.fastest, outcome.frame.slowest]);
        let (fastest, slowest) = times()
            .map(log_ms)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), time| (low.min(time), high.max(time)));
        // A tenth of the width is left at both ends, and at least a factor of 1.5, for labels.
        let space = ((slowest - fastest) * 0.06).max(0.18);
        Self {
            figure,
            times: [fastest - space, slowest + space],
            errors: [bottom, highest.log10().ceil().max(bottom + 1.0)],
            is_beyond: [has_less, errors().any(|error| !error.is_finite())],
        }
    }

    pub(super) const fn top(&self) -> f64 {
        TOP
    }

    pub(super) const fn right(&self) -> f64 {
        RIGHT
    }

    pub(super) const fn bottom(&self) -> f64 {
        BOTTOM
    }

    pub(super) fn x(&self, time: Duration) -> f64 {
        self.x_of_log(log_ms(time))
    }

    fn x_of_log(&self, time: f64) -> f64 {
        let [low, high] = self.times;
        LEFT + (RIGHT - LEFT) * (time - low) / (high - low)
    }

    /// Errors beyond an end are at that end.
    pub(super) fn y(&self, error: f64) -> f64 {
        let [low, high] = self.errors;
        let log = if error > 0.0 { error.log10() } else { low };
        let log = if log.is_nan() { high } else { log.clamp(low, high) };
        BOTTOM - (BOTTOM - TOP) * (log - low) / (high - low)
    }

    /// Where a setting is.
    pub(super) fn place(&self, outcome: &Outcome, figure: Figure) -> (f64, f64) {
        (self.x(outcome.frame.median), self.y(figure.of(&outcome.errors)))
    }

    /// Lines, numbers and names of both axes.
    pub(super) fn grid(&self) -> String {
        let mut svg = String::new();
        let rounding = self.y(self.figure.rounding());
        if rounding < BOTTOM {
            let (width, height) = (RIGHT - LEFT, BOTTOM - rounding);
            let _ = write!(
                svg,
                "<rect class=\"rounding\" x=\"{LEFT}\" y=\"{rounding:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/><text class=\"note\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">rounding: as good as exact</text>",
                RIGHT - 6.0,
                BOTTOM - 7.0
            );
        }
        self.push_errors(&mut svg);
        self.push_times(&mut svg);
        let step = self.y(f64::from(PixelDifference::STEP));
        if step > TOP && step < BOTTOM {
            let _ = write!(
                svg,
                "<path class=\"step\" d=\"M{LEFT} {step:.1}H{RIGHT}\"/><text class=\"note\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">1/255: one step of an 8-bit picture</text>",
                RIGHT - 6.0,
                step - 5.0
            );
        }
        let middle = (TOP + BOTTOM) / 2.0;
        let _ = write!(
            svg,
            "<path class=\"axis\" d=\"M{LEFT} {TOP}V{BOTTOM}H{RIGHT}\"/><text class=\"name\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">milliseconds a frame (median; line: fastest to slowest)</text><text class=\"name\" transform=\"translate(16 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            (LEFT + RIGHT) / 2.0,
            BOTTOM + 40.0,
            self.figure.label()
        );
        svg
    }

    fn push_errors(&self, svg: &mut String) {
        let [low, high] = self.errors;
        for decade in low as i32..=high as i32 {
            let error = 10.0_f64.powi(decade);
            let y = self.y(error);
            let number = if decade >= -3 { format!("{error}") } else { format!("1e{decade}") };
            let text = match self.is_beyond {
                [true, _] if decade == low as i32 => format!("≤ {number}"),
                [_, true] if decade == high as i32 => error_text(f64::INFINITY),
                _ => number,
            };
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{LEFT} {y:.1}H{RIGHT}\"/><text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
                LEFT - 8.0,
                y + 4.0
            );
        }
    }

    fn push_times(&self, svg: &mut String) {
        let [low, high] = self.times;
        for decade in low.floor() as i32..=high.ceil() as i32 {
            for mantissa in 1..10 {
                let ms = f64::from(mantissa) * 10.0_f64.powi(decade);
                let log = ms.log10();
                if !(low..=high).contains(&log) {
                    continue;
                }
                let x = self.x_of_log(log);
                let _ = write!(svg, "<path class=\"grid\" d=\"M{x:.1} {TOP}V{BOTTOM}\"/>");
                // Over many decades the numbers between would run into one another.
                let is_named = match high - low {
                    decades if decades < 1.0 => mantissa < 7 || mantissa == 8,
                    decades if decades < 3.0 => matches!(mantissa, 1 | 2 | 5),
                    _ => mantissa == 1,
                };
                if is_named {
                    let text = if ms >= 0.999 { format!("{ms:.0}") } else { format!("{}", (ms * 1e6).round() / 1e6) };
                    let y = BOTTOM + 18.0;
                    let _ = write!(
                        svg,
                        "<text class=\"tick\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">{text}</text>"
                    );
                }
            }
        }
    }
}

/// Milliseconds as a logarithm; a time that no clock saw counts as a microsecond.
fn log_ms(time: Duration) -> f64 {
    (time.as_secs_f64() * 1e3).max(1e-3).log10()
}
