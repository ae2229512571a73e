//! Names beside the points of the frontier, where there is room.

use std::fmt::Write;

use super::axes::{Axes, LEFT};
use crate::text::escaped;
use crate::{Figure, Study};

/// About the width of a text of the chart: a letter of a sans-serif font at 12 units.
pub(super) fn width(text: &str) -> f64 {
    text.chars().count() as f64 * 6.1
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
        let wide = width(&outcome.setting.name);
        let starts = [x + 10.0, x - 10.0 - wide, x - wide / 2.0];
        let heights = [y + 4.0, y - 10.0, y + 19.0, y - 24.0, y + 33.0];
        let places = heights.iter().flat_map(|&base| starts.iter().map(move |&start| (start, base)));
        let area = |(start, base): (f64, f64)| [start - 2.0, base - 11.0, start + wide + 2.0, base + 3.0];
        let is_free = |place: &(f64, f64)| {
            let area = area(*place);
            let is_inside = area[0] > LEFT && area[2] < axes.right() && area[1] > axes.top() && area[3] < axes.bottom();
            is_inside && !taken.iter().any(|other| overlap(&area, other))
        };
        let Some((start, base)) = places.into_iter().find(is_free) else { continue };
        taken.push(area((start, base)));
        let name = escaped(&outcome.setting.name);
        let _ = write!(svg, "<text class=\"label\" x=\"{start:.1}\" y=\"{base:.1}\">{name}</text>");
    }
    svg
}
