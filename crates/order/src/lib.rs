//! Visibility orders: which tetrahedron is blended before which.
//!
//! Every method is a [`VisibilityOrder`]: it is given the points and cells of a mesh, where rays come from, and which cells are
//! to be drawn; it gives an [`Order`], a permutation of those cells from front to back, with a [`Guarantee`] that says
//! how far it can be trusted. [`OrderMethod`] names the methods as a scene file does; [`MeshVisibility`] makes them and knows which one a mesh
//! needs.
//!
//! ```
//! use glam::DVec3;
//! use tetrascope_mesh::{CellId, VertexId};
//! use tetrascope_order::{Cells, MeshVisibility, OrderMethod};
//! use tetrascope_view::Viewpoint;
//!
//! let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(1.0)];
//! let tetrahedra = [[0, 1, 2, 3].map(VertexId), [1, 2, 3, 4].map(VertexId)];
//! let cells = Cells { positions: &points, tetrahedra: &tetrahedra };
//! let mpvo = MeshVisibility::new().prepare(cells, OrderMethod::Mpvo);
//! let order = mpvo.order(cells, Viewpoint::Eye(DVec3::splat(9.0)), &[CellId(0), CellId(1)]);
//! assert_eq!(order.front_to_back, [CellId(1), CellId(0)]);
//! ```
//!
//! [`Bucket`] and [`Centroid`] sort by one point of a cell and may be wrong for neighbors of different shape. [`Mpvo`] is right for all
//! neighbors, and so for convex meshes; [`BspXmpvo`] is right across the gaps of a mesh too, which [`BspTree`] knows. [`Power`] sorts
//! by one key a cell, and proves for a mesh that this is exact, or says that it is not. [`MeshVisibility::judge`] counts what any
//! order has wrong.
//!
//! Cells that hide one another in a ring have no order. [`Mpvo`] and [`BspXmpvo`] report them in [`Order::cycles`];
//! [`Order::cut_cycles`] cuts them so that there is one, or a back end sorts their pixels ([`CycleRemedy`]).
//!
//! Limits: cells that overlap have no order either; [`MeshVisibility::overlaps`] tells whether there are any. The crate knows no color and no pixel.

mod bsp;
mod bsp_xmpvo;
mod bucket;
mod centroid;
mod convex;
mod cut;
mod cycles;
mod gaps;
mod judge;
mod method;
mod mpvo;
mod overlaps;
mod planes;
mod power;
mod radix;
mod remedy;
mod repair;
mod sides;
mod signs;
mod steps;
mod sweep;
mod touching;
mod unordered;
mod visibility;

use glam::DVec3;
use tetrascope_mesh::{CellId, TetMesh, VertexId};
use tetrascope_view::Viewpoint;

pub use bsp::{ArrowReport, BoundaryFragment, BspTree, TreeReport};
pub use bsp_xmpvo::BspXmpvo;
pub use bucket::Bucket;
pub use centroid::Centroid;
pub use judge::{Relations, Verdict};
pub use method::{OrderMethod, PixelSort, UnknownOrder};
pub use mpvo::{Mpvo, misordered_faces};
pub use overlaps::Overlaps;
pub use power::{Budget, HeightSource, Heights, Power, PowerCertificate};
pub use radix::{sort_by_key, sortable_bits};
pub use remedy::{CycleRemedy, UnknownRemedy};
pub use unordered::Unordered;
pub use visibility::{MeshVisibility, OrderChoice};

/// The geometry that an order looks at: points and the tetrahedra over them.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// Points, in the same coordinates as the viewpoint; those that cells use are finite.
    pub positions: &'a [DVec3],
    /// Four points each.
    pub tetrahedra: &'a [[VertexId; 4]],
}

impl<'a> From<&'a TetMesh> for Cells<'a> {
    fn from(mesh: &'a TetMesh) -> Self {
        Self { positions: mesh.positions(), tetrahedra: mesh.tetrahedra() }
    }
}

impl Cells<'_> {
    /// The mean of a cell's corners.
    #[inline]
    pub fn centroid(&self, cell: CellId) -> DVec3 {
        let [a, b, c, d] = self.tetrahedra[cell.index()].map(|v| self.positions[v.index()]);
        (a + b + c + d) * 0.25
    }
}

/// Cells from front to back, and what that is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The cells that were asked for, the nearest first: each once, or as often as it has pieces.
    pub front_to_back: Vec<CellId>,
    /// Cells that were cut, one entry a piece, by ascending place. None unless [`Self::cut_cycles`] made them.
    pub pieces: Vec<Piece>,
    /// How far the permutation can be trusted.
    pub guarantee: Guarantee,
    /// Rings of cells that hide one another, among all cells of the mesh, where the method looks for them: no order of whole cells is
    /// right there. Each as its cells, ascending; rings that share a cell are one. In [`Self::front_to_back`] a ring's cells come one right
    /// after the other, by the distance of their centroids.
    pub cycles: Vec<Vec<CellId>>,
}

/// A part of a cell that was cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its place in [`Order::front_to_back`].
    pub place: u32,
    /// What cuts it: a point of the cell belongs to the piece if it lies behind all these planes. Two pieces that meet in a plane have
    /// it with the same point and opposite normals.
    pub planes: Vec<CutPlane>,
}

/// A plane; what lies behind it is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPlane {
    /// A point of the plane, in the coordinates of the cells.
    pub point: DVec3,
    /// Away from what is kept, of any length but 0.
    pub normal: DVec3,
}

impl Order {
    /// Whole cells in an order without rings.
    pub fn whole(front_to_back: Vec<CellId>, guarantee: Guarantee) -> Self {
        Self { front_to_back, pieces: Vec::new(), guarantee, cycles: Vec::new() }
    }
}

/// How far an order can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Guarantee {
    /// Nothing was sorted: right where the blending commutes, and only there.
    Unsorted,
    /// Cells are sorted by one number that approximates their depth: neighbors may come in the wrong order, and nothing says where.
    Approximate,
    /// Of two cells that share a face the nearer one comes first, but for the cells in [`Order::cycles`]: right where the mesh is
    /// convex. Across gaps of the mesh it is a guess.
    Faces,
    /// Of two cells on one ray the nearer one comes first, but for the cells in [`Order::cycles`].
    Exact,
    /// The same for cells that do not overlap; but some of the mesh do ([`Overlaps`]), and those have no order. Where they share a face
    /// they are in [`Order::cycles`] too.
    Overlapping,
}

/// A way to sort cells by visibility.
///
/// Shared between threads; what a method learns of a mesh once it keeps to itself.
pub trait VisibilityOrder: std::fmt::Debug + Send + Sync {
    /// The `drawn` cells from front to back, seen from `viewpoint`.
    ///
    /// The same for any number of threads. Where some cells are on no common ray, their order may depend on the views before; nothing
    /// that is drawn does.
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order;

    /// Bytes that it keeps of the mesh from frame to frame, parts that it shares with other orders included.
    fn kept_bytes(&self) -> usize {
        0
    }
}

#[cfg(test)]
mod cycles_tests;
#[cfg(test)]
mod mpvo_tests;
#[cfg(test)]
mod overlaps_tests;
#[cfg(test)]
mod radix_tests;
#[cfg(test)]
mod repair_tests;
#[cfg(test)]
mod sides_tests;
#[cfg(test)]
mod steps_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod touching_tests;
