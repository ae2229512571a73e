//! Meshed polyhedra visibility ordering: neighbors sorted by the planes of the faces between them.

use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency};
use tetrascope_view::Viewpoint;

use crate::centroid::nearest_first;
use crate::convex::is_convex;
use crate::cycles::{Arrows, groups};
use crate::gaps::Gaps;
use crate::overlaps::{both_ways, folded_pairs};
use crate::repair::Kept;
use crate::sides::{FaceSides, neighbor};
use crate::sweep::{is_left, sweep, waiting};
use crate::{Cells, Guarantee, Order, VisibilityOrder};

/// Of two cells that share a face, the one on the eye's side of its plane comes first.
///
/// Right for every two cells that a ray meets one right after the other through a face, and so for all cells where the mesh is convex.
/// Cells with a gap between them have no face in common; of two cells of the boundary that faces leave open the one with the nearer
/// centroid comes first. That is a guess, and where a mesh is not convex it may be wrong.
///
/// Planes are evaluated exactly, and with one result for both cells: a face seen edge-on orders nothing. Where cells hide one
/// another in a ring, or overlap at a face, no order is right: the ring is reported in [`Order::cycles`], its cells stand together by the distance of
/// their centroids, and all others come right.
///
/// Time linear in the number of cells of the mesh but for the sort of the boundary, where it is not convex; all cells take part, also
/// those that are not drawn, since two that are may be ordered by what lies between them. Keeps 49 bytes a tetrahedron: its neighbors
/// (16), the planes of its faces in 16 bits (32), their sides (1). Where the mesh is convex, 9 more hold the last order: for an eye that moved
/// little, and sees no face edge-on, only what lies at faces that turned is put in order anew. Then the order of two cells that no ray
/// meets both of may depend on the views before; that of all others cannot.
///
/// Source: [Williams 1992b]. On a convex mesh any topological order is right and the one of [Kahn 1962] is the fastest; elsewhere
/// a depth-first search from the boundary, sorted by centroid, is his heuristic for meshes that are not convex, from the front.
#[derive(Clone, Debug)]
pub struct Mpvo {
    adjacency: Arc<FaceAdjacency>,
    sides: Arc<FaceSides>,
    /// The cells of the boundary; `None` where the mesh is convex.
    boundary: Option<Arc<[CellId]>>,
    /// Cells on one side of a face that both have: they overlap, and each hides the other.
    folded: Arc<[(CellId, CellId)]>,
    /// The order of the last view, where faces alone decide all.
    last: Arc<Mutex<Kept>>,
}

/// How far the search has come with a cell, in the bits above those for its corners: one byte a cell is all that it touches.
const OPEN: u8 = 0x10;
const PLACED: u8 = 0x20;

impl Mpvo {
    /// Learns which faces a mesh's cells share, on which side of them they lie, and whether the mesh is convex.
    pub fn new(cells: Cells<'_>) -> Self {
        let adjacency = FaceAdjacency::new(cells.tetrahedra);
        let sides = FaceSides::new(cells, &adjacency);
        let is_convex = is_convex(cells, &adjacency);
        let folded = folded_pairs(cells, &adjacency).into();
        Self::with_parts(Arc::new(adjacency), Arc::new(sides), is_convex, folded)
    }

    /// - `folded`: of [`folded_pairs`]; none where the mesh is convex
    pub(crate) fn with_parts(
        adjacency: Arc<FaceAdjacency>,
        sides: Arc<FaceSides>,
        is_convex: bool,
        folded: Arc<[(CellId, CellId)]>,
    ) -> Self {
        let table = adjacency.table();
        let is_outer = |cell: &u32| table[*cell as usize].contains(&FaceAdjacency::NONE);
        let boundary =
            (!is_convex).then(|| (0..table.len() as u32).into_par_iter().filter(is_outer).map(CellId).collect());
        Self { adjacency, sides, boundary, folded, last: Arc::default() }
    }

    /// Cells that overlap their neighbors, pair by pair.
    pub(crate) fn folded(&self) -> &[(CellId, CellId)] {
        &self.folded
    }

    /// What every cell waits for, as [`sweep`] takes it, and whether no face is seen edge-on.
    pub(crate) fn waiting(&self, cells: Cells<'_>, viewpoint: Viewpoint) -> (Vec<u8>, bool) {
        assert_eq!(cells.tetrahedra.len(), self.sides.len(), "an order is made for one mesh");
        let mut bytes = vec![0; self.sides.len() + 1];
        let is_general = self.sides.relations(cells, viewpoint, &mut bytes[..self.sides.len()], waiting);
        (bytes, is_general)
    }

