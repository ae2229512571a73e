//! What visibility orders know of one mesh.

use std::sync::{Arc, OnceLock};

use tetrascope_mesh::{CellId, FaceAdjacency};

use crate::convex::is_convex;
use crate::overlaps::{folded_pairs, overlaps};
use crate::power::may_be_delaunay;
use crate::sides::FaceSides;
use crate::touching::Touch;
use crate::{
    BspTree, BspXmpvo, Bucket, Budget, Cells, Centroid, Heights, Mpvo, OrderMethod, Overlaps, Power, PowerCertificate,
    Unordered, VisibilityOrder,
};

/// What visibility orders know of one mesh: each part is learned once, when first asked for, and shared by all orders.
///
/// Every call takes the cells of the same mesh; orders panic if their number is another one.
#[derive(Debug, Default)]
pub struct MeshVisibility {
    adjacency: OnceLock<Arc<FaceAdjacency>>,
    sides: OnceLock<Arc<FaceSides>>,
    tree: OnceLock<Arc<BspTree>>,
    is_convex: OnceLock<bool>,
    folded: OnceLock<Arc<[(CellId, CellId)]>>,
    /// And what touches but for rounding.
    overlaps: OnceLock<(Overlaps, Arc<[Touch]>)>,
    /// Whether the heights `|p|²` or those given are proven.
    quick: OnceLock<Arc<Power>>,
    power: OnceLock<Arc<Power>>,
    heights: OnceLock<Arc<Vec<f64>>>,
    /// Those that were looked for, since the others are not proven.
    found: OnceLock<Vec<f64>>,
}

/// The cheapest order that is right for a mesh, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OrderChoice {
    /// The order.
    pub method: OrderMethod,
    /// Why, in a few words.
    pub reason: &'static str,
}

impl MeshVisibility {
    /// Knows nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Knows heights that were found before, one a point; they are proven anew before anything rests on them.
    pub fn with_heights(heights: Vec<f64>) -> Self {
        Self { heights: OnceLock::from(Arc::new(heights)), ..Self::default() }
    }

    /// Which cells share faces.
    pub fn adjacency(&self, cells: Cells<'_>) -> &Arc<FaceAdjacency> {
        self.adjacency.get_or_init(|| Arc::new(FaceAdjacency::new(cells.tetrahedra)))
    }

    pub(crate) fn sides(&self, cells: Cells<'_>) -> &Arc<FaceSides> {
        self.sides.get_or_init(|| Arc::new(FaceSides::new(cells, self.adjacency(cells))))
    }

    /// The tree of the boundary faces.
    pub fn tree(&self, cells: Cells<'_>) -> &Arc<BspTree> {
        self.tree.get_or_init(|| Arc::new(BspTree::new(cells, self.adjacency(cells))))
    }

    /// Whether the mesh is convex: one piece, and no ray leaves it and enters it again.
    pub fn is_convex(&self, cells: Cells<'_>) -> bool {
        *self.is_convex.get_or_init(|| is_convex(cells, self.adjacency(cells)))
    }

    /// Where cells overlap, so that no order is right.
    pub fn overlaps(&self, cells: Cells<'_>) -> Overlaps {
        self.meetings(cells).0
    }

    /// Faces that touch, and overlap by no more than rounding.
    pub(crate) fn touching(&self, cells: Cells<'_>) -> &[Touch] {
        &self.meetings(cells).1
    }

    fn meetings(&self, cells: Cells<'_>) -> &(Overlaps, Arc<[Touch]>) {
        self.overlaps.get_or_init(|| {
            let (overlaps, touching) = overlaps(cells, self.adjacency(cells), self.folded(cells).len());
            (overlaps, touching.into())
        })
    }

    /// The same if it was looked for already; an order that depends on it has.
    pub fn known_overlaps(&self) -> Option<Overlaps> {
        self.overlaps.get().map(|(overlaps, _)| *overlaps)
    }

    /// Pairs of cells that lie on one side of a face which both have.
    pub(crate) fn folded(&self, cells: Cells<'_>) -> &Arc<[(CellId, CellId)]> {
        self.folded.get_or_init(|| folded_pairs(cells, self.adjacency(cells)).into())
    }

    /// One key a cell, from the heights given or else from those that [`Heights::solve`] finds.
    pub fn power(&self, cells: Cells<'_>) -> &Arc<Power> {
        self.power.get_or_init(|| {
            let quick = self.quick_power(cells);
            if quick.certificate().is_exact() {
                return Arc::clone(quick);
            }
            let adjacency = self.adjacency(cells);
            let heights = self.found.get_or_init(|| Heights::solve(cells, adjacency, Budget::default()).values);
            Arc::new(self.with_gaps(Power::with_heights(cells, adjacency, heights), cells))
        })
    }

