//! Keys of cells as whole numbers, and cells sorted by these.

use std::ops::Range;

use rayon::prelude::*;
use tetrascope_mesh::CellId;

use crate::radix::{Dealt, bits_for, ones};

/// Bits of a step: two of a million keys are hardly ever as near as that, and f64 still tells neighboring steps apart where terms of keys cancel.
const STEP_BITS: u32 = 36;

/// Keys that the steps are spread by.
const SAMPLES: usize = 1024;

/// Keys of the sample beyond either end of the even steps.
const BEYOND: usize = SAMPLES / 64;

/// Steps over the keys' range: equal ones over the middle, where nearly all keys lie, and beyond ever wider ones.
///
/// Equal steps rather than the bits of a float: keys are spread over their range, and near zero they need not be finer. Wider ones
/// at the ends: few thin cells have keys far away from all others. A larger key never has the lower step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps {
    low: f64,
    high: f64,
    per_key: f64,
    /// Steps on either side of the equal ones.
    tail: f64,
    /// One over how far beyond them half of the others are spent.
    tail_per_key: f64,
    /// Bits below those of the step.
    cell_bits: u32,
}

impl Steps {
    /// Steps for these cells' keys, by a sample of them.
    pub(crate) fn new(drawn: &Drawn<'_>, key: impl Fn(CellId) -> f64) -> Self {
        let count = drawn.cells.len();
        // Multiples of the golden ratio: steps of one length would meet the rows of a grid.
        let place = |sample: usize| {
            let fraction = (sample as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
            ((fraction * count as u64) >> 32) as usize
        };
        let mut sample: Vec<f64> = (0..SAMPLES.min(count))
            .map(|sample| key(drawn.cells[place(sample)]))
            .filter(|key| key.is_finite())
            .collect();
        sample.sort_unstable_by(f64::total_cmp);
        let beyond = BEYOND * sample.len() / SAMPLES;
        let of = |place: usize| sample.get(place).copied().unwrap_or(0.0);
        let (low, high) = (of(beyond), of((sample.len().max(1) - 1) - beyond));
        let bits = STEP_BITS.min(63 - drawn.bits);
        let all = (1_u64 << bits) as f64;
        let tail = all / 16.0;
        // Two steps less, for rounding.
        let per_key = (all - 2.0 * tail - 2.0) / (high - low);
        let widths = [(high - low) / 8.0, of(sample.len().max(1) - 1) - of(0)];
        let tail_per_key =
            widths.iter().map(|width| 1.0 / width).find(|&per_key| per_key > 0.0 && per_key.is_finite()).unwrap_or(1.0);
        // One key alone: no steps between.
        Self {
            low,
            high,
            per_key: if per_key.is_finite() { per_key } else { 0.0 },
            tail,
            tail_per_key,
            cell_bits: drawn.bits,
        }
    }

    /// What is not a number has the step of the lowest of the equal ones.
    #[inline]
    pub(crate) fn step(&self, key: f64) -> u64 {
        // Comparisons rather than `max` and `min`, which look for NaN.
        let above = if key > self.low { key } else { self.low };
        let inside = if above < self.high { above } else { self.high };
        let mut step = (inside - self.low) * self.per_key + self.tail;
        if key > self.high || key < self.low {
            let beyond = key - inside;
            let share = 1.0 - 1.0 / (1.0 + beyond.abs() * self.tail_per_key);
            step += self.tail * share.copysign(beyond);
        }
        // From 2⁵² on, floats are whole numbers one apart: rounds, in less than a checked conversion.
        const WHOLE: f64 = (1_u64 << 52) as f64;
        (step + WHOLE).to_bits() - WHOLE.to_bits()
    }

    /// Whether an error stays below half a step.
    #[inline]
    pub(crate) fn is_sure(&self, error: f64) -> bool {
        const SURE: f64 = 0.49;
        error.is_finite() && error * self.per_key.max(self.tail * self.tail_per_key) <= SURE
    }

    /// The word that sorts a cell.
    #[inline]
    pub(crate) fn word(&self, key: f64, payload: u64) -> u64 {
        self.step(key) << self.cell_bits | payload
    }

    /// The step of a word.
    #[inline]
    pub(crate) fn of_word(&self, word: u64) -> u64 {
        word >> self.cell_bits
    }

    /// Bits of a word.
    pub(crate) fn word_bits(&self) -> u32 {
        STEP_BITS.min(63 - self.cell_bits) + self.cell_bits
    }
}

/// Drawn cells as the lower bits of words, which ascend as the cells come.
pub(crate) struct Drawn<'a> {
    cells: &'a [CellId],
    /// Words then hold the cell itself, and else its place in the list.
    is_ascending: bool,
    bits: u32,
}

impl<'a> Drawn<'a> {
    pub(crate) fn new(cells: &'a [CellId]) -> Self {
        const CELLS_PER_TASK: usize = 1 << 16;
        let is_ascending = cells
            .par_chunks(CELLS_PER_TASK)
            .enumerate()
            .all(|(task, part)| part.is_sorted() && (task == 0 || cells[task * CELLS_PER_TASK - 1] <= part[0]));
        let highest = if is_ascending { cells.last().map_or(0, |cell| u64::from(cell.0)) } else { cells.len() as u64 };
        Self { cells, is_ascending, bits: bits_for(highest) }
    }

    /// The drawn cells at these places, each with the lower bits of its word.
    #[inline]
    pub(crate) fn at(&self, places: Range<usize>) -> impl Iterator<Item = (CellId, u64)> {
        let first = places.start as u64;
        let is_ascending = self.is_ascending;
        (first..)
            .zip(&self.cells[places])
            .map(move |(place, &cell)| (cell, if is_ascending { u64::from(cell.0) } else { place }))
    }

    /// Writes the cells of words.
    #[inline]
    pub(crate) fn read(&self, words: &[u64], cells: &mut [CellId]) {
        let mask = ones(self.bits);
        if self.is_ascending {
            cells.iter_mut().zip(words).for_each(|(cell, word)| *cell = CellId((word & mask) as u32));
        } else {
            cells.iter_mut().zip(words).for_each(|(cell, word)| *cell = self.cells[(word & mask) as usize]);
        }
    }
}

/// Sorts cells by their keys, lowest first, to 36 bits of the keys' range; those with equal ones stay as they come.
///
/// The result does not depend on the number of threads.
pub(crate) fn sort_cells(drawn: &[CellId], key: impl Fn(CellId) -> f64 + Sync) -> Vec<CellId> {
    let drawn = Drawn::new(drawn);
    let steps = Steps::new(&drawn, &key);
    let dealt = Dealt::new(drawn.cells.len(), steps.word_bits(), |places, words| {
        words.extend(drawn.at(places).map(|(cell, payload)| steps.word(key(cell), payload)));
    });
    dealt.sort(CellId(0), |_, words, cells| drawn.read(words, cells)).0
}
