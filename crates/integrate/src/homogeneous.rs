//! The integral of a segment of one color and one extinction.

use crate::{OpticalModel, RgbaAssoc};

/// The light of a segment along which extinction and color are the same everywhere.
///
/// With `tau = extinction * length`: opacity `1 - exp(-tau)`, and light `color * opacity` where the extinction glows,
/// `color * length * (1 - exp(-tau)) / tau` where the color is radiance per length.
///
/// - `extinction`: 1/length, finite, not negative
/// - `color`: linear RGB, not negative; radiance per length in the models that have it so
/// - `length`: finite, not negative; 0 gives nothing
pub fn homogeneous(model: OpticalModel, extinction: f64, color: [f64; 3], length: f64) -> RgbaAssoc {
    if length == 0.0 {
        return RgbaAssoc::TRANSPARENT;
    }
    let tau = if model.needs_extinction() { extinction * length } else { 0.0 };
    let opacity = -(-tau).exp_m1();
    let factor = match model {
        OpticalModel::DensityEmitter => opacity,
        // `opacity / extinction` has no value at 0; the mean transmittance has.
        OpticalModel::Emitter if tau > 0.0 => length * (opacity / tau),
        OpticalModel::Emitter | OpticalModel::Emission => length,
        OpticalModel::Absorption => 0.0,
    };
    RgbaAssoc { rgb: color.map(|channel| channel * factor), opacity }
}
