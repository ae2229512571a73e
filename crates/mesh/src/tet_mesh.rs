//! Tetrahedra over shared points.

use glam::DVec3;

use crate::{CellId, Frame, VertexId};

/// Tetrahedra over shared points, in a local frame.
///
/// Every tetrahedron has four different, finite points and a positive volume
/// `dot(v1 - v0, cross(v2 - v0, v3 - v0)) / 6`. Positions are kept in f64 in the [`Frame`]'s local coordinates; whoever
/// wants 32 bits takes them from there.
#[derive(Clone, Debug)]
pub struct TetMesh {
    pub(crate) frame: Frame,
    pub(crate) positions: Vec<DVec3>,
    pub(crate) tetrahedra: Vec<[VertexId; 4]>,
    pub(crate) source_cells: Vec<u32>,
}

impl TetMesh {
    /// How local coordinates relate to the world's.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// Local coordinates of all points, indexed by [`VertexId`]. Points that no tetrahedron uses may be NaN.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The tetrahedra, indexed by [`CellId`], each with positive volume.
    pub fn tetrahedra(&self) -> &[[VertexId; 4]] {
        &self.tetrahedra
    }

    /// For every tetrahedron the index of the dataset's cell that it was cut from.
    pub fn source_cells(&self) -> &[u32] {
        &self.source_cells
    }

    /// Local coordinates of one tetrahedron's points.
    #[inline]
    pub fn corners(&self, cell: CellId) -> [DVec3; 4] {
        self.tetrahedra[cell.index()].map(|v| self.positions[v.index()])
    }
}
