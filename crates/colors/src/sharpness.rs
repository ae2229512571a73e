//! How ParaView leads an opacity from one control point to the next: by way of a midpoint, and more or less sharply.

/// Midpoints are kept this far from both ends.
const EDGE: f64 = 1e-5;

/// Below this sharpness a way is straight.
const STRAIGHT: f64 = 0.01;

/// A half of the way between two values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Half {
    /// The values at both ends of the whole way.
    pub(crate) ends: [f64; 2],
    /// 0 to 1.
    pub(crate) sharpness: f64,
    /// Whether it is the half behind the midpoint.
    pub(crate) second: bool,
}

/// Whether a way is straight but for its midpoint.
pub(crate) fn is_straight(sharpness: f64) -> bool {
    sharpness < STRAIGHT
}

/// The halves of a way, and the share at which they meet.
///
/// - `midpoint`: where the value is halfway, as a share of the way
pub(crate) fn halves(ends: [f64; 2], midpoint: f64, sharpness: f64) -> [(f64, Half); 2] {
    let half = |second| Half { ends, sharpness, second };
    [(midpoint.clamp(EDGE, 1.0 - EDGE), half(false)), (1.0, half(true))]
}

impl Half {
    /// The value at a share from 0 to 1 of this half.
    pub(crate) fn at(self, share: f64) -> f64 {
        let [from, to] = self.ends;
        let share = 0.5 * share + if self.second { 0.5 } else { 0.0 };
        if is_straight(self.sharpness) {
            return (1.0 - share) * from + share * to;
        }
        // Drawn toward the nearer end, then a cubic between the ends that is flatter there the sharper the way is.
        let power = 1.0 + 10.0 * self.sharpness;
        let s =
            if self.second { 1.0 - 0.5 * (2.0 * (1.0 - share)).powf(power) } else { 0.5 * (2.0 * share).powf(power) };
        let (squared, cubed) = (s * s, s * s * s);
        let slope = (1.0 - self.sharpness) * (to - from);
        let value = (2.0 * cubed - 3.0 * squared + 1.0) * from
            + (3.0 * squared - 2.0 * cubed) * to
            + (2.0 * cubed - 3.0 * squared + s) * slope;
        value.clamp(from.min(to), from.max(to))
    }

    /// From the other end.
    pub(crate) fn reversed(self) -> Self {
        let [from, to] = self.ends;
        Self { ends: [to, from], second: !self.second, ..self }
    }
}
