//! Readers for meshes and writers for pictures.
//!
//! [`read_mesh`] finds the reader by the file's content, then by its extension, and gives a [`Loaded`]: the dataset as the
//! file has it and what was odd about it. Memory is never reserved from a count that the file merely declares.
//! [`write_png`] and [`write_exr`] write to a temporary file beside the target and rename it, so that a failed run leaves
//! no half-written picture.
//!
//! This crate and the command line are the only ones that open files; neither prints here.

mod error;
mod read;
mod vtk;

pub use error::IoError;
pub use read::{Loaded, MeshReader, Source};
