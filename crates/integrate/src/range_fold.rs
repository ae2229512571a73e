//! The composition of any range of a list, in constant time.

/// A disjoint sparse table: for each level the compositions from the middle of every block of `2^k` entries outwards, so
/// that a range is one run that ends in a middle and one that begins there.
///
/// Nothing is ever subtracted, unlike with sums from the start: a range far from the start keeps its digits, and
/// operations without an inverse will do. Memory `n log n`; a transfer function has few pieces, and rays ask for many
/// ranges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RangeFold<T> {
    len: usize,
    /// `levels[k][i]`: the composition of what lies between `i` and the middle of its block of `2^(k + 1)` entries, `i`
    /// included.
    levels: Vec<Vec<T>>,
}

impl<T: Copy> RangeFold<T> {
    /// - `join`: the composition of two neighbors, the lower first; associative
    pub(crate) fn new(values: &[T], join: impl Fn(T, T) -> T) -> Self {
        let mut levels = Vec::new();
        let mut half = 1;
        // A single entry has no middle; one level serves it all the same.
        while levels.is_empty() || half < values.len() {
            let mut level = values.to_vec();
            for middle in (half..values.len()).step_by(2 * half) {
                for i in (middle - half..middle - 1).rev() {
                    level[i] = join(level[i], level[i + 1]);
                }
                for i in middle + 1..(middle + half).min(values.len()) {
                    level[i] = join(level[i - 1], level[i]);
                }
            }
            levels.push(level);
            half *= 2;
        }
        Self { len: values.len(), levels }
    }

    /// The composition of the entries from `start` to before `end`; `None` for an empty range.
    pub(crate) fn get(&self, start: usize, end: usize, join: impl Fn(T, T) -> T) -> Option<T> {
        if start >= end || end > self.len {
            return None;
        }
        let last = end - 1;
        if start == last {
            // The lowest level holds single entries: its blocks are pairs.
            return Some(self.levels[0][start]);
        }
        // The highest bit in which both differ says in which block size they are on two sides of a middle.
        let level = &self.levels[(start ^ last).ilog2() as usize];
        Some(join(level[start], level[last]))
    }
}

#[cfg(test)]
mod tests {
    use super::RangeFold;

    /// Composition of the linear functions `a x + b`: associative, not commutative; exact in small integers.
    fn join((a, b): (i64, i64), (c, d): (i64, i64)) -> (i64, i64) {
        ((a * c) % 1009, (a * d + b) % 1009)
    }

    #[test]
    fn agrees_with_a_fold_on_every_range() {
        for len in [0usize, 1, 2, 3, 8, 37, 64] {
            let values: Vec<_> = (0..len as i64).map(|i| (2 + i * 29 % 41, i * 7 % 13)).collect();
            let table = RangeFold::new(&values, join);
            for start in 0..=len {
                assert_eq!(table.get(start, start, join), None);
                for end in start + 1..=len {
                    let fold = values[start..end].iter().copied().reduce(join);
                    assert_eq!(table.get(start, end, join), fold, "{start}..{end} of {len}");
                }
            }
        }
    }
}
