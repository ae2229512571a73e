//! From the scalar to color and extinction: piecewise linear functions, merged into pieces.

use core::ops::Range;

use crate::TransferFunctionError;
use crate::model::OpticalModel;
use crate::range_max::RangeMax;

#[cfg(test)]
#[path = "transfer_tests.rs"]
mod tests;

/// Maps a scalar to a color and an extinction. Both are piecewise linear with control points of their own, and keep
/// their end values outside of them.
///
/// Two control points at one scalar make a step: below it the first counts, on it and above the second. Of three or
/// more at one scalar the first and the last count.
///
/// Color is linear RGB, not negative, not bounded by 1; in the models where it is radiance per length
/// ([`OpticalModel::color_is_per_length`]) its unit is that of radiance times that of the extinction.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferFunction {
    color: Vec<ControlPoint<3>>,
    extinction: Vec<ControlPoint<1>>,
    pieces: Vec<Piece>,
    /// Ends of the pieces, ascending, without the infinite ones: piece `i` lies between `cuts[i - 1]` and `cuts[i]`.
    cuts: Vec<f64>,
    /// For each cut, the larger of the values at its two sides.
    extinction_at_cuts: RangeMax,
    emission_at_cuts: RangeMax,
}

/// A stretch of scalars over which color and extinction are linear: `[start, end)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Lowest scalar; minus infinity for the first piece.
    pub start: f64,
    /// End of the scalars, always above `start`; infinity for the last piece.
    pub end: f64,
    /// Extinction at `start` and, as the limit from below, at `end`; equal where one of them is infinite.
    pub extinction: [f64; 2],
    /// Color at `start` and at `end`, likewise.
    pub color: [[f64; 3]; 2],
}

impl Piece {
    /// How much the values at `start` and at `end` count at a scalar: not negative, adding up to 1.
    ///
    /// Beyond the piece, and in one without an end, the nearer end counts alone.
    #[inline]
    pub fn shares(&self, scalar: f64) -> [f64; 2] {
        if self.start.is_finite() && self.end.is_finite() {
            shares(self.start, self.end, scalar.clamp(self.start, self.end))
        } else {
            // Both values are equal.
            [1.0, 0.0]
        }
    }

    /// Extinction at a scalar; beyond the piece, that at the nearer end.
    #[inline]
    pub fn extinction_at(&self, scalar: f64) -> f64 {
        mix(self.extinction[0], self.extinction[1], self.shares(scalar))
    }

    /// Color at a scalar; beyond the piece, that at the nearer end.
    #[inline]
    pub fn color_at(&self, scalar: f64) -> [f64; 3] {
        let shares = self.shares(scalar);
        core::array::from_fn(|channel| mix(self.color[0][channel], self.color[1][channel], shares))
    }

    /// Whether color and extinction are the same at both ends.
    pub fn is_constant(&self) -> bool {
        self.extinction[0] == self.extinction[1] && self.color[0] == self.color[1]
    }
}

impl TransferFunction {
    /// A transfer function from control points `[scalar, red, green, blue]` and `[scalar, extinction]`.
    ///
    /// Each list has at least one entry (a single one is a constant), ascends in the scalar, and may repeat a scalar to
    /// make a step.
    ///
    /// # Errors
    ///
    /// An empty list, scalars that descend, a number that is not finite, a negative color or extinction; the error
    /// names the list, the entry's index and what stands there.
    pub fn new(color: &[[f64; 4]], extinction: &[[f64; 2]]) -> Result<Self, TransferFunctionError> {
        let color: Vec<_> = color.iter().map(|&[s, r, g, b]| ControlPoint { scalar: s, value: [r, g, b] }).collect();
        let extinction: Vec<_> = extinction.iter().map(|&[s, rho]| ControlPoint { scalar: s, value: [rho] }).collect();
        check("color", &["red", "green", "blue"], &color)?;
        check("extinction", &["extinction"], &extinction)?;
        Ok(Self::from_checked(color, extinction))
    }

    fn from_checked(color: Vec<ControlPoint<3>>, extinction: Vec<ControlPoint<1>>) -> Self {
        let mut cuts: Vec<f64> =
            color.iter().map(|point| point.scalar).chain(extinction.iter().map(|point| point.scalar)).collect();
        cuts.sort_by(f64::total_cmp);
        // By value: the two zeros are one scalar.
        cuts.dedup_by(|next, kept| *next == *kept);

        let mut pieces = Vec::with_capacity(cuts.len() + 1);
        for i in 0..=cuts.len() {
            let start = if i == 0 { f64::NEG_INFINITY } else { cuts[i - 1] };
            let end = cuts.get(i).copied().unwrap_or(f64::INFINITY);
            let [at_start, at_end] = [limit_above(&extinction, start), limit_below(&extinction, end)];
            let piece = Piece {
                start,
                end,
                extinction: [at_start[0], at_end[0]],
                color: [limit_above(&color, start), limit_below(&color, end)],
            };
            join(&mut pieces, piece);
        }
        let cuts: Vec<f64> = pieces[1..].iter().map(|piece| piece.start).collect();
        let of_pairs = |largest: fn(&Piece, usize) -> f64| {
            RangeMax::new(pieces.windows(2).map(|pair| largest(&pair[0], 1).max(largest(&pair[1], 0))).collect())
        };
        let extinction_at_cuts = of_pairs(|piece, end| piece.extinction[end]);
        let emission_at_cuts = of_pairs(|piece, end| brightest(piece.color[end]));
        Self { color, extinction, pieces, cuts, extinction_at_cuts, emission_at_cuts }
    }

