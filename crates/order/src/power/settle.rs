//! Cells whose keys are too near each other to be told apart by them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rayon::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};
use tetrascope_view::Viewpoint;

use super::double::Double;
use super::frame::Frame;
use super::keys::Key;
use crate::Cells;
use crate::signs::{eye_side, side_of};

/// Up to this many cells common faces are found by comparing all pairs; beyond, through an adjacency of their own.
const FEW: usize = 12;

/// Keys of twice the precision that are worth a task.
const PRECISE_PER_TASK: usize = 32;

/// Cells whose faces are worth a task.
const FACES_PER_TASK: usize = 256;

/// What telling cells apart takes.
#[derive(Clone, Copy)]
pub(super) struct Closer<'a, K, P> {
    pub(super) cells: Cells<'a>,
    pub(super) viewpoint: Viewpoint,
    /// Of the whole mesh, where that is there.
    pub(super) adjacency: Option<&'a FaceAdjacency>,
    /// A cell's key in f64.
    pub(super) key: K,
    /// The same in twice the precision, where there is one and it is wanted.
    pub(super) precise: P,
}

/// Cells from front to back, from cells sorted by their steps: puts right those whose steps do not tell.
pub(super) fn settle<K, P>(frame: Frame, closer: &Closer<'_, K, P>) -> Vec<CellId>
where
    K: Fn(CellId) -> Key + Sync,
    P: Fn(CellId) -> Option<Double> + Sync,
{
    let Frame { mut front_to_back, runs } = frame;
    let settled: Vec<Vec<CellId>> =
        runs.par_iter().map(|run| settle_run(&front_to_back[run.clone()], closer)).collect();
    for (run, members) in runs.into_iter().zip(settled) {
        front_to_back[run].copy_from_slice(&members);
    }
    front_to_back
}

/// Sorts a run by its keys in f64; where these overlap within their errors by keys of twice the precision, and by common faces.
fn settle_run<K, P>(run: &[CellId], closer: &Closer<'_, K, P>) -> Vec<CellId>
where
    K: Fn(CellId) -> Key + Sync,
    P: Fn(CellId) -> Option<Double> + Sync,
{
    let mut keyed: Vec<(Key, CellId)> = run.iter().map(|&cell| ((closer.key)(cell), cell)).collect();
    keyed.sort_by(|(a, _), (b, _)| a.value.total_cmp(&b.value));
    // The lowest that any key from here on may be.
    let mut lowest = vec![f64::INFINITY; keyed.len() + 1];
    for (place, (key, _)) in keyed.iter().enumerate().rev() {
        lowest[place] = lowest[place + 1].min(key.value - key.error);
    }
    let mut highest = f64::NEG_INFINITY;
    let mut start = 0;
    let mut members: Vec<CellId> = keyed.iter().map(|&(_, cell)| cell).collect();
    for end in 1..=keyed.len() {
        let last = &keyed[end - 1].0;
        highest = highest.max(last.value + last.error);
        if end == keyed.len() || highest < lowest[end] {
            if end - start > 1 {
                let group = &mut members[start..end];
                let values = [keyed[start].0.value, keyed[end - 1].0.value];
                let precise: Option<Vec<(Double, CellId)>> = group
                    .par_iter()
                    .with_min_len(PRECISE_PER_TASK)
                    .map(|&cell| Some(((closer.precise)(cell)?, cell)))
                    .collect();
                if let Some(mut precise) = precise {
                    precise.sort_by(|(a, _), (b, _)| a.total_cmp(b));
                    group.iter_mut().zip(precise).for_each(|(place, (_, cell))| *place = cell);
                }
                sort_by_faces(group, values, closer);
            }
            start = end;
        }
    }
    members
}

/// Sorts so that of two cells that share a face the nearer comes first, and otherwise leaves them as they are as far as it can.
///
/// - `values`: the lowest key of a member and the highest, in f64
fn sort_by_faces<K, P>(members: &mut [CellId], values: [f64; 2], closer: &Closer<'_, K, P>)
where
    K: Fn(CellId) -> Key + Sync,
{
    let arrows = arrows(members, values, closer);
    // Along the rows of a grid most faces are seen edge-on, and none is in the wrong order.
    if arrows.iter().all(|[front, back]| front < back) {
        return;
    }
    let mut behind: Vec<Vec<u32>> = vec![Vec::new(); members.len()];
    let mut in_front = vec![0_u32; members.len()];
    for [front, back] in arrows {
        behind[front as usize].push(back);
        in_front[back as usize] += 1;
    }
    let mut ready: BinaryHeap<Reverse<u32>> =
        (0..members.len() as u32).filter(|&place| in_front[place as usize] == 0).map(Reverse).collect();
    let mut order = Vec::with_capacity(members.len());
    while let Some(Reverse(place)) = ready.pop() {
        order.push(members[place as usize]);
        for &next in &behind[place as usize] {
            in_front[next as usize] -= 1;
            if in_front[next as usize] == 0 {
                ready.push(Reverse(next));
            }
        }
    }
    // Cells in a cycle stay as they were: heights that order all faces leave none.
    let stuck = (0..members.len()).filter(|&place| in_front[place] > 0).map(|place| members[place]);
    order.extend(stuck);
    members.copy_from_slice(&order);
}

/// Places of cells that share a face, the nearer first.
fn arrows<K, P>(members: &[CellId], [lowest, highest]: [f64; 2], closer: &Closer<'_, K, P>) -> Vec<[u32; 2]>
where
    K: Fn(CellId) -> Key + Sync,
{
    let &Closer { cells, viewpoint, ref key, .. } = closer;
    let corners = |cell: CellId| cells.tetrahedra[cell.index()];
    let mut arrows = Vec::new();
    let mut meet = |a: usize, b: usize| match nearer(cells, viewpoint, corners(members[a]), corners(members[b])) {
        Some(true) => arrows.push([a as u32, b as u32]),
        Some(false) => arrows.push([b as u32, a as u32]),
        None => {}
    };
    if members.len() <= FEW {
        for a in 0..members.len() {
            (a + 1..members.len()).for_each(|b| meet(a, b));
        }
        return arrows;
    }
    let Some(adjacency) = closer.adjacency else {
        let corners: Vec<[VertexId; 4]> = members.iter().map(|&cell| corners(cell)).collect();
        for (a, neighbors) in FaceAdjacency::new(&corners).table().iter().enumerate() {
            neighbors
                .iter()
                .filter(|&&b| b != FaceAdjacency::NONE && a < b as usize)
                .for_each(|&b| meet(a, b as usize));
        }
        return arrows;
    };
    // Neighbors whose keys lie among the members' and that are not seen edge-on: few. Whether they are drawn shows last.
    let of_cell = |&cell: &CellId| {
        let neighbors = adjacency.table()[cell.index()];
        neighbors.into_iter().filter(move |&other| other != FaceAdjacency::NONE && cell.0 < other).filter_map(
            move |other| {
                let other = CellId(other);
                let value = key(other).value;
                if !(lowest <= value && value <= highest) {
                    return None;
                }
                let is_first = nearer(cells, viewpoint, corners(cell), corners(other))?;
                Some(if is_first { [cell, other] } else { [other, cell] })
            },
        )
    };
    let found: Vec<[CellId; 2]> = members.par_iter().with_min_len(FACES_PER_TASK).flat_map_iter(of_cell).collect();
    if found.is_empty() {
        return arrows;
    }
    let mut places: Vec<(CellId, u32)> = members.iter().copied().zip(0..).collect();
    places.sort_unstable();
    let place = |cell: CellId| {
        let found = places.binary_search_by_key(&cell, |&(cell, _)| cell).ok()?;
        Some(places[found].1)
    };
    found.into_iter().filter_map(|[front, back]| Some([place(front)?, place(back)?])).collect()
}

/// Whether the first of two cells is the nearer; `None` if they share no face or are seen edge-on, or one has no volume.
fn nearer(cells: Cells<'_>, viewpoint: Viewpoint, first: [VertexId; 4], second: [VertexId; 4]) -> Option<bool> {
    let mut apexes = first.iter().filter(|v| !second.contains(v));
    let (&first_apex, None) = (apexes.next()?, apexes.next()) else { return None };
    let &second_apex = second.iter().find(|v| !first.contains(v))?;
    let mut face = first.iter().filter(|v| **v != first_apex).map(|v| cells.positions[v.index()]);
    let face = [face.next()?, face.next()?, face.next()?];
    let eye_side = eye_side(face, viewpoint);
    let sides = [first_apex, second_apex].map(|v| side_of(face, cells.positions[v.index()]));
    // Apart, and not seen edge-on.
    (eye_side != 0 && sides[0] * sides[1] < 0).then_some(eye_side == sides[0])
}
