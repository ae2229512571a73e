//! The segment of a ray inside one cell, and the light that comes out of its front.

/// The part of a ray inside one cell, along which the scalar varies linearly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Segment {
    /// Scalar where the ray enters the cell, at the eye's side; finite.
    pub scalar_front: f64,
    /// Scalar where the ray leaves the cell; finite.
    pub scalar_back: f64,
    /// Length between the two, in the unit whose inverse the extinction has; finite, not negative.
    pub chord_length: f64,
}

/// Light that a stretch of volume sends to the eye, and how much it hides of what lies behind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RgbaAssoc {
    /// Linear light, already multiplied by the opacity where the model has one; not negative, not bounded by 1.
    pub rgb: [f64; 3],
    /// One minus the transmittance, 0 to 1.
    pub opacity: f64,
}

impl RgbaAssoc {
    /// Adds nothing and hides nothing: the neutral element of [`RgbaAssoc::over`].
    pub const TRANSPARENT: Self = Self { rgb: [0.0; 3], opacity: 0.0 };

    /// This in front of `behind`. Associative, not commutative.
    ///
    /// Source: [Porter 1984], `over` with associated color.
    #[must_use]
    pub fn over(self, behind: Self) -> Self {
        let transmittance = 1.0 - self.opacity;
        // The sum, not one minus the product of transmittances: thin layers keep all digits of their opacity.
        let opacity = self.opacity + transmittance * behind.opacity;
        let rgb = core::array::from_fn(|channel| self.rgb[channel] + transmittance * behind.rgb[channel]);
        Self { rgb, opacity }
    }
}
