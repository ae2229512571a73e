//! The light at the thickest point of a projected cell, from the two ends alone.

use crate::{OpticalModel, RgbaAssoc, Segment, TransferFunction, homogeneous};

/// The light of a segment with the mean extinction and the mean color of its two ends.
///
/// The opacity `1 - exp(-length (rho_front + rho_back) / 2)` is exact where the extinction is linear over the segment's
/// scalars, the light where the color is constant and, in the emitter model, the extinction too. Nothing between the
/// ends is looked at.
///
/// Meant for the thick vertex of a projected cell's fan, between which and the silhouette the result is interpolated.
///
/// Source: [Shirley 1990], section 2.5 (opacity from the mean density, color the mean of both ends), for the
/// density emitter; the other models take the same means.
pub fn thick_vertex(transfer: &TransferFunction, model: OpticalModel, segment: &Segment) -> RgbaAssoc {
    let (front, back) = (segment.scalar_front, segment.scalar_back);
    let extinction = 0.5 * transfer.extinction(front) + 0.5 * transfer.extinction(back);
    let (color_front, color_back) = (transfer.color(front), transfer.color(back));
    let color = core::array::from_fn(|channel| 0.5 * color_front[channel] + 0.5 * color_back[channel]);
    homogeneous(model, extinction, color, segment.chord_length)
}
