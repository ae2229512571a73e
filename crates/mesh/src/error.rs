//! Why a dataset has no mesh to draw.

use thiserror::Error;

/// What was wrong with a dataset as a whole. Single bad cells are counted instead, see
/// [`DecompositionCounts`](crate::DecompositionCounts).
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no point.
    #[error("the mesh has no points: check that the file holds the geometry and not only its data")]
    NoPoints,
    /// There are points but no cells.
    #[error(
        "the mesh has {points} points but no cells: only cells can be drawn as a volume, so triangulate the points first"
    )]
    NoCells {
        /// Number of points.
        points: usize,
    },
    /// No cell could be used at all.
    #[error(
        "the mesh has no three-dimensional cell that can be drawn: of {cells} cells {left_out}; give it tetrahedra, \
         hexahedra, wedges, pyramids or polyhedra with finite coordinates"
    )]
    NoSolidCell {
        /// Number of cells.
        cells: usize,
        /// What they were, in words.
        left_out: String,
    },
    /// Cells were cut, but no tetrahedron has a volume.
    #[error(
        "the mesh has no cell with volume: all {tetrahedra} tetrahedra are flat; check that coordinates were not rounded \
         or flattened, for instance by storing them in 32 bits far from the origin"
    )]
    NoVolume {
        /// Tetrahedra that were looked at.
        tetrahedra: usize,
    },
    /// More points, cells or tetrahedra than 32-bit indices can name.
    #[error("the mesh has {count} {what}, more than the {limit} that can be numbered: cut it into parts")]
    TooLarge {
        /// `"points"`, `"cells"` or `"tetrahedra"`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The arrays that lay out the cells contradict each other; a reader should have refused them.
    #[error("the cells' layout contradicts itself: {what} (at {index}: {value}, limit {limit})")]
    Inconsistent {
        /// Which rule of [`UnstructuredCells`](crate::UnstructuredCells) or
        /// [`StructuredBlock`](crate::StructuredBlock) is broken.
        what: &'static str,
        /// Where: the index of the entry or block.
        index: usize,
        /// What stands there.
        value: usize,
        /// What would have been right or the bound that it breaks.
        limit: usize,
    },
}
