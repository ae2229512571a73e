//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.

mod bins;
mod compact;
mod device;
mod error;
mod kernel;
mod keys;
mod power_functions;
mod radix;
mod scan;

#[cfg(test)]
mod bins_tests;
#[cfg(test)]
mod compact_tests;
#[cfg(test)]
mod keys_tests;
#[cfg(test)]
mod power_functions_tests;
#[cfg(test)]
mod radix_tests;
#[cfg(test)]
mod scan_tests;
#[cfg(test)]
mod testing;

pub use device::{AdapterChoice, AdapterDescription, Gpu, adapters};
pub use error::GpuError;
