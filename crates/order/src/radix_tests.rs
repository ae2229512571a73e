//! Words come in order, whatever their spread and the number of threads.

use proptest::prelude::*;

use crate::radix::{Dealt, bits_for};

fn sorted(words: &[u64], bits: u32, threads: usize) -> (Vec<u64>, Vec<(usize, usize)>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let dealt = Dealt::new(words.len(), bits, |places, to| to.extend_from_slice(&words[places]));
        dealt.sort(0, |first, words, to| {
            to.copy_from_slice(words);
            (first, words.len())
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Spread evenly, over few values, or most of them in one bucket.
    #[test]
    fn words_of_any_spread_come_in_order(
        seed: u64, len in 0_usize..100_000, kept in 0_u32..64, crowded in 0_u64..100, threads in 1_usize..4,
    ) {
        let mut state = seed | 1;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        let all_bits = !0_u64 >> 1;
        let words: Vec<u64> = (0..len)
            .map(|_| {
                let word = (random() << 30 ^ random()) & all_bits;
                // The lowest bits of a crowded word stay, and all bits but the highest of the others.
                if random() % 100 < crowded { word & all_bits >> kept.min(62) } else { word >> (kept % 8) << (kept % 8) }
            })
            .collect();
        let bits = bits_for(words.iter().copied().max().unwrap_or(0));
        let (found, buckets) = sorted(&words, bits, threads);
        let mut expected = words;
        expected.sort_unstable();
        prop_assert!(found == expected);
        // Buckets follow each other.
        let mut place = 0;
        for (first, len) in buckets {
            prop_assert_eq!(first, place);
            place += len;
        }
        prop_assert_eq!(place, len);
    }
}
