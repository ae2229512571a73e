//! The light that falls on a surface.

use thiserror::Error;

#[cfg(test)]
#[path = "phong_tests.rs"]
mod tests;

/// Phong's model: how much of its color a surface sends to the eye, and the highlight on top of it.
///
/// A surface of color `c` with the normal `n` towards the eye, lit from `l` and seen from `v`, shows
/// `c (ambient + diffuse max(0, n.l)) + specular max(0, r.v)^shininess` with `r` the mirrored direction of the light.
/// Where `n.l` is not positive there is no highlight.
///
/// The normal is the direction of the scalar's gradient or the opposite one, whichever faces the eye. A gradient of
/// length 0 has no direction, and `ambient` is all there is.
///
/// Source: [Phong 1975]; [Marroquim 2008], section 4.6, for gradients as normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// Share of the color that is there without light.
    pub ambient: f64,
    /// Share that depends on the angle of the light.
    pub diffuse: f64,
    /// Strength of the highlight, which is white.
    pub specular: f64,
    /// Its sharpness, 0 or more; at 0 the highlight has one strength wherever the light falls.
    pub shininess: f64,
}

/// Why a light cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PhongError {
    /// A coefficient is negative or not finite.
    #[error("{component} is {value}; give a finite number, zero or more")]
    Value {
        /// `"ambient"`, `"diffuse"`, `"specular"` or `"shininess"`.
        component: &'static str,
        /// What was given.
        value: f64,
    },
}

impl Phong {
    /// Whether all coefficients are finite and not negative.
    ///
    /// # Errors
    /// [`PhongError`] for the first that is not.
    pub fn check(&self) -> Result<(), PhongError> {
        let components = [
            ("ambient", self.ambient),
            ("diffuse", self.diffuse),
            ("specular", self.specular),
            ("shininess", self.shininess),
        ];
        match components.into_iter().find(|(_, value)| !(value.is_finite() && *value >= 0.0)) {
            Some((component, value)) => Err(PhongError::Value { component, value }),
            None => Ok(()),
        }
    }

    /// What a surface shows.
    ///
    /// - `color`: linear RGB of the side that is seen
    /// - `gradient`: of the scalar there, of any length
    /// - `to_eye`, `to_light`: of length 1, away from the surface
    ///
    /// All directions are in one frame. The result is linear RGB and may exceed 1.
    pub fn shade(&self, color: [f64; 3], gradient: [f64; 3], to_eye: [f64; 3], to_light: [f64; 3]) -> [f64; 3] {
        let [body, highlight] = self.intensities(gradient, to_eye, to_light);
        color.map(|channel| channel * body + highlight)
    }

    /// `[body, highlight]`: what a color is multiplied by, and what is added to each channel. Arguments as for
    /// [`Phong::shade`].
    ///
    /// Gradients may be as short or as long as floats can be. One that is zero, infinite or not a number has no
    /// direction.
    pub fn intensities(&self, gradient: [f64; 3], to_eye: [f64; 3], to_light: [f64; 3]) -> [f64; 2] {
        // The largest component becomes 1: no square overflows, and the squared length is at least 1 unless there is no
        // direction.
        let largest = gradient.iter().fold(0.0f64, |largest, g| largest.max(g.abs()));
        let scaled = gradient.map(|g| g / largest);
        let squared_length = dot(scaled, scaled);
        let has_direction = squared_length >= 1.0;
        if !has_direction {
            return [self.ambient, 0.0];
        }
        let normal = scaled.map(|g| g / squared_length.sqrt());
        let (to_eye_cosine, to_light_cosine) = (dot(normal, to_eye), dot(normal, to_light));
        // Turning the normal to the eye changes the signs of both.
        let facing = if to_eye_cosine < 0.0 { -to_light_cosine } else { to_light_cosine };
        if facing <= 0.0 {
            return [self.ambient, 0.0];
        }
        // r = 2 (n.l) n - l. Rounding may make its component along the view a little longer than 1.
        let mirrored = (2.0 * facing * to_eye_cosine.abs() - dot(to_light, to_eye)).clamp(0.0, 1.0);
        [self.ambient + self.diffuse * facing, self.specular * mirrored.powf(self.shininess)]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
