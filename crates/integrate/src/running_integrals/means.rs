//! What is kept of an interval of scalars: means and first moments, composed without a subtraction.

use crate::Piece;

/// Means of a transfer function over an interval of scalars, which a ray runs through at constant speed.
///
/// `u` below is the share of the interval's optical depth that lies before a scalar, 0 at the start; where there is no
/// depth at all, the share of the interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Means {
    /// Half of the interval's width: the whole may exceed the largest float.
    half_width: f64,
    /// Mean extinction.
    pub(super) extinction: f64,
    /// Mean color, each scalar counting as much as its extinction: `∫ kappa du`.
    pub(super) scattered: [f64; 3],
    /// `∫ (u - 1/2) kappa du`.
    pub(super) scattered_skew: [f64; 3],
    /// Mean color, all scalars counting alike: with `x` the share of the interval, `∫ kappa dx`.
    pub(super) glow: [f64; 3],
    /// `∫ (u - 1/2) kappa dx`.
    pub(super) glow_skew: [f64; 3],
    /// The least and the largest color.
    pub(super) lowest: [f64; 3],
    pub(super) highest: [f64; 3],
}

impl Means {
    /// Of the part of a piece from `start` to `end`, finite and in this order.
    pub(super) fn of_piece(piece: &Piece, start: f64, end: f64) -> Self {
        let halves = [start, end].map(|scalar| 0.5 * piece.extinction_at(scalar));
        let [near, far] = [start, end].map(|scalar| piece.color_at(scalar));
        let [first, second] = shares(halves[0], halves[1]).unwrap_or([0.5; 2]);
        // With the mean extinction as unit it goes from `1 - tilt` to `1 + tilt`, and `u = (1 - tilt) x + tilt x²`.
        let tilt = second - first;
        let by_channel = |value: &dyn Fn(f64, f64) -> f64| core::array::from_fn(|c| value(near[c], far[c]));
        Self {
            half_width: 0.5 * end - 0.5 * start,
            extinction: halves[0] + halves[1],
            scattered: by_channel(&|near, far| mix([near, far], [(1.0 + first) / 3.0, (1.0 + second) / 3.0])),
            // By parts, `∫ x (u - 1/2) du = ∫ (u - u²) / 2 dx`.
            scattered_skew: by_channel(&|near, far| (far - near) * ((5.0 - tilt * tilt) / 60.0)),
            glow: by_channel(&|near, far| 0.5 * near + 0.5 * far),
            glow_skew: by_channel(&|near, far| (far - near) / 12.0 - (0.5 * near + 0.5 * far) * (tilt / 6.0)),
            lowest: by_channel(&f64::min),
            highest: by_channel(&f64::max),
        }
    }

    /// Of this interval and the one above it together.
    pub(super) fn join(self, above: Self) -> Self {
        // Shares of the width, and of the depth.
        let [a, b] = shares(self.half_width, above.half_width).unwrap_or([0.5; 2]);
        let depths = [a * self.extinction, b * above.extinction];
        let [p, q] = shares(depths[0], depths[1]).unwrap_or([a, b]);
        let by_channel = |value: &dyn Fn(usize) -> f64| core::array::from_fn(value);
        Self {
            half_width: self.half_width + above.half_width,
            extinction: depths[0] + depths[1],
            scattered: by_channel(&|c| mix([self.scattered[c], above.scattered[c]], [p, q])),
            // The middles of both lie at `u = p / 2` and `u = 1 - q / 2`, that is `-q / 2` and `p / 2` from the middle.
            scattered_skew: by_channel(&|c| {
                let within = p * p * self.scattered_skew[c] + q * q * above.scattered_skew[c];
                within + 0.5 * p * q * (above.scattered[c] - self.scattered[c])
            }),
            glow: by_channel(&|c| mix([self.glow[c], above.glow[c]], [a, b])),
            glow_skew: by_channel(&|c| {
                let within = a * p * self.glow_skew[c] + b * q * above.glow_skew[c];
                within + 0.5 * (b * p * above.glow[c] - a * q * self.glow[c])
            }),
            lowest: by_channel(&|c| self.lowest[c].min(above.lowest[c])),
            highest: by_channel(&|c| self.highest[c].max(above.highest[c])),
        }
    }

    /// Run through the other way.
    pub(super) fn reversed(self) -> Self {
        let scattered_skew = self.scattered_skew.map(|skew| -skew);
        Self { scattered_skew, glow_skew: self.glow_skew.map(|skew| -skew), ..self }
    }
}

/// Between the two, although shares may add up to a little more than 1: next to the largest float that would be infinite.
fn mix([first, second]: [f64; 2], shares: [f64; 2]) -> f64 {
    (first * shares[0] + second * shares[1]).min(first.max(second))
}

/// What two numbers, not negative, contribute to their sum; `None` if that is 0.
fn shares(first: f64, second: f64) -> Option<[f64; 2]> {
    let sum = first + second;
    (sum > 0.0).then(|| [first / sum, second / sum])
}
