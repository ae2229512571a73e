//! Color maps and opacity curves by the names that people know, and from ParaView's presets.
//!
//! A [`ColorMap`] is a list of colors along 0 to 1 and a [`ColorSpace`] in which the colors between them are found. Colors are
//! sRGB as their authors chose them, and stay so until they are mixed: [`ColorMap::linear_points`] encodes nothing before, and gives
//! control points whose mixture in linear light stays within half a gray level of the map, [`HALF_GRAY_LEVEL`], everywhere.
//! [`Opacity`] does the same for opacity, and says what an opacity means for a length ([`OpacityUnit`]).
//!
//! Maps come from [`ColorMap::named`], which knows matplotlib's continuous maps and ParaView's presets, or from [`read_presets`],
//! which takes the bytes of a file that ParaView saved, JSON or XML.
//!
//! The crate knows no mesh, no range of a field but what it is given, and opens no file. It prints nothing and does not panic on any input.

mod adapt;
mod check;
mod ciede;
mod convert;
mod error;
mod map;
mod names;
mod opacity;
mod opacity_names;
mod preset;
mod preset_json;
mod preset_xml;
mod sharpness;
mod space;
mod srgb;

pub use adapt::HALF_GRAY_LEVEL;
pub use error::ColorError;
pub use map::{ColorMap, ColorPoint};
pub use names::{MapOrigin, NamedMap, all_names};
pub use opacity::{Opacity, OpacityPoint, OpacityUnit};
pub use opacity_names::opacity_names;
pub use preset::{Presets, read_presets};
pub use space::ColorSpace;
pub use srgb::{linear_from_srgb, srgb_from_linear};

#[cfg(test)]
mod known_tests;
#[cfg(test)]
mod map_tests;
#[cfg(test)]
mod opacity_tests;
#[cfg(test)]
mod preset_tests;

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