    /// The pieces, ascending: the first starts at minus infinity, the last ends at infinity, each starts where the one
    /// before ends. Steps have no piece, and neighbors of one and the same constant value are one piece.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Index of the piece that holds a scalar; on a cut, of the one above. NaN gives the first piece.
    #[inline]
    pub fn piece_at(&self, scalar: f64) -> usize {
        self.cuts.partition_point(|&cut| cut <= scalar)
    }

    /// The pieces that an interval of scalars shares more than a point with; for `lo == hi` the one that holds it.
    ///
    /// The ends may be given in either order.
    #[inline]
    pub fn pieces_between(&self, lo: f64, hi: f64) -> Range<usize> {
        let (lo, hi) = if lo <= hi { (lo, hi) } else { (hi, lo) };
        let first = self.piece_at(lo);
        // Pieces that start below `hi`; at least the one that holds `lo`.
        let end = self.cuts.partition_point(|&cut| cut < hi) + 1;
        first..end.max(first + 1)
    }

    /// Largest extinction over a closed interval of scalars, both sides of its steps included.
    pub fn max_extinction(&self, lo: f64, hi: f64) -> f64 {
        self.largest(lo, hi, &self.extinction_at_cuts, Piece::extinction_at)
    }

    /// Largest value of any color channel over a closed interval of scalars, both sides of its steps included.
    pub fn max_emission(&self, lo: f64, hi: f64) -> f64 {
        self.largest(lo, hi, &self.emission_at_cuts, |piece, scalar| brightest(piece.color_at(scalar)))
    }

    /// A piecewise linear function is largest at an end of the interval or at a cut within.
    fn largest(&self, lo: f64, hi: f64, at_cuts: &RangeMax, value: impl Fn(&Piece, f64) -> f64) -> f64 {
        let (lo, hi) = if lo <= hi { (lo, hi) } else { (hi, lo) };
        let first_cut = self.cuts.partition_point(|&cut| cut < lo);
        let end_cut = self.cuts.partition_point(|&cut| cut <= hi);
        let at_ends = value(&self.pieces[first_cut], lo).max(value(&self.pieces[end_cut], hi));
        at_ends.max(at_cuts.get(first_cut, end_cut))
    }

    /// Extinction at a scalar; on a step, that above.
    pub fn extinction(&self, scalar: f64) -> f64 {
        self.pieces[self.piece_at(scalar)].extinction_at(scalar)
    }

    /// Color at a scalar; on a step, that above.
    pub fn color(&self, scalar: f64) -> [f64; 3] {
        self.pieces[self.piece_at(scalar)].color_at(scalar)
    }

    /// The lowest and the highest control point of both lists.
    pub fn domain(&self) -> (f64, f64) {
        let (color, extinction) = (&self.color, &self.extinction);
        let lowest = color[0].scalar.min(extinction[0].scalar);
        (lowest, color[color.len() - 1].scalar.max(extinction[extinction.len() - 1].scalar))
    }

    /// The lowest and the highest control point of the extinction.
    pub fn extinction_domain(&self) -> (f64, f64) {
        (self.extinction[0].scalar, self.extinction[self.extinction.len() - 1].scalar)
    }

    /// The lowest and the highest control point of the color.
    pub fn color_domain(&self) -> (f64, f64) {
        (self.color[0].scalar, self.color[self.color.len() - 1].scalar)
    }

    /// The same optics with lengths in another unit: `factor` is the new unit's length in the old one.
    ///
    /// The extinction is multiplied by `factor`, and the color too where the model has it per length. What grows beyond
    /// the largest float becomes the largest float.
    ///
    /// # Panics
    ///
    /// If `factor` is not positive and finite.
    #[must_use]
    pub fn with_lengths_scaled(&self, factor: f64, model: OpticalModel) -> Self {
        assert!(factor > 0.0 && factor.is_finite(), "a unit of length is positive and finite, not {factor}");
        let color_factor = if model.color_is_per_length() { factor } else { 1.0 };
        Self::from_checked(scaled(&self.color, color_factor), scaled(&self.extinction, factor))
    }

    /// The same optics of a field that counts from another scalar: control points at their scalars less `base`, which is finite.
    ///
    /// What falls below the lowest float, or grows beyond the largest, becomes that.
    #[must_use]
    pub fn with_scalars_from(&self, base: f64) -> Self {
        let from = |scalar: f64| scalar - base;
        Self::from_checked(moved(&self.color, from), moved(&self.extinction, from))
    }

