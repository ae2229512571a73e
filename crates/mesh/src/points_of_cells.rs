//! A mesh in which no two cells share a point, so that a field may differ from cell to cell.

use rayon::prelude::*;

use crate::{MeshError, TetMesh, VertexId};

impl TetMesh {
    /// The same tetrahedra over points of their own: those cut from one cell of the dataset share points, others do not.
    ///
    /// The new points follow the old ones, and lie where these do. Within a cell they are in the order of the old ones, so that what is
    /// computed of the points of a face in ascending order is the same from both sides still. Which tetrahedra are neighbors
    /// [`Self::joined_tetrahedra`] says.
    ///
    /// # Errors
    ///
    /// [`MeshError::TooLarge`] for more points than 32 bits count.
    pub fn with_points_of_cells(&self) -> Result<Self, MeshError> {
        let shared = self.joined_positions().len();
        let mut originals: Vec<VertexId> = Vec::new();
        let mut tetrahedra = Vec::with_capacity(self.tetrahedra.len());
        // Tetrahedra of a cell stand beside each other.
        let mut start = 0;
        while let Some(&cell) = self.source_cells.get(start) {
            let length = self.source_cells[start..].iter().take_while(|other| **other == cell).count();
            let cut = &self.tetrahedra[start..start + length];
            let mut corners: Vec<VertexId> = cut.iter().flatten().copied().collect();
            corners.sort_unstable();
            corners.dedup();
            let first = shared + originals.len();
            // The highest index stays free, as decomposition has it.
            if first + corners.len() > u32::MAX as usize {
                return Err(MeshError::TooLarge {
                    what: "points",
                    count: first + corners.len(),
                    limit: u32::MAX as usize,
                });
            }
            let of_cell = |vertex: &VertexId| {
                let place = corners.partition_point(|corner| corner < vertex);
                VertexId((first + place) as u32)
            };
            tetrahedra.extend(cut.iter().map(|corners| corners.each_ref().map(of_cell)));
            originals.extend(corners.iter().map(|vertex| self.original(*vertex)));
            start += length;
        }
        let mut positions = Vec::with_capacity(shared + originals.len());
        positions.extend_from_slice(self.joined_positions());
        positions.extend(originals.iter().map(|vertex| self.positions[vertex.index()]));
        Ok(Self { positions, tetrahedra, originals, frame: self.frame, source_cells: self.source_cells.clone() })
    }

    /// Points that are there once: all but those that [`Self::with_points_of_cells`] has put beside them.
    pub fn joined_positions(&self) -> &[glam::DVec3] {
        &self.positions[..self.positions.len() - self.originals.len()]
    }

    /// The tetrahedra over [`Self::joined_positions`], the points of each in ascending order as in [`Self::ascending_tetrahedra`], and in the
    /// order of the tetrahedra themselves: neighbors share points.
    pub fn joined_tetrahedra(&self) -> Vec<[VertexId; 4]> {
        let joined = |tetrahedron: &[VertexId; 4]| {
            let mut sorted = tetrahedron.map(|vertex| self.original(vertex));
            sorted.sort_unstable();
            sorted
        };
        self.tetrahedra.par_iter().map(joined).collect()
    }

    /// Whether there are points beside others at the same place, see [`Self::with_points_of_cells`].
    pub fn has_points_of_cells(&self) -> bool {
        !self.originals.is_empty()
    }

    fn original(&self, vertex: VertexId) -> VertexId {
        let shared = self.positions.len() - self.originals.len();
        vertex.index().checked_sub(shared).map_or(vertex, |copy| self.originals[copy])
    }
}

#[cfg(test)]
mod tests {
    use crate::{FaceAdjacency, decompose, rings_sample};

    #[test]
    fn cells_have_points_of_their_own_and_the_neighbors_they_had() {
        let cut = decompose(&rings_sample(3)).unwrap().mesh;
        let split = cut.with_points_of_cells().unwrap();
        assert_eq!(split.source_cells(), cut.source_cells());
        assert!(split.has_points_of_cells() && !cut.has_points_of_cells());
        assert_eq!(split.joined_positions(), cut.positions());
        assert_eq!(split.joined_tetrahedra(), cut.ascending_tetrahedra());
        // 27 hexahedra of 8 points, behind 64 that they shared.
        assert_eq!(split.positions().len(), 64 + 27 * 8);
        for (a, b) in split.tetrahedra().iter().zip(cut.tetrahedra()) {
            for (a, b) in a.iter().zip(b) {
                assert_eq!(split.positions()[a.index()], cut.positions()[b.index()]);
            }
            // The same corner is the lowest, and so on: shared faces are computed alike.
            let rank = |t: &[crate::VertexId; 4]| t.map(|v| t.iter().filter(|w| **w < v).count());
            assert_eq!(rank(a), rank(b));
        }
        for (i, a) in split.tetrahedra().iter().enumerate() {
            for (j, b) in split.tetrahedra().iter().enumerate() {
                let shares = a.iter().any(|v| b.contains(v));
                assert!(!shares || split.source_cells()[i] == split.source_cells()[j]);
            }
        }
        let joined = FaceAdjacency::new(&split.joined_tetrahedra());
        assert_eq!(joined.table(), FaceAdjacency::new(&cut.ascending_tetrahedra()).table());
        // Some cells less, and once more: still the same places.
        let half = split.retain(|cell| cell.index() % 2 == 0);
        let again = half.with_points_of_cells().unwrap();
        assert_eq!(again.joined_tetrahedra(), half.joined_tetrahedra());
    }
}
