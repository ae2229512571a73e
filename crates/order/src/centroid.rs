//! Cells sorted by the depth of their centroids.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::{Cells, Guarantee, Order, VisibilityOrder, sort_by_key, sortable_bits};

/// Sorts by the centroid: its distance from the eye, or its depth in a parallel view.
///
/// The papers sort by the centroid's depth along the view axis ([Marroquim 2006], section 3.2). The distance from
/// the eye costs the same and is far better in perspective: on a regular grid 0.01 % of neighbors come in the wrong order
/// instead of 9 %. Keys have 32 bits; cells with equal keys stay as they come.
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
    let mut keyed: Vec<(u32, CellId)> = Vec::with_capacity(drawn.len());
    match viewpoint {
        Viewpoint::Eye(eye) => drawn
            .par_iter()
            .map(|&cell| (sortable_bits((cells.centroid(cell) - eye).length_squared() as f32), cell))
            .collect_into_vec(&mut keyed),
        Viewpoint::Direction(direction) => drawn
            .par_iter()
            .map(|&cell| (sortable_bits(depth_along(direction, &cells, cell) as f32), cell))
            .collect_into_vec(&mut keyed),
    }
    sort_by_key(&mut keyed);
    keyed.into_iter().map(|(_, cell)| cell).collect()
}

fn depth_along(direction: DVec3, cells: &Cells<'_>, cell: CellId) -> f64 {
    cells.centroid(cell).dot(direction)
}
