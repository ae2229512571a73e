//! `tetrascope render`: from inputs and options to pictures and a report.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tetrascope::{
    Completed, ErrorFigures, Plan, Rendered, SceneFile, Volume, VolumeField, check_writable, explain_blank, is_blank,
    warn_of_non_finite, write_image,
};

use crate::Failure;
use crate::args::RenderArgs;
use crate::compare::write_difference;
use crate::interrupt;
use crate::progress::Bar;
use crate::report::Report;
use crate::scene_of::scene_of;
use crate::scene_paths::{self, folder_of};

/// Where a picture goes when nothing is said.
pub(crate) const DEFAULT_OUTPUT: &str = "tetrascope.png";

pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let (scene, base_dir) = scene_of(&args.scene)?;
    let default_output = [PathBuf::from(DEFAULT_OUTPUT)];
    let outputs = if args.output.is_empty() { &default_output[..] } else { &args.output };
    let job = Job {
        scene,
        scene_path: args.scene.file(),
        base_dir,
        outputs,
        write_scene: args.write_scene.as_deref(),
        threads: args.scene.look.threads.map(usize::from),
        quiet: args.quiet,
        json: args.json,
        explain: args.explain,
        verify: args.verify,
        error_map: args.error_map.as_deref(),
    };
    job.run()
}

/// One picture to be made.
#[derive(Debug)]
pub(crate) struct Job<'a> {
    /// With the options' overrides.
    pub(crate) scene: SceneFile,
    /// The file that the scene was read from, for messages.
    pub(crate) scene_path: Option<&'a Path>,
    /// What the scene's paths are relative to.
    pub(crate) base_dir: PathBuf,
    pub(crate) outputs: &'a [PathBuf],
    pub(crate) write_scene: Option<&'a Path>,
    pub(crate) threads: Option<usize>,
    pub(crate) quiet: bool,
    pub(crate) json: bool,
    /// Whether the device's memory, times and pipelines are told.
    pub(crate) explain: bool,
    /// Whether the reference is drawn and compared with.
    pub(crate) verify: bool,
    /// Where the error of every pixel goes.
    pub(crate) error_map: Option<&'a Path>,
}

