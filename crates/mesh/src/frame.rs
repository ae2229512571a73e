//! The local frame of a mesh: where its coordinates are small numbers.

use glam::DVec3;

/// Maps world coordinates to local ones, in which the mesh has a size of about one and lies about the origin.
///
/// `local = (world - origin) / scale`. `scale` is a power of two and `origin` a multiple of `scale / 1024`, so that the
/// map of any coordinate that was stored in 32 bits is exact, and that of one stored in 64 bits loses nothing but bits
/// below 2⁻⁵³ of the mesh's distance from the world's origin, which were never there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// World coordinates of the local origin.
    pub origin: DVec3,
    /// World length of one local unit; positive, finite, a power of two.
    pub scale: f64,
}

impl Frame {
    /// The frame in which local and world coordinates agree.
    pub const WORLD: Self = Self { origin: DVec3::ZERO, scale: 1.0 };

    /// The frame that fits a box with these corners: its half diagonal becomes a length between 1/2 and 1.
    ///
    /// A box of no size, or one that is not finite, gives [`Frame::WORLD`] moved to the box if it has a place.
    pub fn fitting(lowest: DVec3, highest: DVec3) -> Self {
        // Halves first: the sum of two coordinates near the largest float would overflow.
        let center = lowest * 0.5 + highest * 0.5;
        // Divided by its largest component before it is squared: sizes of 1e-200 and 1e200 have a length too.
        let half = highest * 0.5 - lowest * 0.5;
        let largest = half.abs().max_element();
        let half_diagonal = if largest > 0.0 { (half / largest).length() * largest } else { 0.0 };
        if !center.is_finite() {
            return Self::WORLD;
        }
        if !half_diagonal.is_finite() || half_diagonal < f64::MIN_POSITIVE {
            return Self { origin: center, scale: 1.0 };
        }
        let scale = half_diagonal.log2().ceil().clamp(-1000.0, 1000.0).exp2();
        let grain = scale / 1024.0;
        let origin = (center / grain).round() * grain;
        Self { origin: if origin.is_finite() { origin } else { center }, scale }
    }

    /// A point's local coordinates.
    #[inline]
    pub fn to_local(&self, world: DVec3) -> DVec3 {
        (world - self.origin) / self.scale
    }

    /// A point's world coordinates.
    #[inline]
    pub fn to_world(&self, local: DVec3) -> DVec3 {
        local * self.scale + self.origin
    }
}
