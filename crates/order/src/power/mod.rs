//! One key per cell: exact wherever heights of the points lift the mesh to a convex surface.
//!
//! Give every point a height, and every cell the affine function `H` that takes these heights at its corners. If the piecewise
//! linear whole is strictly convex across every interior face, then at any eye the nearer of two cells that share a face has the
//! larger `H(eye)`: the difference of their functions vanishes on the face's plane and is positive on the nearer cell's
//! side. So `-H(eye)` sorts front to back, for every eye, inside and outside ([Edelsbrunner 1990]). With the heights `|p|²` these are
//! the Delaunay meshes, and the key is the power of the eye with respect to the circumsphere. For other meshes heights are
//! looked for once, at load ([`Heights::solve`]), and what they are worth is proven face by face ([`PowerCertificate`]).
//! Where some eye sees a cycle, no heights exist.

mod certify;
mod double;
mod frame;
mod gaps;
mod heights;
mod keys;
mod lifted;
mod quadratic;
mod relax;
mod settle;

pub use certify::PowerCertificate;
pub use heights::{Budget, HeightSource, Heights};

use std::sync::OnceLock;

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency};
use tetrascope_view::Viewpoint;

use crate::{Cells, Guarantee, Order, VisibilityOrder};
use certify::certify;
use frame::Frame;
use keys::{CellKey, Extent, Rest};
use settle::{Closer, settle};

/// One cell in so many is doubtful in a frame for which more is learned of all cells, once: a view along the rows of
/// a grid, and hardly any other.
const MANY: usize = 16;

/// Whether `|p|²` orders a mesh across all faces, as far as signs in f64 tell: false at the first face that it does not order.
///
/// Far cheaper than a certificate where most faces are in order and some are not.
pub(crate) fn may_be_delaunay(cells: Cells<'_>, adjacency: &FaceAdjacency) -> bool {
    let center = heights::middle(cells);
    let squares: Vec<f64> = cells.positions.par_iter().map(|&p| (p - center).length_squared()).collect();
    !certify::is_any_violated(cells, adjacency, &squares)
}

/// Sorts by the height that a cell's affine function takes at the eye: one key a cell, one radix sort.
///
/// Cells that share a face come in the right order from every viewpoint if [`PowerCertificate::is_exact`]. Keys are sorted by 36
/// bits; cells whose keys are nearer than that resolves are compared in f64, and those nearer than f64 is sure of by the
/// exact side of their common faces. Cells that meet edge-on keep the order of `drawn` where nothing else decides. Memory: 32
/// bytes a cell and 8 a point, and up to 48 more a cell from the first frame on in which many cells have nearly equal keys, as along
/// the rows of a grid; that frame takes about a microsecond a cell. It orders the mesh it was made for, and no other.
///
/// The order's [`Guarantee`] is `Exact` if [`PowerCertificate::is_exact_across_gaps`], `Faces` if only [`PowerCertificate::is_exact`], and
/// else `Approximate`. Where it is `Exact`, cells that share no face are told apart down to 1e-30 of what cancels in their keys;
/// else those whose keys agree to rounding only through cells that are drawn.
#[derive(Clone, Debug)]
pub struct Power {
    keys: Vec<CellKey>,
    center: DVec3,
    /// Half the sum of the sides of the box around the points: bounds what rounding a gradient moves at the center.
    reach: f64,
    /// Of all keys: bounds their errors, in most frames well enough.
    extent: Extent,
    /// Of every cell, from the first frame on that has many cells with nearly equal keys.
    rests: OnceLock<Vec<Rest>>,
    /// Which cells share faces, likewise.
    adjacency: OnceLock<FaceAdjacency>,
    /// One a position.
    heights: Vec<f64>,
    certificate: PowerCertificate,
}

impl Power {
    /// Looks for heights within [`Budget::default`] and proves what they are worth.
    pub fn new(cells: Cells<'_>) -> Self {
        Self::with_adjacency(cells, &FaceAdjacency::new(cells.tetrahedra), Budget::default())
    }

    /// The same for an adjacency that is there already, and a budget.
    pub fn with_adjacency(cells: Cells<'_>, adjacency: &FaceAdjacency, budget: Budget) -> Self {
        Self::with_heights(cells, adjacency, &Heights::solve(cells, adjacency, budget).values)
    }

