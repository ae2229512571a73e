//! Transfer functions and the integral of a ray through one cell.
//!
//! Inside a tetrahedron the scalar is linear along a ray. A [`TransferFunction`] maps it to a color and an extinction,
//! both piecewise linear, and an [`OpticalModel`] says what those do to light. A [`Segment`] is the ray's part inside
//! the cell: the scalars at its two ends and its length.
//!
//! The crate knows no mesh and no pixel.

mod average;
mod error;
mod exact;
mod homogeneous;
mod model;
mod range_max;
mod segment;
pub mod series;
mod special;
mod thick_vertex;
mod transfer;
pub mod weights;

pub use average::average;
pub use error::{NameError, TransferFunctionError};
pub use exact::exact;
pub use model::{Integration, OpticalModel};
pub use segment::{RgbaAssoc, Segment};
pub use thick_vertex::thick_vertex;
pub use transfer::{Piece, TransferFunction};
pub use weights::Weights;

#[cfg(test)]
mod methods_tests;
