//! Why a picture was not drawn.

use tetrascope_integrate::{IsosurfaceError, MethodError};
use tetrascope_shaders::ShaderError;

/// Why a picture was not drawn, or no device was opened.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// The plan or the scalars, for a reason that has nothing to do with the device.
    #[error(transparent)]
    Plan(#[from] tetrascope_scene::PlanError),
    /// No adapter is there, or none that can draw.
    #[error("no graphics adapter was found ({problem}); install its driver, or use the back end \"cpu\"")]
    NoAdapter {
        /// What the system says.
        problem: String,
    },
    /// None of the adapters has this name.
    #[error("no graphics adapter's name contains \"{name}\"; there are {known}")]
    NoSuchAdapter {
        /// The name.
        name: String,
        /// Names of those that are there.
        known: String,
    },
    /// The adapter gave no device.
    #[error("the graphics adapter \"{adapter}\" could not be opened: {problem}")]
    Device {
        /// The adapter.
        adapter: String,
        /// What the driver says.
        problem: String,
    },
    /// Something is larger than the device takes at once.
    #[error(
        "{what} takes {needed} bytes, and the device \"{adapter}\" takes {limit} at once; use the back end \"cpu\""
    )]
    TooLarge {
        /// What.
        what: &'static str,
        /// Bytes needed.
        needed: u64,
        /// Bytes that one buffer may have.
        limit: u64,
        /// The adapter.
        adapter: String,
    },
    /// The device has no memory left.
    #[error(
        "the device \"{adapter}\" has not enough memory: {needed} bytes more were asked for; use the back end \"cpu\""
    )]
    OutOfMemory {
        /// The adapter.
        adapter: String,
        /// Bytes of the buffers that were asked for, besides those that are kept.
        needed: u64,
    },
    /// The device went away while a frame was drawn.
    #[error("the graphics device \"{adapter}\" was lost in frame {frame}: {problem}; the frame was not drawn")]
    Lost {
        /// The adapter.
        adapter: String,
        /// Number of the frame since the renderer was made, from 1.
        frame: u64,
        /// What the driver says.
        problem: String,
    },
    /// The driver refused what it was asked for; a defect here or there.
    #[error("the driver of \"{adapter}\" refused a command in frame {frame}: {problem}")]
    Driver {
        /// The adapter.
        adapter: String,
        /// Number of the frame since the renderer was made, from 1; 0 before the first.
        frame: u64,
        /// What it says.
        problem: String,
    },
    /// The integration does not go with the optical model, or its table has no possible size.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// Isosurfaces have no possible map.
    #[error(transparent)]
    Isosurfaces(#[from] IsosurfaceError),
    /// Triangles are blended in the order in which they come.
    #[error(
        "triangles cannot sort pixel by pixel, which this order or its rings of cells ask for; use the path \"compute\", or another order"
    )]
    TrianglesCannotSort,
    /// A pixel cannot hold back so many segments.
    #[error(
        "a \"k-buffer\" holds back up to {most} cells on a device, not {window}; use a smaller window, or \"per-pixel\""
    )]
    WindowTooLarge {
        /// The window asked for.
        window: u32,
        /// The largest.
        most: u32,
    },
    /// A picture is shown whole or not at all.
    #[error("the picture is too large for this device to hold it whole; show a smaller one")]
    NotWhole,
    /// The driver ended a loop before its end, and the picture is not whole.
    #[error(
        "the driver of \"{adapter}\" ended a loop before its end, as too many tetrahedra lie behind one tile of the picture; use the back end \"cpu\", or an order of cells"
    )]
    LoopCut {
        /// The adapter.
        adapter: String,
    },
    /// The device does not blend such floats.
    #[error("the device \"{adapter}\" cannot blend into floats of {bits} bits; use 16, or the path \"compute\"")]
    TargetNotBlended {
        /// Bits asked for.
        bits: u32,
        /// The adapter.
        adapter: String,
    },
    /// A program could not be composed; a defect.
    #[error(transparent)]
    Shader(#[from] ShaderError),
}

impl GpuError {
    /// Something that cannot be, for a device.
    pub(crate) fn defect(gpu: &crate::Gpu, problem: &str) -> Self {
        Self::Driver { adapter: gpu.description().name.clone(), frame: 0, problem: problem.to_owned() }
    }
}
