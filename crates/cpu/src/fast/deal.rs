//! What a tile's pixels sort: keys dealt to their pixels in one counting pass.

use tetrascope_order::sortable_bits;

/// Keys of things that lie along rays, pixel after pixel: 8 bytes each. The memory is used again.
#[derive(Debug, Default)]
pub(crate) struct Deal {
    /// Where each pixel's keys end.
    ends: Vec<u32>,
    /// The bits of the depth above those of the index: their order is that of the depths, and of the indices where depths are equal.
    keys: Vec<u64>,
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
