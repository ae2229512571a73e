//! The figures as a table in Markdown, as lines and as JSON.

use std::fmt::Write as _;

use serde_json::{Value, json};
use tetrascope::LinearImage;

use super::errors::Errors;
use super::vtk::Drawn;

/// The marks between which the document has the section.
const BEGIN: &str = "<!-- peers:begin -->";
const END: &str = "<!-- peers:end -->";

/// A scene with the errors of all.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) name: String,
    /// The fast renderer on the CPU.
    pub(super) ours: Errors,
    pub(super) projected: Vtk,
    pub(super) ray_cast: Vtk,
}

/// What one of VTK's mappers made of a scene.
#[derive(Clone, Debug)]
pub(super) struct Vtk {
    /// The second frame; else why there is no picture.
    pub(super) drawn: Result<Errors, String>,
    /// The first frame.
    pub(super) first: Option<Errors>,
    /// The second frame where it is neither displaced nor blurred.
    pub(super) aligned: Option<Result<Errors, String>>,
    /// The same without the cells of no volume, where all cells gave no picture.
    pub(super) without_flat: Option<Result<Errors, String>>,
}

impl Default for Vtk {
    fn default() -> Self {
        Self { drawn: Err("not drawn".to_owned()), first: None, aligned: None, without_flat: None }
    }
}

impl Vtk {
    /// Takes the figures of both frames.
    pub(super) fn take(&mut self, drawn: Drawn, exact: &LinearImage) {
        self.drawn = match drawn {
            Drawn::Pictures { first, second } => {
                self.first = Some(Errors::between(&first, exact));
                Ok(Errors::between(&second, exact))
            }
            Drawn::Nothing(reason) => Err(reason),
        };
    }

    /// The best that it makes of a scene.
    pub(super) fn best(&self) -> Option<&Errors> {
        let drawn = self.drawn.as_ref().ok();
        let others = [&self.aligned, &self.without_flat].into_iter().filter_map(|found| found.as_ref()?.as_ref().ok());
        drawn.into_iter().chain(others).min_by(|a, b| a.worst_rms().total_cmp(&b.worst_rms()))
    }

    /// Lines of a cell.
    fn cell(&self) -> String {
        let mut text = said(&self.drawn);
        if let (Some(first), Ok(second)) = (&self.first, &self.drawn)
            && first.worst() > second.worst() + 4.0 / 255.0
        {
            let _ = write!(text, "<br>first frame: {}", short(first));
        }
        if let (Some(aligned), Ok(_)) = (&self.aligned, &self.drawn) {
            let _ = write!(text, "<br>aligned: {}", aligned.as_ref().map_or_else(Clone::clone, short));
        }
        if let Some(without) = &self.without_flat {
            let _ = write!(
                text,
                "<br>without cells of no volume, aligned: {}",
                without.as_ref().map_or_else(Clone::clone, short)
            );
        }
        text
    }
}

fn said(drawn: &Result<Errors, String>) -> String {
    drawn.as_ref().map_or_else(|reason| reason.replace('|', "/"), long)
}

/// Every channel.
fn long(errors: &Errors) -> String {
    let all = |figures: [f64; 4]| figures.map(number).join(" ");
    format!("max {}<br>RMS {}<br>{} off", all(errors.largest), all(errors.rms), share(errors.share))
}

/// The worst channel.
pub(super) fn short(errors: &Errors) -> String {
    format!("max {}, RMS {}, {} off", number(errors.worst()), number(errors.worst_rms()), share(errors.share))
}

/// `0.501`, `2.1e-6`, `0`.
fn number(error: f64) -> String {
    match error {
        0.0 => "0".to_owned(),
        error if error < 5e-4 => format!("{error:.0e}"),
        error => format!("{error:.3}"),
    }
}

fn share(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        percent if percent < 1.0 => format!("{percent:.2} %"),
        percent => format!("{percent:.0} %"),
    }
}

