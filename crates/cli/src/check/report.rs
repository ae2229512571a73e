//! What `tetrascope check` says, as lines and as JSON.

use std::path::Path;

use serde_json::{Value, json};
use tetrascope::{
    Camera, MeshCheck, OrderCheck, OrderMethod, Overlaps, PixelDifference, PowerCertificate, Projection, Relations,
    Verdict, Volume, short,
};

fn row(subject: &str, text: &str) -> String {
    format!("{subject:<12}{text}")
}

pub(super) fn mesh(volume: &Volume, check: &MeshCheck) -> Vec<String> {
    let report = &check.report;
    let mut lines = vec![
        row("mesh", &format!("{} ({})", volume.source_name, volume.format)),
        row("", &format!("{} points, {} tetrahedra", report.points, report.tetrahedra)),
        row(
            "left out",
            &format!(
                "{} tetrahedra without volume, {} where the field is not finite; {} turned round",
                report.decomposition.no_volume, check.left_out, report.decomposition.inverted
            ),
        ),
        row(
            "faces",
            &format!(
                "{}: {} on the boundary, {} of three or more tetrahedra, {} folded",
                check.faces, report.boundary_faces, report.non_manifold_faces, report.folded_faces
            ),
        ),
        row("duplicates", &report.duplicate_tetrahedra.to_string()),
        row("parts", &report.connected_parts.to_string()),
        row("convex", if check.is_convex { "yes" } else { "no: rays may leave the mesh and enter it again" }),
        row("overlaps", &overlapping(&check.overlaps)),
        row("Delaunay", &proven(&check.delaunay)),
    ];
    let one_key = match &check.power {
        None => "unknown: |p|² orders it not, and no heights were looked for; --heights does".to_owned(),
        Some(power) => proven(power),
    };
    lines.push(row("one key", &one_key));
    for (index, finding) in report.findings().iter().enumerate() {
        lines.push(row(if index == 0 { "findings" } else { "" }, finding));
    }
    lines
}

fn overlapping(overlaps: &Overlaps) -> String {
    let Overlaps { folded, piercing, contained, is_complete } = *overlaps;
    let more = if is_complete { "" } else { "; not everything was looked at" };
    if !overlaps.any() {
        return format!("none found{more}");
    }
    format!(
        "{folded} pairs of tetrahedra on one side of a face of both, {piercing} pairs of boundary faces through each other, \
         {contained} parts inside others{more}"
    )
}

fn proven(certificate: &PowerCertificate) -> String {
    if certificate.is_exact() {
        let faces = certificate.faces;
        return match certificate.gaps {
            Some(0) => format!("yes, proven for all {faces} faces between cells and across all gaps"),
            Some(open) => format!(
                "across faces, not across gaps: proven for all {faces} faces between cells; {open} boundary cells are open"
            ),
            None => format!("across faces: proven for all {faces} faces between cells; not looked at across gaps"),
        };
    }
    let PowerCertificate { faces, violated, folded, flat, imprecise, gaps: _ } = *certificate;
    let share = 100.0 * violated as f64 / faces.max(1) as f64;
    let mut text = format!("no: {violated} of {faces} faces between cells are violated ({} %)", short(share));
    for (count, what) in
        [(folded, "folded"), (flat, "of cells without volume"), (imprecise, "cells too thin for their key")]
    {
        if count > 0 {
            text.push_str(&format!(", {count} {what}"));
        }
    }
    text
}

/// Pixels in which anything is seen from a view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) pixels: usize,
    pub(super) all: usize,
}

/// What an order is called: with the number that it goes by, if it has one.
fn name(method: OrderMethod) -> String {
    match number_of(method) {
        Some((_, number)) => format!("{method}, {number}"),
        None => method.to_string(),
    }
}

/// The number that an order goes by, under the name of its key.
pub(super) fn number_of(method: OrderMethod) -> Option<(&'static str, u32)> {
    match method {
        OrderMethod::Bucket { slabs } => Some(("slabs", slabs)),
        OrderMethod::KBuffer { window } => Some(("window", window)),
        _ => None,
    }
}

pub(super) fn view(index: usize, camera: &Camera, relations: &Relations<'_>, seen: Seen) -> Vec<String> {
    let place = |p: [f64; 3]| p.map(short).join(", ");
    let (from, to) = (place(camera.eye.to_array()), place(camera.target.to_array()));
    let projection = match camera.projection {
        Projection::Perspective { .. } => "perspective",
        Projection::Orthographic { .. } => "orthographic",
    };
    let rings = relations.rings();
    let cyclic = if rings.is_empty() {
        "no".to_owned()
    } else {
        let plural = if rings.len() == 1 { "" } else { "s" };
        let cells: usize = rings.iter().map(Vec::len).sum();
        format!("yes: {cells} tetrahedra hide one another in {} ring{plural}", rings.len())
    };
    let seen = if seen.pixels == 0 {
        format!("in no pixel of {}: the pixels below tell nothing", seen.all)
    } else {
        format!("in {} of {} pixels", seen.pixels, seen.all)
    };
    vec![
        String::new(),
        row(&format!("view {}", index + 1), &format!("from ({from}) to ({to}), {projection}")),
        row("seen", &seen),
        row("cyclic", &cyclic),
        format!(
            "{:<14}{:>9} {:>11} {:>10} {:>10} {:>9} {:>9} {:>9} {:>10}",
            "order", "neighbors", "across gaps", "in rings", "order ms", "draw ms", "> 1e-5", "> 1/255", "largest"
        ),
    ]
}

