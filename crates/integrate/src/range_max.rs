//! Largest value in any range of a list, in constant time.

/// A sparse table: level `k` holds the maxima of all runs of `2^k` values, so that two overlapping runs cover any range.
///
/// Memory `n log n`; a transfer function has few points, and cells ask for millions of ranges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RangeMax {
    levels: Vec<Vec<f64>>,
}

impl RangeMax {
    pub(crate) fn new(values: Vec<f64>) -> Self {
        let mut levels = vec![values];
        let mut run = 1;
        while 2 * run <= levels[0].len() {
            let below = &levels[levels.len() - 1];
            let next = below.iter().zip(&below[run..]).map(|(left, right)| left.max(*right)).collect();
            levels.push(next);
            run *= 2;
        }
        Self { levels }
    }

    /// The largest of `values[start..end]`; 0 for an empty range, which suits lists of values that are not negative.
    pub(crate) fn get(&self, start: usize, end: usize) -> f64 {
        if start >= end {
            return 0.0;
        }
        let level = (end - start).ilog2() as usize;
        self.levels[level][start].max(self.levels[level][end - (1 << level)])
    }
}

#[cfg(test)]
mod tests {
    use super::RangeMax;

    #[test]
    fn agrees_with_a_scan_on_every_range() {
        let values: Vec<f64> = (0..37).map(|i| f64::from((i * 29) % 41)).collect();
        let table = RangeMax::new(values.clone());
        for start in 0..values.len() {
            for end in start..=values.len() {
                let scan = values[start..end].iter().copied().fold(0.0, f64::max);
                assert_eq!(table.get(start, end), scan, "{start}..{end}");
            }
        }
    }
}
