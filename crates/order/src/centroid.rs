//! Cells sorted by the depth of their centroids.

use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::steps::sort_cells;
use crate::{Cells, Guarantee, Order, VisibilityOrder};

/// Sorts by the centroid: its distance from the eye, or its depth in a parallel view.
///
/// The papers sort by the centroid's depth along the view axis ([Marroquim 2006], section 3.2). The distance from
/// the eye costs the same and is far better in perspective: on a regular grid 0.01 % of neighbors come in the wrong order
/// instead of 9 %. Keys have 36 bits of their range; cells with equal keys stay as they come.
#[derive(Clone, Copy, Debug, Default)]
pub struct Centroid;

impl VisibilityOrder for Centroid {
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        let front_to_back = nearest_first(cells, viewpoint, drawn);
        Order::whole(front_to_back, Guarantee::Approximate)
    }
}

/// Cells by the distance of their centroids, or by their depth in a parallel view.
pub(crate) fn nearest_first(cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Vec<CellId> {
    match viewpoint {
        Viewpoint::Eye(eye) => sort_cells(drawn, |cell| (cells.centroid(cell) - eye).length_squared()),
        Viewpoint::Direction(direction) => sort_cells(drawn, |cell| cells.centroid(cell).dot(direction)),
    }
}
