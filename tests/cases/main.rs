//! Tests that cross crates, one binary.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "helpers of tests: a panic is a failure, and measured maxima are said"
)]

mod constants;
mod cycles;
mod errors;
mod golden;
mod gpu;
mod hard;
mod hostile;
mod interrupted;
mod invariants;
mod isosurfaces;
mod light;
mod methods;
mod orders;
mod plan;
mod presets;
mod real_meshes;
mod references;
mod saving;
mod soak;
mod work;
