//! Rows, pictures and lists of the page.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use tetrascope::{LinearImage, encode_png};

use crate::text::{bytes_text, error_text, escaped, ms_text, percent_text};
use crate::{Figure, Outcome, Study};

/// The scene's background, for its pictures.
pub(super) const fn background_of(study: &Study) -> [f32; 3] {
    study.start.background
}

/// A picture in the page itself.
pub(super) fn image(picture: &LinearImage, background: [f32; 3], what: &str) -> String {
    let Some(bytes) = encode_png(picture, background) else { return String::new() };
    let (width, height) = (picture.width(), picture.height());
    let data = STANDARD.encode(bytes);
    format!(
        "<img alt=\"{}\" width=\"{width}\" height=\"{height}\" src=\"data:image/png;base64,{data}\">",
        escaped(what)
    )
}

/// A line of the table. Cells carry the number that they are sorted by.
pub(super) fn row(index: usize, outcome: &Outcome, is_chosen: bool) -> String {
    let (setting, errors) = (&outcome.setting, &outcome.errors);
    let mut classes = String::new();
    for (figure, class) in Figure::ALL.iter().zip(["best-largest", "best-rms", "best-p99_9"]) {
        if outcome.is_on_frontier(*figure) {
            let _ = write!(classes, " {class}");
        }
    }
    if is_chosen {
        classes.push_str(" chosen");
    }
    let (stage, share) = outcome.dominant().unwrap_or(("", 0.0));
    let ms = |time: std::time::Duration| time.as_secs_f64() * 1e3;
    let number = |value: f64, text: String| format!("<td class=\"n\" data-value=\"{value:e}\">{text}</td>");
    let scene = if setting.is_scene { " <span class=\"tag\">the scene's own</span>" } else { "" };
    let mut html = format!(
        "<tr data-index=\"{index}\" class=\"{}{classes}\"><th scope=\"row\" data-value=\"{name}\"><button type=\"button\" class=\"link\" data-index=\"{index}\">{name}</button>{scene}</th>",
        setting.axis.key(),
        name = escaped(&setting.name),
    );
    html.push_str(&number(ms(outcome.frame.median), ms_text(outcome.frame.median)));
    for figure in Figure::ALL {
        html.push_str(&number(figure.of(errors), error_text(figure.of(errors))));
    }
    html.push_str(&number(errors.share_above_step, percent_text(errors.share_above_step)));
    html.push_str(&number(ms(outcome.set_up), ms_text(outcome.set_up)));
    html.push_str(&number(outcome.bytes() as f64, bytes_text(outcome.bytes())));
    let _ = write!(html, "<td data-value=\"{}\">{} {}</td></tr>", escaped(stage), escaped(stage), percent_text(share));
    html
}

/// What is shown of a setting that was chosen: its pictures, and where its time and memory go.
pub(super) fn detail(study: &Study, index: usize, outcome: &Outcome, is_chosen: bool) -> String {
    let name = escaped(&outcome.setting.name);
    let hidden = if is_chosen { "" } else { " hidden" };
    let errors = &outcome.errors;
    let mut html =
        format!("<article class=\"detail\" data-index=\"{index}\"{hidden}><h3>{name}</h3><div class=\"pictures\">");
    let picture = image(&outcome.picture, background_of(study), &format!("the picture of {name}"));
    let map = image(&outcome.difference, [0.0; 3], &format!("where {name} is wrong"));
    let at = format!("column {}, row {}", errors.at.0, errors.at.1);
    let _ = write!(
        html,
        "<figure>{picture}<figcaption>this setting</figcaption></figure><figure>{map}<figcaption>its error: largest {} at {at}</figcaption></figure></div>",
        error_text(errors.largest)
    );
    html.push_str(&time_bar(outcome));
    html.push_str("<dl class=\"figures\">");
    let (frame, counts) = (outcome.frame, outcome.counts);
    let memory: Vec<String> =
        outcome.memory.iter().map(|(what, bytes)| format!("{} {}", escaped(what), bytes_text(*bytes))).collect();
    let fragments = if counts.fragments > 0 { format!(", {} fragments", counts.fragments) } else { String::new() };
    let lines = [
        ("frame", format!("{} ms; {} to {}", ms_text(frame.median), ms_text(frame.fastest), ms_text(frame.slowest))),
        ("set-up", format!("{} ms more for the first frame", ms_text(outcome.set_up))),
        ("memory", format!("{}: {}", bytes_text(outcome.bytes()), memory.join(", "))),
        ("order", escaped(&outcome.order)),
        ("drawn", format!("{} of {} tetrahedra{fragments}", counts.drawn, counts.cells)),
    ];
    for (term, text) in lines {
        let _ = write!(html, "<div><dt>{term}</dt><dd>{text}</dd></div>");
    }
    if let Some(device) = &outcome.device {
        let _ = write!(html, "<div><dt>device</dt><dd>{}</dd></div>", escaped(device));
    }
    html.push_str("</dl></article>");
    html
}