impl Row {
    /// A line for the terminal.
    pub(super) fn line(&self) -> String {
        let vtk = |vtk: &Vtk| {
            let drawn = vtk.drawn.as_ref().map_or_else(Clone::clone, short);
            match &vtk.aligned {
                Some(Ok(aligned)) => format!("{drawn} (aligned {})", short(aligned)),
                _ => drawn,
            }
        };
        format!(
            "{}: projected tetrahedra {}; ray cast {}; ours {}",
            self.name,
            vtk(&self.projected),
            vtk(&self.ray_cast),
            short(&self.ours)
        )
    }
}

/// The table of all scenes.
pub(super) fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "| Case | VTK, projected tetrahedra | VTK, ray cast | Tetrascope, `cpu` |\n| --- | --- | --- | --- |\n",
    );
    for row in rows {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} |",
            row.name,
            row.projected.cell(),
            row.ray_cast.cell(),
            long(&row.ours)
        );
    }
    text
}

/// The section of the document: what was done, and the table with what follows it.
pub(super) fn section(version: &str, table: &str) -> String {
    format!(
        "The same scenes drawn by VTK {version}, off screen, with `vtkProjectedTetrahedraMapper` and with `vtkUnstructuredGridVolumeRayCastMapper` (its \
         function by Bunyk, partial pre-integration, one ray a pixel), and by the back end `cpu`, against the back end `reference`. Written by\n\n    \
         cargo xtask peers --python PYTHON\n\n\
         with any Python that has the module `vtk`. What was given to VTK:\n\n\
         - Optics: both mappers are density emitters and take opacity over unit distance as extinction, so that opacity is extinction over the largest \
         extinction, and the unit distance that one's inverse. Steps are a millionth of the range wide. Colors are linear, and nothing \
         is done to them: no gamma.\n\
         - Control points: color and extinction get all points of both, but where a name ends in `as-set`: the ray caster loses points otherwise.\n\
         - Camera: the same eye, target, up and angle or height; near and far plane stand close around the mesh. The background is black and \
         transparent.\n\
         - Read back: VTK's frame buffer has 8 bits a channel, which alone makes differences up to 0.004; the ray caster cuts digits off, it does not round.\n\
         - Frames: the second one counts. Where the first one is worse, it is told.\n\
         - Place: the ray of the ray caster's pixel goes through the lower left corner, and its picture is stretched by a pixel over the window, which displaces it \
         by up to a pixel and blurs it. \"Aligned\" is a second picture without that: the middle of a window five times as wide and high, moved and shrunk \
         so that rays run through the middles of our pixels.\n\n\
         Each entry has the largest difference in R, G, B (times opacity) and opacity, the root of the mean square of each, and the share of the pixels that \
         are off by more than 4/255 in some channel.\n\n{table}"
    )
}

/// The document with another section; a new one if there was none.
pub(super) fn in_document(old: Option<&str>, section: &str) -> String {
    let section = format!("{BEGIN}\n\n{section}\n{END}");
    let heading = "## What VTK draws";
    match old {
        None => format!("# Hard cases\n\n{heading}\n\n{section}\n"),
        Some(old) => match old.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1))) {
            Some((before, after)) => format!("{before}{section}{after}"),
            None => format!("{}\n\n{heading}\n\n{section}\n", old.trim_end()),
        },
    }
}

/// All figures, for other programs.
pub(super) fn json(version: &str, rows: &[Row]) -> Value {
    let errors = |e: &Errors| json!({ "largest": e.largest, "rms": e.rms, "share": e.share });
    let found = |r: &Result<Errors, String>| r.as_ref().map_or_else(|reason| json!(reason), errors);
    let vtk = |vtk: &Vtk| {
        json!({
            "second": found(&vtk.drawn),
            "first": vtk.first.as_ref().map(errors),
            "aligned": vtk.aligned.as_ref().map(found),
            "without_flat": vtk.without_flat.as_ref().map(found),
        })
    };
    let row = |row: &Row| json!({ "case": row.name, "ours": errors(&row.ours), "projected": vtk(&row.projected), "ray_cast": vtk(&row.ray_cast) });
    json!({ "vtk": version, "cases": rows.iter().map(row).collect::<Vec<_>>() })
}
