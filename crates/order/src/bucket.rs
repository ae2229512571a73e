//! Cells put into slabs of depth.

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::{Cells, Guarantee, Order, VisibilityOrder};

/// Puts the centroids into slabs of equal depth and leaves the cells of a slab as they come.
///
/// Source: [Marroquim 2006], section 3.2, who use about 20 slabs while the view changes. Depth is the distance from the
/// eye, or that along a parallel view's direction. One counting pass, no sort, unless there are far more slabs than cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bucket {
    /// Number of slabs, at least 1.
    pub slabs: u32,
}

impl Bucket {
    /// The paper's number of slabs.
    pub const DEFAULT_SLABS: u32 = 20;

    /// Slabs that are counted however few the cells are. Beyond, and beyond the number of cells, counting would take memory for every slab:
    /// 32 GiB for all that a scene can ask for.
    const ALWAYS_COUNTED: usize = 1 << 16;
}

impl Default for Bucket {
    fn default() -> Self {
        Self { slabs: Self::DEFAULT_SLABS }
    }
}

impl VisibilityOrder for Bucket {
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        let depth = |cell: &CellId| match viewpoint {
            Viewpoint::Eye(eye) => (cells.centroid(*cell) - eye).length(),
            Viewpoint::Direction(direction) => cells.centroid(*cell).dot(direction),
        };
        let depths: Vec<f64> = drawn.par_iter().map(depth).collect();
        let (lowest, highest) =
            depths.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &d| (low.min(d), high.max(d)));
        let slabs = self.slabs.max(1) as usize;
        let thickness = (highest - lowest) / slabs as f64;
        // A float below zero or NaN (all cells at one depth) becomes slab 0.
        let slab_of = |depth: f64| (((depth - lowest) / thickness) as usize).min(slabs - 1);

        if slabs > drawn.len().max(Self::ALWAYS_COUNTED) {
            let mut by_slab: Vec<(usize, CellId)> =
                drawn.iter().zip(&depths).map(|(&cell, &d)| (slab_of(d), cell)).collect();
            // Stable, as counting is: the order is the same.
            by_slab.par_sort_by_key(|&(slab, _)| slab);
            return Order::whole(by_slab.into_iter().map(|(_, cell)| cell).collect(), Guarantee::Approximate);
        }

        let mut starts = vec![0_usize; slabs + 1];
        for &d in &depths {
            starts[slab_of(d) + 1] += 1;
        }
        for slab in 0..slabs {
            starts[slab + 1] += starts[slab];
        }
        let mut front_to_back = vec![CellId(0); drawn.len()];
        for (&cell, &d) in drawn.iter().zip(&depths) {
            let next = &mut starts[slab_of(d)];
            front_to_back[*next] = cell;
            *next += 1;
        }
        Order::whole(front_to_back, Guarantee::Approximate)
    }
}
