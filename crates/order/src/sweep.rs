//! A topological order of all cells, from the front.

use tetrascope_mesh::CellId;

use crate::gaps::Gaps;
use crate::sides::Relation;

/// A cell's byte: the corners whose neighbor lies behind it; how much it waits for, in the bits of [`WAITS`]; and [`HAS_GAPS`].
const BEHIND: u8 = 0x0f;
const WAITS_ONE: u8 = 0x10;
/// Up to four neighbors in front, and one more for all that is in front across gaps.
const WAITS: u8 = 0x70;
const HAS_GAPS: u8 = 0x80;

/// Cells that are read at once: as many loads as a processor keeps under way, and their rows stay in the first-level cache.
const BATCH: usize = 32;

/// A cell's byte before anything is placed.
#[inline]
pub(crate) fn waiting(relation: Relation) -> u8 {
    relation.behind & BEHIND | (relation.front.count_ones() as u8) << 4
}

/// Whether a cell was left over.
#[inline]
pub(crate) fn is_left(byte: u8) -> bool {
    byte & WAITS != 0
}

/// Places every cell after all that lie in front of it; what is in a ring, or behind one, is left over.
///
/// Cells come in the order in which they become free, so that all that is read next is known long before: memory is waited for
/// many cells at a time. There is no branch that depends on the view.
///
/// - `bytes`: of all cells as [`waiting`] gives them, and one more of any value
/// - `table`: for every cell its neighbors
///
/// Source: [Kahn 1962].
pub(crate) fn sweep(bytes: &mut [u8], table: &[[u32; 4]], gaps: &Gaps) -> Vec<CellId> {
    let count = table.len();
    let mut named = gaps.named().to_vec();
    for (cell, &named) in gaps.members().zip(&named) {
        let byte = &mut bytes[cell.index()];
        *byte |= HAS_GAPS;
        *byte += if named > 0 { WAITS_ONE } else { 0 };
    }
    // One more than there are cells: the place after the last is written and never kept.
    let mut placed = vec![CellId(0); count + 1];
    let mut free = 0;
    for (cell, &byte) in (0..).zip(&bytes[..count]) {
        placed[free] = CellId(cell);
        free += usize::from(byte & WAITS == 0);
    }
    let mut next = 0;
    let mut batch = [(0_u8, [0_u32; 4]); BATCH];
    while next < free {
        // All of the batch is free, so nothing of it changes any more: it is read at once.
        let cells = next..free.min(next + BATCH);
        let batch = &mut batch[..cells.len()];
        for (entry, cell) in batch.iter_mut().zip(&placed[cells.clone()]) {
            *entry = (bytes[cell.index()], table[cell.index()]);
        }
        for &mut (byte, neighbors) in batch {
            let cell = placed[next];
            next += 1;
            for (corner, neighbor) in neighbors.into_iter().enumerate() {
                // Where there is no neighbor the byte after the last cell stands for it.
                let neighbor = neighbor.min(count as u32);
                let is_behind = byte >> corner & 1;
                let other = &mut bytes[neighbor as usize];
                *other = other.wrapping_sub(is_behind * WAITS_ONE);
                placed[free] = CellId(neighbor);
                free += usize::from(is_behind & u8::from(*other & WAITS == 0));
            }
            if byte & HAS_GAPS != 0 {
                for &behind in gaps.list(cell) {
                    let in_front = &mut named[gaps.member(behind)];
                    *in_front -= 1;
                    if *in_front == 0 {
                        let other = &mut bytes[behind.index()];
                        *other = other.wrapping_sub(WAITS_ONE);
                        placed[free] = behind;
                        free += usize::from(*other & WAITS == 0);
                    }
                }
            }
        }
    }
    placed.truncate(free);
    placed
}
