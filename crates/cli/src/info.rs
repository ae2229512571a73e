//! `tetrascope info`: what is in a mesh file, and what is wrong with it.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};
use tetrascope::mesh::{FaceAdjacency, MeshReport, check};
use tetrascope::{
    ArraySummary, CellKind, Cells, Dataset, Loaded, ReadOptions, decompose, read_mesh, short, summarize_arrays,
};

use crate::Failure;
use crate::args::InfoArgs;
use crate::report::{line, object};

pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let [path, rest @ ..] = args.input.as_slice() else {
        return Err(Failure::Usage("name a file".to_owned()));
    };
    let loaded = read_mesh(path, &ReadOptions::with_solution(rest.first().map(std::path::PathBuf::as_path)))
        .map_err(tetrascope::Error::Io)?;
    let arrays = summarize_arrays(&loaded.dataset);
    // What was read is worth telling even where nothing can be drawn.
    let report = decompose(&loaded.dataset)
        .map(|decomposition| check(&decomposition, &FaceAdjacency::new(decomposition.mesh.tetrahedra())))
        .map_err(|error| error.to_string());
    if args.json {
        object(&as_json(path, &loaded, &arrays, &report));
    } else {
        print(path, &loaded, &arrays, &report);
    }
    report.map(|_| ()).map_err(|error| Failure::Input(format!("{}: {error}", path.display())))
}

fn print(path: &Path, loaded: &Loaded, arrays: &[ArraySummary], report: &Result<MeshReport, String>) {
    let say = |subject: &str, text: &str| line(&format!("{subject:<12}{text}"));
    say("file", &path.display().to_string());
    say("format", &loaded.format);
    say("points", &loaded.dataset.points.len().to_string());
    let kinds = kinds(&loaded.dataset);
    let count: usize = kinds.values().sum();
    say("cells", &count.to_string());
    for (kind, count) in &kinds {
        say("", &format!("{count:>10}  {}", name_of(*kind)));
    }
    if let Ok(report) = report {
        let counts = &report.decomposition;
        let without_volume = match counts.no_volume {
            0 => String::new(),
            n => format!(", of which {n} have no volume"),
        };
        say("tetrahedra", &format!("{}{without_volume}; {} to draw", counts.tetrahedra, report.tetrahedra));
        if let Some((low, high)) = report.bounds_world {
            for (axis, low, high) in [("x", low.x, high.x), ("y", low.y, high.y), ("z", low.z, high.z)] {
                say(if axis == "x" { "bounds" } else { "" }, &format!("{axis} {} to {}", short(low), short(high)));
            }
        }
        say("volume", &short(report.volume_world));
        say("boundary", &format!("{} faces, {} connected parts", report.boundary_faces, report.connected_parts));
    }
    if arrays.is_empty() {
        say("arrays", "none: there is no scalar to draw");
    }
    for (index, array) in arrays.iter().enumerate() {
        say(if index == 0 { "arrays" } else { "" }, &format!("{array}, {}", array.type_name));
    }
    let empty = Vec::new();
    let findings = report.as_ref().map_or(empty, MeshReport::findings);
    let odd: Vec<&String> = loaded.warnings.iter().chain(&findings).collect();
    if odd.is_empty() && report.is_ok() {
        say("findings", "none: the mesh is sound");
    }
    for (index, finding) in odd.into_iter().enumerate() {
        say(if index == 0 { "findings" } else { "" }, finding);
    }
}

fn as_json(path: &Path, loaded: &Loaded, arrays: &[ArraySummary], report: &Result<MeshReport, String>) -> Value {
    let kinds: serde_json::Map<String, Value> =
        kinds(&loaded.dataset).into_iter().map(|(kind, count)| (name_of(kind), json!(count))).collect();
    let arrays: Vec<Value> = arrays
        .iter()
        .map(|array| {
            json!({ "name": array.name, "association": array.association.to_string(), "type": array.type_name,
                "components": array.components, "tuples": array.tuples, "non_finite": array.non_finite,
                "range": array.range.map(|(low, high)| [low, high]) })
        })
        .collect();
    let mut out = json!({ "file": path.display().to_string(), "format": loaded.format,
        "points": loaded.dataset.points.len(), "cells": kinds, "arrays": arrays, "warnings": loaded.warnings });
    let more = match report {
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

fn kinds(dataset: &Dataset) -> BTreeMap<CellKind, usize> {
    let mut kinds = BTreeMap::new();
    match &dataset.cells {
        Cells::Unstructured(cells) => cells.kinds.iter().for_each(|kind| *kinds.entry(*kind).or_default() += 1),
        Cells::Structured(blocks) => {
            let count: usize = blocks.iter().map(tetrascope::StructuredBlock::cell_count).sum();
            if count > 0 {
                kinds.insert(CellKind::Hexahedron, count);
            }
        }
    }
    kinds
}

/// `QuadraticTetrahedron` as "quadratic tetrahedron".
fn name_of(kind: CellKind) -> String {
    match kind {
        CellKind::Flat => "point, line or face".to_owned(),
        CellKind::Other(number) => format!("VTK type {number}"),
        named => {
            let mut words = String::new();
            for letter in format!("{named:?}").chars() {
                if letter.is_uppercase() && !words.is_empty() {
                    words.push(' ');
                }
                words.extend(letter.to_lowercase());
            }
            words
        }
    }
}
