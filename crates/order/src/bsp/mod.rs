//! The relations between cells that do not touch: a binary space partition of the boundary.
//!
//! Cells that share a face know which of them is in front. On a ray through a mesh that is not convex there is also
//! empty space: the ray leaves cell `a` through a boundary face, an *exit*, and enters cell `b` through another, an
//! *entry*. Then
//! `a` comes before `b`, and no shared face says so. Source: [Comba 1999], who find these relations from a binary space
//! partition of the boundary faces, made once; from an eye the tree gives its fragments front to back.
//!
//! **Which relations suffice.** Along a ray the cells come in runs that touch face to face, with gaps between. Faces
//! order a run; one arrow from the last cell of a run to the first of the next orders the gap. So an order is right for
//! all rays if it respects all faces and, for every exit and entry that follow each other on some ray, the arrow from
//! the one's cell to the other's.
//!
//! **Which may not be added.** The fragments' order is one of many. A chain through all of them (what leaves at a
//! fragment comes before what enters at any later one) is linear in the fragments, but claims too much. Let cell
//! `b` hide cell `a` behind it, and let a plane of the tree, from some other part of the mesh, cut both askew. The near
//! side holds a piece of `a`'s exit, the far side a piece of `b`'s entry: the chain wants `a` before `b`, the face
//! between them `b` before `a`. No picture has this cycle, and it is common, since planes extend through the whole
//! mesh. The same is true of a chain for each subtree.
//!
//! **What is done.** An arrow is given where an exit and an entry have a ray in common and the exit is in front,
//! decided exactly for the two triangles. Every arrow is true of some ray, as is every arrow across a shared face; so a
//! cycle among them is a cycle of the mesh, and never one of the method. All pairs in question are compared, also those
//! with something between them: with `D` gaps on a ray there are about `D²/2` pairs where `D` would do. The tree
//! decides which are in question: only an exit that comes before an entry. Of a convex part all entries come before all
//! exits, and nothing is left to compare; otherwise tiles of the picture offer those that may overlap. The ranks in the
//! tree also say which of two whole faces is in front; for faces that were split the two triangles are compared once
//! more.
//!
//! So what the tree cannot settle (it stops at a number of fragments and at a depth) costs time, and not correctness.
//!
//! Planes are those of boundary faces, and planes across an axis where there are many faces: a round surface has all of
//! itself on one side of each of its faces, and its own planes would give a list instead of a tree.
//!
//! Faces of three or more cells, and faces towards a cell without volume, count as boundary faces of each of their
//! cells. Exits come before entries in the same plane, so that parts that touch without sharing faces are ordered too.
//! Cells without volume have no arrows: no ray passes through them.

mod arrows;
mod flat;
mod overlap;
mod split;
mod tiles;
mod tree;

use rayon::prelude::*;
use tetrascope_mesh::{CellFace, CellId, FaceAdjacency};

use crate::Cells;
use crate::signs::side_of;
pub use arrows::ArrowReport;
use split::Face;
use tree::Tree;

/// A binary space partition of the boundary faces of a mesh. See the module's text for what it is good for.
///
/// Made once for a mesh, for any number of views. Memory: about 110 bytes a boundary face and 40 a fragment.
#[derive(Clone, Debug)]
pub struct BspTree {
    faces: Vec<Face>,
    /// Whether a face has one fragment, itself, with a place of its own in the tree.
    is_whole: Vec<bool>,
    tree: Tree,
    report: TreeReport,
    /// The largest coordinate.
    largest: f64,
}

/// A boundary face, or a convex piece of one, as a view has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundaryFragment {
    /// The cell that the face belongs to.
    pub cell: CellId,
    /// Whether a ray enters the cell here; else it leaves the cell.
    pub faces_eye: bool,
}

/// What came of building a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TreeReport {
    /// Boundary faces of cells with a volume.
    pub faces: usize,
    /// Fragments that these were split into.
    pub fragments: usize,
    /// Planes above one another.
    pub depth: u32,
    /// Faces that have fragments without an order, since there were enough fragments or planes. Their arrows are right
    /// all the same.
    pub unordered: usize,
    /// Cells without volume, which no face was taken of.
    pub flat_cells: usize,
}

