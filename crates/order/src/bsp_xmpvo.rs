//! Neighbors by the planes between them, and across gaps by the boundary's faces.

use std::sync::Arc;

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::gaps::Gaps;
use crate::overlaps::both_ways;
use crate::touching::Touch;
use crate::{BspTree, Cells, Guarantee, Mpvo, Order, VisibilityOrder};

/// [`Mpvo`] with the relations that it misses where a mesh is not convex: those that [`BspTree::arrows`] finds across gaps.
///
/// Right for every two cells that a ray meets, also where it leaves the mesh in between; the guarantee says if relations are missing, since
/// there were too many to compare. Where cells hide one another in a ring, by faces or across gaps, no order is right: the ring is
/// reported in [`Order::cycles`].
///
/// No centroid is looked at but for the cells of a ring: which of two cells that no ray meets both of comes first
/// follows from their numbers, or from views before, see [`Mpvo`].
///
/// Source: [Comba 1999].
#[derive(Clone, Debug)]
pub struct BspXmpvo {
    mpvo: Mpvo,
    /// `None` where the mesh is convex.
    tree: Option<Arc<BspTree>>,
    /// Whether cells of the mesh are known to overlap.
    overlaps: bool,
    /// Faces between cells that overlap by no more than rounding, across which there is no gap.
    touching: Arc<[Touch]>,
}

impl BspXmpvo {
    pub(crate) fn with_parts(mpvo: Mpvo, tree: Option<Arc<BspTree>>, overlaps: bool, touching: Arc<[Touch]>) -> Self {
        Self { mpvo, tree, overlaps, touching }
    }
}

impl VisibilityOrder for BspXmpvo {
    fn kept_bytes(&self) -> usize {
        self.mpvo.kept_bytes() + self.tree.as_ref().map_or(0, |tree| tree.bytes()) + size_of_val(self.touching.as_ref())
    }

    /// # Panics
    ///
    /// If `cells` is not the mesh that it was made for, in number.
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        let across = || {
            let Some(tree) = &self.tree else {
                return (Gaps::default(), true);
            };
            let mut arrows = Vec::new();
            let report = tree.arrows(viewpoint, &mut |front, back| {
                // A cell that meets itself, by faces that rounding folded, is no ring.
                if front != back {
                    arrows.push((front, back));
                }
            });
            if !self.mpvo.folded().is_empty() || !self.touching.is_empty() {
                arrows.extend(both_ways(self.mpvo.folded()));
                arrows.extend(self.touching.iter().filter_map(|touch| touch.arrow(viewpoint)));
                arrows.par_sort_unstable();
                arrows.dedup();
            }
            (Gaps::new(cells.tetrahedra.len(), &arrows), report.is_complete)
        };
        let (faces, (gaps, is_complete)) = rayon::join(|| self.mpvo.waiting(cells, viewpoint), across);
        let guarantee = match is_complete {
            true if self.overlaps => Guarantee::Overlapping,
            true => Guarantee::Exact,
            false => Guarantee::Faces,
        };
        self.mpvo.swept(cells, viewpoint, drawn, faces, &gaps, guarantee)
    }
}
