//! Between the values that files and screens have and linear light.

/// Linear light of a channel in sRGB; 0 to 1 both, beyond that the same formula, for negative values its linear part.
///
/// Source: [IEC 61966-2-1].
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// A channel in sRGB of linear light; 0 to 1 both, beyond that the same formula, for negative values its linear part.
///
/// Undoes [`linear_from_srgb`] but for rounding; at the joint of its two parts the standard's constants leave a gap of 3e-8.
/// Source: [IEC 61966-2-1].
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}