impl Job<'_> {
    /// Makes it, telling each step as soon as it is done.
    pub(crate) fn run(&self) -> Result<(), Failure> {
        // What can be wrong with the targets is said before minutes of work, not after.
        self.outputs.iter().try_for_each(|path| check_target(path, &["png", "exr"], "pictures"))?;
        self.error_map.iter().try_for_each(|path| check_target(path, &["exr", "png"], "error maps"))?;
        self.write_scene.iter().try_for_each(|path| check_target(path, &["toml", "json"], "scenes"))?;
        let targets = self.outputs.iter().map(PathBuf::as_path).chain(self.write_scene).chain(self.error_map);
        targets.for_each(interrupt::will_write);
        let start = Instant::now();
        let bar = Bar::new(self.quiet);
        let mut report = Report::new(self.quiet, self.json);
        let done = self.make(&bar, &mut report);
        bar.clear();
        done?;
        report.finish(start.elapsed());
        Ok(())
    }

    fn make(&self, bar: &Bar, report: &mut Report) -> Result<(), Failure> {
        bar.step("reading and cutting into tetrahedra");
        let volume = Volume::of_section(&self.scene.mesh, &self.base_dir, bar.reading())?;
        bar.clear();
        interrupt::go_on()?;
        report.volume(&volume);

        let start = Instant::now();
        let field = volume.field_of_section(&self.scene.mesh)?;
        report.field(&field, start.elapsed());

        bar.step("choosing methods");
        let start = Instant::now();
        let (completed, plan) = self.decide(&field, volume.step_of_several())?;
        bar.clear();
        report.chose_in(start.elapsed());
        interrupt::go_on()?;
        report.plan(&completed, &plan, self.threads);
        field.check_memory(&plan, &self.memory_besides(&plan))?;

        let rendered = field.render(&plan, bar)?;
        bar.clear();
        report.rendered(&rendered, &plan, &field.order_worth(&plan, &rendered));
        field.precision_warnings(&plan).iter().for_each(|warning| report.warn(warning));
        report.device(&rendered, &plan, self.explain);
        self.keep_heights(&field, &completed, &plan, report)?;
        if let Some(warning) = warn_of_non_finite(&rendered.image) {
            report.warn(&warning);
        } else if is_blank(&rendered.image) {
            report.blank(&explain_blank(&plan, &field.facts));
        }
        let written_in = self.write(&completed, &plan, &rendered, report)?;
        report.wrote_in(written_in);
        self.say_errors(&field, &plan, &rendered, bar, report)
    }

    /// What the files take on their way out, and the reference that errors are measured by.
    fn memory_besides(&self, plan: &Plan) -> [(&'static str, u64); 2] {
        let pixels = u64::from(plan.view.width) * u64::from(plan.view.height);
        let is_linear =
            |path: &PathBuf| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"));
        let file = if self.outputs.iter().any(is_linear) { 32 } else { 6 };
        let reference = if self.verify || self.error_map.is_some() { 48 } else { 0 };
        [("files", file * pixels), ("reference", reference * pixels)]
    }

    /// Keeps what the order found out; the file counts as written if it is another one then.
    fn keep_heights(
        &self,
        field: &VolumeField<'_>,
        completed: &Completed,
        plan: &Plan,
        report: &mut Report,
    ) -> Result<(), Failure> {
        interrupt::go_on()?;
        let path = field.heights_path();
        let changed = || path.as_ref().and_then(|path| std::fs::metadata(path).ok()?.modified().ok());
        let before = changed();
        if let Some(warning) = field.keep_heights(completed, plan) {
            report.warn(&warning);
        }
        if let Some(path) = path.as_ref().filter(|_| changed() != before) {
            interrupt::wrote(path);
        }
        interrupt::go_on()
    }

    /// How wrong the picture is thought to be, and how wrong it is where that was asked for. After the picture was written: it is not
    /// lost if the reference takes too long.
    fn say_errors(
        &self,
        field: &VolumeField<'_>,
        plan: &Plan,
        rendered: &Rendered,
        bar: &Bar,
        report: &mut Report,
    ) -> Result<(), Failure> {
        // Whoever wants quiet and an error hears if it is not met.
        if !self.quiet || self.scene.quality.max_error.is_some() {
            bar.step("estimating the error");
            let start = Instant::now();
            let estimate = field.estimate_error(plan, rendered)?;
            bar.clear();
            interrupt::go_on()?;
            report.error(&estimate, self.scene.quality.max_error, start.elapsed());
        }
        if !self.verify && self.error_map.is_none() {
            return Ok(());
        }
        let start = Instant::now();
        let exact = field.reference_picture(plan, bar)?;
        bar.clear();
        if let Some(figures) = ErrorFigures::between(&rendered.image, &exact).filter(|_| self.verify) {
            report.verified(&figures, self.scene.quality.max_error);
        }
        if let Some(path) = self.error_map {
            write_difference(path, &rendered.image, &exact)?;
            report.wrote(path);
        }
        report.verified_in(start.elapsed());
        Ok(())
    }

    fn decide(&self, field: &VolumeField<'_>, step: Option<usize>) -> Result<(Completed, Plan), Failure> {
        let wrong = |error: tetrascope::Error| wrong_scene(self.scene_path, error);
        let mut completed = self.scene.complete(&field.facts).map_err(|error| wrong(error.into()))?;
        completed.file.mesh.field = Some(field.field.name.clone());
        completed.file.mesh.settle_step(step);
        completed.scene.threads = self.threads;
        let plan = field.plan(&mut completed).map_err(wrong)?;
        Ok((completed, plan))
    }

    fn write(
        &self,
        completed: &Completed,
        plan: &Plan,
        rendered: &Rendered,
        report: &mut Report,
    ) -> Result<Duration, Failure> {
        let start = Instant::now();
        for path in self.outputs {
            write_image(path, &rendered.image, plan.background).map_err(tetrascope::Error::Io)?;
            report.wrote(path);
        }
        if let Some(path) = self.write_scene {
            scene_paths::write(&completed.file, &self.base_dir, path)?;
            report.wrote(path);
        }
        Ok(start.elapsed())
    }
}

/// What is wrong with a scene, under the name of its file if it has one.
pub(crate) fn wrong_scene(scene_path: Option<&Path>, error: tetrascope::Error) -> Failure {
    match (scene_path, error) {
        (Some(path), tetrascope::Error::Scene(error)) => Failure::Input(format!("{}: {error}", path.display())),
        (_, error) => error.into(),
    }
}

/// Refuses a target of the wrong kind, in a folder that is not there, or in one that takes no file.
pub(crate) fn check_target(path: &Path, extensions: &[&str], kind: &str) -> Result<(), Failure> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !extensions.contains(&extension.as_str()) {
        let known = extensions.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(" and ");
        return Err(Failure::Usage(format!("{}: {kind} are written as {known}, by extension", path.display())));
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(Failure::Input(format!(
            "{}: there is no folder {}; make it first",
            path.display(),
            folder.display()
        )));
    }
    Ok(check_writable(path).map_err(tetrascope::Error::Io)?)
}
