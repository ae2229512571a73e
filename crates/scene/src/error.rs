//! Why a scene cannot be drawn.

use tetrascope_integrate::TransferFunctionError;
use tetrascope_view::ViewError;

/// What is wrong with a scene's values, as against its text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The key is known but what it asks for is not there yet.
    #[error("{key} is not supported yet: {what}; {remedy}")]
    NotSupported {
        /// The key, with its section.
        key: String,
        /// What it would do.
        what: &'static str,
        /// What to do instead.
        remedy: &'static str,
    },
    /// A number is out of its range.
    #[error("{key} is {value}; {expected}")]
    Value {
        /// The key, with its section.
        key: &'static str,
        /// What it is.
        value: String,
        /// What it must be.
        expected: &'static str,
    },
    /// The camera or the picture's size.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The transfer function.
    #[error("transfer: {0}")]
    Transfer(#[from] TransferFunctionError),
}
