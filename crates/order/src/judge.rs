//! The judge: how many pairs of cells an order has wrong, seen from one viewpoint.

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::overlaps::both_ways;
use crate::sides::neighbor;
use crate::{Cells, MeshVisibility};

/// What an order is worth, counted pair by pair.
///
/// A pair is two cells of which one is known to hide a part of the other. If both are in the order and in one ring, they count in
/// `in_rings` alone: no order of whole cells has all of those right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// Pairs that share a face which is not seen edge-on.
    pub pairs_of_faces: usize,
    /// Of these, pairs with the farther cell first.
    pub misordered_faces: usize,
    /// Pairs with empty space between them on some ray, whether or not other cells are on that ray too.
    pub pairs_across_gaps: usize,
    /// Of these, pairs with the farther cell first.
    pub misordered_gaps: usize,
    /// Whether all relations across gaps are known; if not, pairs are missing from the two counts.
    pub gaps_complete: bool,
    /// Pairs inside one ring, of faces and across gaps.
    pub in_rings: usize,
    /// Of these, pairs with the farther cell first.
    pub misordered_in_rings: usize,
}

impl Verdict {
    /// Pairs in the wrong order that a right order would not have.
    pub fn misordered(&self) -> usize {
        self.misordered_faces + self.misordered_gaps
    }
}

/// Which cells of a mesh come before which, seen from one viewpoint: what orders are judged by.
///
/// Faces by exact signs, gaps by the arrows of [`BspTree`](crate::BspTree). Takes part in no order: rings are found by a search of its own.
#[derive(Clone, Debug)]
pub struct Relations<'a> {
    table: &'a [[u32; 4]],
    /// For every cell the corners whose opposite neighbor lies in front, as bits.
    nearer: Vec<u8>,
    /// Pairs across gaps, the nearer cell first.
    arrows: Vec<(CellId, CellId)>,
    gaps_complete: bool,
    rings: Vec<Vec<CellId>>,
    /// For every cell which ring it is in, counted from 1, or 0.
    ring_of: Vec<u32>,
}

impl MeshVisibility {
    /// Counts the pairs that an order has wrong.
    ///
    /// - `front_to_back`: any cells of the mesh, the nearest first; only pairs of these are judged. A cell that stands there several times,
    ///   in pieces, is wrong with another one only where all its pieces are
    ///
    /// Who judges several orders from one viewpoint asks for the [`Self::relations`] once.
    pub fn judge(&self, cells: Cells<'_>, viewpoint: Viewpoint, front_to_back: &[CellId]) -> Verdict {
        self.relations(cells, viewpoint).judge(front_to_back)
    }

    /// Everything that is known of which cells come before which.
    ///
    /// Time linear in the cells and in the pairs across gaps, of which there may be many more than an order needs: where a ray has `D` gaps,
    /// `D²/2`.
    pub fn relations(&self, cells: Cells<'_>, viewpoint: Viewpoint) -> Relations<'_> {
        let nearer = self.sides(cells).nearer_neighbors(cells, viewpoint);
        let table = self.adjacency(cells).table();
        let mut arrows = Vec::new();
        // A convex mesh has no gaps.
        let gaps_complete = self.is_convex(cells)
            || self.tree(cells).arrows(viewpoint, &mut |front, back| arrows.push((front, back))).is_complete;
        // Cells that overlap at a face hide one another; those that do so by no more than rounding hide as if they only touched.
        let touching = if self.is_convex(cells) { &[][..] } else { self.touching(cells) };
        if !self.folded(cells).is_empty() || !touching.is_empty() {
            arrows.extend(both_ways(self.folded(cells)));
            arrows.extend(touching.iter().filter_map(|touch| touch.arrow(viewpoint)));
            arrows.par_sort_unstable();
            arrows.dedup();
        }
        let rings = rings(&nearer, table, &arrows);
        let mut ring_of = vec![0; nearer.len()];
        for (number, ring) in (1..).zip(&rings) {
            ring.iter().for_each(|cell| ring_of[cell.index()] = number);
        }
        Relations { table, nearer, arrows, gaps_complete, rings, ring_of }
    }
}

impl Relations<'_> {
    /// Cells of the mesh that hide one another in rings, each ring as its cells, ascending.
    pub fn rings(&self) -> &[Vec<CellId>] {
        &self.rings
    }

