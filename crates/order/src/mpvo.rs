//! Meshed polyhedra visibility ordering: neighbors sorted by the planes of the faces between them.

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
    adjacency: FaceAdjacency,
    sides: FaceSides,
}

/// How far the search has come with a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    /// What lies in front of it is being placed.
    Open,
    Placed,
}

impl Mpvo {
    /// Learns which faces a mesh's cells share, and on which side of them they lie.
    pub fn new(cells: Cells<'_>) -> Self {
        let adjacency = FaceAdjacency::new(cells.tetrahedra);
        let sides = FaceSides::new(cells, &adjacency);
        Self { adjacency, sides }
    }

    /// Places cells after all that lie in front of them; gives whether a ring had to be broken.
    fn place(&self, nearer: &[u8], sorted: &[CellId], is_drawn: &[bool], placed: &mut Vec<CellId>) -> bool {
        let table = self.adjacency.table();
        let mut state = vec![State::New; nearer.len()];
        let mut open: Vec<(CellId, u8)> = Vec::new();
        let mut is_cyclic = false;
        for &root in sorted {
            if state[root.index()] != State::New {
                continue;
            }
            state[root.index()] = State::Open;
            open.push((root, nearer[root.index()]));
            while let Some((cell, in_front)) = open.last_mut() {
                if *in_front == 0 {
                    state[cell.index()] = State::Placed;
                    if is_drawn[cell.index()] {
                        placed.push(*cell);
                    }
                    open.pop();
                    continue;
                }
                let corner = in_front.trailing_zeros();
                *in_front &= *in_front - 1;
                let next = neighbor(table, *cell, corner);
                match state[next.index()] {
                    State::New => {
                        state[next.index()] = State::Open;
                        open.push((next, nearer[next.index()]));
                    }
                    State::Open => is_cyclic = true,
                    State::Placed => {}
                }
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
        let nearer = self.sides.nearer_neighbors(cells, viewpoint);
        let sorted = nearest_first(cells, viewpoint, drawn);
        let mut is_drawn = vec![false; nearer.len()];
        for cell in drawn {
            is_drawn[cell.index()] = true;
        }
        let mut front_to_back = Vec::with_capacity(drawn.len());
        let is_cyclic = self.place(&nearer, &sorted, &is_drawn, &mut front_to_back);
        let cycles = if is_cyclic { cycles(&nearer, self.adjacency.table()) } else { Vec::new() };
        Order { front_to_back, guarantee: Guarantee::Faces, cycles }
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
