//! `cargo xtask figures`: draws the pictures of `docs/gallery.md`, after figures of the papers.
//!
//! Every scene is a file in `xtask/figures`; the command line draws most of them as well. Data sets lie beside the repository; what is absent
//! is skipped, and said.

mod cells;
mod maps;
mod presets;
mod scene;
pub(crate) mod sheet;

use std::fs;
use std::time::Instant;

use tetrascope::{LinearImage, write_png};

use crate::Failure;
use scene::Drawing;

/// What to draw.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Only the figures whose names contain this, such as "bluntfin".
    #[arg(long, default_value = "")]
    only: String,
    /// Pixels of a picture's longer side; maps and single cells have 256 always.
    #[arg(long, default_value_t = 384, value_parser = clap::value_parser!(u32).range(16..=4096))]
    size: u32,
}

/// A picture of the gallery, `docs/images/gallery/NAME.png`.
struct Figure {
    name: &'static str,
    work: Work,
}

/// How a figure is made from scenes in `xtask/figures`.
enum Work {
    /// The scene of the figure's own name.
    Scene,
    /// These scenes, side by side.
    Row(&'static [&'static str]),
    /// Cells with a flat isosurface each, above the maps that it is looked up in.
    CellsAndMaps(&'static [&'static str]),
    /// What a scene's isosurfaces and volume are looked up in: pass for the back faces, table, pass for the front faces.
    Maps(&'static str),
    /// Color map files of every kind, each above what VTK makes of it.
    Presets,
    /// The table of a scene with the integral stopped at its isosurfaces.
    StoppedTable(&'static str),
    /// The opacity of a three-dimensional table of that kind, as a volume with one isosurface, drawn as the figure's own scene says.
    StoppedOpacity(&'static str),
}

/// The gallery's pictures in its order.
const FIGURES: &[Figure] = &[
    Figure { name: "rings-table-3d", work: Work::Scene },
    Figure { name: "rings-table-2d", work: Work::Scene },
    Figure { name: "rings-exact", work: Work::Scene },
    Figure { name: "rings-isosurfaces", work: Work::Scene },
    Figure { name: "rings-mixed", work: Work::Scene },
    Figure { name: "cells-and-maps", work: Work::CellsAndMaps(&["cell-one", "cell-two", "cell-three"]) },
    Figure { name: "table-opacity", work: Work::StoppedOpacity("bluntfin-isosurfaces") },
    Figure { name: "bluntfin-maps", work: Work::Maps("bluntfin-isosurfaces") },
    Figure { name: "bluntfin-isosurfaces", work: Work::Scene },
    Figure { name: "bluntfin-stopped", work: Work::StoppedTable("bluntfin-isosurfaces") },
    Figure { name: "cell", work: Work::Row(&["cell", "cell-surface"]) },
    Figure { name: "bluntfin-partial", work: Work::Scene },
    Figure { name: "combustor-isosurfaces", work: Work::Scene },
    Figure { name: "combustor", work: Work::Scene },
    Figure { name: "post", work: Work::Scene },
    Figure { name: "neghip", work: Work::Scene },
    Figure { name: "ring", work: Work::Row(&["ring-report", "ring-cut"]) },
    Figure { name: "presets", work: Work::Presets },
];

/// Draws the figures. Those whose data is absent are named, and no error.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let folder = crate::root().join("docs/images/gallery");
    fs::create_dir_all(&folder)?;
    let chosen: Vec<_> = FIGURES.iter().filter(|figure| figure.name.contains(&args.only)).collect();
    if chosen.is_empty() {
        let names: Vec<_> = FIGURES.iter().map(|figure| figure.name).collect();
        return Err(format!("no figure's name contains \"{}\"; there are {}", args.only, names.join(", ")).into());
    }
    let (mut skipped, mut failures) = (0, Vec::new());
    for figure in chosen {
        let start = Instant::now();
        let path = folder.join(format!("{}.png", figure.name));
        match draw(figure, args.size) {
            Ok(Some(image)) => {
                // Pictures are opaque here: each was laid over its scene's background.
                write_png(&path, &image, [0.0; 3])?;
                println!(
                    "{:<24} {} x {}, {} KiB, {:.1} s",
                    figure.name,
                    image.width(),
                    image.height(),
                    fs::metadata(&path)?.len() / 1024,
                    start.elapsed().as_secs_f64()
                );
            }
            Ok(None) => skipped += 1,
            // The others can be drawn all the same.
            Err(problem) => failures.push(format!("{}: {problem}", figure.name)),
        }
    }
    if skipped > 0 {
        println!("SKIPPED {skipped} figures, whose old pictures stay as they are");
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n").into()) }
}

/// One figure; `None` where its data is absent.
fn draw(figure: &Figure, size: u32) -> Result<Option<LinearImage>, Failure> {
    let parts: &[&str] = match &figure.work {
        Work::Scene => &[figure.name],
        Work::Presets => return presets::sheet().map(Some),
        Work::Row(scenes) | Work::CellsAndMaps(scenes) => scenes,
        Work::Maps(scene) | Work::StoppedTable(scene) | Work::StoppedOpacity(scene) => &[*scene],
    };
    let mut drawings = Vec::new();
    for scene in parts {
        let Some(drawing) = Drawing::load(scene)? else { return Ok(None) };
        drawings.push(drawing);
    }
    let image = match (&figure.work, drawings.as_slice()) {
        (Work::CellsAndMaps(_), cells) => cells::with_maps(cells)?,
        (Work::Maps(_), [drawing]) => maps::three(drawing)?,
        (Work::StoppedTable(_), [drawing]) => maps::stopped(drawing)?,
        (Work::StoppedOpacity(_), [drawing]) => maps::stopped_opacity(drawing, figure.name, size)?,
        (_, drawings) => {
            let each = size / u32::try_from(drawings.len())?;
            let images: Vec<_> = drawings.iter().map(|drawing| drawing.picture(each)).collect::<Result<_, _>>()?;
            sheet::grid(&[images])
        }
    };
    Ok(Some(image))
}
