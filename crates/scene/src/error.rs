//! Why a scene cannot be drawn.

#[cfg(feature = "file")]
use tetrascope_colors::ColorError;
use tetrascope_integrate::{IsosurfaceError, MethodError, TransferFunctionError};
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
        key: String,
        /// What it is.
        value: String,
        /// What it must be.
        expected: String,
    },
    /// Two keys ask for what does not go together.
    #[error("{key} = \"{value}\" {problem}; {remedy}")]
    Conflict {
        /// One of the keys, with its section.
        key: &'static str,
        /// What it asks for.
        value: String,
        /// Why the other key makes that impossible.
        problem: String,
        /// What to do instead.
        remedy: &'static str,
    },
    /// A color map or an opacity curve that is not there.
    #[cfg(feature = "file")]
    #[error("{key}: {error}")]
    Color {
        /// The key, with its section.
        key: &'static str,
        /// Why.
        error: ColorError,
    },
    /// A preset is a file, which a scene does not open.
    #[error("transfer.preset (path = \"{}\") was not read; read it into the scene first", path.display())]
    PresetNotRead {
        /// The file.
        path: std::path::PathBuf,
    },
    /// The camera or the picture's size.
    #[error("{}: {}", key_of_view(.0), .0)]
    View(#[from] ViewError),
    /// The transfer function.
    #[error("{}", of_transfer(.0))]
    Transfer(#[from] TransferFunctionError),
    /// The isosurfaces, for a reason that is no number out of its range.
    #[error("[[isosurface]]: {0}")]
    Isosurface(IsosurfaceError),
    /// The way to integrate.
    #[error("quality.integration: {0}")]
    Integration(MethodError),
}

impl SceneError {
    /// A number out of its range.
    pub(crate) fn value(key: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        Self::Value { key: key.into(), value: value.to_string(), expected: expected.into() }
    }
}

impl From<IsosurfaceError> for SceneError {
    fn from(error: IsosurfaceError) -> Self {
        match error {
            IsosurfaceError::Value { index, component, value, expected } => {
                Self::value(format!("isosurface[{index}].{component}"), value, expected)
            }
            other => Self::Isosurface(other),
        }
    }
}

impl From<MethodError> for SceneError {
    fn from(error: MethodError) -> Self {
        match error {
            MethodError::TableSize { what, size, least, most } => {
                let key = if what == "lengths" { "quality.table_lengths" } else { "quality.table_size" };
                Self::value(key, size, format!("give {least} to {most}"))
            }
            other => Self::Integration(other),
        }
    }
}

/// The key that a view's error is about, before its words.
fn key_of_view(error: &ViewError) -> String {
    let key = match error {
        ViewError::NotFinite { what, .. } => return format!("camera.{what}"),
        ViewError::EyeIsTarget { .. } => "camera.eye",
        ViewError::UpAlongSight { .. } => "camera.up",
        ViewError::FieldOfView { .. } => "camera.fov_y",
        ViewError::Height { .. } => "camera.height",
        ViewError::ImageSize { .. } => "image.width and image.height",
        _ => "camera",
    };
    key.to_owned()
}

/// The key and what is wrong with it: the list of a transfer function is named like its key.
fn of_transfer(error: &TransferFunctionError) -> String {
    match error {
        TransferFunctionError::Empty { list } => format!("transfer.{list} is empty; give at least one control point"),
        other => format!("transfer.{other}"),
    }
}
