//! The picture in linear floats.

/// A picture of 32-bit linear R, G, B, A: premultiplied, with no background under it. Row 0 is the top.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearImage {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 4]>,
}

impl LinearImage {
    /// A picture with nothing in it.
    pub fn transparent(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![[0.0; 4]; width as usize * height as usize] }
    }

    /// The same where the memory for it may not be there: `None` then, and nothing is held.
    pub fn try_transparent(width: u32, height: u32) -> Option<Self> {
        let size = (width as usize).checked_mul(height as usize)?;
        // Asked for and given back: what the system hands out next is zero already, and need not be touched.
        Vec::<[f32; 4]>::new().try_reserve_exact(size).ok()?;
        Some(Self::transparent(width, height))
    }

    /// A picture from its pixels, row after row; `None` unless there are `width * height` of them.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<[f32; 4]>) -> Option<Self> {
        (pixels.len() == width as usize * height as usize).then_some(Self { width, height, pixels })
    }

    /// Pixels a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row after row from the top.
    pub fn pixels(&self) -> &[[f32; 4]] {
        &self.pixels
    }

    /// All pixels, to be written.
    pub fn pixels_mut(&mut self) -> &mut [[f32; 4]] {
        &mut self.pixels
    }

    /// One pixel, premultiplied linear RGBA.
    ///
    /// # Panics
    /// If `x` or `y` is outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 4] {
        assert!(x < self.width && y < self.height, "pixel ({x}, {y}) of a {} x {} picture", self.width, self.height);
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The picture over a background: straight 8-bit sRGB, row after row, three bytes a pixel.
    ///
    /// `background` is linear RGB. Composition is done in linear light and encoded afterwards.
    pub fn to_srgb8(&self, background: [f32; 3]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.pixels.len() * 3);
        for &[r, g, b, a] in &self.pixels {
            for (color, behind) in [r, g, b].into_iter().zip(background) {
                bytes.push(srgb8_from_linear(color + (1.0 - a) * behind));
            }
        }
        bytes
    }
}

/// One channel in linear light to 8-bit sRGB ([IEC 61966-2-1]); clamps, and NaN gives 0.
fn srgb8_from_linear(linear: f32) -> u8 {
    // NaN takes the second branch, stays NaN, and the maximum with 0 drops it.
    let encoded = if linear > 0.003_130_8 { 1.055 * linear.min(1.0).powf(1.0 / 2.4) - 0.055 } else { 12.92 * linear };
    (encoded.max(0.0) * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_known_values() {
        for (linear, byte) in [(0.0, 0), (1.0, 255), (7.0, 255), (-1.0, 0), (f32::NAN, 0), (0.2159, 128), (0.5, 188)] {
            assert_eq!(srgb8_from_linear(linear), byte, "{linear}");
        }
    }

    #[test]
    fn background_shows_through_in_linear_light() {
        let image = LinearImage::from_pixels(1, 1, vec![[0.25, 0.0, 0.0, 0.5]]).unwrap();
        assert_eq!(image.to_srgb8([0.5, 1.0, 0.0]), [188, 188, 0]);
    }
}
