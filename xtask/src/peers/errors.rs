//! How far a picture is from the reference, channel by channel.

use tetrascope::LinearImage;

/// Beyond this a pixel counts as off: four steps of 8 bits.
const LIMIT: f64 = 4.0 / 255.0;

/// Distances of two pictures in R, G, B times opacity and in opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Errors {
    /// Largest of each channel; infinite where a picture holds what is no number.
    pub(super) largest: [f64; 4],
    /// Root of the mean square of each channel.
    pub(super) rms: [f64; 4],
    /// Share of the pixels that are off by more than 4/255 in some channel, 0 to 1.
    pub(super) share: f64,
}

impl Errors {
    /// The distances; both pictures have one size, else nothing is alike.
    pub(super) fn between(drawn: &LinearImage, exact: &LinearImage) -> Self {
        if (drawn.width(), drawn.height()) != (exact.width(), exact.height()) {
            return Self { largest: [f64::INFINITY; 4], rms: [f64::INFINITY; 4], share: 1.0 };
        }
        let mut errors = Self { largest: [0.0; 4], rms: [0.0; 4], share: 0.0 };
        for (drawn, exact) in drawn.pixels().iter().zip(exact.pixels()) {
            let mut is_off = false;
            for channel in 0..4 {
                let apart = (f64::from(drawn[channel]) - f64::from(exact[channel])).abs();
                let apart = if apart.is_finite() { apart } else { f64::INFINITY };
                errors.largest[channel] = errors.largest[channel].max(apart);
                errors.rms[channel] += apart * apart;
                is_off |= apart > LIMIT;
            }
            errors.share += f64::from(u8::from(is_off));
        }
        let pixels = exact.pixels().len().max(1) as f64;
        errors.rms = errors.rms.map(|sum| (sum / pixels).sqrt());
        errors.share /= pixels;
        errors
    }

    /// Largest of all channels.
    pub(super) fn worst(&self) -> f64 {
        self.largest.into_iter().fold(0.0, f64::max)
    }

    /// Largest root of a mean square.
    pub(super) fn worst_rms(&self) -> f64 {
        self.rms.into_iter().fold(0.0, f64::max)
    }
}