    /// The same optics of a field in another unit: control points at `factor` times their scalars.
    ///
    /// Exact where `factor` is a power of two and nothing leaves the range of floats. What grows beyond the largest float becomes
    /// the largest float.
    ///
    /// # Panics
    ///
    /// If `factor` is not positive and finite.
    #[must_use]
    pub fn with_scalars_scaled(&self, factor: f64) -> Self {
        assert!(factor > 0.0 && factor.is_finite(), "a unit of the scalar is positive and finite, not {factor}");
        let scale = |scalar: f64| scalar * factor;
        Self::from_checked(moved(&self.color, scale), moved(&self.extinction, scale))
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct ControlPoint<const N: usize> {
    scalar: f64,
    value: [f64; N],
}

fn check<const N: usize>(
    list: &'static str,
    components: &[&'static str; N],
    points: &[ControlPoint<N>],
) -> Result<(), TransferFunctionError> {
    if points.is_empty() {
        return Err(TransferFunctionError::Empty { list });
    }
    let mut previous = f64::NEG_INFINITY;
    for (index, point) in points.iter().enumerate() {
        let scalar = point.scalar;
        if !scalar.is_finite() {
            return Err(TransferFunctionError::NotFinite { list, index, component: "scalar", value: scalar });
        }
        if scalar < previous {
            return Err(TransferFunctionError::NotSorted { list, index, scalar, previous });
        }
        previous = scalar;
        for (&component, &value) in components.iter().zip(&point.value) {
            if !value.is_finite() {
                return Err(TransferFunctionError::NotFinite { list, index, component, value });
            }
            if value < 0.0 {
                return Err(TransferFunctionError::Negative { list, index, component, value });
            }
        }
    }
    Ok(())
}

/// Appends a piece, or lengthens the last one if both are the same constant.
fn join(pieces: &mut Vec<Piece>, piece: Piece) {
    match pieces.last_mut() {
        Some(last)
            if last.is_constant()
                && piece.is_constant()
                && last.extinction == piece.extinction
                && last.color == piece.color =>
        {
            last.end = piece.end;
        }
        _ => pieces.push(piece),
    }
}

/// The value on and just above a scalar.
fn limit_above<const N: usize>(points: &[ControlPoint<N>], scalar: f64) -> [f64; N] {
    between(points, points.partition_point(|point| point.scalar <= scalar), scalar)
}

/// The value just below a scalar.
fn limit_below<const N: usize>(points: &[ControlPoint<N>], scalar: f64) -> [f64; N] {
    between(points, points.partition_point(|point| point.scalar < scalar), scalar)
}

/// The value at a scalar between the points `next - 1` and `next`, or the end's value where one of them is missing.
fn between<const N: usize>(points: &[ControlPoint<N>], next: usize, scalar: f64) -> [f64; N] {
    if next == 0 {
        return points[0].value;
    }
    let below = &points[next - 1];
    let Some(above) = points.get(next) else { return below.value };
    let shares = shares(below.scalar, above.scalar, scalar);
    core::array::from_fn(|i| mix(below.value[i], above.value[i], shares))
}

fn scaled<const N: usize>(points: &[ControlPoint<N>], factor: f64) -> Vec<ControlPoint<N>> {
    let scale = |point: &ControlPoint<N>| ControlPoint {
        scalar: point.scalar,
        value: point.value.map(|value| (value * factor).min(f64::MAX)),
    };
    points.iter().map(scale).collect()
}

fn moved<const N: usize>(points: &[ControlPoint<N>], to: impl Fn(f64) -> f64) -> Vec<ControlPoint<N>> {
    let place = |scalar: f64| to(scalar).clamp(f64::MIN, f64::MAX);
    points.iter().map(|point| ControlPoint { scalar: place(point.scalar), ..*point }).collect()
}

/// Shares of the two ends at a scalar between them.
///
/// Both come from a difference of their own: one minus the other share would lose the digits of a value that falls to
/// zero at the far end.
#[inline]
fn shares(start: f64, end: f64, scalar: f64) -> [f64; 2] {
    let width = end - start;
    if width.is_finite() {
        [(end - scalar) / width, (scalar - start) / width]
    } else {
        // Wider than the largest float: halves keep the differences finite.
        let width = 0.5 * end - 0.5 * start;
        [(0.5 * end - 0.5 * scalar) / width, (0.5 * scalar - 0.5 * start) / width]
    }
}

/// Linear interpolation that hits both ends and does not overflow, also between values near the largest float. Adding zero turns -0
/// into 0.
#[inline]
fn mix(at_start: f64, at_end: f64, shares: [f64; 2]) -> f64 {
    (at_start * shares[0] + at_end * shares[1] + 0.0).min(f64::MAX)
}

fn brightest(color: [f64; 3]) -> f64 {
    color[0].max(color[1]).max(color[2])
}