/// A line of the table: pairs in the wrong order, times, pixels that differ.
pub(super) fn order(check: &OrderCheck) -> String {
    let pairs = |count: fn(&Verdict) -> usize| check.verdict.as_ref().map_or("-".to_owned(), |v| count(v).to_string());
    let is_partial = check.verdict.is_some_and(|verdict| !verdict.gaps_complete);
    let gaps = format!("{}{}", pairs(|v| v.misordered_gaps), if is_partial { "+" } else { "" });
    let milliseconds = |time: std::time::Duration| format!("{:.2}", time.as_secs_f64() * 1e3);
    format!(
        "{:<14}{:>9} {:>11} {:>10} {:>10} {:>9} {:>9} {:>9} {:>10.2e}",
        name(check.method),
        pairs(|v| v.misordered_faces),
        gaps,
        pairs(|v| v.misordered_in_rings),
        milliseconds(check.sorted_in),
        milliseconds(check.drawn_in),
        check.pixels.above(PixelDifference::ROUNDING),
        check.pixels.above(PixelDifference::STEP),
        check.pixels.largest()
    )
}

pub(super) fn mesh_json(volume: &Volume, check: &MeshCheck) -> Value {
    let report = &check.report;
    json!({
        "mesh": { "path": volume.source_name, "format": volume.format, "points": report.points,
            "tetrahedra": report.tetrahedra },
        "without_volume": report.decomposition.no_volume,
        "field_not_finite": check.left_out,
        "inverted": report.decomposition.inverted,
        "faces": { "all": check.faces, "boundary": report.boundary_faces, "non_manifold": report.non_manifold_faces,
            "folded": report.folded_faces },
        "duplicate_tetrahedra": report.duplicate_tetrahedra,
        "connected_parts": report.connected_parts,
        "findings": report.findings(),
        "convex": check.is_convex,
        "overlaps": { "folded": check.overlaps.folded, "piercing": check.overlaps.piercing,
            "contained": check.overlaps.contained, "complete": check.overlaps.is_complete },
        "delaunay": certificate_json(&check.delaunay),
        "one_key": check.power.as_ref().map(certificate_json),
    })
}

fn certificate_json(certificate: &PowerCertificate) -> Value {
    json!({ "proven": certificate.is_exact(), "proven_across_gaps": certificate.is_exact_across_gaps(), "faces": certificate.faces, "violated": certificate.violated,
        "folded": certificate.folded, "flat": certificate.flat, "imprecise": certificate.imprecise, "open_across_gaps": certificate.gaps })
}

pub(super) fn view_json(camera: &Camera, relations: &Relations<'_>, seen: Seen, orders: Vec<Value>) -> Value {
    let rings = relations.rings();
    let projection = match camera.projection {
        Projection::Perspective { .. } => "perspective",
        Projection::Orthographic { .. } => "orthographic",
    };
    json!({
        "camera": { "eye": camera.eye.to_array(), "target": camera.target.to_array(), "up": camera.up.to_array(),
            "projection": projection },
        "pixels_seen": seen.pixels,
        "cyclic": !rings.is_empty(),
        "rings": rings.len(),
        "cells_in_rings": rings.iter().map(Vec::len).sum::<usize>(),
        "orders": orders,
    })
}

pub(super) fn order_json(check: &OrderCheck, map: Option<&Path>) -> Value {
    let pairs = check.verdict.as_ref().map(|verdict| {
        json!({
            "neighbors": { "pairs": verdict.pairs_of_faces, "misordered": verdict.misordered_faces },
            "across_gaps": { "pairs": verdict.pairs_across_gaps, "misordered": verdict.misordered_gaps,
                "complete": verdict.gaps_complete },
            "in_rings": { "pairs": verdict.in_rings, "misordered": verdict.misordered_in_rings },
        })
    });
    let largest = check.pixels.largest();
    let mut said = json!({
        "order": check.method.to_string(),
        "pairs": pairs,
        "order_secs": check.sorted_in.as_secs_f64(),
        "draw_secs": check.drawn_in.as_secs_f64(),
        "pixels": { "all": check.pixels.by_pixel.len(), "above_rounding": check.pixels.above(PixelDifference::ROUNDING),
            "above_step": check.pixels.above(PixelDifference::STEP),
            // JSON has no infinity.
            "largest": largest.is_finite().then_some(largest) },
        "map": map.map(|path| path.display().to_string()),
    });
    if let (Value::Object(said), Some((key, number))) = (&mut said, number_of(check.method)) {
        said.insert(key.to_owned(), json!(number));
    }
    said
}
