//! `tetrascope study`: what accuracy costs in time, for one scene.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tetrascope::{Backend, Choice, Plan, SceneFile, Volume, VolumeField, check_writable, foresee_blank, make_folder};
use tetrascope_study::{Figure, Options, Outcome, Study, bytes_text, error_text, ms_text, percent_text};

use crate::Failure;
use crate::args::StudyArgs;
use crate::interrupt;
use crate::progress::Bar;
use crate::render::wrong_scene;
use crate::report::{line, object, warning};
use crate::scene_of::scene_as_seen;
use crate::scene_paths::is_scene;

pub(crate) fn run(args: &StudyArgs) -> Result<(), Failure> {
    // What is wrong with the folder is said before minutes of work, not after.
    // Where the study fails, those that are empty go again.
    let missing: Vec<&Path> = args.output.ancestors().take_while(|folder| !is_there(folder)).collect();
    missing.into_iter().rev().for_each(interrupt::made_folder);
    make_folder(&args.output).map_err(tetrascope::Error::Io)?;
    let name = format!("the study in {}", args.output.display());
    if ["study.csv", "study.json", "study.svg", "study.html"].iter().any(|file| args.output.join(file).exists()) {
        interrupt::will_replace(name.clone());
    }
    check_writable(&args.output.join("study.html")).map_err(tetrascope::Error::Io)?;
    let bar = Bar::new(false);
    let done = study(args, &bar);
    bar.clear();
    let study = done?;
    interrupt::go_on()?;
    let paths = study.write(&args.output).map_err(failure)?;
    interrupt::has_replaced(name);
    if args.json {
        let files: Vec<Value> = paths.iter().map(|path| json!(path.display().to_string())).collect();
        let mut said = tetrascope_study::json(&study);
        said["written"] = Value::Array(files);
        object(&said);
        return Ok(());
    }
    table(&study).iter().for_each(|text| line(text));
    paths.iter().for_each(|path| line(&format!("wrote       {}", path.display())));
    line(&format!("time        {:.1} s in all", study.took.as_secs_f64()));
    Ok(())
}

/// Whether a folder need not be made; the empty path is the current one.
fn is_there(folder: &Path) -> bool {
    folder.as_os_str().is_empty() || folder.exists()
}

fn failure(error: tetrascope_study::Error) -> Failure {
    Failure::Input(error.to_string())
}

fn study(args: &StudyArgs, bar: &Bar) -> Result<Study, Failure> {
    let (scene, base_dir) = scene_as_seen(&args.input, &args.mesh, &args.camera, args.size)?;

    bar.step("reading and cutting into tetrahedra");
    let volume = Volume::of_section(&scene.mesh, &base_dir, bar.reading())?;
    let field = volume.field_of_section(&scene.mesh)?;
    bar.clear();
    interrupt::go_on()?;
    let findings = volume.decomposition.counts.findings();
    let warnings = volume.warnings.iter().chain(&findings).chain(&field.field.warnings).cloned();
    warnings.chain(field.on_mesh.warning()).for_each(|text| warning(&text));

    bar.step("choosing methods");
    let scene_path = args.input.first().map(PathBuf::as_path).filter(|path| is_scene(path));
    let threads = args.threads.map(usize::from);
    let (own, warnings) = plan_of(&field, scene.clone(), threads, scene_path)?;
    interrupt::go_on()?;
    let (start, _) = plan_of(&field, as_auto_has_it(scene), threads, scene_path)?;
    bar.clear();
    warnings.iter().for_each(|text| warning(text));
    let blank = foresee_blank(&start, &field.facts);
    if !blank.is_empty() {
        warning(&format!("the pictures will be blank: {}", blank.join("; ")));
    }

    let options = Options {
        name: name_of(&args.input[0]),
        is_quick: args.quick,
        frames: args.frames.map(u32::from),
        adapter: args.adapter.clone(),
        // The reference is what all are compared with, and no setting.
        scene_plan: Some(own).filter(|plan| plan.backend != Backend::Reference),
        ..Options::default()
    };
    Study::run(&field, &start, &options, bar).map_err(failure)
}

