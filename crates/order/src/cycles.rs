//! Cells that hide one another in a ring: strongly connected components of the visibility relation.

use tetrascope_mesh::{CellId, FaceAdjacency};

use crate::gaps::Gaps;

/// What lies in front of what.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrows<'a> {
    /// For every cell the corners whose opposite neighbor lies in front, as bits.
    pub nearer: &'a [u8],
    /// For every cell its neighbors, see [`FaceAdjacency::table`].
    pub table: &'a [[u32; 4]],
    /// For every cell those that lie in front across gaps.
    pub gaps: &'a Gaps,
}

/// A cell whose search is not at its end: the bits and the part of the list that are still to be followed.
struct Open<'a> {
    cell: u32,
    in_front: u8,
    across: &'a [CellId],
}

/// Gives all cells that the roots lead to in groups, from front to back: a ring's cells together, every other cell alone.
///
/// What is in front of a group was given before it, or is of `placed`. Rings that share a cell are one.
///
/// Linear in the number of cells; no recursion. Source: [Tarjan 1972], whose components come out in this order.
pub(crate) fn groups(
    arrows: Arrows<'_>,
    placed: &[CellId],
    roots: impl IntoIterator<Item = CellId>,
    mut sink: impl FnMut(&[u32]),
) {
    const UNSEEN: u32 = u32::MAX;
    let Arrows { nearer, table, gaps } = arrows;
    let mut number = vec![UNSEEN; nearer.len()];
    let mut low = vec![0_u32; nearer.len()];
    let mut is_waiting = vec![false; nearer.len()];
    for cell in placed {
        number[cell.index()] = 0;
    }
    let start = |cell: u32| Open { cell, in_front: nearer[cell as usize], across: gaps.list(CellId(cell)) };
    let (mut waiting, mut open): (Vec<u32>, Vec<Open<'_>>) = (Vec::new(), Vec::new());
    let mut next = 1;
    for root in roots {
        if number[root.index()] != UNSEEN {
            continue;
        }
        open.push(start(root.0));
        while let Some(Open { cell, in_front, across }) = open.last_mut() {
            let id = *cell;
            let cell = id as usize;
            if number[cell] == UNSEEN {
                number[cell] = next;
                low[cell] = next;
                next += 1;
                waiting.push(id);
                is_waiting[cell] = true;
            }
            let other = if *in_front != 0 {
                let corner = in_front.trailing_zeros() as usize;
                *in_front &= *in_front - 1;
                debug_assert_ne!(table[cell][corner], FaceAdjacency::NONE, "an arrow leads to a neighbor");
                Some(table[cell][corner])
            } else if let [first, rest @ ..] = *across {
                *across = rest;
                Some(first.0)
            } else {
                None
            };
            if let Some(other) = other {
                if number[other as usize] == UNSEEN {
                    open.push(start(other));
                } else if is_waiting[other as usize] {
                    low[cell] = low[cell].min(number[other as usize]);
                }
                continue;
            }
            open.pop();
            if let Some(before) = open.last() {
                low[before.cell as usize] = low[before.cell as usize].min(low[cell]);
            }
            if low[cell] == number[cell] {
                let first = waiting.iter().rposition(|&c| c == id).unwrap_or(0);
                for &member in &waiting[first..] {
                    is_waiting[member as usize] = false;
                }
                sink(&waiting[first..]);
                waiting.truncate(first);
            }
        }
    }
}