    /// The order that follows from faces and gaps alone.
    ///
    /// - `bytes` and `is_general`: of [`Self::waiting`]
    /// - `gaps`: for every cell those that lie behind it without a face in common
    pub(crate) fn swept(
        &self,
        cells: Cells<'_>,
        viewpoint: Viewpoint,
        drawn: &[CellId],
        (mut bytes, is_general): (Vec<u8>, bool),
        gaps: &Gaps,
        guarantee: Guarantee,
    ) -> Order {
        let count = self.sides.len();
        let table = self.adjacency.table();
        // Where anything is guessed, or stands as it does for a ring, the order may not depend on views before. Nor where a face is seen
        // edge-on: a ray in it is in both cells as they round, and their order shows in the last bit of a picture.
        let is_kept = is_general && gaps.is_empty() && guarantee == Guarantee::Exact;
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if is_kept && last.repair(&bytes, table) {
            return Order::whole(only_drawn(last.placed().to_vec(), count, drawn), guarantee);
        }
        last.forget();
        let faces = if is_kept { bytes.clone() } else { Vec::new() };
        let placed = sweep(&mut bytes, table, gaps);
        if placed.len() == count {
            if is_kept {
                last.keep(&faces, &placed);
            }
            return Order::whole(only_drawn(placed, count, drawn), guarantee);
        }
        drop(last);
        let left: Vec<CellId> =
            (0..).map(CellId).zip(&bytes[..count]).filter(|(_, b)| is_left(**b)).map(|(c, _)| c).collect();
        self.with_rings(cells, viewpoint, drawn, (placed, left), &gaps.reversed(count), guarantee)
    }

    /// The order where cells hide one another in rings.
    ///
    /// - `parts`: cells that are in order and have nothing else in front of them, and all others
    /// - `gaps`: for every cell those that lie in front of it without a face in common
    fn with_rings(
        &self,
        cells: Cells<'_>,
        viewpoint: Viewpoint,
        drawn: &[CellId],
        (placed, left): (Vec<CellId>, Vec<CellId>),
        gaps: &Gaps,
        guarantee: Guarantee,
    ) -> Order {
        let (nearer, roots) =
            rayon::join(|| self.sides.nearer_neighbors(cells, viewpoint), || nearest_first(cells, viewpoint, &left));
        let arrows = Arrows { nearer: &nearer, table: self.adjacency.table(), gaps };
        let is_drawn = Marks::new(self.sides.len(), drawn);
        let mut front_to_back = only_drawn(placed.clone(), self.sides.len(), drawn);
        let mut cycles = Vec::new();
        groups(arrows, &placed, roots, |group| {
            if let [cell] = *group {
                front_to_back.extend(is_drawn.has(CellId(cell)).then_some(CellId(cell)));
                return;
            }
            let mut ring: Vec<CellId> = group.iter().copied().map(CellId).collect();
            ring.sort_unstable();
            let members: Vec<CellId> = ring.iter().copied().filter(|&cell| is_drawn.has(cell)).collect();
            front_to_back.extend(nearest_first(cells, viewpoint, &members));
            cycles.push(ring);
        });
        cycles.sort_unstable();
        Order { cycles, ..Order::whole(front_to_back, guarantee) }
    }

