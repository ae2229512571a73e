//! One frame of the power order: keys of cells, their steps, and the cells by these.

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use super::Power;
use super::keys::{Key, Steps};
use super::sort::{PARALLEL_FROM, sort_by_upper_half};

/// Cells by their steps, and where that does not tell.
pub(super) struct Frame {
    /// Step in the upper half, place in the list of drawn cells in the lower; ascending.
    pub(super) sorted: Vec<u64>,
    /// Ranges of steps, as [`Steps::unsure`] gives them.
    pub(super) unsure: Vec<[u32; 2]>,
}

/// Keys of a part of the cells.
struct Part {
    keys: Vec<f64>,
    low: f64,
    high: f64,
    error: f64,
}

impl Frame {
    pub(super) fn new(power: &Power, viewpoint: Viewpoint, drawn: &[CellId]) -> Self {
        let chunk_len = drawn.len().div_ceil(rayon::current_num_threads()).max(PARALLEL_FROM);
        let parts: Vec<Part> = drawn
            .par_chunks(chunk_len)
            .map(|drawn| match viewpoint {
                // Once for every cell's loop, so that the compiler sees which.
                Viewpoint::Eye(eye) => part(drawn, |cell| power.key(cell, Viewpoint::Eye(eye))),
                Viewpoint::Direction(along) => part(drawn, |cell| power.key(cell, Viewpoint::Direction(along))),
            })
            .collect();
        let extreme =
            |pick: fn(f64, f64) -> f64, of: fn(&Part) -> f64| parts.iter().map(of).reduce(pick).unwrap_or(0.0);
        let steps = Steps::between(extreme(f64::min, |part| part.low), extreme(f64::max, |part| part.high));
        let error = extreme(f64::max, |part| part.error);
        let chunks: Vec<Vec<u64>> = parts
            .into_par_iter()
            .enumerate()
            .map(|(number, part)| {
                let places = (number * chunk_len) as u64..;
                places.zip(part.keys).map(|(place, key)| u64::from(steps.step(key)) << 32 | place).collect()
            })
            .collect();
        // Most frames have no key that is less sure than a step.
        let unsure = if steps.is_sure(error) {
            Vec::new()
        } else {
            steps.unsure(drawn.par_iter().map(|&cell| power.key(cell, viewpoint)))
        };
        Self { sorted: sort_by_upper_half(&chunks), unsure }
    }
}

fn part(drawn: &[CellId], key: impl Fn(CellId) -> Key) -> Part {
    let mut part =
        Part { keys: Vec::with_capacity(drawn.len()), low: f64::INFINITY, high: f64::NEG_INFINITY, error: 0.0 };
    for &cell in drawn {
        let Key { value, error } = key(cell);
        part.keys.push(value);
        part.low = part.low.min(value);
        part.high = part.high.max(value);
        // What is no number is the largest error.
        part.error = if error <= part.error {
            part.error
        } else if error.is_nan() {
            f64::INFINITY
        } else {
            error
        };
    }
    part
}
