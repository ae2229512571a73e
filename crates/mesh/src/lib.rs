//! The mesh model: points, cells of any kind, and the tetrahedra they are cut into.
//!
//! A reader hands over a [`Dataset`]: points in world coordinates, cells of any kind, and named arrays.
//! [`decompose`] cuts it into a [`TetMesh`] by a fixed rule and says what it left out. From there on only tetrahedra exist:
//! [`FaceAdjacency`] joins them face to face (it knows no positions), [`check`] says what is wrong with them, and
//! [`vertex_gradients`] and [`chord_lengths`], the mean and longest way of rays inside cells, are computed only when
//! something asks for them.
//!
//! Coordinates are f64 in a [`Frame`] of the mesh's own, so that neither a cube of a nanometer nor one at a northing of
//! five million loses anything. Which way round a tetrahedron lies, and whether it has a volume at all, is decided
//! exactly.
//!
//! ```
//! use tetrascope_mesh::{CellId, FaceAdjacency, check, decompose, rings_sample, vertex_gradients};
//!
//! let dataset = rings_sample(8);
//! let cut = decompose(&dataset)?;
//! let scalars = cut.point_scalars(&dataset.point_arrays[0].component(0));
//! let adjacency = FaceAdjacency::new(cut.mesh.tetrahedra());
//! assert_eq!(cut.mesh.tetrahedra().len(), 5 * 8 * 8 * 8);
//! assert!(adjacency.neighbor(CellId(0), 0).is_some());
//! assert!(check(&cut, &adjacency).findings().is_empty());
//! assert_eq!(vertex_gradients(&cut.mesh, &scalars).len(), dataset.points.len());
//! # Ok::<(), tetrascope_mesh::MeshError>(())
//! ```
//!
//! Limits: 2³² - 1 points and 2³⁰ - 1 tetrahedra. Points that coincide are not joined, and a mesh that overlaps itself
//! is reported, not mended. Cells of higher than second order, and VTK's quadratic polygons and polyhedra, are counted
//! and left out.
//!
//! The crate knows no camera, no color and no file.

mod adjacency;
mod check;
mod chords;
mod dataset;
mod decompose;
mod error;
mod frame;
mod gradient;
mod ids;
mod orientation;
mod points_of_cells;
mod renderer_units;
mod sample;
mod tet_mesh;

pub use adjacency::{CellFace, FaceAdjacency};
pub use check::{MeshReport, check};
pub use chords::{ChordLengths, chord_lengths, segment_lengths};
pub use dataset::{ArrayValues, CellKind, Cells, DataArray, Dataset, StructuredBlock, UnstructuredCells};
pub use decompose::{AddedPoint, Decomposition, DecompositionCounts, cell_data_to_points, check_layout, decompose};
pub use error::MeshError;
pub use frame::Frame;
pub use gradient::{point_gradients, vertex_gradients};
pub use ids::{CellId, FaceId, VertexId};
pub use renderer_units::{ascending, scalar_base, scalar_factor, scalar_range};
pub use sample::rings_sample;
pub use tet_mesh::TetMesh;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
