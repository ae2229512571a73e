//! How often each value occurs.

use tetrascope::Association;

/// Counts of values in bins of one width.
#[derive(Debug)]
pub(super) struct Histogram {
    /// The field, so that it is found by this name again.
    pub(super) name: String,
    /// What is counted.
    pub(super) association: Association,
    /// Lowest and highest finite value; `None` where there is none.
    pub(super) range: Option<(f64, f64)>,
    /// From the lowest values to the highest; one bin where all are the same, none where none is finite.
    pub(super) counts: Vec<u64>,
    /// Values that are NaN or infinite, which are in no bin.
    pub(super) non_finite: usize,
}

impl Histogram {
    /// Counts finite values. Bins are closed at their lower end, the last one at both.
    ///
    /// - `bins`: at least 1
    pub(super) fn new(name: String, association: Association, values: &[f64], bins: usize) -> Self {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let range = finite().fold(None, |range: Option<(f64, f64)>, value| {
            let (low, high) = range.unwrap_or((value, value));
            Some((low.min(value), high.max(value)))
        });
        let counts = match range {
            None => Vec::new(),
            Some((low, high)) => {
                let mut counts = vec![0; if low < high { bins.max(1) } else { 1 }];
                for value in finite() {
                    let bin = bin_of(value, low, high, counts.len());
                    if let Some(count) = counts.get_mut(bin) {
                        *count += 1;
                    }
                }
                counts
            }
        };
        let non_finite = values.len() - finite().count();
        Self { name, association, range, counts, non_finite }
    }

    /// Values that are counted.
    pub(super) fn total(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// How many bins one column of a drawing stands for, where there are so many columns.
    pub(super) fn bins_a_column(&self, width: usize) -> usize {
        self.counts.len().div_ceil(width.max(1)).max(1)
    }

    /// The histogram as lines of blocks, the highest counts' first. Bins that do not fit stand together in one column; few bins are wider.
    ///
    /// - `rows`: lines
    /// - `is_log`: heights by the logarithm of the counts, of one more so that 1 is not nothing
    pub(super) fn draw(&self, width: usize, rows: usize, is_log: bool) -> Vec<String> {
        let columns: Vec<u64> = self.counts.chunks(self.bins_a_column(width)).map(|bins| bins.iter().sum()).collect();
        let wide = (width / columns.len().max(1)).max(1);
        let height = |count: u64| if is_log { (count as f64).ln_1p() } else { count as f64 };
        let highest = columns.iter().copied().map(height).fold(0.0, f64::max);
        let eighths: Vec<usize> = columns
            .iter()
            .map(|&count| {
                let share = if highest > 0.0 { height(count) / highest } else { 0.0 };
                let eighths = (share * (rows * LEVELS) as f64).round() as usize;
                // What is there is seen.
                eighths.max(usize::from(count > 0))
            })
            .collect();
        let row = |row: usize| {
            let base = (rows - 1 - row) * LEVELS;
            let block = |eighths: &usize| BLOCKS[eighths.saturating_sub(base).min(LEVELS)];
            let text: String = eighths.iter().flat_map(|eighths| std::iter::repeat_n(block(eighths), wide)).collect();
            text.trim_end().to_owned()
        };
        (0..rows).map(row).collect()
    }

    /// Columns that a drawing takes.
    pub(super) fn drawn_width(&self, width: usize) -> usize {
        let columns = self.counts.len().div_ceil(self.bins_a_column(width));
        columns * (width / columns.max(1)).max(1)
    }
}

/// Heights within a line.
const LEVELS: usize = 8;
const BLOCKS: [char; LEVELS + 1] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// The bin of a value from `low` to `high`, of which the one is below the other.
fn bin_of(value: f64, low: f64, high: f64, bins: usize) -> usize {
    // Halved, so that a range over all numbers does not overflow.
    let share = (value / 2.0 - low / 2.0) / (high / 2.0 - low / 2.0);
    // Between the smallest of numbers halves may be none: then nothing is told apart.
    let share = if share.is_nan() { 0.0 } else { share };
    ((share * bins as f64) as usize).min(bins - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64], bins: usize) -> Histogram {
        Histogram::new("s".to_owned(), Association::Point, values, bins)
    }

    #[test]
    fn every_finite_value_is_in_one_bin() {
        let histogram = of(&[0.0, 1.0, 1.5, 2.0, 3.9, 4.0, f64::NAN, f64::NEG_INFINITY], 4);
        assert_eq!(histogram.counts, [1, 2, 1, 2]);
        assert_eq!((histogram.range, histogram.non_finite, histogram.total()), (Some((0.0, 4.0)), 2, 6));
        assert_eq!(of(&[7.0; 5], 9).counts, [5]);
        assert_eq!(of(&[f64::NAN], 9).counts, [0; 0]);
        assert_eq!(of(&[], 9).total(), 0);
    }

    #[test]
    fn ranges_at_the_limits_of_numbers() {
        assert_eq!(of(&[-f64::MAX, 0.0, f64::MAX], 2).counts, [1, 2]);
        let smallest = f64::from_bits(1);
        assert_eq!(of(&[0.0, smallest], 2).total(), 2);
        assert_eq!(of(&[0.0, 1e-320], 2).counts, [1, 1]);
    }

    #[test]
    fn bars_are_as_high_as_their_counts() {
        let histogram = of(&[0.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0], 4);
        assert_eq!(histogram.counts, [1, 2, 4, 8]);
        assert_eq!(histogram.draw(4, 1, false), ["▁▂▄█"]);
        assert_eq!(histogram.draw(4, 2, false), ["   █", "▂▄██"]);
        assert_eq!(histogram.draw(9, 1, false), ["▁▁▂▂▄▄██"]);
        assert_eq!(histogram.draw(2, 1, false), ["▂█"]);
        assert_eq!(histogram.drawn_width(9), 8);
        // By logarithms of 2, 3, 5 and 9.
        assert_eq!(histogram.draw(4, 1, true), ["▃▄▆█"]);
        assert_eq!(of(&[f64::NAN], 3).draw(5, 1, false), [""]);
    }

    #[test]
    fn a_single_value_is_seen_beside_a_million() {
        let mut values = vec![0.0; 1_000_000];
        values.push(1.0);
        assert_eq!(of(&values, 2).draw(2, 1, false), ["█▁"]);
    }
}
