//! The section of the transfer function: by points, by names, or from a file.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};
use tetrascope_colors::ColorMap;

/// `[transfer]`
///
/// `color` counts before `colormap`, and that before the colors of `preset`; `extinction` before `opacity`, and that before the opacity of
/// `preset`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransferSection {
    /// Scalar and linear R, G, B.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<Vec<[f64; 4]>>,
    /// Scalar and extinction per world unit of length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extinction: Option<Vec<[f64; 2]>>,
    /// A color map by its name, see [`ColorMap::named`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colormap: Option<String>,
    /// A file that ParaView saved a color map to, relative to the scene file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<PathBuf>,
    /// Which color map of a preset file with several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset_name: Option<String>,
    /// Lowest and highest scalar of color map, preset, named opacity and the defaults; the field's range if it is not there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Opacity by a name or by points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opacity: Option<OpacityName>,
    /// The length that opacity is for, world units: the extinction is opacity over it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub opacity_length: Option<f64>,
    /// What the preset file holds, once it was read: a scene with a preset is not complete without.
    #[serde(skip)]
    pub preset_map: Option<PresetMap>,
}

/// `transfer.opacity`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a name such as \"sigmoid\", a list of opacities over the range, or a list of [scalar, opacity]"
)]
pub enum OpacityName {
    /// One of [`tetrascope_colors::opacity_names`], over the range.
    Name(String),
    /// Opacities, 0 to 1, at equal distances over the range; at least one.
    Values(Vec<f64>),
    /// Scalar and opacity, 0 to 1.
    Points(Vec<[f64; 2]>),
}

/// A color map from a file, and what was odd in it.
#[derive(Clone, Debug, PartialEq)]
pub struct PresetMap {
    /// Colors, and opacity if the file has any.
    pub map: ColorMap,
    /// A sentence on everything odd.
    pub warnings: Vec<String>,
}
