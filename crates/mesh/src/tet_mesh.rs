//! Tetrahedra over shared points.

use glam::DVec3;

use rayon::prelude::*;

use crate::{
    CellId, CellKind, Cells, Dataset, Decomposition, Frame, MeshError, UnstructuredCells, VertexId, decompose,
};

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
    /// The last so many points lie where these do; see [`TetMesh::with_points_of_cells`].
    pub(crate) originals: Vec<VertexId>,
}

impl TetMesh {
    /// A mesh of tetrahedra that are known already: [`decompose`] of a dataset of nothing else.
    ///
    /// - `points_world`: world coordinates
    /// - `tetrahedra`: four point indices each, either way round; those of no volume are left out and counted
    ///
    /// # Errors
    ///
    /// As [`decompose`]; an index beyond the points is [`MeshError::Inconsistent`].
    pub fn from_tetrahedra(points_world: &[DVec3], tetrahedra: &[[u32; 4]]) -> Result<Decomposition, MeshError> {
        let cells = UnstructuredCells {
            kinds: vec![CellKind::Tetrahedron; tetrahedra.len()],
            offsets: (0..=tetrahedra.len()).map(|cell| 4 * cell).collect(),
            connectivity: tetrahedra.as_flattened().to_vec(),
            polyhedra: Vec::new(),
        };
        let cells = Cells::Unstructured(cells);
        decompose(&Dataset { points: points_world.to_vec(), cells, ..Dataset::default() })
    }

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

    /// The tetrahedra with the points of each in ascending order, which says nothing of their orientation.
    ///
    /// Neighbors then have the points of a shared face in the same order, so that what is computed of it is the same from both sides.
    pub fn ascending_tetrahedra(&self) -> Vec<[VertexId; 4]> {
        let ascending = |tetrahedron: &[VertexId; 4]| {
            let mut sorted = *tetrahedron;
            sorted.sort_unstable();
            sorted
        };
        self.tetrahedra.par_iter().map(ascending).collect()
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

    /// Six times the volume of a tetrahedron, in local units: multiply by the frame's scale cubed for the world's.
    #[inline]
    pub fn volume6_local(&self, cell: CellId) -> f64 {
        let [v0, v1, v2, v3] = self.corners(cell);
        (v1 - v0).dot((v2 - v0).cross(v3 - v0))
    }

    /// The mesh of those tetrahedra that `keep` wants, in their order, over the same points and in the same frame.
    ///
    /// Cell ids are new; [`TetMesh::source_cells`] still names the dataset's cells. No tetrahedron may be left.
    pub fn retain(&self, keep: impl Fn(CellId) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.tetrahedra.len()).filter(|&cell| keep(CellId(cell as u32))).collect();
        Self {
            frame: self.frame,
            positions: self.positions.clone(),
            tetrahedra: kept.iter().map(|&cell| self.tetrahedra[cell]).collect(),
            source_cells: kept.iter().map(|&cell| self.source_cells[cell]).collect(),
            originals: self.originals.clone(),
        }
    }

    /// Lowest and highest world coordinates of the points that tetrahedra use; `None` if there is no tetrahedron.
    pub fn bounds_world(&self) -> Option<(DVec3, DVec3)> {
        let empty = || (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let join = |a: (DVec3, DVec3), b: (DVec3, DVec3)| (a.0.min(b.0), a.1.max(b.1));
        let grow = |bounds, tetrahedron: &[VertexId; 4]| {
            tetrahedron.iter().map(|v| self.positions[v.index()]).fold(bounds, |bounds, p| join(bounds, (p, p)))
        };
        let (lowest, highest) = self.tetrahedra.par_iter().fold(empty, grow).reduce(empty, join);
        // The map is monotone, so the bounds of the local coordinates are those of the world's.
        (!self.tetrahedra.is_empty()).then(|| (self.frame.to_world(lowest), self.frame.to_world(highest)))
    }
}
