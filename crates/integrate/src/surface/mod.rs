//! Isosurfaces: surfaces of one scalar inside the volume, found along the ray and never extracted.
//!
//! A ray crosses a surface where the scalar passes its value. Which surfaces a segment crosses follows from the ranks
//! of its two ends ([`Isosurfaces::rank`]) and from nothing else, so that along a chain of segments each counts once.
//! [`Isosurfaces::compose`] cuts the segment there, with the volume in front of and behind each surface.
//! [`IsosurfaceMap`] and [`SmoothMaps`] look the surfaces up instead, for any number of them at one cost, and move them
//! by up to half a texel. [`Phong`] is the light on them.

mod compose;
mod maps;
mod phong;
mod set;
mod smooth_maps;

pub use compose::Crossing;
pub use maps::{IsosurfaceMap, TexelAxis};
pub use phong::{Phong, PhongError};
pub use set::{Isosurface, IsosurfaceError, Isosurfaces, SurfaceShading};
pub use smooth_maps::SmoothMaps;
