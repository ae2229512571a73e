//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.

mod device;
mod draw;
mod error;
mod kept;
mod kernel;
mod kernels;
mod lookups;
mod mesh;
mod part;
mod renderer;
mod sorting;
mod stopwatch;
mod work;

#[cfg(test)]
mod testing;

pub use device::{AdapterChoice, AdapterDescription, Gpu, adapters};
pub use error::GpuError;
pub use renderer::GpuRenderer;