    /// Counts the pairs that an order has wrong, see [`MeshVisibility::judge`].
    pub fn judge(&self, front_to_back: &[CellId]) -> Verdict {
        // First and last place of every cell.
        let mut places = vec![[u32::MAX, 0]; self.nearer.len()];
        for (place, cell) in (0_u32..).zip(front_to_back) {
            let [first, last] = &mut places[cell.index()];
            (*first, *last) = (place.min(*first), place);
        }
        let is_there = |cell: CellId| places[cell.index()][0] != u32::MAX;
        let is_wrong = |front: CellId, back: CellId| places[front.index()][0] > places[back.index()][1];
        let share_ring = |front: CellId, back: CellId| {
            let ring = self.ring_of[front.index()];
            ring != 0 && ring == self.ring_of[back.index()]
        };
        let count = |front: CellId, back: CellId| -> Count {
            if !is_there(front) || !is_there(back) {
                return Count::default();
            }
            let wrong = usize::from(is_wrong(front, back));
            if share_ring(front, back) {
                Count { in_rings: 1, misordered_in_rings: wrong, ..Count::default() }
            } else {
                Count { pairs: 1, misordered: wrong, ..Count::default() }
            }
        };
        let faces = (0..self.nearer.len() as u32)
            .into_par_iter()
            .map(|cell| {
                let bits = self.nearer[cell as usize];
                (0..4)
                    .filter(|corner| bits >> corner & 1 == 1)
                    .map(|corner| count(neighbor(self.table, CellId(cell), corner), CellId(cell)))
                    .fold(Count::default(), Count::and)
            })
            .reduce(Count::default, Count::and);
        let gaps = self.arrows.par_iter().map(|&(front, back)| count(front, back)).reduce(Count::default, Count::and);
        Verdict {
            pairs_of_faces: faces.pairs,
            misordered_faces: faces.misordered,
            pairs_across_gaps: gaps.pairs,
            misordered_gaps: gaps.misordered,
            gaps_complete: self.gaps_complete,
            in_rings: faces.in_rings + gaps.in_rings,
            misordered_in_rings: faces.misordered_in_rings + gaps.misordered_in_rings,
        }
    }
}

#[derive(Clone, Copy, Default)]
struct Count {
    pairs: usize,
    misordered: usize,
    in_rings: usize,
    misordered_in_rings: usize,
}

impl Count {
    fn and(self, other: Self) -> Self {
        Self {
            pairs: self.pairs + other.pairs,
            misordered: self.misordered + other.misordered,
            in_rings: self.in_rings + other.in_rings,
            misordered_in_rings: self.misordered_in_rings + other.misordered_in_rings,
        }
    }
}

/// The strongly connected components of two or more cells, each ascending, by ascending first cell. Source: [Tarjan 1972].
///
/// - `nearer`: for every cell the corners whose opposite neighbor lies in front, as bits
/// - `table`: for every cell its neighbors
/// - `arrows`: pairs of cells besides, the nearer one first
fn rings(nearer: &[u8], table: &[[u32; 4]], arrows: &[(CellId, CellId)]) -> Vec<Vec<CellId>> {
    let in_front = InFront::new(nearer.len(), arrows);
    const UNSEEN: u32 = u32::MAX;
    /// The number of a cell whose component is known.
    const DONE: u32 = u32::MAX - 1;
    // A cell's number while it waits, and the smallest number that it is known to lead to.
    let mut number = vec![UNSEEN; nearer.len()];
    let mut low = vec![0_u32; nearer.len()];
    let (mut waiting, mut found) = (Vec::<CellId>::new(), Vec::new());
    // A cell and how many of its nearer cells were looked at.
    let mut open: Vec<(CellId, usize)> = Vec::new();
    let mut next = 0;
    for root in (0..nearer.len() as u32).map(CellId) {
        if number[root.index()] != UNSEEN {
            continue;
        }
        open.push((root, 0));
        while let Some((cell, looked_at)) = open.last_mut() {
            let cell = *cell;
            if *looked_at == 0 {
                (number[cell.index()], low[cell.index()]) = (next, next);
                next += 1;
                waiting.push(cell);
            }
            // The first four are the faces; a face without an arrow stands for nothing.
            let look = *looked_at;
            *looked_at += 1;
            let other = if look < 4 {
                (nearer[cell.index()] >> look & 1 == 1).then(|| neighbor(table, cell, look as u32))
            } else if let Some(&other) = in_front.of(cell).get(look - 4) {
                Some(other)
            } else {
                open.pop();
                if let Some(&(before, _)) = open.last() {
                    low[before.index()] = low[before.index()].min(low[cell.index()]);
                }
                if low[cell.index()] == number[cell.index()] {
                    let first = waiting.iter().rposition(|&c| c == cell).unwrap_or(0);
                    let mut ring: Vec<CellId> = waiting.drain(first..).collect();
                    ring.iter().for_each(|member| number[member.index()] = DONE);
                    if ring.len() > 1 {
                        ring.sort_unstable();
                        found.push(ring);
                    }
                }
                None
            };
            match other.map(|other| (other, number[other.index()])) {
                Some((other, UNSEEN)) => open.push((other, 0)),
                None | Some((_, DONE)) => {}
                Some((_, waits)) => low[cell.index()] = low[cell.index()].min(waits),
            }
        }
    }
    found.sort_unstable();
    found
}

/// For every cell those in front of it across gaps.
struct InFront {
    starts: Vec<u32>,
    cells: Vec<CellId>,
}

impl InFront {
    fn new(cell_count: usize, arrows: &[(CellId, CellId)]) -> Self {
        let mut starts = vec![0_u32; cell_count + 1];
        for (_, back) in arrows {
            starts[back.index() + 1] += 1;
        }
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        let mut next = starts.clone();
        let mut cells = vec![CellId(0); arrows.len()];
        for &(front, back) in arrows {
            let place = &mut next[back.index()];
            cells[*place as usize] = front;
            *place += 1;
        }
        Self { starts, cells }
    }

    fn of(&self, cell: CellId) -> &[CellId] {
        &self.cells[self.starts[cell.index()] as usize..self.starts[cell.index() + 1] as usize]
    }
}

#[cfg(test)]
#[path = "judge_tests.rs"]
mod tests;
