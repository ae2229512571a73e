//! Why nothing was said of a picture.

use tetrascope_cpu::RenderError;

/// Why nothing was said of a picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EstimateError {
    /// The plan or the scalars, as for a renderer.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The picture is not the one of the plan.
    #[error("the picture has {} pixels and the plan's view {}; give the picture that was drawn by the plan", size(.found), size(.expected))]
    PictureSize {
        /// Pixels a row, and rows.
        found: [u32; 2],
        /// Of the plan's view.
        expected: [u32; 2],
    },
    /// There is not one rank for each cell.
    #[error("there are {ranks} ranks for {cells} tetrahedra; give one each")]
    Ranks {
        /// Ranks.
        ranks: usize,
        /// Tetrahedra.
        cells: usize,
    },
}

fn size([width, height]: &[u32; 2]) -> String {
    format!("{width} x {height}")
}
