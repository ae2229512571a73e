//! Structures and constants of sorting and binning.

use bytemuck::{Pod, Zeroable};

/// Consecutive entries of a list that one thread of a stage works on.
pub const LIST_ITEMS: u32 = 8;
/// Entries that one group works on.
pub const LIST_BLOCK: u32 = LIST_ITEMS * crate::layout::GROUP;
/// Bits of a key that one pass of the sort looks at: a thread of a group has one digit's counts.
pub const RADIX_BITS: u32 = 8;
/// Place in `totals` of the number of pairs that were written: all that were needed, or none.
pub const PAIRS_WRITTEN: u32 = 4;

/// What a stage over a list works on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Work {
    /// Entries that the list may have.
    pub most: u32,
    /// Place in `totals` of how many it has, in stages that ask.
    pub count_at: u32,
    /// The lowest bit of the digit, of a pass of the sort.
    pub shift: u32,
    /// Nothing.
    pub unused: u32,
}

/// A part of the order that is drawn at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Block {
    /// Its first place in the order.
    pub first: u32,
    /// How many cells it has, if the order has so many.
    pub count: u32,
    /// Pairs of tile and cell that there is room for.
    pub capacity: u32,
    /// Nothing.
    pub unused: u32,
}

/// A view of the keys of the power order: how far it is along an axis that a key has counted from the lowest.
///
/// A key is `gradient · axis + (constant << constant_shift)` in whole numbers of 96 bits, less the lowest; the lower `drop` bits
/// are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct PowerView {
    /// What gradients are multiplied with: the eye's offset from the center, negated, or the direction; unused.
    pub axis: [i32; 4],
    /// The lowest key that there may be, two's complement, low word first; unused.
    pub lowest: [u32; 4],
    /// Bits that the constant is moved up by, below 32.
    pub constant_shift: u32,
    /// 0 where constants do not count: along a direction.
    pub has_constant: u32,
    /// Lower bits that are left out.
    pub drop: u32,
    /// Nothing.
    pub unused: u32,
}
