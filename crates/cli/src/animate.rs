//! `tetrascope animate`: time steps and a turn of the camera as numbered pictures, with one scale for all.

mod record;
mod steps;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};
use serde_json::json;
use tetrascope::{
    Completed, MeshFacts, Progress, SceneFile, Stage, Volume, VolumeField, check_writable, frames_of, make_folder,
    short, turned_camera, write_image,
};
use tetrascope_study::StudyProgress;

use crate::Failure;
use crate::args::{LookArgs, vector};
use crate::interrupt;
use crate::progress::Bar;
use crate::render::wrong_scene;
use crate::report::{line, object, warning};
use crate::scene_of::{override_by_options, read_color_map};
use crate::scene_paths::is_scene;

use record::{FrameFile, Record};
use steps::{Shown, inputs_of, steps_of};

const ANIMATE_EXAMPLES: &str = "\
Examples:
  tetrascope animate case.e -o frames                          a frame for each time step
  tetrascope animate out_*.vtu -o frames --field T --cmap plasma
  tetrascope animate case.pvd -o frames --frames 240 --turn 90 --size 1280x720
  tetrascope animate case.vtu -o frames                        once around it, in 96 frames
  ffmpeg -framerate 24 -i frames/frame_%04d.png -pix_fmt yuv420p film.mp4    frames to a film

All frames have one camera, one range of colors and one extinction: what a scene leaves open is chosen to fit all time steps, for which each is
read once before. A scene written by `render --write-scene` leaves nothing open. frames/animation.json keeps what was chosen.

Interrupted, the same command goes on after the last whole frame. In a folder with frames of another animation nothing is drawn; --restart removes
them. Exit codes: 0 good, 1 wrong input or no room, 2 wrong usage, 130 interrupted.";

/// What a frame is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FrameFormat {
    /// 8-bit sRGB over the background
    Png,
    /// 32-bit linear, premultiplied
    Exr,
}

impl FrameFormat {
    fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Exr => "exr",
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = ANIMATE_EXAMPLES)]
pub(crate) struct AnimateArgs {
    /// A scene file, a mesh file with its time steps, or one mesh file a time step; behind a PLOT3D grid its solutions (.q)
    #[arg(required = true, num_args = 1.., value_name = "INPUT")]
    pub(crate) input: Vec<PathBuf>,
    /// Folder for frame_0000.png and so on; made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "frames")]
    pub(crate) output: PathBuf,
    /// Number of frames, over which the time steps are spread [default: one a time step; 96 of one time step]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), help_heading = "Frames")]
    pub(crate) frames: Option<u32>,
    /// Degrees that the camera turns around its target in all, counterclockwise seen from above [default: 360 for one time step, 0 for several]
    #[arg(long, value_name = "DEGREES", value_parser = crate::args::number, allow_hyphen_values = true, help_heading = "Frames")]
    pub(crate) turn: Option<f64>,
    /// The direction that it turns around [default: the camera's up]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true, help_heading = "Frames")]
    pub(crate) axis: Option<[f64; 3]>,
    /// First time step of the file that is shown [default: 0]
    #[arg(long, value_name = "N", conflicts_with_all = ["step", "time"], help_heading = "Frames")]
    pub(crate) first: Option<usize>,
    /// Last time step of the file that is shown [default: the last one]
    #[arg(long, value_name = "N", conflicts_with_all = ["step", "time"], help_heading = "Frames")]
    pub(crate) last: Option<usize>,
    /// Show every N-th of these [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Frames")]
    pub(crate) every: Option<u32>,
    /// What frames are written as
    #[arg(long, value_name = "NAME", value_enum, default_value = "png", help_heading = "Frames")]
    pub(crate) format: FrameFormat,
    /// Draw all frames anew, and remove those of another animation that the folder holds
    #[arg(long, help_heading = "Frames")]
    pub(crate) restart: bool,

    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// Report on standard output as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,
}

pub(crate) fn run(args: &AnimateArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let missing: Vec<&Path> =
        args.output.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists()).collect();
    missing.into_iter().rev().for_each(interrupt::made_folder);
    make_folder(&args.output).map_err(tetrascope::Error::Io)?;
    check_writable(&args.output.join(record::NAME)).map_err(tetrascope::Error::Io)?;
    let bar = Bar::new(false);
    let done = animate(args, &bar);
    bar.clear();
    let Animated { record, drawn, warnings } = done?;
    if args.json {
        object(&json!({ "folder": args.output.display().to_string(), "frames": record.frames.len(), "drawn": drawn,
            "steps": record.steps.len(), "times": record.times(), "field": record.field, "range": record.range, "warnings": warnings,
            "seconds": start.elapsed().as_secs_f64() }));
        return Ok(());
    }
    line(&format!("steps       {}{}", record.steps.len(), record.times_text()));
    let over = record.range.map(|[low, high]| format!(", {} to {} over all of them", short(low), short(high)));
    line(&format!("field       {}{}", record.field, over.unwrap_or_default()));
    let before = record.frames.len() - drawn;
    let there = if before > 0 { format!(", {before} were there before") } else { String::new() };
    line(&format!("frames      {drawn} drawn{there}"));
    if let (Some(first), Some(last)) = (record.frames.first(), record.frames.last()) {
        line(&format!("wrote       {} to {}", args.output.join(&first.file).display(), last.file));
    }
    line(&format!("time        {:.1} s in all", start.elapsed().as_secs_f64()));
    Ok(())
}

