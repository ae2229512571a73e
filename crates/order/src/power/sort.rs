//! Cells sorted by 32 bits, for one key a cell and nothing else.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

/// Three passes: a table of counters stays in the first-level cache.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;
const SHIFTS: [u32; 3] = [32, 32 + DIGIT_BITS, 32 + 2 * DIGIT_BITS];

/// Below this many items threads cost more than they save.
pub(super) const PARALLEL_FROM: usize = 1 << 14;

/// Sorts items by their upper halves, the lowest first; their lower halves ascend from chunk to chunk, and so do those of items
/// with equal upper halves in the result.
///
/// A radix sort. Items go to their places through relaxed atomic stores: plain stores to the machine, which threads may
/// make into one list.
pub(super) fn sort_by_upper_half(chunks: &[Vec<u64>]) -> Vec<u64> {
    let len = chunks.iter().map(Vec::len).sum();
    if len < PARALLEL_FROM {
        let mut all = chunks.concat();
        all.sort_unstable();
        return all;
    }
    let places = || -> Vec<AtomicU64> { (0..len).into_par_iter().map(|_| AtomicU64::new(0)).collect() };
    let (mut from, mut to) = (places(), places());
    let slices: Vec<&[u64]> = chunks.iter().map(Vec::as_slice).collect();
    pass(&slices, |&item| item, SHIFTS[0], &from);
    for &shift in &SHIFTS[1..] {
        let slices: Vec<&[AtomicU64]> = from.chunks(len.div_ceil(chunks.len())).collect();
        pass(&slices, |item| item.load(Ordering::Relaxed), shift, &to);
        std::mem::swap(&mut from, &mut to);
    }
    from.into_iter().map(AtomicU64::into_inner).collect()
}

/// Moves every item to its place by one digit; equal digits keep their order.
fn pass<T: Sync>(chunks: &[&[T]], read: impl Fn(&T) -> u64 + Sync, shift: u32, to: &[AtomicU64]) {
    let digit = |item: u64| (item >> shift) as usize & (DIGITS - 1);
    let mut next: Vec<Vec<u32>> = chunks
        .par_iter()
        .map(|chunk| {
            let mut counts = vec![0; DIGITS];
            chunk.iter().for_each(|item| counts[digit(read(item))] += 1);
            counts
        })
        .collect();
    let mut place = 0;
    for value in 0..DIGITS {
        for counts in &mut next {
            place += std::mem::replace(&mut counts[value], place);
        }
    }
    chunks.par_iter().zip(&mut next).for_each(|(chunk, next)| {
        for item in *chunk {
            let item = read(item);
            let next = &mut next[digit(item)];
            to[*next as usize].store(item, Ordering::Relaxed);
            *next += 1;
        }
    });
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Lower halves are places, so that the sorted list of whole items is the stable one.
        #[test]
        fn upper_halves_ascend_and_equal_ones_keep_their_places(
            seed: u64, len in 1_usize..60_000, spread in 0_u32..33, parts in 1_usize..5,
        ) {
            let mut state = seed | 1;
            let items: Vec<u64> = (0..len as u64)
                .map(|place| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    (state >> 32).checked_shr(spread).unwrap_or(0) << 32 | place
                })
                .collect();
            let chunks: Vec<Vec<u64>> = items.chunks(len.div_ceil(parts)).map(<[u64]>::to_vec).collect();
            let sorted = sort_by_upper_half(&chunks);
            let mut expected = items;
            expected.sort_unstable();
            prop_assert!(sorted == expected);
        }
    }
}
