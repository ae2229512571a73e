//! Isosurfaces looked up in maps.

#[derive(Debug)]
pub(crate) struct Maps;
