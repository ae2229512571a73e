//! A stable radix sort of cells by 32-bit keys.

use rayon::prelude::*;
use tetrascope_mesh::CellId;

/// Three passes of 11 bits: a counter table of 8 KiB stays in the first-level cache.
const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;

/// Below this many cells threads cost more than they save.
const PARALLEL_FROM: usize = 1 << 14;

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
/// Linear: three counting passes over chunks, one a thread. Each chunk counts its digits, a prefix sum over (digit, chunk)
/// gives every chunk its place for every digit, and the chunks scatter independently.
pub fn sort_by_key(items: &mut Vec<(u32, CellId)>) {
    if items.len() < PARALLEL_FROM {
        items.sort_by_key(|&(key, _)| key);
        return;
    }
    let chunk_len = items.len().div_ceil(rayon::current_num_threads()).max(1);
    let mut from = std::mem::take(items);
    let mut to = vec![(0, CellId(0)); from.len()];
    for pass in 0..32_u32.div_ceil(DIGIT_BITS) {
        let shift = pass * DIGIT_BITS;
        let digit = |key: u32| (key >> shift) as usize & (DIGITS - 1);
        let counts: Vec<Vec<u32>> = from
            .par_chunks(chunk_len)
            .map(|chunk| {
                let mut counts = vec![0_u32; DIGITS];
                for &(key, _) in chunk {
                    counts[digit(key)] += 1;
                }
                counts
            })
            .collect();
        // All items share this digit: the pass would move nothing.
        if counts.iter().map(|chunk| chunk[digit(from[0].0)] as usize).sum::<usize>() == from.len() {
            continue;
        }
        scatter(&from, &mut to, &counts, chunk_len, digit);
        std::mem::swap(&mut from, &mut to);
    }
    *items = from;
}

/// Moves every item to its place for one digit.
///
/// The destination is cut into one slice for each (digit, chunk), which the borrow checker can hand to threads safely.
fn scatter(
    from: &[(u32, CellId)],
    to: &mut [(u32, CellId)],
    counts: &[Vec<u32>],
    chunk_len: usize,
    digit: impl Fn(u32) -> usize + Sync,
) {
    let mut slices: Vec<Vec<&mut [(u32, CellId)]>> = counts.iter().map(|_| Vec::with_capacity(DIGITS)).collect();
    let mut rest = to;
    for value in 0..DIGITS {
        for (chunk, counts) in counts.iter().enumerate() {
            let (slice, tail) = rest.split_at_mut(counts[value] as usize);
            slices[chunk].push(slice);
            rest = tail;
        }
    }
    from.par_chunks(chunk_len).zip(slices.par_iter_mut()).for_each(|(chunk, slices)| {
        let mut filled = vec![0_u32; DIGITS];
        for &item in chunk {
            let value = digit(item.0);
            slices[value][filled[value] as usize] = item;
            filled[value] += 1;
        }
    });
}
