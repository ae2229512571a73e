//! The GPU back end: Projected Tetrahedra on any device that wgpu reaches.
//!
//! A mesh is given to a device once, as whole numbers on a lattice ([`GpuRenderer::new`]), and every frame goes through the same stages there:
//!
//! 1. transform: points along the camera's axes, in integers, so that every device has the same bits;
//! 2. order: cells that the transfer function or the view leaves out are dropped, the others sorted by one key (`centroid`, `power`), unless
//!    the CPU made the order (`mpvo`, `bsp-xmpvo`, `bucket`, and those that a device cannot): its permutation is sent when the view changed;
//! 3. bin: cells are listed tile by tile; or set up: outlines for the hardware;
//! 4. rasterize: every pixel integrates its ray's segments front to back in registers, sorts them by itself where the plan says so, or has
//!    the hardware blend them.
//!
//! Programs are composed from the plan (`tetrascope_shaders`): a variant binds what the plan asks for, and [`Rendered::device`] says what that was,
//! how much memory it took, and where the device has a clock, how long each stage was.
//!
//! ```no_run
//! use std::sync::Arc;
//!
//! use tetrascope_gpu::{AdapterChoice, Gpu, GpuRenderer};
//! use tetrascope_scene::Silent;
//! # fn draw(mesh: &tetrascope_mesh::TetMesh, scalars: &[f64], plan: &tetrascope_scene::Plan) -> Result<(), tetrascope_gpu::GpuError> {
//! let gpu = Arc::new(Gpu::open(&AdapterChoice::default())?);
//! let renderer = GpuRenderer::new(gpu, mesh, scalars, Arc::default())?;
//! let rendered = renderer.render(plan, &Silent)?;
//! # let _ = rendered;
//! # Ok(())
//! # }
//! ```
//!
//! Accuracy: against the CPU's picture within 2e-5, by triangles into 16 bits within 1e-2.
//!
//! Limits: positions are multiples of 2⁻²⁹ of the mesh's size, so that a view into a millionth of it is coarse; points, and one number a
//! cell, must each fit into one binding (8 million points, 33 million cells at WebGPU's least of 128 MiB); cells are drawn whole, so that rings are sorted in the pixels and
//! not cut; triangles cannot sort pixel by pixel. Across gaps of a mesh the order `power` is told apart by 40 bits of its keys.
//!
//! [`Rendered::device`]: tetrascope_scene::Rendered

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
