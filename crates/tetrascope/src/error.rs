//! One error for the way from file to picture.

use std::path::PathBuf;

use crate::MemoryError;
use tetrascope_colors::ColorError;
use tetrascope_cpu::RenderError;
use tetrascope_estimate::EstimateError;
use tetrascope_gpu::GpuError;
use tetrascope_io::IoError;
use tetrascope_mesh::MeshError;
use tetrascope_scene::{FieldError, PlanError, SceneError, SceneSyntaxError, WriteSceneError};

/// What went wrong, with the place and a remedy in the message.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file was not read or written. The message names it.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The file was read, but there is no mesh in it to draw.
    #[error("{source_name}: {error}")]
    Mesh {
        /// The file, or what stands for it.
        source_name: String,
        /// What is wrong.
        error: MeshError,
    },
    /// There is no such field, or nothing finite in it.
    #[error("{source_name}: {error}")]
    Field {
        /// The file, or what stands for it.
        source_name: String,
        /// What is wrong.
        error: FieldError,
    },
    /// The text of a scene file.
    #[error(transparent)]
    Syntax(#[from] SceneSyntaxError),
    /// The values of a scene.
    #[error("the scene: {0}")]
    Scene(#[from] SceneError),
    /// A color map's file. The message names it.
    #[error(transparent)]
    Color(#[from] ColorError),
    /// A scene that cannot be written as text.
    #[error(transparent)]
    WriteScene(#[from] WriteSceneError),
    /// The back end gave no picture.
    #[error("{0}")]
    Render(#[from] RenderError),
    /// The GPU gave no picture.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Nothing can be said of a picture's error.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    /// More memory is asked for than there is.
    #[error(transparent)]
    Memory(#[from] MemoryError),
    /// A mesh needs more memory than there is.
    #[error("{source_name}: {error}")]
    MeshMemory {
        /// What the mesh is called.
        source_name: String,
        /// How much it needs.
        error: MemoryError,
    },
    /// A mesh that is built in does not change.
    #[error("{source_name}: {problem}; leave the step out")]
    NoSuchStep {
        /// What the mesh is called.
        source_name: String,
        /// Why there is none.
        problem: String,
    },
    /// A mesh that is built in goes by another name.
    #[error("there is no built-in mesh \"{}\"; there is {}", name.display(), crate::SAMPLE)]
    NoSuchSample {
        /// The name asked for.
        name: PathBuf,
    },
}

impl Error {
    /// Whether nothing failed but that the work was to be given up, as [`Progress::is_stopped`](tetrascope_scene::Progress::is_stopped) or
    /// [`ReadProgress::is_stopped`](tetrascope_io::ReadProgress::is_stopped) said.
    pub fn is_interrupted(&self) -> bool {
        let plan = match self {
            Self::Io(IoError::Interrupted { .. }) => return true,
            Self::Render(RenderError::Plan(plan))
            | Self::Gpu(GpuError::Plan(plan))
            | Self::Estimate(EstimateError::Render(RenderError::Plan(plan))) => plan,
            _ => return false,
        };
        *plan == PlanError::Interrupted
    }
}

impl From<PlanError> for Error {
    fn from(error: PlanError) -> Self {
        Self::Render(error.into())
    }
}
