//! Structures and constants that both languages know. Names of fields are those of the shaders.
//!
//! Positions and scalars of a mesh are whole numbers on a lattice: differences are exact there, and every device computes the same
//! bits. One step is [`LATTICE_STEP`] of the mesh's local unit, in which no point is farther than about 1 from the origin;
//! likewise of the renderer's unit of scalars, in which the field's range is between 1 and 2 long, about its middle.

use bytemuck::{Pod, Zeroable};
use tetrascope_integrate::PsiTable;

use crate::constants::Constant;
pub use crate::layout_effects::*;
pub use crate::layout_optics::OpticsUniform;
pub use crate::layout_order::{Block, LIST_BLOCK, LIST_ITEMS, PAIRS_WRITTEN, PowerView, RADIX_BITS, Work};

/// One step of the lattice of positions and scalars, in local units.
pub const LATTICE_STEP: f64 = 1.0 / (1u64 << 29) as f64;
/// What a unit vector's component of 1 becomes in [`Frame`].
pub const UNIT: f64 = (1u64 << 30) as f64;
/// Side of a tile of the picture, pixels: one thread a pixel.
pub const TILE_SIDE: u32 = 16;
/// Threads of a group in every stage over lists.
pub const GROUP: u32 = 256;
/// The bit of a cell's last vertex index that says that its volume is negative in ascending order of the vertices.
pub const NEGATIVE_BIT: u32 = 1 << 31;
/// The bit of a cell's number in an order that says that it lies in a ring, and of a drawn cell's third vertex index.
pub const RING_BIT: u32 = 1 << 31;

/// The bit of a tile's last count that says that some of its pixels are to be run again.
pub const TILE_OPEN: u32 = 1 << 30;
/// The bit that says that the driver ended a loop before its end.
pub const TILE_CUT: u32 = 1 << 31;

/// Those that every program has.
pub(crate) const CONSTANTS: &[(&str, Constant)] = &[
    ("LATTICE_STEP", Constant::F32(LATTICE_STEP as f32)),
    ("TILE_SIDE", Constant::U32(TILE_SIDE)),
    ("TILE_PIXELS", Constant::U32(TILE_SIDE * TILE_SIDE)),
    ("GROUP", Constant::U32(GROUP)),
    ("NEGATIVE_BIT", Constant::U32(NEGATIVE_BIT)),
    ("RING_BIT", Constant::U32(RING_BIT)),
    ("TILE_OPEN", Constant::U32(TILE_OPEN)),
    ("TILE_CUT", Constant::U32(TILE_CUT)),
    ("PSI_DEPTHS", Constant::U32(PsiTable::DEPTHS as u32)),
    ("PSI_BALANCES", Constant::U32(PsiTable::BALANCES as u32)),
    ("LIST_ITEMS", Constant::U32(LIST_ITEMS)),
    ("LIST_BLOCK", Constant::U32(LIST_BLOCK)),
    ("RADIX_BITS", Constant::U32(RADIX_BITS)),
    ("PAIRS_WRITTEN", Constant::U32(PAIRS_WRITTEN)),
];

/// A view, and the part of the picture that is drawn.
///
/// Camera axes: right, down, forward. Lengths in the mesh's local unit; about the *base*, a point of the lattice next to the eye or to
/// the mesh, so that what counts is small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Frame {
    /// The camera's axes over the mesh's, times [`UNIT`]; last the base along the axis, lattice steps.
    pub right: [i32; 4],
    /// Likewise.
    pub down: [i32; 4],
    /// Likewise.
    pub forward: [i32; 4],
    /// The eye from the base; last the depth that depths are counted from, from the eye.
    pub eye: [f32; 4],
    /// Where the ray of a column meets the plane through the base that faces the camera: column, place there and per column in
    /// lattice steps; last what half a column adds to the slope of the ray, times a power of two, see [`Self::tangent`].
    pub columns: [i32; 4],
    /// Likewise for rows.
    pub rows: [i32; 4],
    /// What rounding took from places: of `columns` place and per column, of `rows` likewise; lattice steps.
    pub rest: [f32; 4],
    /// Slope of rays per pixel, right and down, 0 in an orthographic view; size of a pixel, at depth 1 in a perspective view.
    pub slope: [f32; 4],
    /// Width and height of the whole picture, pixels.
    pub size: [u32; 2],
    /// First column and row of the part that is drawn.
    pub origin: [u32; 2],
    /// Width and height of that part.
    pub extent: [u32; 2],
    /// Tiles a row, and rows, of that part.
    pub tiles: [u32; 2],
    /// 1 in a perspective view, else 0.
    pub is_perspective: u32,
    /// Transmittance below which a pixel ends.
    pub termination: f32,
    /// Cells of the mesh, and points.
    pub cells: u32,
    /// Likewise.
    pub points: u32,
    /// Bits: slopes of rays in integers are in units of 2^-first, 1 to 30; `columns` and `rows` give them after a shift down by the second
    /// and the third. The fourth: lattice steps are rounded down by so many bits where products of two must fit 64.
    pub tangent: [u32; 4],
}
