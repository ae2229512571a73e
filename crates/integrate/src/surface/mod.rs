//! Isosurfaces: surfaces of one scalar inside the volume, found along the ray and never extracted.
//!
//! A ray crosses a surface where the scalar passes its value. Which surfaces a segment crosses follows from the ranks
//! of its two ends ([`Isosurfaces::rank`]) and from nothing else, so that along a chain of segments each counts once.
//! [`Isosurfaces::compose`] cuts the segment there, with the volume in front of and behind each surface.
//! [`Phong`] is the light on them.

mod compose;
mod phong;
mod set;

pub use compose::Crossing;
pub use phong::Phong;
pub use set::{Isosurface, IsosurfaceError, Isosurfaces, SurfaceShading};
