//! How wrong a picture will be, how wrong it is, and the cheapest way to one that is right enough.
//!
//! Errors are the largest difference of any channel of any pixel from the picture that f64, exact integration and a per-pixel order give.
//! Two kinds of statement are kept apart:
//!
//! - A **bound** is never exceeded. It follows from what each cell can at most do ([`ErrorPart::bound`], [`ErrorEstimate::bound`]): 0
//!   for an exact integration and for an order that is right, otherwise the sum over the cells in front of a pixel, which is far above the
//!   truth where many cells lie behind each other.
//! - An **estimate** comes from some of the picture's rays, traced in f64: about a thousand all over the mesh, then more around the worst
//!   ([`estimate`]). What is between their exact light and the pixel is measured, cause by cause; the largest of the picture is
//!   taken to be three times the largest of these. Single pixels may be worse.
//!
//! [`choose_integration`] asks before anything is drawn: which methods would take less time than the exact one, by a model of the
//! CPU back end's cost, and which of these stay within a wanted error, by their bounds or by rays.
//! Orders are not traded: a wrong one errs in single pixels, which rays do not see.
//!
//! ```
//! use glam::DVec3;
//! use tetrascope_cpu::CpuRenderer;
//! use tetrascope_estimate::{BlendingOrder, Cause, Subject, estimate};
//! use tetrascope_integrate::{Integration, OpticalModel, TransferFunction};
//! use tetrascope_mesh::TetMesh;
//! use tetrascope_scene::{Plan, Silent};
//! use tetrascope_view::{Camera, Projection, View};
//!
//! let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let (mesh, scalars) = (TetMesh::from_tetrahedra(&corners, &[[0, 1, 2, 3]])?.mesh, [0.0, 1.0, 2.0, 3.0]);
//! let projection = Projection::Perspective { fov_y: 0.5 };
//! let camera = Camera { eye: DVec3::splat(3.0), target: DVec3::ZERO, up: DVec3::Y, projection };
//! let transfer = TransferFunction::new(&[[0.0, 0.9, 0.6, 0.2]], &[[1.0, 0.0], [1.5, 9.0], [2.0, 0.0]])?;
//! let mut plan = Plan::new(View::new(&camera, 64, 64)?, transfer, OpticalModel::DensityEmitter);
//! plan.integration = Integration::Average;
//!
//! let picture = CpuRenderer::new(&mesh, &scalars)?.render(&plan, &Silent)?.image;
//! let subject = Subject { mesh: &mesh, scalars: &scalars, plan: &plan, order: BlendingOrder::Right };
//! let wrong = estimate(&subject, &picture)?;
//! assert!(wrong.expected > 0.01, "the peak is narrower than the cell");
//! assert_eq!(wrong.parts[1].cause, Cause::Order);
//! assert_eq!(wrong.parts[1].bound, Some(0.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Limits: rounding has no bound, so that the bound of a whole picture is what its colors can be; the cost model is of the CPU back end,
//! and knows no isosurfaces; errors that single pixels have, such as those of a k-buffer that is a little too short, are missed by rays that
//! are not these pixels.

mod bound;
mod choose;
mod cost;
mod error;
mod estimate;
mod probe;
mod sample;
mod survey;

pub use choose::{Candidate, IntegrationChoice, ROUNDING_OF_32_BITS, choose_integration};
pub use error::EstimateError;
pub use estimate::{BlendingOrder, Cause, ErrorEstimate, ErrorPart, RAYS, Subject, estimate};

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
