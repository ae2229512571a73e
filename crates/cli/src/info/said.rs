//! What is known of a file, for machines.

use serde_json::{Map, Value, json};

use super::Facts;
use super::histogram::Histogram;
use crate::kinds::{kinds, name_of};

impl Facts {
    pub(super) fn as_json(&self) -> Value {
        let loaded = &self.loaded;
        let kinds: Map<String, Value> =
            kinds(&loaded.dataset).into_iter().map(|(kind, count)| (name_of(kind), json!(count))).collect();
        let arrays: Vec<Value> = self
            .arrays
            .iter()
            .map(|array| {
                json!({ "name": array.name, "association": array.association.to_string(), "type": array.type_name,
                    "components": array.components, "tuples": array.tuples, "non_finite": array.non_finite,
                    "range": array.range.map(|(low, high)| [low, high]) })
            })
            .collect();
        let mut out = json!({ "file": self.path.display().to_string(), "format": loaded.format,
            "times": loaded.times, "step": loaded.step, "time": loaded.times.get(loaded.step),
            "points": loaded.dataset.points.len(), "cells": kinds, "arrays": arrays, "warnings": loaded.warnings,
            "histogram": self.histogram.as_ref().map(|histogram| match histogram {
                Ok(histogram) => of_histogram(histogram),
                Err(problem) => json!({ "error": problem }),
            }) });
        let more = match &self.report {
            Ok(report) => json!({ "tetrahedra": report.tetrahedra, "tetrahedra_cut": report.decomposition.tetrahedra,
                "tetrahedra_without_volume": report.decomposition.no_volume, "volume": report.volume_world,
                "bounds": report.bounds_world.map(|(low, high)| [low.to_array(), high.to_array()]),
                "boundary_faces": report.boundary_faces, "connected_parts": report.connected_parts,
                "findings": report.findings() }),
            Err(error) => json!({ "tetrahedra": 0, "error": error }),
        };
        if let (Value::Object(out), Value::Object(more)) = (&mut out, more) {
            out.extend(more);
        }
        out
    }
}

fn of_histogram(histogram: &Histogram) -> Value {
    json!({ "field": histogram.name, "association": histogram.association.to_string(),
        "range": histogram.range.map(|(low, high)| [low, high]), "bins": histogram.counts.len(),
        "counts": histogram.counts, "non_finite": histogram.non_finite })
}
