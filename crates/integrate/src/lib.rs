//! Transfer functions and the integral of a ray through one cell.
//!
//! Inside a tetrahedron the scalar is linear along a ray. A [`TransferFunction`] maps it to a color and an extinction,
//! both piecewise linear, and an [`OpticalModel`] says what those do to light. A [`Segment`] is the ray's part inside
//! one cell: the scalars at its two ends and its length. What comes out of its front is an [`RgbaAssoc`], and segments
//! one behind the other are composed with [`RgbaAssoc::over`].
//!
//! [`exact`] cuts a segment where its scalar crosses a control point; on each of the pieces color and extinction are
//! linear, and the integral has a closed form: the two ends count with [`weights`] that depend on nothing but the
//! optical depths there. [`average`], [`thick_vertex`], [`opacity_2d`] and [`partial`] are the approximations of the
//! literature, [`RunningIntegrals`] has the opacity of [`exact`] at one cost for any transfer function. [`Table3d`] holds
//! exact light over both scalars and the length, [`Table2d`] over the scalars alone. [`Integrator`] has any of them by its
//! name, an [`Integration`], and [`deviation()`] measures how far they are from [`exact`].
//!
//! [`Isosurfaces`] are surfaces of one scalar, met along the ray and never extracted: [`Isosurfaces::compose`] cuts a
//! segment where its scalar passes their values, with the volume integrated in front of and behind each. Which surfaces are
//! met follows from the ranks of the two ends, so that along a chain of segments each counts once. [`IsosurfaceMap`] and
//! [`SmoothMaps`] look them up instead, at one cost for any number, and move them by up to half a texel of scalar.
//! [`Phong`] is the light on them.
//!
//! All of that is in 64 bits, but for the entries of tables and maps; [`lanes`] has the same for eight rays at once in 32
//! bits, for renderers.
//!
//! ```
//! use tetrascope_integrate::{OpticalModel, Segment, TransferFunction, average, exact};
//!
//! // Blue to red; a thin dense shell about the scalar 0.5.
//! let color = [[0.0, 0.1, 0.2, 0.9], [1.0, 0.9, 0.2, 0.1]];
//! let extinction = [[0.49, 0.0], [0.5, 200.0], [0.51, 0.0]];
//! let transfer = TransferFunction::new(&color, &extinction)?;
//! let segment = Segment { scalar_front: 0.2, scalar_back: 1.0, chord_length: 0.8 };
//!
//! let light = exact(&transfer, OpticalModel::DensityEmitter, &segment);
//! assert!((light.opacity - (1.0 - (-2.0f64).exp())).abs() < 1e-14, "the whole shell counts");
//! let missed = average(&transfer, OpticalModel::DensityEmitter, &segment);
//! assert_eq!(missed.opacity, 0.0, "the mean scalar lies beside it");
//! # Ok::<(), tetrascope_integrate::TransferFunctionError>(())
//! ```
//!
//! # Limits
//!
//! The crate knows no mesh and no pixel; scattering is not here. Extinction has one
//! value for all colors. Scalars and lengths are finite: to [`exact`] a NaN scalar takes the first piece's values, a NaN
//! length gives NaN. Lengths are in the unit whose inverse the extinction has ([`TransferFunction::with_lengths_scaled`] changes it).

mod average;
mod deviation;
mod error;
mod exact;
mod homogeneous;
mod integrator;
pub mod lanes;
mod method;
mod model;
mod opacity_2d;
mod psi_table;
mod range_fold;
mod range_max;
mod running_integrals;
mod segment;
pub mod series;
mod special;
pub mod surface;
mod table_2d;
mod table_3d;
mod table_axes;
mod table_pairs;
mod table_settings;
mod thick_vertex;
mod transfer;
pub mod weights;
mod window;

pub use average::average;
pub use deviation::{Deviation, deviation};
pub use error::{MethodError, NameError, TransferFunctionError};
pub use exact::exact;
pub use homogeneous::homogeneous;
pub use integrator::Integrator;
pub use method::Integration;
pub use model::OpticalModel;
pub use opacity_2d::{OpacityTable, opacity_2d};
pub use psi_table::{PsiTable, partial};
pub use running_integrals::RunningIntegrals;
pub use segment::{RgbaAssoc, Segment};
pub use surface::{
    Crossing, Isosurface, IsosurfaceError, IsosurfaceMap, Isosurfaces, Phong, PhongError, SmoothMaps, SurfaceShading,
    TexelAxis,
};
pub use table_2d::Table2d;
pub use table_3d::Table3d;
pub use table_axes::ScalarAxis;
pub use table_pairs::SurfaceRole;
pub use table_settings::{LengthAxis, TableDomain, TableSettings};
pub use thick_vertex::thick_vertex;
pub use transfer::{Piece, TransferFunction};
pub use weights::Weights;

#[cfg(test)]
mod every_method_tests;
#[cfg(test)]
mod methods_tests;
#[cfg(test)]
mod table_tests;

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