    /// The heights that [`Self::power`] looked for, one a point; `None` if it did not have to, or was not asked yet.
    pub fn found_heights(&self) -> Option<&[f64]> {
        self.found.get().map(Vec::as_slice)
    }

    /// What is proven of the heights given, or of `|p|²` without any: whether the mesh is Delaunay.
    pub fn quick_certificate(&self, cells: Cells<'_>) -> PowerCertificate {
        self.quick_power(cells).certificate()
    }

    fn quick_power(&self, cells: Cells<'_>) -> &Arc<Power> {
        self.quick.get_or_init(|| {
            let adjacency = self.adjacency(cells);
            let power = match self.heights.get() {
                Some(heights) => Power::with_heights(cells, adjacency, heights),
                None => Power::with_adjacency(cells, adjacency, Budget { visits_per_face: 0 }),
            };
            Arc::new(self.with_gaps(power, cells))
        })
    }

    fn with_gaps(&self, power: Power, cells: Cells<'_>) -> Power {
        if power.certificate().is_exact() {
            power.prove_gaps(cells, self.adjacency(cells), self.is_convex(cells))
        } else {
            power
        }
    }

    /// The cheapest order that is right for the mesh from everywhere, but for cells in rings.
    ///
    /// No heights are looked for: that takes longer than many frames. Those given count, and those that [`Self::power`] has found.
    pub fn choose(&self, cells: Cells<'_>) -> OrderChoice {
        let known = self.power.get().or_else(|| self.quick.get()).or_else(|| {
            // Its keys need not be made where one face speaks against it.
            let may_be = self.heights.get().is_some() || may_be_delaunay(cells, self.adjacency(cells));
            may_be.then(|| self.quick_power(cells))
        });
        if known.is_some_and(|power| power.certificate().is_exact_across_gaps()) {
            let reason = if self.is_convex(cells) {
                "one key a cell is proven to be exact"
            } else {
                "one key a cell is proven to be exact, across gaps too"
            };
            return OrderChoice { method: OrderMethod::Power, reason };
        }
        if !self.is_convex(cells) {
            let overlaps = self.overlaps(cells);
            if overlaps.piercing > 0 || overlaps.contained > 0 {
                let reason =
                    "parts of the mesh stand in one another, where no order of cells is right: every pixel sorts";
                return OrderChoice { method: OrderMethod::PerPixel, reason };
            }
            let reason = "the mesh is not convex: neighbors by their faces, and across gaps by the boundary's";
            return OrderChoice { method: OrderMethod::BspXmpvo, reason };
        }
        OrderChoice { method: OrderMethod::Mpvo, reason: "the mesh is convex: neighbors by the planes between them" }
    }

    fn mpvo(&self, cells: Cells<'_>) -> Mpvo {
        Mpvo::with_parts(
            Arc::clone(self.adjacency(cells)),
            Arc::clone(self.sides(cells)),
            self.is_convex(cells),
            Arc::clone(self.folded(cells)),
        )
    }

    /// A method, ready for the mesh: what it has to know of it is learned here, once.
    ///
    /// [`OrderMethod::pixel_sort`] is left to the back end.
    pub fn prepare(&self, cells: Cells<'_>, method: OrderMethod) -> Arc<dyn VisibilityOrder> {
        match method {
            OrderMethod::None | OrderMethod::PerPixel => Arc::new(Unordered),
            OrderMethod::Bucket { slabs } => Arc::new(Bucket { slabs }),
            OrderMethod::Centroid | OrderMethod::KBuffer { .. } => Arc::new(Centroid),
            OrderMethod::Power => Arc::clone(self.power(cells)) as Arc<dyn VisibilityOrder>,
            OrderMethod::Mpvo => Arc::new(self.mpvo(cells)),
            OrderMethod::BspXmpvo => {
                if self.is_convex(cells) {
                    return Arc::new(BspXmpvo::with_parts(self.mpvo(cells), None, false, Arc::new([])));
                }
                let (overlaps, touching) = self.meetings(cells);
                let tree = Some(Arc::clone(self.tree(cells)));
                Arc::new(BspXmpvo::with_parts(self.mpvo(cells), tree, overlaps.any(), Arc::clone(touching)))
            }
        }
    }
}
