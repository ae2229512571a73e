//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.

mod bins;
mod compact;
mod device;
mod draw;
mod effects;
mod error;
mod frame;
mod kept;
mod kernel;
mod kernels;
mod keys;
mod lattice;
mod lookups;
mod maps;
mod mesh;
mod part;
mod power_functions;
mod radix;
mod renderer;
mod report;
mod scan;
mod sorting;
mod stopwatch;
mod targets;
mod triangles;
mod view;
mod work;

#[cfg(test)]
mod bins_tests;
#[cfg(test)]
mod cell_tests;
#[cfg(test)]
mod compact_tests;
#[cfg(test)]
mod keys_tests;
#[cfg(test)]
mod power_functions_tests;
#[cfg(test)]
mod radix_tests;
#[cfg(test)]
mod renderer_tests;
#[cfg(test)]
mod scan_tests;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod triangles_tests;

pub use device::{AdapterChoice, AdapterDescription, Gpu, adapters};
pub use error::GpuError;
pub use renderer::GpuRenderer;