/// Stages side by side, as wide as they take long; those under a hundredth are left to the list.
fn time_bar(outcome: &Outcome) -> String {
    let all: f64 = outcome.stages.iter().map(|(_, time)| time.as_secs_f64()).sum();
    if all <= 0.0 {
        return String::new();
    }
    let mut html = "<div class=\"bar\" role=\"img\" aria-label=\"where the time goes\">".to_owned();
    for (stage, time) in &outcome.stages {
        let share = time.as_secs_f64() / all;
        if share < 0.01 {
            continue;
        }
        let text = if share > 0.12 { format!("{} {}", escaped(stage), percent_text(share)) } else { String::new() };
        let title = format!("{}: {} ms, {}", escaped(stage), ms_text(*time), percent_text(share));
        let _ = write!(html, "<span style=\"flex-grow:{share:.4}\" title=\"{title}\">{text}</span>");
    }
    html.push_str("</div>");
    html
}

/// What is not in the study, a line each.
pub(super) fn left_out(study: &Study) -> String {
    if study.left_out.is_empty() {
        return "<p>Nothing.</p>".to_owned();
    }
    let line =
        |one: &crate::LeftOut| format!("<div><dt>{}</dt><dd>{}</dd></div>", escaped(&one.name), escaped(&one.reason));
    format!("<dl class=\"list\">{}</dl>", study.left_out.iter().map(line).collect::<String>())
}

/// How it was measured, and on what.
pub(super) fn measured(study: &Study) -> String {
    let devices = study.devices();
    let devices = if devices.is_empty() { "none".to_owned() } else { escaped(&devices.join("; ")) };
    let opened: String =
        study.opened.iter().map(|(place, time)| format!("; {place} ready after {} ms", ms_text(*time))).collect();
    let lines = [
        (
            "frames",
            format!(
                "{} of each setting over a turn of {} degrees about the middle of the mesh, all settings in turn; the middle one is the scene's own view, and its picture is compared",
                study.frames, study.turn_degrees
            ),
        ),
        (
            "reference",
            format!(
                "every ray against every cell in 64 bits, {} ms; errors are over red, green, blue and alpha",
                ms_text(study.reference_time)
            ),
        ),
        (
            "set-up",
            format!(
                "what the first frame took longer than the median; what settings share is paid by the first of them{opened}"
            ),
        ),
        (
            "memory",
            "of the CPU computed from what its renderer says of itself, of a GPU the sum of its buffers".to_owned(),
        ),
        (
            "machine",
            format!(
                "{} threads, {}, {}; devices: {devices}",
                study.threads,
                std::env::consts::ARCH,
                std::env::consts::OS
            ),
        ),
        ("version", format!("Tetrascope {}; the whole study took {:.1} s", crate::VERSION, study.took.as_secs_f64())),
    ];
    let line = |(term, text): &(&str, String)| format!("<div><dt>{term}</dt><dd>{text}</dd></div>");
    format!("<dl class=\"list\">{}</dl>", lines.iter().map(line).collect::<String>())
}
