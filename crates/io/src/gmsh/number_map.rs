//! From the numbers that a file gives its nodes or elements, which need not follow one another, to indices.

/// Finds the index of a number.
pub(super) enum NumberMap {
    /// Of numbers that lie close together: the smallest, and for each from there on its index, or [`NONE`].
    Table(i64, Vec<u32>),
    /// Of others: numbers and their indices, sorted.
    Sorted(Vec<(i64, u32)>),
}

/// A place in the table that no number has taken.
const NONE: u32 = u32::MAX;

/// A table may have this many places a number; beyond that, sorted pairs are shorter.
const PLACES: usize = 4;

impl NumberMap {
    /// Of pairs of a number and its index, and how many pairs were left out because an earlier one has their number.
    pub(super) fn new(pairs: impl Iterator<Item = (i64, u32)> + Clone) -> (Self, usize) {
        let count = pairs.clone().count();
        let low = pairs.clone().map(|(number, _)| number).min().unwrap_or(0);
        let high = pairs.clone().map(|(number, _)| number).max().unwrap_or(0);
        let span = high.checked_sub(low).and_then(|span| usize::try_from(span).ok());
        match span {
            Some(span) if span / PLACES <= count => {
                let mut table = vec![NONE; span + 1];
                let mut repeated = 0;
                for (number, index) in pairs {
                    let place = usize::try_from(number - low).ok().and_then(|place| table.get_mut(place));
                    match place {
                        Some(place) if *place == NONE => *place = index,
                        _ => repeated += 1,
                    }
                }
                (Self::Table(low, table), repeated)
            }
            _ => {
                let mut sorted: Vec<_> = pairs.collect();
                // Stable, so that of equal numbers the first one stays.
                sorted.sort_by_key(|&(number, _)| number);
                sorted.dedup_by_key(|&mut (number, _)| number);
                let repeated = count - sorted.len();
                (Self::Sorted(sorted), repeated)
            }
        }
    }

    /// Of no numbers.
    pub(super) fn none() -> Self {
        Self::Sorted(Vec::new())
    }

    /// The index of a number.
    pub(super) fn get(&self, number: i64) -> Option<u32> {
        match self {
            Self::Table(low, table) => {
                let place = usize::try_from(number.checked_sub(*low)?).ok()?;
                table.get(place).copied().filter(|&index| index != NONE)
            }
            Self::Sorted(sorted) => {
                let at = sorted.binary_search_by_key(&number, |&(number, _)| number).ok()?;
                sorted.get(at).map(|&(_, index)| index)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn close_and_far_numbers() {
        for numbers in [vec![3, 1, 2, 3], vec![7, -4, i64::MAX, 7, i64::MIN], vec![], vec![1 << 40, 5, 5]] {
            let pairs = numbers.iter().zip(0_u32..).map(|(&number, index)| (number, index));
            let (map, repeated) = NumberMap::new(pairs);
            let mut distinct = numbers.clone();
            distinct.sort_unstable();
            distinct.dedup();
            assert_eq!(repeated, numbers.len() - distinct.len(), "{numbers:?}");
            for &number in &numbers {
                let first = numbers.iter().position(|&other| other == number).unwrap();
                assert_eq!(map.get(number), u32::try_from(first).ok(), "{numbers:?}");
            }
            for missing in [0, 4, -1, i64::MIN + 1] {
                assert!(map.get(missing).is_none() || numbers.contains(&missing), "{missing} in {numbers:?}");
            }
        }
    }
}
