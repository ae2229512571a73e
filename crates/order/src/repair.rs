//! The last order, repaired for a view that differs a little.

use tetrascope_mesh::{CellId, FaceAdjacency};

/// An order of all cells, and what it was made for. Memory: 9 bytes a cell.
#[derive(Debug, Default)]
pub(crate) struct Kept {
    /// For every cell a byte; its low half has the corners whose neighbor lies behind.
    bytes: Vec<u8>,
    placed: Vec<CellId>,
    /// For every cell its place; empty until it is asked for.
    ranks: Vec<u32>,
}

/// Cells that may be looked at for one cell of the mesh before a new order is the cheaper one: it costs about 10 ns a cell, and a cell
/// that is looked at here some 100.
const MOVES_PER_CELL: f64 = 0.05;

/// Cells looked at for one face that is put right, about, if the step is small.
const MOVES_PER_FACE: f64 = 5.0;

/// One cell and a neighbor that lies behind it since its face turned.
struct Wrong {
    front: u32,
    behind: u32,
}

/// What one repair works with.
struct Repair<'a> {
    bytes: &'a [u8],
    table: &'a [[u32; 4]],
    placed: &'a mut [CellId],
    ranks: &'a mut [u32],
    is_met: Vec<u64>,
    moves_left: usize,
}

impl Kept {
    /// Keeps an order of all cells, and the bytes that it was made for.
    pub(crate) fn keep(&mut self, bytes: &[u8], placed: &[CellId]) {
        self.bytes.clear();
        self.bytes.extend_from_slice(bytes);
        self.placed.clear();
        self.placed.extend_from_slice(placed);
        self.ranks.clear();
    }

    /// The order; empty if none is known.
    pub(crate) fn placed(&self) -> &[CellId] {
        &self.placed
    }

    /// Bytes that it keeps.
    pub(crate) fn bytes(&self) -> usize {
        self.bytes.len() + size_of_val(self.placed.as_slice()) + size_of_val(self.ranks.as_slice())
    }

    /// Forgets the order.
    pub(crate) fn forget(&mut self) {
        self.placed.clear();
    }

    /// Makes the order right for other bytes, if they differ in little. If not, or if cells hide one another in a ring, nothing is known
    /// of the order any more, and it gives `false`.
    ///
    /// Only faces whose arrow turned can be wrong. They are put right one after the other: what lies behind the one cell, and comes
    /// before the other, changes places with what lies in front of the other and comes after the one; whatever was right stays so.
    /// Source: [Pearce 2007].
    pub(crate) fn repair(&mut self, bytes: &[u8], table: &[[u32; 4]]) -> bool {
        let count = table.len();
        if self.placed.len() != count || self.bytes.len() != bytes.len() {
            return false;
        }
        let most = count as f64 * MOVES_PER_CELL;
        let turned = |old: &u8, new: &u8| (new & !old & 0x0f).count_ones();
        let turns: u32 = self.bytes.iter().zip(bytes).map(|(old, new)| turned(old, new)).sum();
        if f64::from(turns) * MOVES_PER_FACE > most {
            return false;
        }
        if self.ranks.is_empty() {
            self.ranks.resize(count, 0);
            for (rank, cell) in (0..).zip(&self.placed) {
                self.ranks[cell.index()] = rank;
            }
        }
        let mut wrong = Vec::new();
        for (block, (old, new)) in self.bytes[..count].chunks(64).zip(bytes[..count].chunks(64)).enumerate() {
            if old == new {
                continue;
            }
            for (lane, (&old, &new)) in old.iter().zip(new).enumerate() {
                let cell = 64 * block + lane;
                for corner in (0..4).filter(|corner| new & !old & 1 << corner != 0) {
                    wrong.push(Wrong { front: cell as u32, behind: table[cell][corner] });
                }
            }
        }
        let mut repair = Repair {
            bytes,
            table,
            placed: &mut self.placed,
            ranks: &mut self.ranks,
            is_met: vec![0; count.div_ceil(64)],
            moves_left: most as usize,
        };
        if !wrong.iter().all(|wrong| repair.put_right(wrong)) {
            return false;
        }
        self.bytes.copy_from_slice(bytes);
        true
    }
}

impl Repair<'_> {
    /// Gives `false` if there is a ring, or if too much would have to move.
    fn put_right(&mut self, wrong: &Wrong) -> bool {
        let (low, high) = (self.ranks[wrong.behind as usize], self.ranks[wrong.front as usize]);
        if high < low {
            // Seen edge-on before, or set right along with another.
            return true;
        }
        // An arrow between the wrong ranks is still to be put right and is not followed.
        let Some(after) = self.reached(wrong.behind, |from, to| from < to && to <= high, true) else { return false };
        if after.contains(&wrong.front) {
            return false;
        }
        let Some(before) = self.reached(wrong.front, |from, to| low <= to && to < from, false) else { return false };
        let mut moved: Vec<u32> = Vec::with_capacity(before.len() + after.len());
        for mut part in [before, after] {
            part.sort_unstable_by_key(|&cell| self.ranks[cell as usize]);
            moved.extend(part);
        }
        let mut places: Vec<u32> = moved.iter().map(|&cell| self.ranks[cell as usize]).collect();
        places.sort_unstable();
        for (cell, place) in moved.into_iter().zip(places) {
            self.ranks[cell as usize] = place;
            self.placed[place as usize] = CellId(cell);
        }
        true
    }

    /// The cells that arrows lead to, backward or forward, over ranks that are asked for; `None` if they are too many.
    fn reached(&mut self, first: u32, follows: impl Fn(u32, u32) -> bool, is_forward: bool) -> Option<Vec<u32>> {
        let mut reached = vec![first];
        self.is_met[first as usize / 64] |= 1 << (first % 64);
        let mut next = 0;
        while next < reached.len() && reached.len() <= self.moves_left {
            let cell = reached[next];
            next += 1;
            for (corner, &other) in self.table[cell as usize].iter().enumerate() {
                if other == FaceAdjacency::NONE || !follows(self.ranks[cell as usize], self.ranks[other as usize]) {
                    continue;
                }
                let is_arrow = if is_forward {
                    self.bytes[cell as usize] >> corner & 1 == 1
                } else {
                    // Of the neighbor's corners those whose neighbor this cell is.
                    let towards = self.table[other as usize].iter().enumerate().filter(|(_, back)| **back == cell);
                    towards.into_iter().any(|(corner, _)| self.bytes[other as usize] >> corner & 1 == 1)
                };
                let met = &mut self.is_met[other as usize / 64];
                if is_arrow && *met >> (other % 64) & 1 == 0 {
                    *met |= 1 << (other % 64);
                    reached.push(other);
                }
            }
        }
        for &cell in &reached {
            self.is_met[cell as usize / 64] &= !(1 << (cell % 64));
        }
        self.moves_left = self.moves_left.checked_sub(reached.len())?;
        Some(reached)
    }
}
