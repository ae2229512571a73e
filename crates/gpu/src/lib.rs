//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.

mod device;
mod error;
mod kernel;
mod renderer;

#[cfg(test)]
mod testing;

pub use device::{AdapterChoice, AdapterDescription, Gpu, adapters};
pub use error::GpuError;
pub use renderer::GpuRenderer;
