//! Readers for meshes and writers for pictures.
//!
//! [`read_mesh`] finds the reader by the file's content, then by its extension, and gives a [`Loaded`]: the dataset as the
//! file has it and what was odd about it. Memory is never reserved from a count that the file merely declares.
//! [`write_png`] and [`write_exr`] write to a temporary file beside the target and rename it, so that a failed run leaves
//! no half-written picture, and [`end_writing`] leaves nothing of what is under way; [`read_picture`] reads either back; [`write_heights`] does the same for what the power order found out about a mesh.
//!
//! ```no_run
//! use std::path::Path;
//! use tetrascope_io::{ReadOptions, read_mesh, write_image};
//! use tetrascope_view::LinearImage;
//!
//! # fn main() -> Result<(), tetrascope_io::IoError> {
//! let options = ReadOptions { solution: Some("bluntfinq.bin".into()), ..ReadOptions::default() };
//! let loaded = read_mesh(Path::new("bluntfinxyz.bin"), &options)?;
//! assert_eq!(loaded.dataset.points.len(), 40_960);
//! assert_eq!(loaded.dataset.point_arrays[0].name, "Density");
//! for warning in &loaded.warnings {
//!     eprintln!("{warning}");
//! }
//! write_image(Path::new("picture.exr"), &LinearImage::transparent(512, 512), [0.0; 3])?;
//! # Ok(())
//! # }
//! ```
//!
//! This crate and the command line are the only ones that open files; neither prints here. Files are read whole into
//! memory, except for VTK's XML files with appended raw data, whose arrays are read piece by piece; of an OpenFOAM case, which is a folder,
//! only the files of the chosen time step.

mod budget;
mod bytes;
mod error;
mod exodus;
mod foreign;
mod gmsh;
mod grid;
mod heights;
mod nrrd;
mod open;
mod opened;
mod openfoam;
mod picture;
mod plot3d;
mod progress;
mod raw;
mod read;
mod sample;
mod unpack;
mod vtk;
mod vtkhdf;

pub use bytes::ByteOrder;
pub use error::IoError;
pub use heights::{read_heights, write_heights};
pub use open::{file_length, read_mesh, read_small_file, readers};
pub use opened::OpenFile;
pub use picture::{
    PictureFile, PngImage, check_writable, encode_png, end_writing, make_folder, read_exr, read_picture, read_png,
    write_bytes, write_exr, write_files, write_image, write_png,
};
pub use progress::{ReadProgress, ReadStage};
pub use raw::RawVolume;
pub use read::{Loaded, MeshReader, ReadOptions, Source, StepChoice};
pub use sample::SampleType;
pub use vtk::{VtuEncoding, VtuOptions, WrittenVtu, write_vtu, write_vtu_with};

/// Compiles the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod shared;
