//! The transfer functions that errors are measured on.

use tetrascope::integrate::TransferFunctionError;
use tetrascope::{OpticalModel, TransferFunction};

/// A transfer function over the scalars from 0 to 1, with a name.
#[derive(Clone, Debug)]
pub(crate) struct Family {
    /// A word.
    pub(crate) name: &'static str,
    /// Extinction up to 400 per length.
    pub(crate) transfer: TransferFunction,
}

/// Five of them, each hard for methods of another kind.
///
/// - `ramp`: extinction from 0 to 10, linear; nothing to miss
/// - `tents`: three peaks of 50, each a tenth of the range wide
/// - `shell`: one peak of 400, 1/64 of the range wide: thinner than a texel of most tables
/// - `box`: 20 from 0.3 to 0.7, with edges of 1/256
/// - `table`: 256 entries without order, up to 10, as of a transfer function drawn by hand
///
/// Colors go from blue over white to orange in all of them. Models that take the color as light per length get it ten times as bright:
/// what leaves a segment of length 0.1 is then about as bright as its color.
pub(crate) fn families(model: OpticalModel) -> Result<Vec<Family>, TransferFunctionError> {
    let brightness = match model {
        OpticalModel::DensityEmitter | OpticalModel::Absorption => 1.0,
        OpticalModel::Emitter | OpticalModel::Emission => 10.0,
    };
    let color = [[0.0, 0.1, 0.2, 0.9], [0.5, 0.9, 0.9, 0.8], [1.0, 0.9, 0.2, 0.1]]
        .map(|[scalar, r, g, b]| [scalar, r * brightness, g * brightness, b * brightness]);
    let tent = |center: f64, half: f64, height: f64| [[center - half, 0.0], [center, height], [center + half, 0.0]];
    let tents = [tent(0.2, 0.05, 50.0), tent(0.5, 0.05, 50.0), tent(0.8, 0.05, 50.0)].concat();
    let edge = 1.0 / 256.0;
    // Multiples of the golden ratio: spread evenly, and in no order once the factor is squared.
    let noise = |i: u32| (f64::from(i) * 0.618_033_988_75).fract();
    let table: Vec<_> = (0..256).map(|i| [f64::from(i) / 255.0, 10.0 * noise(i * i)]).collect();
    [
        ("ramp", vec![[0.0, 0.0], [1.0, 10.0]]),
        ("tents", tents),
        ("shell", tent(0.5, 1.0 / 128.0, 400.0).to_vec()),
        ("box", vec![[0.3, 0.0], [0.3 + edge, 20.0], [0.7, 20.0], [0.7 + edge, 0.0]]),
        ("table", table),
    ]
    .into_iter()
    .map(|(name, extinction)| Ok(Family { name, transfer: TransferFunction::new(&color, &extinction)? }))
    .collect()
}
