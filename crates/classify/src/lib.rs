//! Projected Tetrahedra: silhouette class, thick vertex and triangle fan of one tetrahedron in one view.
//!
//! A viewpoint makes a signed volume with each face of a cell ([`SignedVolumes`]). Their four signs say which faces look at
//! the eye: they *are* the classification by planes ([`by_planes`], [Shirley 1990]), and for projected points
//! they are the four cross products of the classification by a table of 81 entries ([`TRUTH_TABLE`],
//! [Marroquim 2006]). Their values weight the corners: the positive ones give the near end of the thickest chord, the negative ones the
//! far end ([`ThickVertex`]), in every class by the same formula. The silhouette is drawn as a [`Fan`] of one to four
//! triangles around that thick vertex.
//!
//! ```
//! use glam::DVec3;
//! use tetrascope_classify::{FanVertex, ProjectionClass, Viewpoint, project};
//!
//! let positions = [DVec3::ZERO, DVec3::new(2., 2., 0.), DVec3::new(0., 2., 3.), DVec3::new(2., 0., 3.)];
//! let shown = project(&positions, &[0.0, 1.0, 4.0, 6.0], [0, 1, 2, 3], Viewpoint::Direction(DVec3::Z));
//!
//! assert_eq!(shown.class, ProjectionClass::Two);
//! let thick = shown.thick.ok_or("nothing to draw")?;
//! assert_eq!((thick.scalar_front, thick.scalar_back, thick.chord_length), (0.5, 5.0, 3.0));
//! assert_eq!(shown.fan.triangles().count(), 4);
//! assert_eq!(shown.fan.as_slice()[0], FanVertex::Thick);
//! # Ok::<(), &str>(())
//! ```
//!
//! # Limits
//! - Positions are finite and positively oriented: `(p1 − p0) × (p2 − p0) · (p3 − p0) > 0`. Cells without positive volume
//!   draw nothing.
//! - The signs that choose a class are rounded. That changes pictures continuously and never gives a fan without a thick
//!   vertex; where topology hangs on a sign, [`exact_signs`] does not round.
//! - Cells that reach behind the eye or the near plane have no fan on the screen: draw the pieces of [`cut_at_depth`].
//! - Nothing here knows colors, pixels or the order of cells.

mod class;
mod cut;
mod exact;
mod fan;
mod project;
mod ternary;
#[cfg(test)]
mod tests;
mod volumes;

pub use class::{Classified, Corners, ProjectionClass, Sign, by_planes};
pub use cut::{Cut, DepthPlane, Piece, PieceId, cut_at_depth};
pub use exact::{exact_face_sign, exact_orientation, exact_signs};
pub use fan::{Fan, FanVertex};
pub use project::{FanAttributes, Projected, ScreenAttributes, ThickVertex, project};
pub use ternary::{TRUTH_TABLE, TableEntry, Tests};
pub use tetrascope_view::Viewpoint;
pub use volumes::{FACES, SignedVolumes, face_volume, six_volume};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
