//! The study as a table for spreadsheets.

use std::time::Duration;

use tetrascope::{GpuPath, Integration, LengthAxis, Plan, TargetBits};

use crate::{Figure, Outcome, Study};

/// Columns of [`csv`], in its first line.
const COLUMNS: [&str; 31] = [
    "name",
    "backend",
    "gpu_path",
    "target_bits",
    "integration",
    "table_scalars",
    "table_lengths",
    "length_axis",
    "order",
    "cycles",
    "interpolation",
    "isosurfaces",
    "is_scene",
    "frontier_largest",
    "frontier_rms",
    "frontier_p99_9",
    "largest_error",
    "rms_error",
    "p99_9_error",
    "share_above_1_255",
    "ms_median",
    "ms_fastest",
    "ms_slowest",
    "setup_ms",
    "memory_bytes",
    "dominated_by",
    "dominated_share",
    "order_guarantee",
    "cells_drawn",
    "fragments",
    "device",
];

/// One line a setting, in the order of the study, behind one of names. Fields as RFC 4180 has them: commas between, quotes where they are needed.
///
/// What a setting does not have is empty; errors that are no number are `inf`.
pub fn csv(study: &Study) -> String {
    let mut text = COLUMNS.join(",");
    text.push_str("\r\n");
    for outcome in &study.outcomes {
        let fields = fields_of(outcome).map(|field| quoted(&field));
        text.push_str(&fields.join(","));
        text.push_str("\r\n");
    }
    text
}

fn fields_of(outcome: &Outcome) -> [String; 31] {
    let plan = &outcome.setting.plan;
    let errors = &outcome.errors;
    let [scalars, lengths, axis] = tables_of(plan);
    let (stage, share) = outcome.dominant().map_or_else(Default::default, |(stage, share)| (stage, share.to_string()));
    let frontier = |figure| outcome.is_on_frontier(figure).to_string();
    let text = |option: Option<String>| option.unwrap_or_default();
    [
        outcome.setting.name.clone(),
        plan.backend.to_string(),
        text(plan.gpu.path.map(|path: GpuPath| path.to_string())),
        text(plan.gpu.target_bits.map(|bits: TargetBits| bits.bits().to_string())),
        plan.integration.to_string(),
        scalars,
        lengths,
        axis,
        crate::setting::order_name(plan.order),
        plan.cycles.to_string(),
        plan.interpolation.to_string(),
        text(plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.method.name().to_owned())),
        outcome.setting.is_scene.to_string(),
        frontier(Figure::Largest),
        frontier(Figure::RootMeanSquare),
        frontier(Figure::Percentile),
        errors.largest.to_string(),
        errors.root_mean_square.to_string(),
        errors.percentile_99_9.to_string(),
        errors.share_above_step.to_string(),
        ms(outcome.frame.median),
        ms(outcome.frame.fastest),
        ms(outcome.frame.slowest),
        ms(outcome.set_up),
        outcome.bytes().to_string(),
        stage.to_owned(),
        share,
        outcome.order.clone(),
        outcome.counts.drawn.to_string(),
        outcome.counts.fragments.to_string(),
        text(outcome.device.clone()),
    ]
}

fn ms(time: Duration) -> String {
    format!("{:.4}", time.as_secs_f64() * 1e3)
}

fn tables_of(plan: &Plan) -> [String; 3] {
    let Some(tables) = plan.table_settings() else { return Default::default() };
    if plan.integration != Integration::Table3d {
        return [tables.scalars.to_string(), String::new(), String::new()];
    }
    [tables.scalars.to_string(), tables.lengths.to_string(), length_axis_name(tables.length_axis).to_owned()]
}

pub(crate) const fn length_axis_name(axis: LengthAxis) -> &'static str {
    match axis {
        LengthAxis::Linear => "linear",
        LengthAxis::Logarithmic => "logarithmic",
    }
}

/// A field in quotes if it has to be.
fn quoted(field: &str) -> String {
    if field.contains(['"', ',', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn quotes_where_they_are_needed() {
        for (field, expected) in [
            ("plain", "plain"),
            ("", ""),
            ("a, b", "\"a, b\""),
            ("5\" wide", "\"5\"\" wide\""),
            ("two\nlines", "\"two\nlines\""),
        ] {
            assert_eq!(quoted(field), expected);
        }
    }
}
