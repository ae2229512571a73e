//! The mesh model: points, cells of any kind, and the tetrahedra they are cut into.
//!
//! A reader hands over a [`Dataset`]: points in world coordinates, cells of any kind, and named arrays.
//! [`decompose`] cuts it into a [`TetMesh`] by a fixed rule and says what it left out. From there on only tetrahedra exist:
//! [`FaceAdjacency`] joins them face to face (it knows no positions), [`check`] says what is wrong with them, and
//! [`vertex_gradients`] is computed only when something asks for it.
//!
//! The crate knows no camera, no color and no file.

mod adjacency;
mod check;
mod dataset;
mod decompose;
mod error;
mod frame;
mod gradient;
mod ids;
mod orientation;
mod sample;
mod tet_mesh;

pub use adjacency::{CellFace, FaceAdjacency};
pub use check::{MeshReport, check};
pub use dataset::{ArrayValues, CellKind, Cells, DataArray, Dataset, StructuredBlock, UnstructuredCells};
pub use decompose::{AddedPoint, Decomposition, DecompositionCounts, cell_data_to_points, decompose};
pub use error::MeshError;
pub use frame::Frame;
pub use gradient::vertex_gradients;
pub use ids::{CellId, FaceId, VertexId};
pub use sample::rings_sample;
pub use tet_mesh::TetMesh;
