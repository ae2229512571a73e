//! Why there is no study.

use crate::LeftOut;

/// Why there is no study.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The reference was not drawn, or a file not written.
    #[error(transparent)]
    Tetrascope(#[from] tetrascope::Error),
    /// Nothing was left to compare.
    #[error("no setting draws this scene: {}", list(left_out))]
    NothingToCompare {
        /// Every setting, with its reason.
        left_out: Vec<LeftOut>,
    },
    /// The reference has no pixel.
    #[error("the picture has no pixel; give it a size")]
    NoPixel,
}

impl From<tetrascope::IoError> for Error {
    fn from(error: tetrascope::IoError) -> Self {
        Self::Tetrascope(error.into())
    }
}

fn list(left_out: &[LeftOut]) -> String {
    left_out.iter().map(|one| format!("\n  {}: {}", one.name, one.reason)).collect()
}
