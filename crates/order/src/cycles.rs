//! Cells that hide one another in a ring: strongly connected components of the visibility relation.

use tetrascope_mesh::{CellId, FaceAdjacency};

/// The rings among cells, each as its cells, ascending; rings that share a cell are one. By ascending first cell.
///
/// - `nearer`: for every cell the corners whose opposite neighbor lies in front, as bits
/// - `table`: for every cell its neighbors, see [`FaceAdjacency::table`]
///
/// Linear in the number of cells; no recursion. Source: [Tarjan 1972].
pub(crate) fn cycles(nearer: &[u8], table: &[[u32; 4]]) -> Vec<Vec<CellId>> {
    const UNSEEN: u32 = u32::MAX;
    let mut number = vec![UNSEEN; nearer.len()];
    let mut low = vec![0_u32; nearer.len()];
    let mut is_waiting = vec![false; nearer.len()];
    let (mut waiting, mut open) = (Vec::new(), Vec::new());
    let (mut next, mut found) = (0, Vec::new());
    for root in 0..nearer.len() {
        if number[root] != UNSEEN {
            continue;
        }
        open.push((root, nearer[root]));
        while let Some((cell, in_front)) = open.last_mut() {
            let cell = *cell;
            if number[cell] == UNSEEN {
                number[cell] = next;
                low[cell] = next;
                next += 1;
                waiting.push(cell);
                is_waiting[cell] = true;
            }
            if *in_front != 0 {
                let corner = in_front.trailing_zeros() as usize;
                *in_front &= *in_front - 1;
                debug_assert_ne!(table[cell][corner], FaceAdjacency::NONE, "an arrow leads to a neighbor");
                let other = table[cell][corner] as usize;
                if number[other] == UNSEEN {
                    open.push((other, nearer[other]));
                } else if is_waiting[other] {
                    low[cell] = low[cell].min(number[other]);
                }
                continue;
            }
            open.pop();
            if let Some(&(before, _)) = open.last() {
                low[before] = low[before].min(low[cell]);
            }
            if low[cell] == number[cell] {
                let first = waiting.iter().rposition(|&c| c == cell).unwrap_or(0);
                let mut ring: Vec<CellId> = waiting.drain(first..).map(|c| CellId(c as u32)).collect();
                for member in &ring {
                    is_waiting[member.index()] = false;
                }
                if ring.len() > 1 {
                    ring.sort_unstable();
                    found.push(ring);
                }
            }
        }
    }
    found.sort_unstable();
    found
}