/// What is asked for, before any file was looked into.
struct Asked<'a> {
    args: &'a AnimateArgs,
    scene: SceneFile,
    /// What the scene's paths are relative to.
    base_dir: PathBuf,
    /// The scene's file, for messages.
    scene_path: Option<&'a Path>,
    bar: &'a Bar,
}

fn animate<'a>(args: &'a AnimateArgs, bar: &'a Bar) -> Result<Animated, Failure> {
    let (mut scene, base_dir, shown) = inputs_of(&args.input)?;
    override_by_options(&mut scene, &args.look);
    read_color_map(&mut scene, &base_dir, &args.look)?;
    let scene_path = args.input.first().map(PathBuf::as_path).filter(|path| is_scene(path));
    let asked = Asked { args, scene, base_dir, scene_path, bar };
    let text = record::asked_text(&asked.scene, &asked.base_dir, &shown, args)?;
    let mut kept = Kept::default();
    let record = match record::find(args, &text)? {
        Some(record) => record,
        None => {
            let record = decide(&asked, shown, text, &mut kept)?;
            record.make_way(args)?;
            record.write(&args.output)?;
            record
        }
    };
    let drawn = draw(&asked, &record, &mut kept)?;
    Ok(Animated { record, drawn, warnings: kept.said })
}

/// What was done.
struct Animated {
    record: Record,
    /// Frames that were not there.
    drawn: usize,
    warnings: Vec<String>,
}

/// The mesh of the last time step that was read.
#[derive(Default)]
struct Kept {
    volume: Option<(usize, Volume)>,
    /// What the user should know, each once.
    said: Vec<String>,
}

impl Kept {
    fn volume(&mut self, asked: &Asked<'_>, record: &[Shown], step: usize) -> Result<&Volume, Failure> {
        let is_there = matches!(&self.volume, Some((kept, _)) if *kept == step);
        if !is_there {
            // One mesh at a time.
            self.volume = None;
            let shown = record.get(step).ok_or_else(|| Failure::Input("the record names no such step".to_owned()))?;
            let volume = Volume::of_section(&shown.section(&asked.scene.mesh), &asked.base_dir, asked.bar.reading())?;
            interrupt::go_on()?;
            let findings = volume.decomposition.counts.findings();
            for text in volume.warnings.iter().chain(&findings) {
                say_once(&mut self.said, text);
            }
            self.volume = Some((step, volume));
        }
        match &self.volume {
            Some((_, volume)) => Ok(volume),
            None => Err(Failure::Input("the mesh is gone".to_owned())),
        }
    }
}

fn say_once(said: &mut Vec<String>, text: &str) {
    if !said.iter().any(|other| other == text) {
        warning(text);
        said.push(text.to_owned());
    }
}

/// Reads all time steps, to choose for all of them what the scene leaves open.
fn decide(asked: &Asked<'_>, inputs: Vec<Shown>, text: String, kept: &mut Kept) -> Result<Record, Failure> {
    let Asked { args, bar, .. } = asked;
    bar.step("reading the time steps");
    let steps = steps_of(asked, inputs, kept)?;
    let frames = frames_of(steps.len(), args.frames.map(|frames| frames as usize), args.turn);
    let mut used: Vec<usize> = frames.iter().map(|frame| frame.step).collect();
    used.dedup();
    let looks_at_all = !leaves_nothing_open(&asked.scene) || used.len() == 1;
    if !looks_at_all {
        used.truncate(1);
    }
    // The one that is there already first.
    used.sort_by_key(|step| !matches!(&kept.volume, Some((there, _)) if there == step));

    let mut mesh = asked.scene.mesh.clone();
    let mut all: Option<MeshFacts> = None;
    let total = used.len() as u64;
    for (done, step) in used.into_iter().enumerate() {
        if total > 1 {
            StudyProgress::report(*bar, "looking at all time steps", done as u64, total);
        }
        let volume = kept.volume(asked, &steps, step)?;
        let field = volume.field_of_section(&mesh)?;
        // The same array of all files, also where they have them in another order.
        mesh.field = Some(field.field.name.clone());
        all = Some(all.map_or(field.facts, |facts| facts.joined(&field.facts)));
        let (warnings, on_mesh) = (field.field.warnings.clone(), field.on_mesh.warning());
        warnings.iter().chain(&on_mesh).for_each(|text| say_once(&mut kept.said, text));
        interrupt::go_on()?;
    }
    let facts = all.ok_or_else(|| Failure::Usage("there is no frame to draw".to_owned()))?;
    let completed = asked.scene.complete(&facts).map_err(|error| wrong_scene(asked.scene_path, error.into()))?;
    completed.warnings.iter().for_each(|text| say_once(&mut kept.said, text));
    // Numbers for all frames; methods are chosen for each mesh.
    let scene = SceneFile { mesh, quality: asked.scene.quality.clone(), ..completed.file };
    let digits = frames.len().saturating_sub(1).to_string().len().max(4);
    let extension = args.format.extension();
    let frames = frames.iter().enumerate().map(|(number, frame)| FrameFile {
        file: format!("frame_{number:0digits$}.{extension}"),
        step: frame.step,
        turned: frame.turned,
    });
    let (low, high) = facts.scalar_range;
    Ok(Record {
        asked: text,
        field: scene.mesh.field.clone().unwrap_or_default(),
        range: looks_at_all.then_some([low, high]),
        frames: frames.collect(),
        steps,
        scene,
    })
}