/// The scene with its methods left open: where the study begins.
fn as_auto_has_it(mut scene: SceneFile) -> SceneFile {
    let quality = &mut scene.quality;
    quality.integration = Choice::Auto;
    (quality.table_size, quality.table_lengths, quality.length_axis, quality.max_error) = (None, None, None, None);
    (quality.slabs, quality.window) = (None, None);
    quality.order = Choice::Auto;
    (quality.cycles, quality.interpolation, quality.isosurfaces, quality.map_size) = (None, Choice::Auto, None, None);
    quality.replace_backend(Choice::Named(Backend::Cpu));
    scene
}

fn plan_of(
    field: &VolumeField<'_>,
    scene: SceneFile,
    threads: Option<usize>,
    scene_path: Option<&Path>,
) -> Result<(Plan, Vec<String>), Failure> {
    let wrong = |error: tetrascope::Error| wrong_scene(scene_path, error);
    let mut completed = scene.complete(&field.facts).map_err(|error| wrong(error.into()))?;
    completed.scene.threads = threads;
    let plan = field.plan(&mut completed).map_err(wrong)?;
    Ok((plan, completed.warnings))
}

/// The input's name without its folders.
fn name_of(input: &Path) -> String {
    input.file_stem().map_or_else(|| input.display().to_string(), |stem| stem.to_string_lossy().into_owned())
}

/// All settings by time, those of the frontier marked, and what was left out.
fn table(study: &Study) -> Vec<String> {
    let mut outcomes: Vec<&Outcome> = study.outcomes.iter().collect();
    outcomes.sort_by_key(|outcome| outcome.frame.median);
    let head =
        ["", "ms", "fastest-slowest", "largest", "rms", "99.9 %", "> 1/255", "set-up ms", "memory", "most time in"];
    let mut rows = vec![head.map(str::to_owned)];
    rows[0][0] = "setting".to_owned();
    rows.extend(outcomes.into_iter().map(row));
    let widths: Vec<usize> =
        (0..head.len()).map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)).collect();
    let mut lines: Vec<String> = rows
        .iter()
        .map(|row| {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| match column {
                0 => format!("{cell:width$}"),
                9 => cell.clone(),
                _ => format!("{cell:>width$}"),
            });
            cells.collect::<Vec<_>>().join("  ")
        })
        .collect();
    let view = &study.start.view;
    lines.push("* nothing else is faster and as right (largest error)".to_owned());
    if study.outcomes.iter().any(|outcome| outcome.setting.is_scene) {
        lines.push("> what the scene asks for".to_owned());
    }
    lines.push(format!(
        "settings    {}, frames timed of each {}, at {} x {}; the reference took {} ms",
        study.outcomes.len(),
        study.frames,
        view.width,
        view.height,
        ms_text(study.reference_time)
    ));
    lines.extend(study.left_out.iter().map(|one| format!("left out    {}: {}", one.name, one.reason)));
    lines
}

fn row(outcome: &Outcome) -> [String; 10] {
    let mark = match (outcome.is_on_frontier(Figure::Largest), outcome.setting.is_scene) {
        (true, true) => "*>",
        (true, false) => "* ",
        (false, true) => " >",
        (false, false) => "  ",
    };
    let (frame, errors) = (outcome.frame, outcome.errors);
    [
        format!("{mark} {}", outcome.setting.name),
        ms_text(frame.median),
        format!("{}-{}", ms_text(frame.fastest), ms_text(frame.slowest)),
        error_text(errors.largest),
        error_text(errors.root_mean_square),
        error_text(errors.percentile_99_9),
        percent_text(errors.share_above_step),
        ms_text(outcome.set_up),
        bytes_text(outcome.bytes()),
        outcome.dominant().map_or_else(String::new, |(stage, share)| format!("{stage} {}", percent_text(share))),
    ]
}
