//! Isosurfaces: surfaces of one scalar inside the volume, found along the ray and never extracted.

mod phong;
mod set;

pub use phong::Phong;
pub use set::{Isosurface, IsosurfaceError, Isosurfaces, SurfaceShading};
