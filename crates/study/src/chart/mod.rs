//! The chart: error against time, both by the logarithm, a point for every setting, and the frontier.

mod axes;
mod labels;

use std::fmt::Write;

use tetrascope::TargetBits;

use crate::text::{error_text, escaped, ms_text, percent_text};
use crate::{Axis, Figure, Outcome, Place, Study};
use axes::{Axes, HEIGHT, WIDTH};

/// Colors and lines, for light and dark; the page has it in its own style sheet.
pub(crate) const STYLE: &str = include_str!("chart.css");

/// The chart alone, as a file that any browser or README shows, in light and in dark.
///
/// Deterministic for one study. The style is in it; there is no script and nothing is loaded.
pub fn chart_svg(study: &Study, figure: Figure) -> String {
    let style = format!("<style>{STYLE}svg.chart {{ background: var(--paper); }}</style>");
    chart(study, figure, &style)
}

/// The chart with something at its beginning.
pub(crate) fn chart(study: &Study, figure: Figure, head: &str) -> String {
    let axes = Axes::of(study, figure);
    let title = format!("{} against time of a frame, {} settings", figure.label(), study.outcomes.len());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" data-figure=\"{}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"group\" aria-label=\"{}\">{head}",
        figure.key(),
        escaped(&title)
    );
    svg.push_str(&axes.grid());
    svg.push_str(&frontier_line(study, figure, &axes));
    // The frontier last, so that it lies on top.
    let mut order: Vec<usize> = (0..study.outcomes.len()).collect();
    order.sort_by_key(|&index| study.outcomes[index].is_on_frontier(figure));
    for &index in &order {
        push_spread(&mut svg, &study.outcomes[index], figure, &axes);
    }
    for &index in &order {
        push_point(&mut svg, index, &study.outcomes[index], figure, &axes);
    }
    svg.push_str(&labels::labels(study, figure, &axes));
    svg.push_str(&legend(study));
    svg.push_str("</svg>");
    svg
}

/// Steps from each setting of the frontier to the next: the least error that so much time buys.
fn frontier_line(study: &Study, figure: Figure, axes: &Axes) -> String {
    let mut corners: Vec<(f64, f64)> = study
        .outcomes
        .iter()
        .filter(|outcome| outcome.is_on_frontier(figure))
        .map(|outcome| axes.place(outcome, figure))
        .collect();
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some(&(x, y)) = corners.first() else { return String::new() };
    let mut path = format!("M{x:.1} {:.1}V{y:.1}", axes.top());
    for (x, y) in &corners[1..] {
        let _ = write!(path, "H{x:.1}V{y:.1}");
    }
    format!("<path class=\"frontier\" d=\"{path}H{:.1}\"/>", axes.right())
}

/// From the fastest frame to the slowest.
fn push_spread(svg: &mut String, outcome: &Outcome, figure: Figure, axes: &Axes) {
    let (_, y) = axes.place(outcome, figure);
    let (from, to) = (axes.x(outcome.frame.fastest), axes.x(outcome.frame.slowest));
    let _ = write!(svg, "<path class=\"spread\" d=\"M{from:.1} {y:.1}H{to:.1}\"/>");
}

fn push_point(svg: &mut String, index: usize, outcome: &Outcome, figure: Figure, axes: &Axes) {
    let (x, y) = axes.place(outcome, figure);
    let on_frontier = outcome.is_on_frontier(figure);
    let kind = if on_frontier { " best" } else { "" };
    let label = escaped(&summary(outcome));
    let _ = write!(
        svg,
        "<g class=\"point {}{kind}\" data-index=\"{index}\" tabindex=\"0\" role=\"button\" aria-label=\"{label}\" transform=\"translate({x:.1} {y:.1})\"><title>{label}</title><circle class=\"hit\" r=\"9\"/>",
        outcome.setting.axis.key(),
    );
    if outcome.setting.is_scene {
        svg.push_str("<circle class=\"ring\" r=\"9\"/>");
    }
    let _ = write!(svg, "{}</g>", mark(outcome.setting.place, if on_frontier { 5.5 } else { 4.0 }));
}

/// The setting's name and its figures, a line each.
fn summary(outcome: &Outcome) -> String {
    let (frame, errors) = (outcome.frame, outcome.errors);
    let mut lines = vec![
        outcome.setting.name.clone(),
        format!("{} ms a frame, {} to {}", ms_text(frame.median), ms_text(frame.fastest), ms_text(frame.slowest)),
        format!("largest error {}", error_text(errors.largest)),
        format!("root mean square {}", error_text(errors.root_mean_square)),
        format!("99.9th percentile {}", error_text(errors.percentile_99_9)),
        format!("{} of the pixels above 1/255", percent_text(errors.share_above_step)),
    ];
    if let Some((stage, share)) = outcome.dominant() {
        lines.push(format!("{} of the time: {stage}", percent_text(share)));
    }
    if outcome.setting.is_scene {
        lines.push("what the scene asks for".to_owned());
    }
    lines.join("\n")
}

/// A shape that tells who draws.
fn mark(place: Place, radius: f64) -> String {
    let r = radius;
    match place {
        Place::Cpu => format!("<circle class=\"mark\" r=\"{r}\"/>"),
        Place::GpuCompute => {
            let (start, side) = (-0.9 * r, 1.8 * r);
            format!("<rect class=\"mark\" x=\"{start:.1}\" y=\"{start:.1}\" width=\"{side:.1}\" height=\"{side:.1}\"/>")
        }
        Place::GpuTriangles(bits) => {
            let up = if bits == TargetBits::ThirtyTwo { -1.0 } else { 1.0 };
            let (tip, base) = (up * 1.2 * r, up * -0.8 * r);
            format!("<path class=\"mark\" d=\"M0 {tip:.1}L{:.1} {base:.1}H{:.1}Z\"/>", 1.15 * r, -1.15 * r)
        }
    }
}

/// What colors and shapes mean, of those that are there.
fn legend(study: &Study) -> String {
    let mut svg = String::new();
    // Room for four lines: what is of one kind may take two.
    let mut at = (axes::LEFT, HEIGHT - 74.0);
    let mut entry = |class: &str, mark: &str, text: &str, (x, y): &mut (f64, f64)| {
        if *x + 18.0 + labels::width(text) > axes::RIGHT {
            (*x, *y) = (axes::LEFT, *y + 20.0);
        }
        let _ = write!(
            svg,
            "<g class=\"key {class}\" transform=\"translate({:.1} {:.1})\">{mark}<text x=\"12\" y=\"4\">{text}</text></g>",
            *x + 6.0,
            *y
        );
        *x += 32.0 + labels::width(text);
    };
    for axis in Axis::ALL {
        if study.outcomes.iter().any(|outcome| outcome.setting.axis == axis) {
            entry(axis.key(), &mark(Place::Cpu, 4.5), axis.label(), &mut at);
        }
    }
    at = (axes::LEFT, at.1 + 20.0);
    let mut places: Vec<Place> = Vec::new();
    for outcome in &study.outcomes {
        if !places.contains(&outcome.setting.place) {
            places.push(outcome.setting.place);
        }
    }
    for place in places {
        entry("place", &mark(place, 4.5), &place.to_string(), &mut at);
    }
    entry("line", "<path class=\"frontier\" d=\"M-6 0H7\"/>", "frontier: nothing else is faster and as right", &mut at);
    if study.outcomes.iter().any(|outcome| outcome.setting.is_scene) {
        entry("place", "<circle class=\"ring\" r=\"7\"/>", "what the scene asks for", &mut at);
    }
    svg
}
