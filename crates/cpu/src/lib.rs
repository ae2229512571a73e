//! The CPU back end: it needs no driver, it is the default, and it is what other back ends are measured against.
//!
//! Two renderers live here, kept apart, and both follow a [`Plan`](tetrascope_scene::Plan):
//!
//! - [`mod@reference`] clips every pixel's ray against every tetrahedron in f64, sorts what it finds along each ray and
//!   integrates it as the plan says, by any method along a ray. It needs no visibility order and handles cycles. Slow, and
//!   the judge.
//! - [`CpuRenderer`] is what users run: one set-up per tetrahedron, tiles, eight pixels at a time in f32, all cores. It
//!   draws the cells in the order that the plan names, with any method.
//!
//! [`rays`] has single rays of the reference, for those who measure errors.
//!
//! Both see a cell through the same four planes, so they agree on which pixels it covers, seams included: a ray that runs
//! exactly in a face, along an edge or through a vertex belongs to exactly one cell.
//!
//! Isosurfaces are met along the ray, inside the cells. On which side of them a ray leaves one cell is on which side it
//! enters the next, so that no surface is missed or met twice between them; in the fast renderer where the order is right. The reference cuts rays at the crossings
//! whatever the plan says of maps, which approximate that. Gradients, tables and maps are made if the plan asks for them.
//!
//! ```
//! use glam::DVec3;
//! use tetrascope_cpu::CpuRenderer;
//! use tetrascope_integrate::{OpticalModel, TransferFunction};
//! use tetrascope_mesh::TetMesh;
//! use tetrascope_scene::{Plan, Silent};
//! use tetrascope_view::{Camera, Projection, View};
//!
//! let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let mesh = TetMesh::from_tetrahedra(&corners, &[[0, 1, 2, 3]])?.mesh;
//! let camera = Camera {
//!     eye: DVec3::splat(3.0),
//!     target: DVec3::ZERO,
//!     up: DVec3::Y,
//!     projection: Projection::Perspective { fov_y: 0.5 },
//! };
//! let transfer = TransferFunction::new(&[[0.0, 0.9, 0.6, 0.2]], &[[0.0, 2.0]])?;
//! let plan = Plan::new(View::new(&camera, 64, 64)?, transfer, OpticalModel::DensityEmitter);
//! let rendered = CpuRenderer::new(&mesh, &[0.0, 1.0, 2.0, 3.0])?.render(&plan, &Silent)?;
//! assert!(rendered.image.pixel(32, 32)[3] > 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Cells are blended in one global order, so that the fast renderer is right only where that order is, for the sides of isosurfaces too;
//! unless the plan leaves the order to the pixels: [`OrderMethod::PerPixel`](tetrascope_order::OrderMethod::PerPixel) sorts all that a
//! ray meets and is right on every mesh whose cells do not overlap, [`OrderMethod::KBuffer`](tetrascope_order::OrderMethod::KBuffer)
//! within a window, and [`CycleRemedy::PerPixel`](tetrascope_order::CycleRemedy::PerPixel) only where cells lie in rings. Their cost is a
//! list of the fragments of each tile; without an order a tile cannot end early where it is opaque.
//!
//! Segments are exact unless the plan asks for an [`Interpolation`](tetrascope_scene::Interpolation) of the literature, over the triangles of each cell's fan: then
//! the fast renderer makes fans too, and only then. Coverage stays that of the planes, so that a ray still belongs to one cell. Cells
//! without a fan in 32 bits are drawn exactly in every way: pieces of cut cells, cells that reach the plane of the eye or are seen nearly edge-on.
//!
//! Limits: the reference keeps all fragments of a tile in memory and has no fan for
//! [`Integration::Vertex`](tetrascope_integrate::Integration::Vertex).

mod domain;
mod error;
mod fast;
mod geometry;
mod grid;
pub mod rays;
pub mod reference;

#[cfg(test)]
mod rays_tests;
#[cfg(test)]
mod reference_tests;

pub use error::RenderError;
pub use fast::CpuRenderer;
