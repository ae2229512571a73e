//! Isosurfaces in whole pictures.

mod planes;
mod sides;
mod spheres;

pub(crate) use spheres::{sample, view_from};
