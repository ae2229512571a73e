//! Neighbors by the planes between them, and across gaps by the boundary's faces.

use std::sync::Arc;

use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::{BspTree, Cells, Mpvo, Order, VisibilityOrder};

/// [`Mpvo`] with the relations that it misses where a mesh is not convex.
///
/// Source: [Comba 1999].
#[derive(Clone, Debug)]
pub struct BspXmpvo {
    mpvo: Mpvo,
    /// `None` where the mesh is convex.
    tree: Option<Arc<BspTree>>,
}

impl BspXmpvo {
    pub(crate) fn with_parts(mpvo: Mpvo, tree: Option<Arc<BspTree>>) -> Self {
        Self { mpvo, tree }
    }
}

impl VisibilityOrder for BspXmpvo {
    fn order(&self, cells: Cells<'_>, viewpoint: Viewpoint, drawn: &[CellId]) -> Order {
        self.mpvo.order(cells, viewpoint, drawn)
    }
}
