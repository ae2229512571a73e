//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.

mod device;
mod error;
mod kernel;
mod lattice;
mod view;

#[cfg(test)]
mod cell_tests;
#[cfg(test)]
mod testing;

pub use device::{AdapterChoice, AdapterDescription, Gpu, adapters};
pub use error::GpuError;
