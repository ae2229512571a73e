//! The sections of isosurfaces, of surfaces and of the light that falls on them.

use std::path::PathBuf;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use tetrascope_integrate::{Isosurface, Phong, SurfaceShading};

use crate::Lighting;

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

impl IsosurfaceSection {
    /// An opaque surface of one color without shading.
    pub fn new(value: f64, color: [f64; 3]) -> Self {
        Self { value, color, back_color: None, opacity: opaque(), shading: Shading::None }
    }
}

impl From<&IsosurfaceSection> for Isosurface {
    fn from(section: &IsosurfaceSection) -> Self {
        Self {
            value: section.value,
            color: section.color,
            back_color: section.back_color.unwrap_or(section.color),
            opacity: section.opacity,
            shading: section.shading.into(),
        }
    }
}

impl From<Shading> for SurfaceShading {
    fn from(shading: Shading) -> Self {
        match shading {
            Shading::None => Self::None,
            Shading::Flat => Self::Flat,
            Shading::Smooth => Self::Smooth,
        }
    }
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
    /// Whether the volume is lit too, by its gradients.
    pub volume: bool,
}

impl Default for LightSection {
    fn default() -> Self {
        let Lighting { phong, volume, .. } = Lighting::default();
        let Phong { ambient, diffuse, specular, shininess } = phong;
        let direction = LightDirection::Named(LightName::Headlight);
        Self { direction, ambient, diffuse, specular, shininess, volume }
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

impl From<&LightSection> for Lighting {
    fn from(section: &LightSection) -> Self {
        let LightSection { direction, ambient, diffuse, specular, shininess, volume } = *section;
        let direction = match direction {
            LightDirection::Named(LightName::Headlight) => None,
            LightDirection::Vector(direction) => Some(DVec3::from(direction)),
        };
        Self { phong: Phong { ambient, diffuse, specular, shininess }, direction, volume }
    }
}