impl TreeReport {
    /// Whether the tree orders all fragments.
    pub fn is_complete(&self) -> bool {
        self.unordered == 0
    }
}

impl BspTree {
    /// Builds the tree. The same for any number of threads; at most 8 fragments a face and 200 planes above one
    /// another.
    ///
    /// - `cells`: corners in any order; cells may be without volume, points may be there twice
    /// - `adjacency`: of the same tetrahedra
    pub fn new(cells: Cells<'_>, adjacency: &FaceAdjacency) -> Self {
        let corners = |cell: CellId| cells.tetrahedra[cell.index()].map(|v| cells.positions[v.index()]);
        let volume_side = |cell: CellId| {
            let [a, b, c, d] = corners(cell);
            side_of([a, b, c], d)
        };
        let flat: Vec<CellId> = (0..cells.tetrahedra.len() as u32)
            .into_par_iter()
            .map(CellId)
            .filter(|&cell| volume_side(cell) == 0)
            .collect();

        let mut outer: Vec<CellFace> = adjacency.boundary_faces().to_vec();
        outer.extend(adjacency.non_manifold_faces().iter().flatten());
        // What borders on a flat cell borders on nothing that a ray passes through.
        for &cell in &flat {
            for neighbor in (0..4).filter_map(|corner| adjacency.neighbor(cell, corner)) {
                let towards = (0..4_u8).filter(|&c| adjacency.neighbor(neighbor, usize::from(c)) == Some(cell));
                outer.extend(towards.map(|corner| CellFace { cell: neighbor, corner }));
            }
        }
        outer.sort_unstable();
        outer.dedup();

        let mut faces: Vec<Face> = outer
            .into_par_iter()
            .filter_map(|CellFace { cell, corner }| {
                let [a, b, c, d] = corners(cell);
                let (points, apex) = match corner {
                    0 => ([b, c, d], a),
                    1 => ([a, c, d], b),
                    2 => ([a, b, d], c),
                    _ => ([a, b, c], d),
                };
                let cell_side = side_of(points, apex);
                (cell_side != 0).then_some(Face { points, numbers: [0; 3], cell, cell_side })
            })
            .collect();
        number_points(&mut faces);
        let tree = Tree::new(&faces);
        let is_whole = tree.whole_faces(faces.len());
        let mut unordered = tree.unordered.clone();
        unordered.sort_unstable();
        unordered.dedup();
        let report = TreeReport {
            faces: faces.len(),
            fragments: tree.fragments(),
            depth: tree.depth,
            unordered: unordered.len(),
            flat_cells: flat.len(),
        };
        let largest = faces.iter().flat_map(|face| face.points).map(|p| p.abs().max_element()).fold(0.0, f64::max);
        Self { faces, is_whole, tree, report, largest }
    }

    /// Bytes that it keeps.
    pub fn bytes(&self) -> usize {
        size_of_val(self.faces.as_slice()) + self.is_whole.len() + self.tree.bytes()
    }

    /// What came of building.
    pub fn report(&self) -> TreeReport {
        self.report
    }
}

/// Gives the points of faces their numbers. Zeros of either sign are one place.
fn number_points(faces: &mut [Face]) {
    let mut corners: Vec<([u64; 3], u32)> = (0..)
        .zip(faces.iter().flat_map(|face| face.points))
        .map(|(corner, p)| ((p + 0.0).to_array().map(f64::to_bits), corner))
        .collect();
    corners.par_sort_unstable();
    let mut number = 0;
    for (i, &(place, corner)) in corners.iter().enumerate() {
        number += u32::from(i > 0 && corners[i - 1].0 != place);
        faces[corner as usize / 3].numbers[corner as usize % 3] = number;
    }
}

#[cfg(test)]
mod flat_tests;
#[cfg(test)]
mod tests;
