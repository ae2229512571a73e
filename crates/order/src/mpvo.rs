//! Meshed polyhedra visibility ordering: neighbors sorted by the planes of the faces between them.

use std::sync::Arc;

use rayon::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency};
use tetrascope_view::Viewpoint;

use crate::centroid::nearest_first;
use crate::cycles::cycles;
use crate::sides::{FaceSides, neighbor};
use crate::{Cells, Guarantee, Order, VisibilityOrder};

/// Of two cells that share a face, the one on the eye's side of its plane comes first.
///
/// Right for every two cells that a ray meets one right after the other through a face, and so for all cells where the mesh is convex.
/// Cells with a gap between them have no face in common; among what the faces leave open the nearer centroid comes first.
/// That is a guess, and where a mesh is not convex it may be wrong.
///
/// Planes are evaluated once for both sides, exactly: a face seen edge-on orders nothing. Where cells hide one another in a ring, no
/// order is right: the ring is broken at one of its faces and reported in [`Order::cycles`].
///
/// Time linear in the number of cells of the mesh but for the sort of the centroids; all cells take part, also those that
/// are not drawn, since two that are may be ordered by what lies between them. Keeps 17 bytes a tetrahedron.
///
/// Source: [Williams 1992b], with a depth-first search over cells sorted by centroid in the place of his search from the
/// back; his heuristic for meshes that are not convex sorts the boundary alone.
#[derive(Clone, Debug)]
pub struct Mpvo {
    adjacency: Arc<FaceAdjacency>,
    sides: Arc<FaceSides>,
}

/// How far the search has come with a cell, in the bits above those for its corners: one byte a cell is all that it touches.
const OPEN: u8 = 0x10;
const PLACED: u8 = 0x20;
const DRAWN: u8 = 0x40;

impl Mpvo {
    /// Learns which faces a mesh's cells share, and on which side of them they lie.
    pub fn new(cells: Cells<'_>) -> Self {
        let adjacency = FaceAdjacency::new(cells.tetrahedra);
        let sides = FaceSides::new(cells, &adjacency);
        Self::with_parts(Arc::new(adjacency), Arc::new(sides))
    }

    pub(crate) fn with_parts(adjacency: Arc<FaceAdjacency>, sides: Arc<FaceSides>) -> Self {
        Self { adjacency, sides }
    }

    /// Places cells after all that lie in front of them; gives whether a ring had to be broken.
    ///
    /// - `state`: for every cell the corners whose opposite neighbor lies in front of it, as bits, and [`DRAWN`]
    fn place(&self, state: &mut [u8], sorted: &[CellId], placed: &mut Vec<CellId>) -> bool {
        let table = self.adjacency.table();
        let mut open: Vec<(CellId, u8)> = Vec::new();
        let mut is_cyclic = false;
        let mut begin = |cell: CellId, state: &mut [u8], open: &mut Vec<(CellId, u8)>| {
            let bits = &mut state[cell.index()];
            match *bits & (OPEN | PLACED) {
                0 => {
                    open.push((cell, *bits & 0x0f));
                    *bits |= OPEN;
                }
                OPEN => is_cyclic = true,
                _ => {}
            }
        };
        for &root in sorted {
            if state[root.index()] & PLACED != 0 {
                continue;
            }
            begin(root, state, &mut open);
            while let Some((cell, in_front)) = open.last_mut() {
                if *in_front == 0 {
                    let bits = &mut state[cell.index()];
                    *bits ^= OPEN | PLACED;
                    if *bits & DRAWN != 0 {
                        placed.push(*cell);
                    }
                    open.pop();
                    continue;
                }
                let corner = in_front.trailing_zeros();
                *in_front &= *in_front - 1;
                let next = neighbor(table, *cell, corner);
                begin(next, state, &mut open);
            }
        }
        is_cyclic
    }
}

impl VisibilityOrder for Mpvo {
    /// # Panics
    ///
    /// If `cells` is not the mesh that it was made for, in number.
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        assert_eq!(cells.tetrahedra.len(), self.sides.len(), "an order is made for one mesh");
        let (mut state, sorted) =
            rayon::join(|| self.sides.nearer_neighbors(cells, viewpoint), || nearest_first(cells, viewpoint, drawn));
        for cell in drawn {
            state[cell.index()] |= DRAWN;
        }
        let mut front_to_back = Vec::with_capacity(drawn.len());
        let is_cyclic = self.place(&mut state, &sorted, &mut front_to_back);
        let cycles = if is_cyclic {
            state.par_iter_mut().for_each(|bits| *bits &= 0x0f);
            cycles(&state, self.adjacency.table())
        } else {
            Vec::new()
        };
        Order { cycles, ..Order::whole(front_to_back, Guarantee::Faces) }
    }
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
