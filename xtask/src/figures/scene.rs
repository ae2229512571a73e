//! A scene file of the gallery with its mesh.

use std::fs;
use std::path::{Path, PathBuf};

use tetrascope::{LinearImage, Plan, SceneFile, Silent, Volume, VolumeField, is_builtin, render_volume, resolve_path};

use super::sheet;
use crate::Failure;

/// A scene and the mesh that it shows.
#[derive(Debug)]
pub(super) struct Drawing {
    pub(super) scene: SceneFile,
    pub(super) volume: Volume,
}

impl Drawing {
    /// Reads the scene `xtask/figures/NAME.toml` and its mesh; `None`, with a loud word, where the mesh is absent.
    pub(super) fn load(name: &str) -> Result<Option<Self>, Failure> {
        let scene = read_scene(name)?;
        let mesh = resolve_path(&folder(), &scene.mesh.path);
        let solution = scene.mesh.solution.as_ref().map(|path| resolve_path(&folder(), path));
        let absent = |path: &&PathBuf| !is_builtin(path) && !path.exists();
        if let Some(path) = [Some(&mesh), solution.as_ref()].into_iter().flatten().find(absent) {
            println!("SKIPPED {name}: there is no {}", path.display());
            return Ok(None);
        }
        let volume = Volume::of_section(&scene.mesh, &folder(), None)?;
        Ok(Some(Self { scene, volume }))
    }

    /// The picture over the scene's background, opaque; its longer side has `size` pixels.
    pub(super) fn picture(&self, size: u32) -> Result<LinearImage, Failure> {
        let mut scene = self.scene.clone();
        let (width, height) = (u64::from(scene.image.width), u64::from(scene.image.height));
        let longer = width.max(height).max(1);
        let fitted = |side: u64| u32::try_from((side * u64::from(size) / longer).max(1));
        (scene.image.width, scene.image.height) = (fitted(width)?, fitted(height)?);
        let picture = render_volume(&self.volume, &scene, &Silent)?;
        for warning in &picture.warnings {
            println!("{}: {warning}", self.scene.mesh.path.display());
        }
        Ok(sheet::over(&picture.image, picture.plan.background))
    }

    /// The field that the scene names.
    pub(super) fn field(&self) -> Result<VolumeField<'_>, Failure> {
        Ok(self.volume.field(self.scene.mesh.field.as_deref())?)
    }

    /// What the renderer is told.
    pub(super) fn plan(&self) -> Result<Plan, Failure> {
        Ok(self.scene.complete(&self.field()?.facts)?.scene.plan()?)
    }
}

/// The scene `xtask/figures/NAME.toml`.
pub(super) fn read_scene(name: &str) -> Result<SceneFile, Failure> {
    let path = folder().join(format!("{name}.toml"));
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(SceneFile::parse(&text, &path)?)
}

/// The folder of scenes.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("figures")
}