    /// For heights that were found before, one a position. They are proven anew: any heights give an order, wrong ones a bad
    /// one that the certificate tells. Missing heights count as 0.
    pub fn with_heights(cells: Cells<'_>, adjacency: &FaceAdjacency, heights: &[f64]) -> Self {
        let mut heights = heights.to_vec();
        heights.resize(cells.positions.len(), 0.0);
        let center = heights::middle(cells);
        let extent = |v: &tetrascope_mesh::VertexId| (cells.positions[v.index()] - center).abs();
        let half = cells.tetrahedra.par_iter().flatten_iter().map(extent).reduce(|| DVec3::ZERO, DVec3::max);
        let found: Vec<(CellKey, bool)> = cells
            .tetrahedra
            .par_iter()
            .map(|corners| {
                let positions = corners.map(|v| cells.positions[v.index()]);
                CellKey::new(positions, corners.map(|v| heights[v.index()]), center)
            })
            .collect();
        let imprecise = found.iter().filter(|(_, is_precise)| !is_precise).count();
        let certificate = PowerCertificate { imprecise, ..certify(cells, adjacency, &heights) };
        let keys: Vec<CellKey> = found.into_iter().map(|(key, _)| key).collect();
        let extent = keys.par_iter().map(CellKey::extent).reduce(Extent::default, Extent::max);
        Self {
            keys,
            center,
            reach: half.element_sum(),
            extent,
            rests: OnceLock::new(),
            adjacency: OnceLock::new(),
            heights,
            certificate,
        }
    }

    /// Proves what can be proven across the gaps of the mesh: [`PowerCertificate::gaps`].
    ///
    /// Nothing is looked at where faces alone are not in order. Some microseconds a boundary face.
    ///
    /// - `is_convex`: whether the mesh has no gaps; believed
    #[must_use]
    pub fn prove_gaps(mut self, cells: Cells<'_>, adjacency: &FaceAdjacency, is_convex: bool) -> Self {
        if self.certificate.is_exact() {
            let gaps = if is_convex {
                0
            } else {
                gaps::unproven(cells, adjacency, &self.heights, &self.keys, self.center, self.reach)
            };
            self.certificate.gaps = Some(gaps);
        }
        self
    }

    /// How far the order can be trusted.
    pub fn guarantee(&self) -> Guarantee {
        if self.certificate.is_exact_across_gaps() {
            Guarantee::Exact
        } else if self.certificate.is_exact() {
            Guarantee::Faces
        } else {
            Guarantee::Approximate
        }
    }

    /// What is proven about this order.
    pub fn certificate(&self) -> PowerCertificate {
        self.certificate
    }

    /// The point that the functions of cells are counted from, in the coordinates of the mesh.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// A cell's affine function as gradient and constant: `constant + gradient · (p - center)`, larger for the nearer of two cells
    /// that share a face. Rounded to f64; along a direction the cell with the lower slope is nearer.
    ///
    /// # Panics
    ///
    /// If there is no such cell.
    pub fn function(&self, cell: CellId) -> (DVec3, f64) {
        let key = &self.keys[cell.index()];
        (key.gradient(), key.constant())
    }

    fn rest(&self, cells: Cells<'_>, cell: CellId) -> Rest {
        let corners = cells.tetrahedra[cell.index()];
        let positions = corners.map(|v| cells.positions[v.index()]);
        Rest::new(positions, corners.map(|v| self.heights[v.index()]), self.center)
    }

    #[inline(always)]
    fn key(&self, cell: CellId, viewpoint: Viewpoint) -> keys::Key {
        self.keys[cell.index()].at(viewpoint, self.center, self.reach)
    }
}

impl VisibilityOrder for Power {
    fn kept_bytes(&self) -> usize {
        let rests = self.rests.get().map_or(0, |rests| size_of_val(rests.as_slice()));
        let neighbors = self.adjacency.get().map_or(0, |adjacency| size_of_val(adjacency.table()));
        size_of_val(self.keys.as_slice()) + size_of_val(self.heights.as_slice()) + rests + neighbors
    }

    /// # Panics
    ///
    /// If `cells` is not the mesh that it was made for, in number.
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        assert_eq!(cells.tetrahedra.len(), self.keys.len(), "an order is made for one mesh");
        let guarantee = self.guarantee();
        let frame = Frame::new(self, viewpoint, drawn);
        // Faces tell neighbors apart; only what is proven across gaps needs more.
        let is_precise = guarantee == Guarantee::Exact;
        let doubtful: usize = frame.runs.iter().map(ExactSizeIterator::len).sum();
        let are_many = doubtful > drawn.len() / MANY;
        let adjacency = are_many.then(|| self.adjacency.get_or_init(|| FaceAdjacency::new(cells.tetrahedra)));
        let rests = (is_precise && are_many).then(|| {
            self.rests.get_or_init(|| {
                (0..cells.tetrahedra.len()).into_par_iter().map(|cell| self.rest(cells, CellId(cell as u32))).collect()
            })
        });
        let precise = |cell: CellId| {
            if !is_precise {
                return None;
            }
            let rest = rests.map_or_else(|| self.rest(cells, cell), |rests| rests[cell.index()]);
            self.keys[cell.index()].precise(rest, viewpoint, self.center)
        };
        let closer = Closer { cells, viewpoint, adjacency, key: |cell| self.key(cell, viewpoint), precise };
        Order::whole(settle(frame, &closer), guarantee)
    }
}

#[cfg(test)]
mod gap_tests;
#[cfg(test)]
mod tests;
