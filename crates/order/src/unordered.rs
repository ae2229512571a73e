//! No order, for what commutes.

use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::{Cells, Guarantee, Order, VisibilityOrder};

/// Leaves the cells as they come: for emission alone and absorption alone, where blending commutes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unordered;

impl VisibilityOrder for Unordered {
    fn order(&self, _: Cells<'_>, _: Viewpoint, drawn: &[CellId]) -> Order {
        Order::whole(drawn.to_vec(), Guarantee::Unsorted)
    }
}
