//! The page: one file with charts, table and pictures, which loads nothing.

mod parts;

use tetrascope::PixelDifference;

use crate::chart::{STYLE, chart};
use crate::text::{error_text, escaped, ms_text};
use crate::{Figure, Outcome, Study};
use parts::{background_of, detail, image, left_out, measured, row};

const TEMPLATE: &str = include_str!("page.html");
const PAGE_STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The study as one page for a browser. It loads nothing and needs no network; without scripts it still shows chart, table and what was left out.
pub fn html(study: &Study) -> String {
    let chosen = chosen(study);
    let outcomes = || study.outcomes.iter().enumerate();
    let charts: String = Figure::ALL
        .iter()
        .map(|figure| {
            let hidden = if *figure == Figure::Largest { "" } else { " hidden" };
            format!("<div class=\"view\" data-figure=\"{}\"{hidden}>{}</div>", figure.key(), chart(study, *figure, ""))
        })
        .collect();
    let mut by_time: Vec<(usize, &Outcome)> = outcomes().collect();
    by_time.sort_by_key(|(_, outcome)| outcome.frame.median);
    let rows: String = by_time.into_iter().map(|(index, outcome)| row(index, outcome, index == chosen)).collect();
    let details: String = outcomes().map(|(index, outcome)| detail(study, index, outcome, index == chosen)).collect();
    let switches: String = Figure::ALL
        .iter()
        .map(|figure| {
            let checked = if *figure == Figure::Largest { " checked" } else { "" };
            let (key, label) = (figure.key(), figure.label());
            format!(
                "<label><input type=\"radio\" name=\"figure\" value=\"{key}\"{checked}><span>{label}</span></label>"
            )
        })
        .collect();
    let values = [
        ("title", escaped(&study.name)),
        ("style", format!("{STYLE}{PAGE_STYLE}")),
        ("facts", escaped(&facts(study))),
        ("answer", answer(study)),
        ("switches", switches),
        ("charts", charts),
        ("reference", image(&study.reference, background_of(study), "the exact picture")),
        ("details", details),
        ("rows", rows),
        ("left_out", left_out(study)),
        ("measured", measured(study)),
        ("script", SCRIPT.to_owned()),
    ];
    filled(TEMPLATE, &values)
}

/// The template with a value in the place of every `{{name}}`; values are taken as they are, even if they have such names in them.
fn filled(template: &str, values: &[(&str, String)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        let Some((name, after)) = after.split_once("}}") else { break };
        page.push_str(before);
        let value = values.iter().find(|(known, _)| *known == name);
        page.push_str(value.map_or("", |(_, value)| value));
        rest = after;
    }
    page.push_str(rest);
    page
}

/// The setting whose pictures are shown at first: what the scene asks for, else the answer, else the first.
fn chosen(study: &Study) -> usize {
    let own = study.outcomes.iter().position(|outcome| outcome.setting.is_scene);
    own.or_else(|| fastest_within(study, f64::from(PixelDifference::STEP))).unwrap_or_default()
}

fn fastest_within(study: &Study, error: f64) -> Option<usize> {
    let within = study.outcomes.iter().enumerate().filter(|(_, outcome)| outcome.errors.largest <= error);
    within.min_by_key(|(_, outcome)| outcome.frame.median).map(|(index, _)| index)
}

/// What most readers came for.
fn answer(study: &Study) -> String {
    let wishes = [(f64::from(PixelDifference::STEP), "1/255"), (1e-3, "0.001"), (1e-4, "0.0001")];
    let said = wishes.iter().map(|(error, name)| {
        let found = match fastest_within(study, *error) {
            Some(index) => {
                let outcome = &study.outcomes[index];
                let (name, ms) = (escaped(&outcome.setting.name), ms_text(outcome.frame.median));
                let error = error_text(outcome.errors.largest);
                format!("<dd><button type=\"button\" class=\"link\" data-index=\"{index}\">{name}</button><span>{ms} ms, error {error}</span></dd>")
            }
            None => "<dd>none of these settings</dd>".to_owned(),
        };
        format!("<div><dt>fastest within {name}</dt>{found}</div>")
    });
    said.collect()
}

/// The scene and the mesh in a line.
fn facts(study: &Study) -> String {
    let view = &study.start.view;
    let projection = if view.is_perspective { "perspective" } else { "orthographic" };
    let isosurfaces = match study.start.isosurfaces.as_ref().map_or(0, |one| one.surfaces.as_slice().len()) {
        0 => String::new(),
        1 => ", 1 isosurface".to_owned(),
        count => format!(", {count} isosurfaces"),
    };
    let [cells, points] = study.mesh;
    format!(
        "{} on {cells} tetrahedra with {points} points; {} × {} pixels, {projection}; {}{isosurfaces}",
        study.field, view.width, view.height, study.start.model
    )
}

#[cfg(test)]
mod tests {
    use super::filled;

    #[test]
    fn a_template_is_filled_once() {
        let values = [("a", "{{b}}".to_owned()), ("b", "x".to_owned())];
        assert_eq!(filled("<{{a}}> {{b}} {{c}}.", &values), "<{{b}}> x .");
        assert_eq!(filled("no end {{a", &values), "no end {{a");
    }
}
