//! `cargo xtask peers`: gives the hard cases and known faults to VTK, and says how far its pictures, and ours, are from the reference; and
//! lets it read the files that we write, of meshes of all kinds.
//!
//! VTK is reached through Python, each picture in a process of its own: some end in a signal. Nothing is installed or loaded; where
//! there is no Python with the module `vtk`, the task says what to do, and is done.

mod errors;
mod faults;
mod files;
mod job;
mod table;
mod vtk;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use tetrascope::{LinearImage, SceneFile, Volume, write_png};
use tetrascope_tests::ways::Way;
use tetrascope_tests::{hard, peers};

use crate::Failure;
use crate::figures::sheet;
use errors::Errors;
use job::{Job, Mapper, Subset};
use table::{Row, Vtk};
use vtk::Drawn;

/// What to compare, and with whom.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// A Python that has the module vtk.
    #[arg(long, default_value = "python3", value_name = "PATH")]
    python: PathBuf,
    /// Where meshes, pictures and figures go; "target/peers" in the repository unless given.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Only this case. The document stays as it is then.
    #[arg(long, value_name = "NAME")]
    case: Option<String>,
    /// No pictures: only whether VTK reads what we write.
    #[arg(long, conflicts_with = "case")]
    files: bool,
}

/// The document that gets the table.
const DOCUMENT: &str = "docs/hard-cases.md";
/// What pixels have behind them on the sheets.
const PAPER: [f32; 3] = [0.25; 3];

/// A scene to be drawn by everybody.
struct Subject {
    name: String,
    volume: Arc<Volume>,
    scene: SceneFile,
    is_merged: bool,
    /// Why it is not given to VTK; `None` if it is.
    reason: Option<&'static str>,
}

/// Draws everything by everybody, prints the figures as they come, and writes the table.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let subjects: Vec<Subject> =
        subjects().into_iter().filter(|s| args.case.as_ref().is_none_or(|c| *c == s.name)).collect();
    if subjects.is_empty() {
        let names: Vec<_> = self::subjects().into_iter().map(|subject| subject.name).collect();
        return Err(format!("no case has this name; there are {}", names.join(", ")).into());
    }
    let folder = args.output.clone().unwrap_or_else(|| crate::root().join("target/peers"));
    fs::create_dir_all(&folder)?;
    // A process may run in another folder; paths in jobs are whole.
    let folder = fs::canonicalize(folder)?;
    let script = vtk::write_script(&folder)?;
    let version = match vtk::version(&args.python, &script) {
        Ok(version) => version,
        Err(reason) => {
            println!("{}", vtk::absent(&args.python, &reason));
            return Ok(());
        }
    };
    println!("VTK {version}; pictures and figures in {}", folder.display());
    if args.case.is_none() {
        files::run(&folder, &args.python)?;
    }
    if args.files {
        return Ok(());
    }
    let compare = |subject: &Subject| {
        let row = row(subject, &folder, &args.python, &script).map_err(|e| format!("{}: {e}", subject.name))?;
        println!("{}", row.line());
        Ok(row)
    };
    let rows: Vec<Row> = subjects.par_iter().map(compare).collect::<Result<_, String>>()?;
    let text = format!("{}\n{}", table::table(&rows), faults::sentences(&rows));
    fs::write(folder.join("figures.json"), serde_json::to_string_pretty(&table::json(&version, &rows))?)?;
    if args.case.is_some() {
        println!("{text}");
    } else {
        let path = crate::root().join(DOCUMENT);
        let old = fs::read_to_string(&path).ok();
        fs::write(&path, table::in_document(old.as_deref(), &table::section(&version, &text)))?;
        println!("written: {DOCUMENT}");
    }
    Ok(())
}

/// The control, the hard cases, and the scenes that show known faults.
fn subjects() -> Vec<Subject> {
    let of_peer = |peer: peers::PeerScene| Subject {
        name: peer.name.to_owned(),
        volume: Arc::new(peer.volume),
        scene: peer.scene,
        is_merged: peer.is_merged,
        reason: None,
    };
    let (control, faults): (Vec<_>, Vec<_>) =
        peers::all().into_iter().map(of_peer).partition(|subject| subject.name == peers::CONTROL);
    let of_case = |case: hard::HardCase| {
        let scenes = (case.scenes)();
        let wanted = scenes.iter().find(|hard| job::untranslatable(&hard.scene).is_none()).or(scenes.first())?;
        Some(Subject {
            name: case.name.to_owned(),
            volume: Arc::clone(&wanted.volume),
            scene: wanted.scene.clone(),
            is_merged: true,
            reason: job::untranslatable(&wanted.scene),
        })
    };
    control.into_iter().chain(hard::all().into_iter().filter_map(of_case)).chain(faults).collect()
}

/// All pictures of a scene, held against the reference.
fn row(subject: &Subject, folder: &Path, python: &Path, script: &Path) -> Result<Row, Failure> {
    let exact = Way::Reference.draw(&subject.volume, &subject.scene)?.image;
    let ours = Errors::between(&Way::Cpu.draw(&subject.volume, &subject.scene)?.image, &exact);
    let mut row = Row { name: subject.name.clone(), ours, projected: Vtk::default(), ray_cast: Vtk::default() };
    if let Some(reason) = subject.reason {
        let left_out = || Vtk { drawn: Err(reason.to_owned()), ..Vtk::default() };
        (row.projected, row.ray_cast) = (left_out(), left_out());
        return Ok(row);
    }
    let job = Job::write(subject, folder)?;
    let mut sheet = vec![exact.clone()];
    let mut draw = |mapper, subset, is_aligned| -> Result<Drawn, Failure> {
        let drawn = vtk::draw(python, script, &job, mapper, subset, is_aligned)?;
        sheet.push(match &drawn {
            Drawn::Pictures { second, .. } => second.clone(),
            Drawn::Nothing(_) => LinearImage::transparent(exact.width(), exact.height()),
        });
        Ok(drawn)
    };
    row.projected.take(draw(Mapper::Projected, Subset::All, false)?, &exact);
    row.ray_cast.take(draw(Mapper::RayCast, Subset::All, false)?, &exact);
    let aligned = draw(Mapper::RayCast, Subset::All, true)?;
    row.ray_cast.aligned = aligned.errors(&exact);
    if job.has_flat_cells && row.ray_cast.drawn.is_err() {
        row.ray_cast.without_flat = draw(Mapper::RayCast, Subset::WithVolume, true)?.errors(&exact);
    }
    // Reference, projected tetrahedra, ray cast, ray cast aligned; what was not drawn is empty.
    let sheet: Vec<_> = sheet.iter().map(|image| sheet::over(image, PAPER)).collect();
    write_png(&folder.join(format!("{}.png", subject.name)), &sheet::grid(&[sheet]), [0.0; 3])?;
    Ok(row)
}

#[cfg(test)]
mod tests;
