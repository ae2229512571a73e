//! A cell before it is set up: corners, scalars, outline, and its part of the transfer function.

use glam::DVec3;

use crate::geometry::{ClipCell, ClipFace};

/// The pixels that a cell may cover: first and last column, first and last row.
pub(crate) type Outline = [u16; 4];

/// The outline of a cell that cannot be seen.
pub(crate) const NOWHERE: Outline = [1, 0, 1, 0];

/// A cell before set-up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// In pixel space, in ascending order of the vertices.
    pub(crate) corners: [DVec3; 4],
    pub(crate) scalars: [f64; 4],
    /// Whether the volume in that order is positive.
    pub(crate) is_positive: bool,
    pub(crate) outline: Outline,
    pub(crate) pieces: CellPieces,
}

/// A cell that is drawn in f64, or a piece of one.
#[derive(Clone, Debug)]
pub(crate) struct CarefulCell {
    /// The cell's, in ascending order of the vertices.
    pub(crate) corners: [DVec3; 4],
    pub(crate) clip: ClipCell,
    /// What else bounds a piece; none for a whole cell, which takes no memory.
    pub(crate) cuts: Box<[ClipFace]>,
    /// Whether the transfer function changes faster in it than 32 bits know a scalar, so that the light is to be found in f64 too.
    pub(crate) is_sharp: bool,
}

/// The pieces of the transfer function that a cell's range of scalars meets: `first .. first + count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CellPieces {
    pub(crate) first: u32,
    pub(crate) count: u32,
}

/// A piece as one cell sees it: in f32, over scalars relative to the cell's reference, cut to the cell's range, and with
/// lengths in the cell's unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalPiece {
    /// Lowest and highest scalar.
    pub(crate) start: f32,
    pub(crate) end: f32,
    /// Extinction at `start`, and its slope.
    pub(crate) extinction: [f32; 2],
    /// Color at `start`, and its slope.
    pub(crate) color: [[f32; 3]; 2],
}
