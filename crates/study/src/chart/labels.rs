//! Names beside the points of the frontier, where there is room.

use std::fmt::Write;

use super::axes::{Axes, LEFT};
use crate::text::escaped;
use crate::{Figure, Study};

/// About the width of a text of the chart: a letter of a wide sans-serif font at 12 units, and of a bold one.
pub(super) fn width(text: &str) -> f64 {
    text.chars().count() as f64 * 6.7
}

fn bold_width(text: &str) -> f64 {
    text.chars().count() as f64 * 7.2
}

/// Left, top, right, bottom.
type Area = [f64; 4];

const fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Names of the frontier, none over a point or another name; one that finds no room is left to the hover.
pub(super) fn labels(study: &Study, figure: Figure, axes: &Axes) -> String {
    let mut taken: Vec<Area> = Vec::new();
    for outcome in &study.outcomes {
        let (x, y) = axes.place(outcome, figure);
        taken.push([x - 5.0, y - 5.0, x + 5.0, y + 5.0]);
    }
    let mut svg = String::new();
    for outcome in study.outcomes.iter().filter(|outcome| outcome.is_on_frontier(figure)) {
        let (x, y) = axes.place(outcome, figure);
        // The mark has the place already.
        let place = format!(", {}", outcome.setting.place);
        let name = outcome.setting.name.strip_suffix(&place).unwrap_or(&outcome.setting.name);
        let wide = bold_width(name);
        // To the lower left of the frontier there is no point. A text is bound to the end that is near its point, as its width is a guess.
        let ends = [(x - 8.0, "end"), (x + 8.0, "start"), (x, "middle")];
        let heights = [y + 15.0, y - 9.0, y + 4.0, y + 30.0, y - 24.0, y + 45.0];
        let places = heights.iter().flat_map(|&base| ends.iter().map(move |&end| (end, base)));
        let area = |((end, anchor), base): ((f64, &str), f64)| {
            let left = match anchor {
                "end" => end - wide,
                "start" => end,
                _ => end - wide / 2.0,
            };
            [left, base - 11.0, left + wide, base + 3.0]
        };
        let is_free = |place: &((f64, &str), f64)| {
            let area = area(*place);
            let is_inside = area[0] > LEFT && area[2] < axes.right() && area[1] > axes.top() && area[3] < axes.bottom();
            is_inside && !taken.iter().any(|other| overlap(&area, other))
        };
        let Some(found) = places.into_iter().find(is_free) else { continue };
        taken.push(area(found));
        let ((end, anchor), base) = found;
        let text = escaped(name);
        let _ =
            write!(svg, "<text class=\"label\" x=\"{end:.1}\" y=\"{base:.1}\" text-anchor=\"{anchor}\">{text}</text>");
    }
    svg
}
