//! On which side of each face its cell and the eye lie: the arrows of the visibility relation.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};
use tetrascope_view::Viewpoint;

use crate::Cells;
use crate::planes::{Glance, Planes};
use crate::signs::{eye_side, side_of};

/// For every cell, which of its faces it shares with a cell on the other side, and on which side of them it lies.
///
/// Faces are taken with their points in ascending order, so that both cells of a face ask about the same plane and hear the same
/// answer.
#[derive(Clone, Debug)]
pub(crate) struct FaceSides {
    /// Bit `i` is set in the low half if the cell lies on the positive side of the face opposite corner `i`, and in the high half if
    /// the face may carry an arrow.
    sides: Vec<u8>,
    planes: Planes,
}

/// A cell's faces with an arrow, as bits by corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Relation {
    /// The neighbor lies in front.
    pub front: u8,
    /// The neighbor lies behind.
    pub behind: u8,
}

impl FaceSides {
    /// Exact, whatever the cells' orientation.
    ///
    /// A cell without volume takes the side that its neighbor leaves to it; where both are flat, or where both lie on
    /// one side, since the mesh is folded there, the face carries no arrow.
    pub(crate) fn new(cells: Cells<'_>, adjacency: &FaceAdjacency) -> Self {
        let table = adjacency.table();
        let side = |cell: usize, corner: usize| {
            let tetrahedron = cells.tetrahedra[cell];
            let apex = cells.positions[tetrahedron[corner].index()];
            is_positive(side_of(face(cells, tetrahedron, corner), apex))
        };
        let sides: Vec<u8> = (0..cells.tetrahedra.len())
            .into_par_iter()
            .map(|cell| {
                let mut bits = 0;
                for (corner, &neighbor) in table[cell].iter().enumerate() {
                    if neighbor == FaceAdjacency::NONE {
                        continue;
                    }
                    // The two may share more than one face: then it is that of the same points.
                    let own = face_ids(cells.tetrahedra[cell], corner);
                    let other = (0..4).find(|&i| face_ids(cells.tetrahedra[neighbor as usize], i) == own);
                    let theirs = other.and_then(|other| side(neighbor as usize, other));
                    let is_positive = match (side(cell, corner), theirs) {
                        (Some(mine), Some(theirs)) if mine != theirs => mine,
                        (Some(mine), None) => mine,
                        (None, Some(theirs)) => !theirs,
                        _ => continue,
                    };
                    bits |= 0x10 << corner | u8::from(is_positive) << corner;
                }
                bits
            })
            .collect();
        // The positive side is the one that the normal leads away from.
        let outward = |cell: usize, corner: usize| {
            let bits = sides[cell] >> corner;
            (bits & 0x10 != 0).then(|| (face(cells, cells.tetrahedra[cell], corner), bits & 1 == 1))
        };
        let planes = Planes::new(cells, outward);
        Self { sides, planes }
    }

    /// For every cell a byte of its relations to its neighbors.
    ///
    /// Gives whether no such face is seen edge-on. Exact: what the planes in 16 bits leave open is asked of the points.
    pub(crate) fn relations(
        &self,
        cells: Cells<'_>,
        viewpoint: Viewpoint,
        bytes: &mut [u8],
        byte: impl Fn(Relation) -> u8 + Sync,
    ) -> bool {
        let is_any_edge_on = AtomicBool::new(false);
        self.planes.glance(viewpoint, bytes, |first, glances, bytes| {
            let mut open = 0;
            for ((glance, &bits), result) in glances.iter().zip(&self.sides[first..]).zip(&mut *bytes) {
                open |= !(glance.front | glance.behind) & bits >> 4;
                *result = byte(Relation { front: glance.front, behind: glance.behind });
            }
            if open != 0 {
                for ((lane, &glance), result) in glances.iter().enumerate().zip(bytes) {
                    if !(glance.front | glance.behind) & self.sides[first + lane] >> 4 != 0 {
                        let relation = self.settle(cells, viewpoint, first + lane, glance);
                        if !(relation.front | relation.behind) & self.sides[first + lane] >> 4 != 0 {
                            is_any_edge_on.store(true, Ordering::Relaxed);
                        }
                        *result = byte(relation);
                    }
                }
            }
        });
        !is_any_edge_on.into_inner()
    }

    /// A cell's relations where a glance did not tell all.
    #[cold]
    fn settle(&self, cells: Cells<'_>, viewpoint: Viewpoint, cell: usize, glance: Glance) -> Relation {
        let bits = self.sides[cell];
        let mut relation = Relation { front: glance.front, behind: glance.behind };
        for corner in 0..4 {
            if !(glance.front | glance.behind) & bits >> 4 & 1 << corner == 0 {
                continue;
            }
            // The cell on the eye's side of the face is the nearer one; seen edge-on, neither.
            match is_positive(eye_side(face(cells, cells.tetrahedra[cell], corner), viewpoint)) {
                Some(eye_is_positive) if eye_is_positive != (bits >> corner & 1 == 1) => relation.front |= 1 << corner,
                Some(_) => relation.behind |= 1 << corner,
                None => {}
            }
        }
        relation
    }

    /// For every cell the corners whose opposite neighbor lies in front of it, as bits.
    pub(crate) fn nearer_neighbors(&self, cells: Cells<'_>, viewpoint: Viewpoint) -> Vec<u8> {
        let mut nearer = vec![0; self.len()];
        self.relations(cells, viewpoint, &mut nearer, |relation| relation.front);
        nearer
    }

    pub(crate) fn len(&self) -> usize {
        self.sides.len()
    }

    /// Bytes that it keeps.
    pub(crate) fn bytes(&self) -> usize {
        self.sides.len() + self.planes.bytes()
    }
}

/// A face's points in the order in which the cell lists them.
#[inline]
fn corners_of(corner: usize) -> [usize; 3] {
    [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]][corner]
}

/// A face's points, ascending.
#[inline]
fn face_ids(tetrahedron: [VertexId; 4], corner: usize) -> [VertexId; 3] {
    let mut points = corners_of(corner).map(|i| tetrahedron[i]);
    points.sort_unstable();
    points
}

/// A face's points by ascending number, in space.
#[inline]
fn face(cells: Cells<'_>, tetrahedron: [VertexId; 4], corner: usize) -> [DVec3; 3] {
    face_ids(tetrahedron, corner).map(|v| cells.positions[v.index()])
}

/// A side as [`signs`](crate::signs) counts it: whether it is the positive one; `None` on the plane.
#[inline]
fn is_positive(side: i8) -> Option<bool> {
    (side != 0).then_some(side > 0)
}

/// Of which cells a set of corner bits speaks.
#[inline]
pub(crate) fn neighbor(table: &[[u32; 4]], cell: CellId, corner: u32) -> CellId {
    CellId(table[cell.index()][corner as usize])
}
