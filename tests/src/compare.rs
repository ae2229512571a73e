//! How far two pictures are apart.

use tetrascope::LinearImage;

/// The largest difference in any channel, where it is, and how many pixels are beyond a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Largest absolute difference of any of the four channels.
    pub largest: f64,
    /// Column and row of that pixel.
    pub at: (u32, u32),
    /// Largest difference of the opacities alone, which no order of the cells can change.
    pub opacity: f64,
    /// Root of the mean square over all channels.
    pub rms: f64,
    /// Pixels that differ by more than the limit in some channel.
    pub beyond: usize,
}

/// Compares all pixels but those left out.
///
/// # Panics
/// If the pictures differ in size or one holds a value that is not finite.
pub fn difference(a: &LinearImage, b: &LinearImage, limit: f64, leave_out: &[(u32, u32)]) -> Difference {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()), "pictures of different size");
    let mut found = Difference { largest: 0.0, at: (0, 0), opacity: 0.0, rms: 0.0, beyond: 0 };
    for y in 0..a.height() {
        for x in 0..a.width() {
            if leave_out.contains(&(x, y)) {
                continue;
            }
            let mut here = 0.0_f64;
            for (p, q) in a.pixel(x, y).into_iter().zip(b.pixel(x, y)) {
                assert!(p.is_finite() && q.is_finite(), "pixel ({x}, {y}) holds {p} and {q}");
                let d = (f64::from(p) - f64::from(q)).abs();
                here = here.max(d);
                found.rms += d * d;
            }
            found.opacity = found.opacity.max((f64::from(a.pixel(x, y)[3]) - f64::from(b.pixel(x, y)[3])).abs());
            found.beyond += usize::from(here > limit);
            if here > found.largest {
                (found.largest, found.at) = (here, (x, y));
            }
        }
    }
    found.rms = (found.rms / (4.0 * a.pixels().len() as f64)).sqrt();
    found
}
