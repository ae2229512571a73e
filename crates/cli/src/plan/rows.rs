//! What `tetrascope plan` says, as rows and as JSON.

use serde_json::{Value, json};
use tetrascope::order::PixelSort;
use tetrascope::{
    Backend, Bytes, Decision, Gradients, Interpolation, OrderMethod, Plan, Stage, Volume, VolumeField, Work, short,
};

/// A line of the report.
pub(super) struct Row {
    pub(super) subject: &'static str,
    pub(super) text: String,
}

/// All of it.
pub(super) struct Said {
    pub(super) rows: Vec<Row>,
    pub(super) json: Value,
    pub(super) warnings: Vec<String>,
}

/// Whether something is done, which, why, and what it takes.
struct Effect {
    name: &'static str,
    /// `None` where it is left out.
    choice: Option<String>,
    reason: String,
    cost: String,
}

impl Effect {
    fn row(&self) -> String {
        let choice = self.choice.as_deref().unwrap_or("left out");
        let cost = if self.cost.is_empty() { String::new() } else { format!(" [{}]", self.cost) };
        format!("{choice}: {}{cost}", self.reason)
    }

    fn json(&self) -> Value {
        json!({ "effect": self.name, "is_done": self.choice.is_some(), "choice": self.choice, "reason": self.reason,
            "cost": self.cost })
    }
}

/// Says what is planned.
pub(super) fn say(volume: &Volume, field: &VolumeField<'_>, plan: &Plan, work: &Work, threads: Option<usize>) -> Said {
    let threads = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let effects = effects(plan, work);
    let mut rows = vec![
        row("mesh", format!("{} ({})", volume.source_name, volume.format)),
        row("field", field.field.name.clone()),
        row("picture", format!("{} x {} pixels", plan.view.width, plan.view.height)),
        row("model", plan.model.to_string()),
        row("backend", backend_of(plan, threads)),
    ];
    rows.extend(effects.iter().map(|effect| row(effect.name, effect.row())));
    let drawn = work.drawn_at_most();
    rows.push(row(
        "cells",
        format!(
            "{} tetrahedra: {} left out since nothing shows in them, {} of the others since they are out of view, {drawn} at most are \
             drawn",
            work.cells, work.transparent, work.outside
        ),
    ));
    rows.push(row("fragments", fragments_of(work)));
    let stages: Vec<String> = work.stages.iter().map(Stage::to_string).collect();
    rows.push(row("stages", stages.join(", ")));
    for buffer in &work.buffers {
        rows.push(row("memory", format!("{}: {} bytes, {}", buffer.label, bytes_of(buffer.bytes), buffer.role)));
    }
    let total: u64 = work.buffers.iter().map(|buffer| buffer.bytes.number()).sum();
    rows.push(row("", format!("{} MiB in all, about", short(total as f64 / f64::from(1 << 20)))));

    let decisions: Vec<Value> = plan
        .decisions
        .iter()
        .map(|d| json!({ "subject": d.subject, "choice": d.choice, "reason": d.reason }))
        .collect();
    let buffers: Vec<Value> = work
        .buffers
        .iter()
        .map(|b| {
            json!({ "label": b.label, "role": b.role.to_string(), "bytes": b.bytes.number(), "bound": bound_of(b.bytes) })
        })
        .collect();
    let table = work.table.map(|table| {
        json!({ "scalars": table.scalars, "lengths": table.lengths, "entries": table.entries(), "bytes": table.bytes() })
    });
    let maps = work.maps.map(
        |maps| json!({ "count": maps.count, "size": maps.size, "entries": maps.entries(), "bytes": maps.bytes() }),
    );
    let json = json!({
        "mesh": { "path": volume.source_name, "format": volume.format, "points": work.points, "tetrahedra": work.cells },
        "field": { "name": field.field.name, "range": [field.on_mesh.range.0, field.on_mesh.range.1] },
        "image": { "width": plan.view.width, "height": plan.view.height },
        "model": plan.model.to_string(),
        "backend": plan.backend.to_string(),
        "threads": threads,
        "effects": effects.iter().map(Effect::json).collect::<Vec<_>>(),
        "decisions": decisions,
        "cells": { "all": work.cells, "transparent": work.transparent, "outside": work.outside, "drawn_at_most": drawn },
        "fragments": { "estimate": work.fragments.estimate, "standard_error": work.fragments.standard_error,
            "sampled": work.fragments.sampled },
        "table": table,
        "maps": maps,
        "stages": stages,
        "buffers": buffers,
    });
    Said { rows, json, warnings: Vec::new() }
}

