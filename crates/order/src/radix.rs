//! A stable sort of cells by keys: dealt into buckets, which are then sorted in the cache.

use std::ops::Range;

use rayon::prelude::*;
use tetrascope_mesh::CellId;

/// Words that one task deals, and their copy: half of a second-level cache of 1 MiB, so that dealing writes no memory at random.
const WORDS_PER_CHUNK: usize = 1 << 15;

/// Words of a bucket, about: two copies of them stay in the first-level cache.
const WORDS_PER_BUCKET: usize = 512;

/// Buckets at most, as a power of two: beyond, a chunk has only few words for each.
const MOST_BUCKET_BITS: u32 = 11;

/// Sub-buckets of a large bucket at most, as a power of two: their counters stay in the second-level cache.
const MOST_SUB_BUCKET_BITS: u32 = 16;

/// Words of neighboring buckets that one task sorts, at least.
const WORDS_PER_TASK: usize = 1 << 14;

/// Words of a sub-bucket up to which shifting each to its place is the fastest.
const FEW: u32 = 12;

/// A float's bits, mapped so that unsigned comparison orders them as the floats.
///
/// Negative numbers come before positive ones; -0 just before +0. NaN is not expected (it sorts outside infinity).
#[inline]
pub fn sortable_bits(value: f32) -> u32 {
    let bits = value.to_bits();
    // A set sign bit flips all bits, a clear one only itself.
    bits ^ (((bits as i32) >> 31) as u32 | 0x8000_0000)
}

/// Sorts by the key, lowest first; equal keys keep their order. The result does not depend on the number of threads.
///
/// Linear where keys are spread over their range, and never worse than a sort by comparison.
pub fn sort_by_key(items: &mut Vec<(u32, CellId)>) {
    let keys = || items.par_iter().map(|&(key, _)| key);
    let (Some(low), Some(high)) = (keys().min(), keys().max()) else { return };
    let place_bits = bits_for(items.len() as u64);
    let dealt = Dealt::new(items.len(), bits_for(u64::from(high - low)) + place_bits, |places, words| {
        words.extend(places.map(|place| u64::from(items[place].0 - low) << place_bits | place as u64));
    });
    let (sorted, _) = dealt.sort((0, CellId(0)), |_, words, sorted| {
        for (item, word) in sorted.iter_mut().zip(words) {
            *item = items[(word & ones(place_bits)) as usize];
        }
    });
    *items = sorted;
}

/// Bits that hold a number.
pub(crate) fn bits_for(number: u64) -> u32 {
    u64::BITS - number.leading_zeros()
}

/// The lowest bits set, up to 63 of them.
#[inline]
pub(crate) fn ones(bits: u32) -> u64 {
    (1 << bits) - 1
}

/// Words, dealt by their highest bits: of every chunk of them first those of the first bucket, and so on.
///
/// Dealing a chunk stays in the cache, and so does sorting a bucket: of memory there is one pass that writes words and one that reads
/// them.
pub(crate) struct Dealt {
    chunks: Vec<Chunk>,
    buckets: usize,
    /// Bits of a word below those that tell its bucket.
    low_bits: u32,
}

struct Chunk {
    words: Vec<u64>,
    /// Where every bucket's words begin, and the end.
    starts: Vec<u32>,
}

/// What sorting one bucket takes, kept for the next.
#[derive(Default)]
struct Scratch {
    gathered: Vec<u64>,
    sorted: Vec<u64>,
    ends: Vec<u32>,
}

impl Dealt {
    /// Deals words.
    ///
    /// - `bits`: words are below 2 to the power of it; at most 63
    /// - `fill`: appends the words of these places
    pub(crate) fn new(count: usize, bits: u32, fill: impl Fn(Range<usize>, &mut Vec<u64>) + Sync) -> Self {
        let bucket_bits = bits_for((count / WORDS_PER_BUCKET) as u64).min(MOST_BUCKET_BITS).min(bits);
        let (buckets, low_bits) = (1 << bucket_bits, bits - bucket_bits);
        let chunks = (0..count.div_ceil(WORDS_PER_CHUNK))
            .into_par_iter()
            .map_init(Vec::new, |words, chunk| {
                let places = chunk * WORDS_PER_CHUNK..((chunk + 1) * WORDS_PER_CHUNK).min(count);
                words.clear();
                fill(places, words);
                Chunk::new(words, buckets, low_bits)
            })
            .collect();
        Self { chunks, buckets, low_bits }
    }

