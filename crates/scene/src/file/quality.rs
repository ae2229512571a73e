//! The section that says how a picture is computed.

use serde::{Deserialize, Serialize};
use tetrascope_integrate::{Integration, LengthAxis};
use tetrascope_order::{CycleRemedy, OrderMethod};

use super::names::{Choice, as_optional_name};
use crate::{Backend, GpuPath, Interpolation, IsosurfaceMethod, Mixing};

/// `[quality]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct QualitySection {
    /// How a ray's segment in a cell becomes color and opacity.
    pub integration: Choice<Integration>,
    /// How what a ray has inside a cell is found at a pixel.
    pub interpolation: Choice<Interpolation>,
    /// In which order cells are blended.
    pub order: Choice<OrderMethod>,
    /// Number of slabs, for `order = "bucket"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slabs: Option<u32>,
    /// Cells that a pixel holds back, for `order = "k-buffer"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<u32>,
    /// What is done about cells that hide one another in rings, for orders that look for them: `"mpvo"` and `"bsp-xmpvo"`.
    #[serde(skip_serializing_if = "Option::is_none", with = "as_optional_name")]
    pub cycles: Option<CycleRemedy>,
    /// Whether the heights of `order = "power"` are kept in a file beside the mesh and read from there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep_heights: Option<bool>,
    /// Samples along each scalar axis of a table, and along its axis of lengths unless `table_lengths` says otherwise;
    /// for `integration = "table-2d"` and `"table-3d"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table_size: Option<u32>,
    /// Samples along the axis of chord lengths, for `integration = "table-3d"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table_lengths: Option<u32>,
    /// How those are spaced.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_axis: Option<LengthAxisName>,
    /// How isosurfaces are found along a ray.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub isosurfaces: Option<IsosurfaceMethodName>,
    /// Samples along each side of the maps of isosurfaces, for `isosurfaces = "map-smooth"` and `"map-stopped"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map_size: Option<u32>,
    /// The largest error wanted in a channel, 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_error: Option<f64>,
    /// Who computes; `"cpu"` where nothing is said.
    pub backend: Choice<Backend>,
    /// How a GPU makes pixels of cells, for `backend = "gpu"` and `"auto"` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gpu_path: Option<Choice<GpuPath>>,
    /// Bits of a channel of the target that triangles are blended into, 16 or 32; likewise, and not with `gpu_path = "compute"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_bits: Option<u32>,
    /// A part of the name of the GPU's adapter, or its number among the adapters; likewise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adapter: Option<String>,
}

impl Default for QualitySection {
    fn default() -> Self {
        Self {
            integration: Choice::Auto,
            interpolation: Choice::Auto,
            order: Choice::Auto,
            slabs: None,
            window: None,
            cycles: None,
            keep_heights: None,
            table_size: None,
            table_lengths: None,
            length_axis: None,
            isosurfaces: None,
            map_size: None,
            max_error: None,
            backend: Choice::Named(Backend::default()),
            gpu_path: None,
            target_bits: None,
            adapter: None,
        }
    }
}

/// `quality.length_axis`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LengthAxisName {
    /// Evenly.
    #[default]
    Linear,
    /// As many in every octave.
    Logarithmic,
}

impl From<LengthAxisName> for LengthAxis {
    fn from(name: LengthAxisName) -> Self {
        match name {
            LengthAxisName::Linear => Self::Linear,
            LengthAxisName::Logarithmic => Self::Logarithmic,
        }
    }
}

/// `quality.isosurfaces`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IsosurfaceMethodName {
    /// [`IsosurfaceMethod::Exact`].
    #[default]
    Exact,
    /// [`IsosurfaceMethod::Map`] with [`Mixing::Smooth`].
    MapSmooth,
    /// [`IsosurfaceMethod::Map`] with [`Mixing::Stopped`].
    MapStopped,
}

impl IsosurfaceMethodName {
    /// The method with maps of this size, where it has any.
    pub const fn with_size(self, size: u32) -> IsosurfaceMethod {
        match self {
            Self::Exact => IsosurfaceMethod::Exact,
            Self::MapSmooth => IsosurfaceMethod::Map { size, mixing: Mixing::Smooth },
            Self::MapStopped => IsosurfaceMethod::Map { size, mixing: Mixing::Stopped },
        }
    }
}