fn row(subject: &'static str, text: String) -> Row {
    Row { subject, text }
}

fn backend_of(plan: &Plan, threads: usize) -> String {
    let with = match plan.backend {
        Backend::Gpu => String::new(),
        Backend::Cpu | Backend::Reference => format!(", {threads} thread{}", if threads == 1 { "" } else { "s" }),
    };
    let reason = decision(plan, "backend").map_or_else(String::new, |d| format!(": {}", d.reason));
    format!("{}{with}{reason}", plan.backend)
}

fn decision<'a>(plan: &'a Plan, subject: &str) -> Option<&'a Decision> {
    plan.decisions.iter().find(|decision| decision.subject == subject)
}

fn reason_of(plan: &Plan, subject: &str, otherwise: &str) -> String {
    decision(plan, subject).map_or_else(|| otherwise.to_owned(), |decision| decision.reason.clone())
}

/// Everything that a picture may have, done or left out.
fn effects(plan: &Plan, work: &Work) -> Vec<Effect> {
    let drawn = work.drawn_at_most();
    let model = format!("the model {}", plan.model);
    let of_model = |name, needs: bool, doing: &str| Effect {
        name,
        choice: needs.then(|| doing.to_owned()),
        reason: if needs { format!("{model} has it") } else { format!("{model} ignores it") },
        cost: String::new(),
    };
    vec![
        of_model("emission", plan.model.needs_emission(), "light of the volume is gathered"),
        of_model("absorption", plan.model.needs_extinction(), "what is behind is hidden"),
        integration(plan, work),
        Effect {
            name: "pre-integration",
            choice: work.table.map(|table| match table.lengths {
                Some(lengths) => format!("a table of {0} x {0} x {lengths}", table.scalars),
                None => format!("a table of {0} x {0}", table.scalars),
            }),
            reason: if work.table.is_some() {
                "the integration looks light up".to_owned()
            } else {
                "the integration looks nothing up".to_owned()
            },
            cost: work.table.map_or_else(String::new, |table| {
                format!("{} entries integrated once, {} bytes", table.entries(), table.bytes())
            }),
        },
        isosurfaces(plan, work),
        Effect {
            name: "surfaces",
            choice: None,
            reason: "the scene has no geometry in the volume".to_owned(),
            cost: String::new(),
        },
        lighting(plan, work),
        order(plan, work, drawn),
        pixel_sort(work),
        perspective(plan),
    ]
}

fn integration(plan: &Plan, work: &Work) -> Effect {
    let cost = if work.makes_fans {
        format!("a fan of triangles for each of at most {} cells", work.drawn_at_most())
    } else {
        format!("about {:.0} segments", work.fragments.estimate)
    };
    Effect {
        name: "integration",
        choice: Some(plan.integration.to_string()),
        reason: reason_of(plan, "integration", "asked for"),
        cost,
    }
}

fn isosurfaces(plan: &Plan, work: &Work) -> Effect {
    let choice =
        (work.surfaces > 0).then(|| decision(plan, "isosurfaces").map(|d| d.choice.clone()).unwrap_or_default());
    let cost = match (work.surfaces, work.maps) {
        (0, _) => String::new(),
        (_, Some(maps)) => format!("{} texels, {} bytes", maps.entries(), maps.bytes()),
        (count, None) => format!("up to {count} crossings a ray and cell"),
    };
    Effect { name: "isosurfaces", choice, reason: reason_of(plan, "isosurfaces", "the scene has none"), cost }
}

