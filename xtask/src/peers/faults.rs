//! The faults that were known of VTK's mappers, and whether these pictures show them.

use std::fmt::Write as _;

use super::errors::Errors;
use super::table::{Row, Vtk, short};

/// A fault is seen where some channel is off by more than this: four times what counts as off.
const SEEN: f64 = 16.0 / 255.0;

/// A fault, and how its scene shows it.
struct Fault {
    /// A sentence without its full stop.
    claim: &'static str,
    /// The scene.
    scene: &'static str,
    /// Whether it is seen there, and the figures that say so.
    look: fn(&Row, &[Row]) -> Found,
}

/// Whether a fault is seen, with its figures.
struct Found {
    is_seen: bool,
    figures: String,
}

const FAULTS: &[Fault] = &[
    Fault {
        claim: "Projected tetrahedra in perspective lose cells that are thin beside the longest edge of the mesh, as lengths come from a table of square roots",
        scene: "thin-cells",
        look: |row, rows| beside(&row.projected, rows, "thin-cells-orthographic", "without perspective"),
    },
    Fault {
        claim: "Projected tetrahedra take a wrong extinction where the diagonals of a silhouette cross off their middles",
        scene: "off-center-diagonals",
        look: |row, _| plainly(&row.projected),
    },
    Fault {
        claim: "The first frame of projected tetrahedra leaves out cells: a mesh of up to 1,000 is empty in any single screenshot",
        scene: "one-frame",
        look: |row, _| match (&row.projected.first, &row.projected.drawn) {
            (Some(first), Ok(second)) => Found {
                is_seen: first.worst() > SEEN && first.worst() > 2.0 * second.worst(),
                figures: format!("first frame {}; second {}", short(first), short(second)),
            },
            _ => plainly(&row.projected),
        },
    },
    Fault {
        claim: "Projected tetrahedra look at the transfer function at the points alone: what lies between is lost",
        scene: "narrow-peak",
        look: |row, _| plainly(&row.projected),
    },
    Fault {
        claim: "Projected tetrahedra keep opacity in 8 bits: extinction below 1/255 of its peak is none",
        scene: "faint-extinction",
        look: |row, _| plainly(&row.projected),
    },
    Fault {
        claim: "Projected tetrahedra sort centroids: a cell in front that slopes away is drawn behind",
        scene: "sloping-cell",
        look: |row, _| plainly(&row.projected),
    },
    Fault {
        claim: "The ray caster sorts the faces that a ray enters by the depth of a face's first point: a cell in front that slopes away is drawn behind",
        scene: "sloping-cell",
        look: |row, _| at_best(&row.ray_cast),
    },
    Fault {
        claim: "The ray caster crashes on cells of no volume",
        scene: "cells-of-no-volume",
        look: |row, _| match &row.ray_cast.drawn {
            Err(reason) => Found { is_seen: reason.contains("signal"), figures: reason.clone() },
            Ok(_) => Found { is_seen: false, ..at_best(&row.ray_cast) },
        },
    },
    Fault {
        claim: "The ray caster loses control points of extinction that the color does not have",
        scene: "narrow-peak-as-set",
        look: |row, rows| {
            let merged = rows.iter().find(|other| other.name == "narrow-peak").and_then(|other| other.ray_cast.best());
            let found = at_best(&row.ray_cast);
            let beside = merged.map_or(String::new(), |merged| format!("; with all points {}", short(merged)));
            Found { is_seen: found.is_seen, figures: found.figures + &beside }
        },
    },
    Fault {
        claim: "The ray caster shoots its rays through the lower left corners of the pixels, and its picture is stretched by a pixel and blurred when it is shown",
        scene: "silhouettes",
        look: |row, _| match (&row.ray_cast.drawn, &row.ray_cast.aligned) {
            (Ok(drawn), Some(Ok(aligned))) => Found {
                is_seen: drawn.worst() > SEEN && aligned.worst_rms() < 0.5 * drawn.worst_rms(),
                figures: format!("{}; aligned {}", short(drawn), short(aligned)),
            },
            _ => plainly(&row.ray_cast),
        },
    },
    Fault {
        claim: "Projected tetrahedra drop cells that reach behind the eye",
        scene: "eye-inside",
        look: |row, _| plainly(&row.projected),
    },
    Fault {
        claim: "The ray caster draws almost nothing where the eye is inside the mesh",
        scene: "eye-inside",
        look: |row, _| at_best(&row.ray_cast),
    },
    Fault {
        claim: "The ray caster interpolates scalars over a face as it lies on the screen, without perspective: wrong in cells that are large for their distance",
        scene: "large-cells",
        look: |row, _| at_best(&row.ray_cast),
    },
];

/// The picture as it is.
fn plainly(vtk: &Vtk) -> Found {
    of(vtk.drawn.as_ref().map_err(String::as_str))
}

/// Aligned, where that is better.
fn at_best(vtk: &Vtk) -> Found {
    of(vtk.best().ok_or(vtk.drawn.as_ref().err().map_or("", String::as_str)))
}

fn of(drawn: Result<&Errors, &str>) -> Found {
    match drawn {
        Ok(errors) => Found { is_seen: errors.worst() > SEEN, figures: short(errors) },
        Err(reason) => Found { is_seen: true, figures: reason.to_owned() },
    }
}

/// The picture as it is, beside the one of another scene that should be free of the fault.
fn beside(vtk: &Vtk, rows: &[Row], other: &str, words: &str) -> Found {
    let found = plainly(vtk);
    let free = rows.iter().find(|row| row.name == other).and_then(|row| row.projected.drawn.as_ref().ok());
    let free = free.map_or(String::new(), |free| format!("; {words} {}", short(free)));
    Found { is_seen: found.is_seen, figures: found.figures + &free }
}

/// A sentence for each fault whose scene was drawn; nothing if none was.
pub(super) fn sentences(rows: &[Row]) -> String {
    let mut text = String::new();
    for fault in FAULTS {
        let Some(row) = rows.iter().find(|row| row.name == fault.scene) else { continue };
        if text.is_empty() {
            text.push_str("What measurements of VTK had found, and whether its scene shows it here (more than 16/255 in some channel):\n\n");
        }
        let found = (fault.look)(row, rows);
        let verdict = if found.is_seen { "Confirmed" } else { "Not confirmed" };
        let _ = writeln!(text, "- {}. {verdict} on `{}`: {}.", fault.claim, fault.scene, found.figures);
    }
    if !text.is_empty() {
        text.push_str(LEFT_OUT);
    }
    text
}

/// What those measurements had found of other mappers.
const LEFT_OUT: &str = "\nWhat they had found of ZSweep, of grids that a mesh is resampled to, of cells that are no tetrahedra and of ParaView was not tried again.\n";

/// The scenes that faults are looked for in.
#[cfg(test)]
pub(super) fn scenes() -> impl Iterator<Item = &'static str> {
    FAULTS.iter().map(|fault| fault.scene)
}
