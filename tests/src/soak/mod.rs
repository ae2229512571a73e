//! Scenes of chance, wilder than any that a user would make, drawn in every way and held against one another.
//!
//! A seed gives a [`Case`]: a mesh with a field, a view, a transfer function. [`judge()`] draws it with every way there is and says what is
//! wrong; [`reduce()`] makes a failing case small while it fails in the same manner; [`write_case`] writes it as a scene that reproduces it.
//! `cargo xtask soak` runs seeds for as long as it is told, a test runs a few in every change.

mod case;
mod judge;
mod mesh;
mod mesh_changes;
mod numbers;
mod optics;
mod quality;
mod reduce;
mod tally;
mod truth;
mod view;
mod write;

pub use case::Case;
pub use judge::{Drawing, Failure, Fault, Judged, Margin, draw, judge};
pub use reduce::{Reduced, reduce};
pub use tally::Tally;
pub use write::{Written, read_case, write_case};
