//! The light that falls on a surface.

/// Phong's model: how much of its color a surface sends to the eye, and the highlight on top of it.
///
/// A surface of color `c` with the normal `n` towards the eye, lit from `l` and seen from `v`, shows
/// `c (ambient + diffuse max(0, n.l)) + specular max(0, r.v)^shininess` with `r` the mirrored direction of the light.
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
    /// Its sharpness, 0 or more.
    pub shininess: f64,
}
