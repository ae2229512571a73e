//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.

mod device;
mod effects;
mod error;
mod kernel;
mod maps;

#[cfg(test)]
mod testing;

pub use device::{AdapterChoice, AdapterDescription, Gpu, adapters};
pub use error::GpuError;
