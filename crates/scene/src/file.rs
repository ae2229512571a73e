//! The scene file's sections, key by key.
//!
//! What may be left out is an `Option`; [`SceneFile::complete`] fills it with numbers. Unknown keys are refused.

mod names;
mod quality;
mod surfaces;
mod transfer;

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use tetrascope_integrate::OpticalModel;

pub use names::Choice;
pub use quality::{IsosurfaceMethodName, LengthAxisName, QualitySection};
pub use surfaces::{IsosurfaceSection, LightDirection, LightName, LightSection, Shading, SurfaceSection};
pub use transfer::{OpacityName, PresetMap, TransferSection};

use names::as_name;

/// A scene as its file says it: everything one picture depends on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Which mesh and which of its fields.
    pub mesh: MeshSection,
    /// From where it is seen.
    #[serde(default)]
    pub camera: CameraSection,
    /// The picture's size and background.
    #[serde(default)]
    pub image: ImageSection,
    /// What color and extinction mean.
    #[serde(default)]
    pub optics: OpticsSection,
    /// Color and extinction over the scalar.
    #[serde(default)]
    pub transfer: TransferSection,
    /// Surfaces of one value.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub isosurface: Vec<IsosurfaceSection>,
    /// Opaque geometry standing in the volume.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub surface: Vec<SurfaceSection>,
    /// For shaded isosurfaces, and for the volume where it is lit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub light: Option<LightSection>,
    /// How it is computed.
    #[serde(default)]
    pub quality: QualitySection,
}

/// `[mesh]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshSection {
    /// The mesh file, relative to the scene file.
    pub path: PathBuf,
    /// PLOT3D: the solution file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solution: Option<PathBuf>,
    /// The field to show: an array's name, with `:0`, `:x` or `:mag` for a vector's component or magnitude.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// Which of the file's time steps, counted from 0; the last one if neither this nor `time` is there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<usize>,
    /// In place of `step`: the time step nearest to this time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// That the file is a raw volume, and of what: `"64x64x64:uint8"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub raw: Option<String>,
    /// Whether a cell array is drawn as one constant a cell, instead of being averaged onto the points.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub cells: bool,
}

impl MeshSection {
    /// Names the time step that was read, in place of a time or of the last one; nothing is said of a mesh without steps.
    pub fn settle_step(&mut self, step: Option<usize>) {
        if step.is_some() {
            (self.step, self.time) = (step, None);
        }
    }

    /// A mesh of which only the path is said.
    pub fn of_path(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), solution: None, field: None, step: None, time: None, raw: None, cells: false }
    }
}

/// `[camera]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraSection {
    /// How rays spread.
    #[serde(default)]
    pub projection: ProjectionName,
    /// World coordinates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// World coordinates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<[f64; 3]>,
    /// A direction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<[f64; 3]>,
    /// Full vertical angle, degrees; perspective only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fov_y: Option<f64>,
    /// Full height of the view, world units; orthographic only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
}

/// `camera.projection`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ProjectionName {
    /// All rays start at the eye.
    #[default]
    Perspective,
    /// All rays are parallel.
    Orthographic,
}

/// `[image]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ImageSection {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB.
    pub background: [f64; 3],
}

impl Default for ImageSection {
    fn default() -> Self {
        Self { width: 512, height: 512, background: [0.0; 3] }
    }
}

/// `[optics]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpticsSection {
    /// What color and extinction mean.
    #[serde(default = "density_emitter", with = "as_name")]
    pub model: OpticalModel,
}

fn density_emitter() -> OpticalModel {
    OpticalModel::DensityEmitter
}

impl Default for OpticsSection {
    fn default() -> Self {
        Self { model: density_emitter() }
    }
}

impl SceneFile {
    /// A scene that says nothing but the mesh's path.
    pub fn of_mesh(path: impl Into<PathBuf>) -> Self {
        Self {
            mesh: MeshSection::of_path(path),
            camera: CameraSection::default(),
            image: ImageSection::default(),
            optics: OpticsSection::default(),
            transfer: TransferSection::default(),
            isosurface: Vec::new(),
            surface: Vec::new(),
            light: None,
            quality: QualitySection::default(),
        }
    }
}