/// Whether no number of a scene depends on its mesh.
fn leaves_nothing_open(scene: &SceneFile) -> bool {
    let camera = &scene.camera;
    let has_camera = camera.eye.is_some() && camera.target.is_some() && camera.up.is_some();
    has_camera
        && (camera.fov_y.is_some() || camera.height.is_some())
        && scene.transfer.color.is_some()
        && scene.transfer.extinction.is_some()
}

/// Draws the frames that are not there; how many these were.
fn draw(asked: &Asked<'_>, record: &Record, kept: &mut Kept) -> Result<usize, Failure> {
    let bar = asked.bar;
    let folder = &asked.args.output;
    let is_open = |frame: &&FrameFile| !folder.join(&frame.file).exists();
    let open: Vec<&FrameFile> = record.frames.iter().filter(is_open).collect();
    let total = record.frames.len();
    let mut done = total - open.len();
    let said = |done: usize| format!("{} ({done} of {total} frames; the same command goes on)", folder.display());
    if done > 0 {
        interrupt::has_replaced(said(done));
    }
    // Frames of one time step share its mesh.
    for group in open.chunk_by(|a, b| a.step == b.step) {
        let Some(first) = group.first() else { continue };
        StudyProgress::report(bar, "reading", done as u64, total as u64);
        kept.volume(asked, &record.steps, first.step)?;
        let Kept { volume: Some((_, volume)), said: warned } = &mut *kept else { continue };
        let field = volume.field_of_section(&record.scene.mesh)?;
        for frame in group {
            StudyProgress::report(bar, &format!("drawing {}", frame.file), done as u64, total as u64);
            let warnings = draw_frame(asked, &record.scene, &field, frame)?;
            warnings.iter().for_each(|text| say_once(warned, text));
            interrupt::replaces(&said(done), said(done + 1));
            done += 1;
        }
    }
    Ok(open.len())
}

/// Draws one frame; gives what the user should know.
fn draw_frame(
    asked: &Asked<'_>,
    scene: &SceneFile,
    field: &VolumeField<'_>,
    frame: &FrameFile,
) -> Result<Vec<String>, Failure> {
    let args = asked.args;
    let mut scene = scene.clone();
    scene.camera = turned_camera(&scene.camera, args.axis, frame.turned)?;
    let wrong = |error: tetrascope::Error| wrong_scene(asked.scene_path, error);
    let mut completed: Completed = scene.complete(&field.facts).map_err(|error| wrong(error.into()))?;
    completed.scene.threads = args.look.threads.map(usize::from);
    let plan = field.plan(&mut completed).map_err(wrong)?;
    let pixels = u64::from(plan.view.width) * u64::from(plan.view.height);
    field.check_memory(&plan, &[("files", 32 * pixels)])?;
    let rendered = field.render(&plan, &Unseen)?;
    interrupt::go_on()?;
    write_image(&args.output.join(&frame.file), &rendered.image, plan.background).map_err(tetrascope::Error::Io)?;
    let mut warnings = field.order_worth(&plan, &rendered).warnings;
    warnings.extend(field.precision_warnings(&plan));
    Ok(warnings)
}

/// Progress of one frame, of which nothing is shown: frames are counted.
#[derive(Debug)]
struct Unseen;

impl Progress for Unseen {
    fn report(&self, _stage: Stage, _done: u64, _total: u64) {}

    fn is_stopped(&self) -> bool {
        interrupt::is_stopped()
    }
}
