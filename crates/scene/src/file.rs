//! The scene file's sections, key by key.
//!
//! What may be left out is an `Option`; [`SceneFile::complete`] fills it with numbers. Unknown keys are refused.

use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use tetrascope_integrate::{Integration, OpticalModel};
use tetrascope_order::OrderMethod;

use crate::Backend;

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
    /// For shaded isosurfaces.
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

/// `[transfer]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransferSection {
    /// Scalar and linear R, G, B.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Vec<[f64; 4]>>,
    /// Scalar and extinction per world unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extinction: Option<Vec<[f64; 2]>>,
    /// A color map file, in place of the two.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<PathBuf>,
}

/// `[[isosurface]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IsosurfaceSection {
    /// The scalar on it.
    pub value: f64,
    /// Linear RGB of the side that faces rising scalars.
    pub color: [f64; 3],
    /// Linear RGB of the other side; none means the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back_color: Option<[f64; 3]>,
    /// 0 to 1.
    #[serde(default = "opaque")]
    pub opacity: f64,
    /// How light falls on it.
    #[serde(default)]
    pub shading: Shading,
}

fn opaque() -> f64 {
    1.0
}

/// `isosurface.shading`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Shading {
    /// Its color, everywhere.
    #[default]
    None,
    /// One normal a cell.
    Flat,
    /// Interpolated gradients.
    Smooth,
}

/// `[[surface]]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfaceSection {
    /// The geometry file, relative to the scene file.
    pub path: PathBuf,
}

/// `[light]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LightSection {
    /// From the surface towards the light.
    pub direction: LightDirection,
    /// Share of the color that is there without light.
    pub ambient: f64,
    /// Share that depends on the angle of the light.
    pub diffuse: f64,
    /// Strength of the highlight.
    pub specular: f64,
    /// Its sharpness.
    pub shininess: f64,
}

impl Default for LightSection {
    fn default() -> Self {
        Self {
            direction: LightDirection::Named(LightName::Headlight),
            ambient: 0.2,
            diffuse: 0.7,
            specular: 0.3,
            shininess: 32.0,
        }
    }
}

/// `light.direction`
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected \"headlight\" or a vector of three numbers")]
pub enum LightDirection {
    /// By name.
    Named(LightName),
    /// World coordinates.
    Vector([f64; 3]),
}

/// Lights that have a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LightName {
    /// From where the eye is.
    Headlight,
}

/// `[quality]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct QualitySection {
    /// How a ray's segment in a cell becomes color and opacity.
    pub integration: Choice<Integration>,
    /// In which order cells are blended.
    pub order: Choice<OrderMethod>,
    /// Number of slabs, for `order = "bucket"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slabs: Option<u32>,
    /// The largest error wanted in a channel, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_error: Option<f64>,
    /// Who computes.
    #[serde(with = "as_name")]
    pub backend: Backend,
}

/// A method by name, or the freedom to choose one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice<T> {
    /// `"auto"`: chosen for the scene, with a reason.
    #[default]
    Auto,
    /// This one.
    Named(T),
}

impl<T: FromStr> FromStr for Choice<T> {
    type Err = T::Err;

    fn from_str(name: &str) -> Result<Self, T::Err> {
        if name == "auto" { Ok(Self::Auto) } else { name.parse().map(Self::Named) }
    }
}

impl<T: Display> Display for Choice<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Named(method) => method.fmt(f),
        }
    }
}

impl<T: Display> Serialize for Choice<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de, T> Deserialize<'de> for Choice<T>
where
    T: FromStr,
    T::Err: Display,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        as_name::deserialize(deserializer)
    }
}

/// Reads and writes what has `FromStr` and `Display` as a string.
mod as_name {
    use super::{Deserialize, Deserializer, Display, FromStr, Serializer};
    use serde::de::Error;

    pub(super) fn serialize<T: Display, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(value)
    }

    pub(super) fn deserialize<'de, T, D>(deserializer: D) -> Result<T, D::Error>
    where
        T: FromStr,
        T::Err: Display,
        D: Deserializer<'de>,
    {
        String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
    }
}

impl SceneFile {
    /// A scene that says nothing but the mesh's path.
    pub fn of_mesh(path: impl Into<PathBuf>) -> Self {
        Self {
            mesh: MeshSection { path: path.into(), solution: None, field: None },
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