    /// The order where gaps are guessed across by the centroids of the boundary's cells.
    fn guessed(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId], boundary: &[CellId]) -> Order {
        let count = self.sides.len();
        let all = || (0..count as u32).map(CellId).collect();
        if !self.folded.is_empty() {
            // The same in both directions.
            let gaps = Gaps::new(count, &both_ways(&self.folded));
            return self.with_rings(cells, viewpoint, drawn, (Vec::new(), all()), &gaps, Guarantee::Faces);
        }
        let (mut state, sorted) =
            rayon::join(|| self.sides.nearer_neighbors(cells, viewpoint), || nearest_first(cells, viewpoint, boundary));
        let mut placed = Vec::with_capacity(count);
        let is_cyclic = self.search(&mut state, &sorted, &mut placed);
        if !is_cyclic {
            return Order::whole(only_drawn(placed, count, drawn), Guarantee::Faces);
        }
        self.with_rings(cells, viewpoint, drawn, (Vec::new(), all()), &Gaps::default(), Guarantee::Faces)
    }

    /// Places cells after all that lie in front of them; gives whether a ring had to be broken.
    ///
    /// - `state`: for every cell the corners whose opposite neighbor lies in front of it, as bits
    fn search(&self, state: &mut [u8], sorted: &[CellId], placed: &mut Vec<CellId>) -> bool {
        let table = self.adjacency.table();
        let mut open: Vec<(CellId, u8)> = Vec::new();
        let mut is_cyclic = false;
        let (mut touched, last) = (0, (table.len() as u32).saturating_sub(1));
        // Whatever has something behind it is reached from the boundary; rings and flat cells may not be.
        for root in sorted.iter().copied().chain((0..table.len() as u32).map(CellId)) {
            if state[root.index()] & PLACED != 0 {
                continue;
            }
            let (mut cell, mut in_front) = (root, state[root.index()]);
            state[cell.index()] |= OPEN;
            loop {
                if in_front == 0 {
                    state[cell.index()] ^= OPEN | PLACED;
                    placed.push(cell);
                    let Some(before) = open.pop() else { break };
                    (cell, in_front) = before;
                    continue;
                }
                let next = neighbor(table, cell, in_front.trailing_zeros());
                in_front &= in_front - 1;
                let bits = state[next.index()];
                if bits & (OPEN | PLACED) == 0 {
                    // The rows of all neighbors are asked for at once; that of the next one is needed right after.
                    let rows = table[next.index()].map(|n| table[n.min(last) as usize][0]);
                    touched ^= rows[0] ^ rows[1] ^ rows[2] ^ rows[3];
                    state[next.index()] |= OPEN;
                    open.push((cell, in_front));
                    (cell, in_front) = (next, bits);
                }
                is_cyclic |= bits & OPEN != 0;
            }
        }
        std::hint::black_box(touched);
        is_cyclic
    }
}

impl VisibilityOrder for Mpvo {
    fn kept_bytes(&self) -> usize {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).bytes();
        size_of_val(self.adjacency.table())
            + self.sides.bytes()
            + self.boundary.as_deref().map_or(0, size_of_val)
            + last
    }

    /// # Panics
    ///
    /// If `cells` is not the mesh that it was made for, in number.
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        assert_eq!(cells.tetrahedra.len(), self.sides.len(), "an order is made for one mesh");
        match &self.boundary {
            Some(boundary) => self.guessed(cells, viewpoint, drawn, boundary),
            None => {
                let faces = self.waiting(cells, viewpoint);
                self.swept(cells, viewpoint, drawn, faces, &Gaps::default(), Guarantee::Exact)
            }
        }
    }
}

/// A bit for every cell.
struct Marks(Vec<u64>);

impl Marks {
    fn new(count: usize, cells: &[CellId]) -> Self {
        let mut bits = vec![0; count.div_ceil(64)];
        for cell in cells {
            bits[cell.index() / 64] |= 1 << (cell.index() % 64);
        }
        Self(bits)
    }

    fn has(&self, cell: CellId) -> bool {
        self.0[cell.index() / 64] >> (cell.index() % 64) & 1 == 1
    }
}

/// Leaves those that are drawn; `drawn` names each of the `count` cells of the mesh at most once.
fn only_drawn(mut placed: Vec<CellId>, count: usize, drawn: &[CellId]) -> Vec<CellId> {
    if drawn.len() < count {
        let is_drawn = Marks::new(count, drawn);
        placed.retain(|&cell| is_drawn.has(cell));
    }
    placed
}

/// Pairs of drawn cells that share a face and come in the wrong order: what a method's guarantee is worth here.
///
/// The judge of [`Guarantee::Faces`], for any order; faces seen edge-on judge nobody.
pub fn misordered_faces(cells: Cells<'_>, viewpoint: Viewpoint, front_to_back: &[CellId]) -> usize {
    let adjacency = FaceAdjacency::new(cells.tetrahedra);
    let nearer = FaceSides::new(cells, &adjacency).nearer_neighbors(cells, viewpoint);
    let mut rank = vec![u32::MAX; cells.tetrahedra.len()];
    for (place, cell) in front_to_back.iter().enumerate() {
        rank[cell.index()] = place as u32;
    }
    let wrong = |&cell: &CellId| {
        let in_front = nearer[cell.index()];
        let corners = (0..4).filter(|corner| in_front >> corner & 1 == 1);
        corners
            .map(|corner| rank[neighbor(adjacency.table(), cell, corner).index()])
            .filter(|&other| other != u32::MAX && other > rank[cell.index()])
            .count()
    };
    front_to_back.par_iter().map(wrong).sum()
}
