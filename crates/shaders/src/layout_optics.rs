//! What integration needs to know besides the transfer function itself.

use bytemuck::{Pod, Zeroable};

/// Numbers of the integration. Scalars in lattice steps about the middle of the range; "a unit" of scalar is 2^29 of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct OpticsUniform {
    /// Pieces of the transfer function; at least 1.
    pub piece_count: u32,
    /// Where the table of psi begins behind them, in vectors of 16 bytes; 0 without it.
    pub psi_start: u32,
    /// Samples of the table along each of its two scalar axes; 0 without a table, and then all that follows.
    pub table_scalars: u32,
    /// Samples along its axis of lengths; 0 in a two-dimensional one.
    pub table_lengths: u32,
    /// Scalar of the first sample.
    pub table_start: i32,
    /// Whole lattice steps from one sample to the next.
    pub table_step: i32,
    /// What they lack to the next sample, in samples.
    pub table_rest: f32,
    /// Samples per unit of scalar.
    pub table_per_scalar: f32,
    /// Two dimensions: what entries are multiplied by per local unit of length. Three: share of the axis of lengths, likewise.
    pub table_per_length: f32,
    /// 1 if the axis of lengths is logarithmic, else 0.
    pub table_is_logarithmic: u32,
    /// Nothing.
    pub unused: [u32; 2],
}
