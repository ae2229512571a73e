//! Points of maps and curves, checked once.

use crate::error::ColorError;

/// How far a color or opacity may lie outside of 0 to 1 before it is an error: what rounding and mixing in other programs leave. It is
/// clamped.
const SLACK: f64 = 1e-3;

/// Where points come from, for messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin<'a> {
    pub(crate) file: &'a str,
    /// The preset's name; may be empty.
    pub(crate) preset: &'a str,
}

impl Origin<'_> {
    pub(crate) fn invalid(&self, place: &str, problem: impl Into<String>, remedy: &str) -> ColorError {
        let place = match (self.preset, place) {
            ("", place) => place.to_owned(),
            (preset, "") => format!("preset \"{}\"", crate::error::shown(preset)),
            (preset, place) => format!("preset \"{}\", {place}", crate::error::shown(preset)),
        };
        ColorError::Invalid { file: self.file.to_owned(), place, problem: problem.into(), remedy: remedy.to_owned() }
    }

    /// A share from 0 to 1, what rounding left clamped.
    pub(crate) fn share(&self, place: &str, what: &str, value: f64) -> Result<f64, ColorError> {
        if !(-SLACK..=1.0 + SLACK).contains(&value) {
            let remedy = if (1.0..=255.0).contains(&value) && what != "sharpness" && what != "midpoint" {
                "write it as a share of 1; values from 0 to 255 are divided by 255"
            } else {
                "correct it, or save the preset again"
            };
            return Err(self.invalid(place, format!("the {what} is {value}, not between 0 and 1"), remedy));
        }
        Ok(value.clamp(0.0, 1.0))
    }
}

/// Places on an axis brought to 0 to 1: the lowest becomes 0 and the highest 1. Points are sorted, those at one place as they
/// came, since two of them make a step.
///
/// - `what`: the kind of point, for messages
///
/// A single point lies at 0. Errors: no point, a number that is not finite, several points that all lie at one place.
pub(crate) fn normalize<T>(
    origin: Origin<'_>,
    what: &str,
    mut points: Vec<(f64, T)>,
) -> Result<Vec<(f64, T)>, ColorError> {
    const REMEDY: &str = "correct it, or save the preset again";
    if let Some((number, (x, _))) = points.iter().enumerate().find(|(_, (x, _))| !x.is_finite()) {
        let problem = format!("its position is {x}, not a finite number");
        return Err(origin.invalid(&format!("{what} {}", number + 1), problem, REMEDY));
    }
    points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (Some(&(lowest, _)), Some(&(highest, _))) = (points.first(), points.last()) else {
        return Err(origin.invalid("", format!("it has no {what}"), "give it one at least"));
    };
    if points.len() > 1 && lowest >= highest {
        let problem = format!("all {} {what}s lie at {lowest}", points.len());
        return Err(origin.invalid("", problem, "spread them out, or leave one"));
    }
    // Halves, so that the distance of the ends is finite.
    let width = 0.5 * highest - 0.5 * lowest;
    for (x, _) in &mut points {
        *x = if width > 0.0 { ((0.5 * *x - 0.5 * lowest) / width).clamp(0.0, 1.0) } else { 0.0 };
    }
    Ok(points)
}
