//! From a scene to a picture in one call.

use std::path::Path;
use std::time::{Duration, Instant};

use tetrascope_io::write_image;
use tetrascope_scene::{Counts, DeviceReport, Plan, Progress, SceneFile, explain_blank};
use tetrascope_view::LinearImage;

use crate::{Error, OrderWorth, Volume, read_preset};

/// A picture, and how it was made.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Linear, premultiplied, with no background.
    pub image: LinearImage,
    /// What was computed, with a reason for every choice.
    pub plan: Plan,
    /// The scene with every default as a number.
    pub completed: SceneFile,
    /// What the user should know; ends with the likely reasons if there is nothing to see.
    pub warnings: Vec<String>,
    /// Wall time of each step, in order.
    pub timings: Vec<(String, Duration)>,
    /// What the back end did.
    pub counts: Counts,
    /// What the order of its cells was worth.
    pub order: OrderWorth,
    /// The device that drew it, if one did.
    pub device: Option<DeviceReport>,
}

impl Picture {
    /// Writes the picture: `.png` over the scene's background, or `.exr` in linear floats.
    ///
    /// # Errors
    /// [`Error::Io`] for another extension or if the file cannot be written; no part of it is left then.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(write_image(path.as_ref(), &self.image, self.plan.background)?)
    }
}

/// Reads the scene's mesh, fills what the scene leaves open, and draws it.
///
/// Paths in the scene are relative to `base_dir`, the folder of the scene file.
///
/// # Errors
/// [`Error`], from whichever step failed.
pub fn render_scene(scene: &SceneFile, base_dir: &Path, progress: &dyn Progress) -> Result<Picture, Error> {
    let mut scene = scene.clone();
    read_preset(&mut scene, base_dir)?;
    let volume = Volume::of_section(&scene.mesh, base_dir, None)?;
    render_volume(&volume, &scene, progress)
}

/// Draws a mesh that is in memory: of the scene's `[mesh]` only the field is looked at. A preset was [read](read_preset) before.
///
/// # Errors
/// [`Error`], from whichever step failed; [`Error::Memory`] before anything is drawn where the picture needs more memory than is left.
pub fn render_volume(volume: &Volume, scene: &SceneFile, progress: &dyn Progress) -> Result<Picture, Error> {
    let field = volume.field_of_section(&scene.mesh)?;
    let mut completed = scene.complete(&field.facts)?;
    completed.file.mesh.field = Some(field.field.name.clone());
    completed.file.mesh.settle_step(volume.step_of_several());
    let start = Instant::now();
    let plan = field.plan(&mut completed)?;
    let chosen = start.elapsed();
    field.check_memory(&plan, &[])?;
    let rendered = field.render(&plan, progress)?;
    let order = field.order_worth(&plan, &rendered);
    completed.warnings.extend(field.keep_heights(&completed, &plan));

    let mut warnings = volume.warnings.clone();
    warnings.extend(volume.decomposition.counts.findings());
    warnings.extend(field.field.warnings.iter().cloned());
    warnings.extend(field.on_mesh.warning());
    warnings.extend(completed.warnings);
    warnings.extend(order.warnings.iter().cloned());
    warnings.extend(field.precision_warnings(&plan));
    warnings.extend(warn_of_non_finite(&rendered.image));
    if is_blank(&rendered.image) {
        warnings.push("the picture is blank".to_owned());
        warnings.extend(explain_blank(&plan, &field.facts));
    }
    let steps = volume.timings.iter().map(|(step, time)| ((*step).to_owned(), *time));
    let stages = rendered.timings.iter().map(|(stage, time)| (stage.to_string(), *time));
    Ok(Picture {
        image: rendered.image,
        plan,
        completed: completed.file,
        warnings,
        timings: steps.chain([("choose".to_owned(), chosen)]).chain(stages).collect(),
        counts: rendered.counts,
        order,
        device: rendered.device,
    })
}

/// Whether no channel of any pixel reaches 1/255, alpha included.
pub fn is_blank(image: &LinearImage) -> bool {
    image.pixels().iter().flatten().all(|channel| channel.is_nan() || *channel < 1.0 / 255.0)
}

/// A warning if pixels are NaN or infinite, which is a defect of a back end; `None` otherwise.
pub fn warn_of_non_finite(image: &LinearImage) -> Option<String> {
    let is_bad = |pixel: &[f32; 4]| !pixel.iter().all(|channel| channel.is_finite());
    let first = image.pixels().iter().position(is_bad)?;
    let count = image.pixels().iter().filter(|pixel| is_bad(pixel)).count();
    let width = image.width() as usize;
    Some(format!(
        "{count} pixels are no numbers (the first is column {}, row {}): the back end failed there; compare with the back \
         end \"reference\"",
        first % width,
        first / width
    ))
}
