//! Opacity from the mean extinction and the length, color from the mean of both ends.

use crate::{MethodError, OpticalModel, RgbaAssoc, Segment, TableSettings, TransferFunction, thick_vertex};

#[cfg(test)]
#[path = "opacity_2d_tests.rs"]
mod tests;

/// The light of a segment with the mean extinction and the mean color of its two ends, along any ray.
///
/// The formula is that of [`thick_vertex`]; the difference is where it is used. There it gives one value a cell, and what
/// lies between the thick vertex and the silhouette is interpolated; here every ray has its own segment, so that the
/// opacity `1 - exp(-length (rho_front + rho_back) / 2)` is right in the whole cell wherever the extinction is linear.
/// The light is right where the color is constant too and, in the emitter model, the extinction; nothing between the
/// ends is looked at.
///
/// Source: [Stein 1994], who looks the opacity up in a texture over the mean extinction and the length, since hardware
/// of the time had no exponential for a pixel. That is [`OpacityTable`]; the renderers take the exponential, which is
/// exact and cheaper than the four loads of a bilinear look-up.
pub fn opacity_2d(transfer: &TransferFunction, model: OpticalModel, segment: &Segment) -> RgbaAssoc {
    thick_vertex(transfer, model, segment)
}

/// A table of the opacity `1 - exp(-extinction * length)`, for comparison with the closed form.
///
/// Entry `i * lengths + j` is the opacity at the extinction `i / (extinctions - 1)` and the length `j / (lengths - 1)`
/// of their largest values; bilinear between. [`OpacityTable::largest_error`] says what that costs: for a largest optical
/// depth of 8, which 8 bits cannot tell from opaque, 1.9e-3 with 64 samples along both axes and 1.2e-4 with 256.
///
/// Source: [Stein 1994].
#[derive(Clone, Debug, PartialEq)]
pub struct OpacityTable {
    entries: Vec<f32>,
    lengths: usize,
    /// Entries per extinction and per length.
    scale: [f64; 2],
    /// Largest extinction and length.
    largest: [f64; 2],
}

impl OpacityTable {
    /// - `max_extinction`: 1/length, `max_length`: length; finite, not negative. What is above is looked up as if it was
    ///   there.
    /// - `size`: samples along the axes of extinctions and of lengths, 2 to 1024 each
    ///
    /// # Errors
    /// [`MethodError::TableSize`].
    pub fn new(max_extinction: f64, max_length: f64, size: [u32; 2]) -> Result<Self, MethodError> {
        let (least, most) = (TableSettings::LEAST, TableSettings::MOST);
        for (what, size) in [("extinctions", size[0]), ("lengths", size[1])] {
            if !(least..=most).contains(&size) {
                return Err(MethodError::TableSize { what, size, least, most });
            }
        }
        // No extinction at all makes a table of zeros, not of divisions by zero.
        let [max_extinction, max_length] = [max_extinction, max_length].map(|largest| largest.max(1e-300));
        let [last_row, last_column] = size.map(|size| f64::from(size - 1));
        let entry = |row: u32, column: u32| {
            // The length of a sample first: the largest extinction and length may have no product.
            let depth = max_extinction * (f64::from(row) / last_row) * (max_length * (f64::from(column) / last_column));
            -(-depth).exp_m1() as f32
        };
        let entries = (0..size[0]).flat_map(|row| (0..size[1]).map(move |column| entry(row, column))).collect();
        Ok(Self {
            entries,
            lengths: size[1] as usize,
            scale: [last_row / max_extinction, last_column / max_length],
            largest: [max_extinction, max_length],
        })
    }

    /// The opacity of a segment, 0 to 1. What is not in the table's range is moved to its nearer end; NaN counts as 0.
    pub fn look_up(&self, mean_extinction: f64, length: f64) -> f64 {
        let rows = self.entries.len() / self.lengths;
        let place = |value: f64, axis: usize, samples: usize| {
            let place = (value.max(0.0).min(self.largest[axis]) * self.scale[axis]).min((samples - 1) as f64);
            let index = (place as usize).min(samples - 2);
            (index, place - index as f64)
        };
        let ((row, down), (column, right)) = (place(mean_extinction, 0, rows), place(length, 1, self.lengths));
        let [above, below] = [row, row + 1].map(|row| {
            let [left, right_entry] = [column, column + 1].map(|c| f64::from(self.entries[row * self.lengths + c]));
            left + (right_entry - left) * right
        });
        above + (below - above) * down
    }

    /// Largest absolute error at 7 × 7 places between any four entries, within the table's range.
    ///
    /// Beyond the range the error is that of the opacity at its end.
    pub fn largest_error(&self) -> f64 {
        self.errors().fold(0.0, f64::max)
    }

    /// The root mean square of the error at the same places.
    pub fn root_mean_square_error(&self) -> f64 {
        let (squares, count) = self.errors().fold((0.0, 0_u64), |(sum, count), error| (sum + error * error, count + 1));
        if count == 0 { 0.0 } else { (squares / count as f64).sqrt() }
    }

    fn errors(&self) -> impl Iterator<Item = f64> {
        const STEPS: u32 = 8;
        let (rows, columns) = (self.entries.len() / self.lengths, self.lengths);
        let at = |index: usize, step: u32, axis: usize| {
            (index as f64 + f64::from(step) / f64::from(STEPS)) / self.scale[axis]
        };
        let cells = (0..rows - 1).flat_map(move |row| (0..columns - 1).map(move |column| (row, column)));
        let steps = || (1..STEPS).flat_map(|down| (1..STEPS).map(move |right| (down, right)));
        cells.flat_map(move |(row, column)| {
            steps().map(move |(down, right)| {
                let (extinction, length) = (at(row, down, 0), at(column, right, 1));
                let known = -(-(extinction * length)).exp_m1();
                (self.look_up(extinction, length) - known).abs()
            })
        })
    }
}
