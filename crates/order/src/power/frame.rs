//! One frame of the power order: cells by the steps of their keys, and where these do not tell.

use std::ops::Range;

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use super::Power;
use super::keys::Key;
use crate::radix::Dealt;
use crate::steps::{Drawn, Steps};

/// Cells by the steps of their keys.
pub(super) struct Frame {
    pub(super) front_to_back: Vec<CellId>,
    /// Places whose cells are not told apart by steps, ascending.
    pub(super) runs: Vec<Range<usize>>,
}

/// What one bucket of the sort has.
struct Part {
    /// The first place and step, the last step, the end; `None` for an empty bucket.
    ends: Option<[(usize, u64); 2]>,
    runs: Vec<Range<usize>>,
}

impl Frame {
    pub(super) fn new(power: &Power, viewpoint: Viewpoint, drawn: &[CellId]) -> Self {
        // Once for every cell's loop, so that the compiler sees which.
        match viewpoint {
            Viewpoint::Eye(eye) => {
                let offset = eye - power.center;
                Self::by(power, viewpoint, drawn, |cell| power.keys[cell.index()].seen_from(offset))
            }
            Viewpoint::Direction(along) => {
                Self::by(power, viewpoint, drawn, |cell| power.keys[cell.index()].along(along))
            }
        }
    }

    fn by(power: &Power, viewpoint: Viewpoint, drawn: &[CellId], value: impl Fn(CellId) -> f64 + Sync) -> Self {
        let listed = Drawn::new(drawn);
        let steps = Steps::new(&listed, &value);
        let dealt = Dealt::new(drawn.len(), steps.word_bits(), |places, words| {
            words.extend(listed.at(places).map(|(cell, payload)| steps.word(value(cell), payload)));
        });
        // Most frames have no key that is less sure than a step.
        let unsure = if steps.is_sure(power.extent.error(viewpoint, power.center, power.reach)) {
            Vec::new()
        } else {
            unsure(&steps, drawn.par_iter().map(|&cell| power.key(cell, viewpoint)))
        };
        let is_joined = |before: u64, after: u64| {
            after - before < 2
                || !unsure.is_empty() && {
                    // The first range that does not end before.
                    let range = unsure.partition_point(|range| range[1] < after);
                    unsure.get(range).is_some_and(|&[first, _]| first <= before)
                }
        };
        let (front_to_back, parts) = dealt.sort(CellId(0), |first, words, cells| {
            listed.read(words, cells);
            let mut runs = Vec::new();
            let step = |place: usize| steps.of_word(words[place]);
            let mut start = 0;
            for place in 1..=words.len() {
                if place == words.len() || !is_joined(step(place - 1), step(place)) {
                    if place - start > 1 {
                        runs.push(first + start..first + place);
                    }
                    start = place;
                }
            }
            let last = words.len().checked_sub(1);
            Part { ends: last.map(|last| [(first, step(0)), (first + words.len(), step(last))]), runs }
        });
        Self { front_to_back, runs: join(parts, is_joined) }
    }
}

/// Runs of all parts, those joined that meet between two.
fn join(parts: Vec<Part>, is_joined: impl Fn(u64, u64) -> bool) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    let mut last_step = None;
    for Part { ends, runs } in parts {
        let Some([(first, step), (end, next_last)]) = ends else { continue };
        let mut runs = runs.into_iter().peekable();
        if last_step.is_some_and(|before| is_joined(before, step)) {
            let own_end = runs.next_if(|run| run.start == first).map_or(first + 1, |run| run.end);
            match all.last_mut() {
                Some(before) if before.end == first => before.end = own_end,
                _ => all.push(first - 1..own_end),
            }
        }
        all.extend(runs);
        debug_assert!(all.last().is_none_or(|run| run.end <= end));
        last_step = Some(next_last);
    }
    all
}

/// Ranges of steps, first and last, in which some key's error reaches beyond the neighboring step; disjoint, ascending.
///
/// Other keys two steps apart are in the right order: each errs by less than half a step.
fn unsure(steps: &Steps, keys: impl ParallelIterator<Item = Key>) -> Vec<[u64; 2]> {
    let mut ranges: Vec<[u64; 2]> = keys
        .filter(|key| !steps.is_sure(key.error))
        .map(|Key { value, error }| {
            // Anything may be beside what is no number.
            let [low, high] =
                if error.is_finite() { [value - error, value + error] } else { [f64::NEG_INFINITY, f64::INFINITY] };
            [steps.step(low).saturating_sub(2), steps.step(high) + 2]
        })
        .collect();
    ranges.sort_unstable();
    let mut merged: Vec<[u64; 2]> = Vec::new();
    for range in ranges {
        match merged.last_mut() {
            Some(last) if range[0] <= last[1] => last[1] = last[1].max(range[1]),
            _ => merged.push(range),
        }
    }
    merged
}
