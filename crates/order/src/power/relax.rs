//! Relaxation: heights moved until every face's inequality holds.

use rayon::prelude::*;

use super::lifted::LiftedFace;

/// How one relaxation goes about it. All in units in which every face's weights have length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    /// What every face's convexity shall reach, at first and at last; in between geometrically.
    pub(super) margins: [f64; 2],
    /// The step, as a multiple of the projection onto the violated inequality, below 2.
    pub(super) over: f64,
    /// Looks at faces at most; the margin goes from first to last as they are spent.
    pub(super) visits: u64,
}

/// Sweeps over the faces that were violated in the last sweep over all, before the next.
///
/// They are a few percent, so that these cost less than the sweep over all; more of them no longer save any.
const INNER_SWEEPS: u32 = 15;

/// Projects `heights` onto every inequality that lacks its margin, face after face, until none is violated or the schedule's
/// looks are spent. Gives how many were.
///
/// Source: [Agmon 1954], [Motzkin 1954]; the margin that shrinks is ours. A margin that stays large asks for more than thin
/// cells can give while wide ones are satisfied; one that is small from the beginning moves bends over many cells too slowly.
/// One thread: a face sees what the faces before it did, and the result is always the same.
pub(super) fn relax(faces: &[LiftedFace], heights: &mut [f64], schedule: Schedule) -> u64 {
    let Schedule { margins: [first, last], over, visits } = schedule;
    let mut spent = 0;
    let mut active: Vec<u32> = Vec::new();
    while spent + faces.len() as u64 <= visits {
        let margin = first * (last / first).powf(spent as f64 / visits as f64);
        spent += faces.len() as u64;
        active.clear();
        let mut all_hold = true;
        for (index, face) in faces.iter().enumerate() {
            let convexity = project(face, heights, margin, over);
            all_hold &= convexity > 0.0;
            if convexity < margin {
                active.push(index as u32);
            }
        }
        // Later steps of the same sweep may have undone what held.
        if all_hold && (active.is_empty() || count_violated(faces, heights) == 0) {
            break;
        }
        for _ in 0..INNER_SWEEPS {
            spent += active.len() as u64;
            for &index in &active {
                project(&faces[index as usize], heights, margin, over);
            }
        }
    }
    spent
}

/// Steps towards the margin where a face lacks it, and gives the convexity before.
#[inline]
fn project(face: &LiftedFace, heights: &mut [f64], margin: f64, over: f64) -> f64 {
    let convexity = face.convexity(heights);
    if convexity < margin {
        let step = over * (margin - convexity);
        for (point, weight) in face.points.iter().zip(face.weights) {
            heights[*point as usize] += step * weight;
        }
    }
    convexity
}

/// Faces across which the lift is not convex, in f64.
pub(super) fn count_violated(faces: &[LiftedFace], heights: &[f64]) -> usize {
    let holding = faces.par_iter().filter(|face| face.convexity(heights) > 0.0).count();
    // NaN does not hold.
    faces.len() - holding
}