    /// Sorts, the lowest first; gives what `read` made of every word, and what it returned for each bucket, both in order.
    ///
    /// - `empty`: stands where nothing is written yet
    /// - `read`: gets the place of a bucket's first word, its words in order, and where to write what it makes of them
    pub(crate) fn sort<T, R>(self, empty: T, read: impl Fn(usize, &[u64], &mut [T]) -> R + Sync) -> (Vec<T>, Vec<R>)
    where
        T: Copy + Send + Sync,
        R: Send,
    {
        let mut sizes = vec![0_usize; self.buckets];
        for chunk in &self.chunks {
            for (size, ends) in sizes.iter_mut().zip(chunk.starts.windows(2)) {
                *size += (ends[1] - ends[0]) as usize;
            }
        }
        // By all threads: pages are cleared at the first write.
        let mut all: Vec<T> =
            (0..sizes.iter().sum()).into_par_iter().with_min_len(WORDS_PER_TASK).map(|_| empty).collect();
        let mut tasks: Vec<(usize, Range<usize>, &mut [T])> = Vec::new();
        let (mut rest, mut first_place, mut first_bucket, mut len) = (all.as_mut_slice(), 0, 0, 0);
        for (bucket, size) in sizes.iter().enumerate() {
            len += size;
            if len >= WORDS_PER_TASK || bucket + 1 == self.buckets {
                let (part, tail) = rest.split_at_mut(len);
                tasks.push((first_place, first_bucket..bucket + 1, part));
                (rest, first_place, first_bucket, len) = (tail, first_place + len, bucket + 1, 0);
            }
        }
        let found: Vec<Vec<R>> = tasks
            .into_par_iter()
            .map_init(Scratch::default, |scratch, (mut place, buckets, mut part)| {
                buckets
                    .map(|bucket| {
                        let (of_bucket, tail) = std::mem::take(&mut part).split_at_mut(sizes[bucket]);
                        let found = read(place, self.sort_bucket(bucket, sizes[bucket], scratch), of_bucket);
                        (place, part) = (place + sizes[bucket], tail);
                        found
                    })
                    .collect()
            })
            .collect();
        (all, found.into_iter().flatten().collect())
    }

    /// The words of a bucket in order: dealt again by the bits that follow, about one to a sub-bucket.
    fn sort_bucket<'a>(&self, bucket: usize, size: usize, scratch: &'a mut Scratch) -> &'a [u64] {
        let Scratch { gathered, sorted, ends } = scratch;
        let digit_bits = bits_for(size as u64).min(MOST_SUB_BUCKET_BITS).min(self.low_bits);
        let (shift, mask) = (self.low_bits - digit_bits, ones(digit_bits));
        let digit = |word: u64| (word >> shift & mask) as usize;
        gathered.clear();
        ends.clear();
        ends.resize(1 << digit_bits, 0);
        for chunk in &self.chunks {
            let words = &chunk.words[chunk.starts[bucket] as usize..chunk.starts[bucket + 1] as usize];
            words.iter().for_each(|&word| ends[digit(word)] += 1);
            gathered.extend_from_slice(words);
        }
        let (mut place, mut most) = (0, 0);
        for end in ends.iter_mut() {
            most = most.max(*end);
            place += std::mem::replace(end, place);
        }
        sorted.resize(size, 0);
        for &word in gathered.iter() {
            let place = &mut ends[digit(word)];
            sorted[*place as usize] = word;
            *place += 1;
        }
        if most <= FEW {
            shift_to_places(sorted);
        } else {
            let mut start = 0;
            for &end in ends.iter() {
                sorted[start..end as usize].sort_unstable();
                start = end as usize;
            }
        }
        sorted
    }
}

impl Chunk {
    fn new(words: &[u64], buckets: usize, low_bits: u32) -> Self {
        let mut starts = vec![0_u32; buckets + 1];
        for word in words {
            starts[(word >> low_bits) as usize + 1] += 1;
        }
        for bucket in 0..buckets {
            starts[bucket + 1] += starts[bucket];
        }
        let mut next = starts.clone();
        let mut dealt = vec![0; words.len()];
        for &word in words {
            let place = &mut next[(word >> low_bits) as usize];
            dealt[*place as usize] = word;
            *place += 1;
        }
        Self { words: dealt, starts }
    }
}

/// Sorts words that are nearly in order.
fn shift_to_places(words: &mut [u64]) {
    for end in 1..words.len() {
        let word = words[end];
        let mut place = end;
        while place > 0 && words[place - 1] > word {
            words[place] = words[place - 1];
            place -= 1;
        }
        words[place] = word;
    }
}
