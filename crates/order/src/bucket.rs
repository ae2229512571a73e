//! Cells put into slabs of depth.

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::{Cells, Guarantee, Order, VisibilityOrder};

/// Puts the centroids into slabs of equal depth and leaves the cells of a slab as they come.
///
/// Source: [Marroquim 2006], section 3.2, who use about 20 slabs while the view changes. Depth is the distance from the
/// eye, or that along a parallel view's direction. One counting pass, no sort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bucket {
    /// Number of slabs, at least 1.
    pub slabs: u32,
}

impl Bucket {
    /// The paper's number of slabs.
    pub const DEFAULT_SLABS: u32 = 20;
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
