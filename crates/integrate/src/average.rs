//! The transfer function at the mean scalar of a segment.

use crate::{OpticalModel, RgbaAssoc, Segment, TransferFunction, homogeneous};

/// The light of a segment that has the color and the extinction of its mean scalar throughout.
///
/// Exact where the transfer function is constant over the segment's scalars. Else the error has no bound but 1: a peak
/// between the ends is missed or taken for the whole.
///
/// Source: [Marroquim 2006], eq. (1), for the density emitter; the other models are the
/// same idea, the integral of a homogeneous segment.
pub fn average(transfer: &TransferFunction, model: OpticalModel, segment: &Segment) -> RgbaAssoc {
    // Halves first: the sum of two scalars near the largest float would overflow.
    let mean = 0.5 * segment.scalar_front + 0.5 * segment.scalar_back;
    homogeneous(model, transfer.extinction(mean), transfer.color(mean), segment.chord_length)
}
