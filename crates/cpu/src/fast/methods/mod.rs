//! From a block's segments to light: the integration methods on eight lanes, one a file.

use std::ops::Range;

use fearless_simd::{Simd, f32x8, mask32x8, prelude::*};

mod average;
mod cumulative;
mod ends;
mod exact;
mod partial;
mod tabulated;
mod vertex;

pub(crate) use average::Average;
pub(crate) use cumulative::Cumulative;
pub(crate) use ends::Ends;
pub(crate) use exact::Exact;
pub(crate) use partial::Partial;
pub(crate) use tabulated::Tabulated;
pub(crate) use vertex::Vertex;

use super::cell::LocalPiece;
use super::fan::Fan;
use super::lookup::CellTable;
use super::model::{Model, at};
use super::sample::{Light, Sample};
use super::sharp::SharpCell;

/// What a method knows of a cell's optics.
#[derive(Clone, Copy)]
pub(crate) struct CellOptics<'a> {
    /// The pieces of the transfer function that the cell meets, ascending; at least one.
    pub(crate) pieces: &'a [LocalPiece],
    /// Its fan of triangles, where the method asks for fans; `None` if its outline has no area.
    pub(crate) fan: Option<&'a Fan>,
    /// The table, where the method has one.
    pub(crate) table: Option<CellTable<'a>>,
    /// What the exact method and running integrals draw in f64 all through.
    pub(crate) sharp: Option<SharpCell<'a>>,
}

/// An integration method.
pub(crate) trait Method {
    /// Whether [`CellOptics::pieces`] is looked at.
    const NEEDS_PIECES: bool;

    /// The light of a block's segments through a cell.
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S>;
}

/// Extinction and color of a piece at a scalar.
#[inline(always)]
pub(crate) fn value<S: Simd>(simd: S, piece: &LocalPiece, scalar: f32x8<S>) -> (f32x8<S>, [f32x8<S>; 3]) {
    let distance = scalar - f32x8::splat(simd, piece.start);
    let [start, slope] = piece.color;
    let mut color = [distance; 3];
    for c in 0..3 {
        color[c] = at(simd, [start[c], slope[c]], distance);
    }
    (at(simd, piece.extinction, distance), color)
}

/// Extinction and color at scalars within the cell's range.
///
/// - `covered`: the lanes that count
#[inline(always)]
fn transfer_at<S: Simd>(
    simd: S,
    pieces: &[LocalPiece],
    covered: mask32x8<S>,
    scalar: f32x8<S>,
) -> (f32x8<S>, [f32x8<S>; 3]) {
    let pieces = &pieces[met(simd, pieces, covered, scalar, scalar)];
    let (mut extinction, mut color) = value(simd, &pieces[0], scalar);
    for piece in &pieces[1..] {
        let is_here = scalar.simd_ge(f32x8::splat(simd, piece.start));
        if is_here.any_true() {
            let (rho, kappa) = value(simd, piece, scalar);
            extinction = is_here.select(rho, extinction);
            for c in 0..3 {
                color[c] = is_here.select(kappa[c], color[c]);
            }
        }
    }
    (extinction, color)
}

/// Pieces of a cell that are run through rather than searched: with more of them, a coarse cell on a fine transfer function, a block sees few of many.
const FEW_PIECES: usize = 4;

/// Those of a cell's pieces that lanes may meet between two scalars; at least one.
///
/// - `low`, `high`: in lanes that are not `covered` any numbers
#[inline(always)]
fn met<S: Simd>(simd: S, pieces: &[LocalPiece], covered: mask32x8<S>, low: f32x8<S>, high: f32x8<S>) -> Range<usize> {
    if pieces.len() <= FEW_PIECES {
        return 0..pieces.len();
    }
    let lowest = covered.select(low, f32x8::splat(simd, f32::INFINITY));
    let highest = covered.select(high, f32x8::splat(simd, f32::NEG_INFINITY));
    let (lowest, highest) = (lowest.reduce_min(), highest.reduce_max());
    // A scalar on a cut belongs to the piece above; beyond the ends the first and the last piece go on.
    let last = pieces.len() - 1;
    let first = pieces[..last].partition_point(|piece| piece.end <= lowest);
    first..pieces.partition_point(|piece| piece.start <= highest).max(first + 1)
}
