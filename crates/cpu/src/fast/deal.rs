//! What a tile's pixels sort: keys dealt to their pixels in one counting pass, and put in order there.

use tetrascope_order::sortable_bits;

/// Keys of things that lie along rays, pixel after pixel: 8 bytes each. The memory is used again.
#[derive(Debug, Default)]
pub(crate) struct Deal {
    /// Where each pixel's keys end.
    ends: Vec<u32>,
    /// The bits of the depth above those of the index: their order is that of the depths, and of the indices where depths are equal.
    keys: Vec<u64>,
}

/// Brings a pixel's keys into the order in which they leave a window: it holds `window` of them, and gives up the nearest when one more comes.
///
/// In place: keys that are held stand sorted right before the next one. Keys that come nearly sorted cost next to nothing; at worst each one
/// moves past the whole window.
///
/// - `window`: 1 or more; with that of all keys they are sorted
pub(crate) fn pass_through_window(keys: &mut [u64], window: usize) {
    if keys.len() <= window {
        keys.sort_unstable();
        return;
    }
    for last in 1..keys.len() {
        let first = (last + 1).saturating_sub(window);
        let key = keys[last];
        let mut place = last;
        while place > first && keys[place - 1] > key {
            keys[place] = keys[place - 1];
            place -= 1;
        }
        keys[place] = key;
    }
}

/// The index in a key.
pub(crate) fn index_of(key: u64) -> usize {
    key as u32 as usize
}

impl Deal {
    /// Deals things to their pixels, each pixel's in the order in which they come.
    ///
    /// - `pixels`: how many there are
    /// - `things`: each one's pixel, depth and index
    #[inline(always)]
    pub(crate) fn fill(&mut self, pixels: usize, things: impl Iterator<Item = (u32, f32, u32)> + Clone) {
        self.ends.clear();
        self.ends.resize(pixels, 0);
        for (pixel, _, _) in things.clone() {
            self.ends[pixel as usize] += 1;
        }
        // First where each pixel's keys begin; dealing moves that to where they end.
        let mut begin = 0;
        for end in &mut self.ends {
            begin += std::mem::replace(end, begin);
        }
        self.keys.clear();
        self.keys.resize(begin as usize, 0);
        for (pixel, depth, index) in things {
            let place = &mut self.ends[pixel as usize];
            self.keys[*place as usize] = u64::from(sortable_bits(depth)) << 32 | u64::from(index);
            *place += 1;
        }
    }

    /// Every pixel's number and keys, in the order in which they came.
    pub(crate) fn pixels(&mut self) -> impl Iterator<Item = (usize, &mut [u64])> {
        let mut rest = self.keys.as_mut_slice();
        let mut begin = 0;
        self.ends.iter().enumerate().map(move |(pixel, &end)| {
            let (keys, others) = std::mem::take(&mut rest).split_at_mut((end - begin) as usize);
            (rest, begin) = (others, end);
            (pixel, keys)
        })
    }
}

#[cfg(test)]
mod tests {
    use std::cmp::Reverse;
    use std::collections::BinaryHeap;

    use proptest::prelude::*;

    use super::*;

    /// What leaves a window first, said in another way.
    fn through_heap(keys: &[u64], window: usize) -> Vec<u64> {
        let (mut held, mut left) = (BinaryHeap::new(), Vec::new());
        for &key in keys {
            if held.len() == window {
                left.extend(held.pop().map(|Reverse(key)| key));
            }
            held.push(Reverse(key));
        }
        while let Some(Reverse(key)) = held.pop() {
            left.push(key);
        }
        left
    }

    proptest! {
        #[test]
        fn window_gives_up_the_nearest(keys in prop::collection::vec(0..50_u64, 0..60), window in 1..70_usize) {
            let mut found = keys.clone();
            pass_through_window(&mut found, window);
            prop_assert_eq!(&found, &through_heap(&keys, window));
            if window == 1 {
                prop_assert_eq!(found, keys);
            }
        }

        #[test]
        fn pixels_get_what_is_theirs(things in prop::collection::vec((0..7_u32, -2.0..2.0_f32), 0..60)) {
            let mut deal = Deal::default();
            for _ in 0..2 {
                deal.fill(7, (0..).zip(&things).map(|(index, &(pixel, depth))| (pixel, depth, index)));
                let mut pixels = 0;
                for (pixel, keys) in deal.pixels() {
                    let own: Vec<usize> = (0..things.len()).filter(|&i| things[i].0 as usize == pixel).collect();
                    prop_assert_eq!(keys.iter().map(|&key| index_of(key)).collect::<Vec<_>>(), own);
                    keys.sort_unstable();
                    prop_assert!(keys.is_sorted_by_key(|&key| things[index_of(key)].1));
                    pixels += 1;
                }
                prop_assert_eq!(pixels, 7);
            }
        }
    }
}