fn lighting(plan: &Plan, work: &Work) -> Effect {
    let (choice, cost) = match work.gradients {
        Gradients::None => (None, String::new()),
        Gradients::Cells => (Some("with one gradient a cell"), "set up with the cells that a surface cuts".to_owned()),
        Gradients::Points => {
            (Some("with one gradient a point"), format!("{} gradients, computed once and kept", work.points))
        }
    };
    let reason = if work.gradients == Gradients::None {
        reason_of(plan, "gradients", "nothing is lit")
    } else {
        reason_of(plan, "light", "asked for")
    };
    Effect { name: "lighting", choice: choice.map(str::to_owned), reason, cost }
}

fn order(plan: &Plan, work: &Work, drawn: u64) -> Effect {
    let choice = work.sorts_cells.then(|| plan.order.to_string());
    let reason = match (plan.backend, plan.order) {
        (Backend::Reference, _) => "pixels sort what their rays meet".to_owned(),
        _ if plan.commutes() && !work.sorts_cells => {
            "the light of all cells adds up to the same sum in any order".to_owned()
        }
        (_, OrderMethod::PerPixel) => "pixels sort what their rays meet".to_owned(),
        _ => reason_of(plan, "order", "asked for"),
    };
    let cost = if !work.sorts_cells {
        String::new()
    } else if plan.backend == Backend::Gpu {
        format!("up to {} cells sorted, again when the view changes", work.cells)
    } else {
        format!("up to {drawn} cells sorted in every frame")
    };
    Effect { name: "order", choice, reason, cost }
}

fn pixel_sort(work: &Work) -> Effect {
    let (choice, reason) = match work.pixel_sort {
        PixelSort::All => (Some("all segments of a pixel".to_owned()), "no order of cells is used"),
        PixelSort::Window(window) => (Some(format!("within {window} segments")), "the order is mended pixel by pixel"),
        PixelSort::None if work.sorts_rings => {
            (None, "cells come in order; only where some hide one another in rings do pixels sort, or are cells cut")
        }
        PixelSort::None => (None, "cells come in order, or it does not matter"),
    };
    Effect { name: "sorting in pixels", choice, reason: reason.to_owned(), cost: String::new() }
}

fn perspective(plan: &Plan) -> Effect {
    let (choice, reason) = match (plan.view.is_perspective, plan.interpolation) {
        (false, _) => (None, "parallel rays: what is linear in space is linear on the screen"),
        (true, Interpolation::Exact) => (Some("exact"), "both ends of a segment have their own depth"),
        (true, Interpolation::Perspective) => {
            (Some("by the depth of the front"), "asked for; the back is not where it puts it")
        }
        (true, Interpolation::Screen) => (None, "asked for: linear on the screen, which perspective makes wrong"),
    };
    Effect {
        name: "perspective correction",
        choice: choice.map(str::to_owned),
        reason: reason.to_owned(),
        cost: String::new(),
    }
}

fn fragments_of(work: &Work) -> String {
    let fragments = work.fragments;
    let spread = if fragments.standard_error > 0.0 {
        format!(", give or take {:.0}", 2.0 * fragments.standard_error)
    } else {
        String::new()
    };
    format!(
        "about {:.0}{spread}, {} a pixel: an estimate from the outlines of {} cells; fewer where pixels become opaque",
        fragments.estimate,
        short(fragments.estimate / work.pixels.max(1) as f64),
        fragments.sampled
    )
}

fn bound_of(bytes: Bytes) -> &'static str {
    match bytes {
        Bytes::Exact(_) => "exact",
        Bytes::AtMost(_) => "at most",
        Bytes::AtLeast(_) => "at least",
        Bytes::About(_) => "about",
    }
}

fn bytes_of(bytes: Bytes) -> String {
    match bytes {
        Bytes::Exact(number) => number.to_string(),
        other => format!("{} {}", bound_of(other), other.number()),
    }
}
