//! Numbers of twice the precision, as unevaluated sums of two floats.

use std::ops::{Add, Mul, Neg, Sub};

/// Bound of the relative rounding of a determinant in [`Double`], against its permanent.
///
/// A sum is off by little more than 3 · 2⁻¹⁰⁶ of itself, a product by 5 · 2⁻¹⁰⁶ ([Joldes 2017]). A four by four
/// determinant chains three products and five sums: below 32 · 2⁻¹⁰⁶ = 4e-31 of the permanent, whose own rounding in f64 the
/// rest of the margin takes.
pub(super) const ROUNDING: f64 = 1e-30;

/// `high + low`, where `low` is below half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Double {
    pub(super) high: f64,
    pub(super) low: f64,
}

impl Double {
    /// `x - y`, exact.
    pub(super) fn difference(x: f64, y: f64) -> Self {
        two_sum(x, -y)
    }

    /// Compares as numbers; NaN comes after all others.
    pub(super) fn total_cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.high.total_cmp(&other.high).then(self.low.total_cmp(&other.low))
    }

    /// The quotient, off by a few 2⁻¹⁰⁰ of itself.
    pub(super) fn over(self, divisor: Self) -> Self {
        let first = self.high / divisor.high;
        let rest = self - divisor * Self::from(first);
        let second = rest.high / divisor.high;
        let rest = rest - divisor * Self::from(second);
        two_sum(first, second) + Self::from(rest.high / divisor.high)
    }
}

impl From<f64> for Double {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (highs, lows) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let sum = two_sum(highs.high, highs.low + lows.high);
        two_sum(sum.high, sum.low + lows.low)
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = self.high * other.high;
        let error = self.high.mul_add(other.high, -product);
        two_sum(product, error + (self.high * other.low + self.low * other.high))
    }
}

/// A sum as its rounded value and its error (Knuth).
fn two_sum(x: f64, y: f64) -> Double {
    let high = x + y;
    let y_seen = high - x;
    Double { high, low: (x - (high - y_seen)) + (y - y_seen) }
}
