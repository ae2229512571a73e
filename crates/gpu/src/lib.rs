//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.

mod device;
mod effects;
mod error;
mod kernel;
mod lattice;
mod lookups;
mod maps;
mod targets;
mod triangles;
mod view;

#[cfg(test)]
mod cell_tests;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod triangles_tests;

pub use device::{AdapterChoice, AdapterDescription, Gpu, adapters};
pub use error::GpuError;
pub use targets::TargetPrecision;
