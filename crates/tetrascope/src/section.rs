//! What a scene names and other files hold: its mesh, its field, its color map.

use std::path::Path;
use std::sync::Arc;

use tetrascope_colors::read_presets;
use tetrascope_io::{RawVolume, ReadOptions, ReadProgress, StepChoice, read_small_file};
use tetrascope_scene::{MeshSection, PresetMap, SceneError, SceneFile};

use crate::{Error, Volume, VolumeField, resolve_path};

/// Bytes that a file of color maps may have: those that ParaView comes with have a few hundred thousand.
const MOST_PRESET_BYTES: u64 = 16 << 20;

impl Volume {
    /// Reads the mesh that a scene names, at the time that it names.
    ///
    /// - `base_dir`: what the scene's paths are relative to
    /// - `progress`: who is told of reading
    ///
    /// # Errors
    /// Those of [`Volume::load`], and [`Error::Scene`] for keys that contradict each other or say nothing.
    pub fn of_section(
        section: &MeshSection,
        base_dir: &Path,
        progress: Option<Arc<dyn ReadProgress>>,
    ) -> Result<Self, Error> {
        let options = ReadOptions { progress, ..read_options(section, base_dir)? };
        Self::load(&resolve_path(base_dir, &section.path), &options)
    }

    /// The field that a scene names, averaged onto points or constant in each cell.
    ///
    /// # Errors
    /// Those of [`Volume::field`] and [`Volume::cell_field`].
    pub fn field_of_section(&self, section: &MeshSection) -> Result<VolumeField<'_>, Error> {
        let name = section.field.as_deref();
        if section.cells { self.cell_field(name) } else { self.field(name) }
    }
}

/// What a scene says of its mesh file besides the name.
///
/// # Errors
/// [`Error::Scene`] for a step and a time, and for a raw volume that is none.
pub fn read_options(section: &MeshSection, base_dir: &Path) -> Result<ReadOptions, Error> {
    let step = match (section.step, section.time) {
        (None, None) => StepChoice::Last,
        (Some(step), None) => StepChoice::Number(step),
        (None, Some(time)) => StepChoice::Time(time),
        (Some(step), Some(_)) => {
            return Err(Error::Scene(SceneError::Conflict {
                key: "mesh.step",
                value: step.to_string(),
                problem: "and mesh.time both say which time step".to_owned(),
                remedy: "remove one of them",
            }));
        }
    };
    let raw = section.raw.as_deref().map(str::parse::<RawVolume>).transpose();
    let raw = raw.map_err(|expected| SceneError::Value {
        key: "mesh.raw".to_owned(),
        value: section.raw.clone().unwrap_or_default(),
        expected,
    })?;
    let solution = section.solution.as_ref().map(|path| resolve_path(base_dir, path));
    Ok(ReadOptions { solution, step, raw, progress: None })
}

/// Reads the color map that a scene names by a file into the scene; nothing is done for a scene that names none.
///
/// - `base_dir`: what the scene's paths are relative to
///
/// # Errors
/// [`Error::Io`] if the file is not read, [`Error::Color`] if it holds no color map, or several of which none is chosen.
pub fn read_preset(scene: &mut SceneFile, base_dir: &Path) -> Result<(), Error> {
    let transfer = &mut scene.transfer;
    let Some(path) = &transfer.preset else { return Ok(()) };
    let path = base_dir.join(path);
    let bytes = read_small_file(&path, MOST_PRESET_BYTES)?;
    let presets = read_presets(&path.display().to_string(), &bytes)?;
    let map = presets.choose(transfer.preset_name.as_deref())?;
    transfer.preset_map = Some(PresetMap { map, warnings: presets.warnings().to_vec() });
    Ok(())
}
