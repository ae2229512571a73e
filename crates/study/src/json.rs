//! The study for machines.

use std::time::Duration;

use serde_json::{Value, json};
use tetrascope::{Integration, Plan};

use crate::csv::length_axis_name;
use crate::setting::order_name;
use crate::{Figure, Outcome, Study};

/// The study as one JSON object: `settings` has one entry a setting, in the order of the study.
///
/// Times are milliseconds, memory bytes, errors absolute in the units of the picture and `null` where a channel is no number.
pub fn json(study: &Study) -> Value {
    let left_out: Vec<Value> =
        study.left_out.iter().map(|one| json!({ "name": one.name, "reason": one.reason })).collect();
    let opened: Vec<Value> =
        study.opened.iter().map(|(place, time)| json!({ "place": place.to_string(), "ms": ms(*time) })).collect();
    let view = &study.start.view;
    json!({
        "scene": {
            "name": study.name,
            "field": study.field,
            "cells": study.mesh[0],
            "points": study.mesh[1],
            "scalar_range": [study.facts.scalar_range.0, study.facts.scalar_range.1],
            "width": view.width,
            "height": view.height,
            "projection": if view.is_perspective { "perspective" } else { "orthographic" },
            "model": study.start.model.to_string(),
            "isosurfaces": study.start.isosurfaces.as_ref().map_or(0, |isosurfaces| isosurfaces.surfaces.as_slice().len()),
        },
        "machine": {
            "threads": study.threads,
            "devices": study.devices(),
            "architecture": std::env::consts::ARCH,
            "system": std::env::consts::OS,
        },
        "version": crate::VERSION,
        "frames": study.frames,
        "turn_degrees": study.turn_degrees,
        "reference_ms": ms(study.reference_time),
        "took_ms": ms(study.took),
        "opened": opened,
        "settings": study.outcomes.iter().map(of_outcome).collect::<Vec<_>>(),
        "left_out": left_out,
    })
}

fn of_outcome(outcome: &Outcome) -> Value {
    let (setting, errors, counts) = (&outcome.setting, &outcome.errors, &outcome.counts);
    let plan = &setting.plan;
    let frontier: serde_json::Map<String, Value> =
        Figure::ALL.iter().map(|figure| (figure.key().to_owned(), json!(outcome.is_on_frontier(*figure)))).collect();
    let stages: Vec<Value> =
        outcome.stages.iter().map(|(stage, time)| json!({ "stage": stage, "ms": ms(*time) })).collect();
    let memory: Vec<Value> =
        outcome.memory.iter().map(|(what, bytes)| json!({ "what": what, "bytes": bytes })).collect();
    json!({
        "name": setting.name,
        "backend": plan.backend.to_string(),
        "gpu_path": plan.gpu.path.map(|path| path.to_string()),
        "target_bits": plan.gpu.target_bits.map(|bits| bits.bits()),
        "integration": plan.integration.to_string(),
        "table": table_of(plan),
        "order": order_name(plan.order),
        "cycles": plan.cycles.to_string(),
        "interpolation": plan.interpolation.to_string(),
        "isosurfaces": plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.method.name()),
        "is_scene": setting.is_scene,
        "differs_in": setting.axis.key(),
        "frontier": frontier,
        "errors": {
            "largest": errors.largest, "at": [errors.at.0, errors.at.1], "rms": errors.root_mean_square,
            "p99_9": errors.percentile_99_9, "share_above_1_255": errors.share_above_step,
        },
        "frame_ms": {
            "median": ms(outcome.frame.median), "fastest": ms(outcome.frame.fastest), "slowest": ms(outcome.frame.slowest),
        },
        "setup_ms": ms(outcome.set_up),
        "stages": stages,
        "memory": memory,
        "memory_bytes": outcome.bytes(),
        "order_guarantee": outcome.order,
        "cells_drawn": counts.drawn,
        "fragments": counts.fragments,
        "crossings": counts.crossings,
        "sorted": counts.sorted,
        "device": outcome.device,
    })
}

fn table_of(plan: &Plan) -> Value {
    let Some(tables) = plan.table_settings() else { return Value::Null };
    if plan.integration != Integration::Table3d {
        return json!({ "scalars": tables.scalars });
    }
    json!({ "scalars": tables.scalars, "lengths": tables.lengths, "length_axis": length_axis_name(tables.length_axis) })
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
