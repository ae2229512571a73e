//! The plan: everything that a back end needs to draw one picture, and why each choice was made.

use std::fmt;
use std::str::FromStr;

use tetrascope_integrate::{Integration, OpticalModel, TransferFunction};
use tetrascope_order::OrderMethod;
use tetrascope_view::View;

/// What is to be computed for one picture: numbers and methods, no file names and no "auto".
///
/// Back ends take a plan as it is. Whatever a scene does not ask for is not in it, so that it costs nothing.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Where rays come from and how many pixels there are; world coordinates.
    pub view: View,
    /// Linear RGB behind the volume. Back ends leave it alone: it is for whoever writes an 8-bit picture.
    pub background: [f32; 3],
    /// Color and extinction over the scalar; extinction per world unit of length.
    pub transfer: TransferFunction,
    /// What color and extinction mean.
    pub model: OpticalModel,
    /// How a ray's segment inside one cell becomes color and opacity.
    pub integration: Integration,
    /// In which order cells are blended.
    pub order: OrderMethod,
    /// Who computes.
    pub backend: Backend,
    /// Number of threads; `None` leaves it to the back end, which takes one a core.
    pub threads: Option<usize>,
    /// Transmittance, 0 to 1, below which a back end that goes front to back may end a pixel; 0 never ends one early.
    /// The error that it makes in any channel is at most this number times the largest color behind.
    pub termination: f32,
    /// What was chosen and what was left out, with the reason.
    pub decisions: Vec<Decision>,
}

/// One choice that led to a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decision {
    /// What was chosen: `"integration"`, `"order"`, `"gradients"`.
    pub subject: &'static str,
    /// The choice, in the scene file's words where it has any.
    pub choice: String,
    /// Why, in a few words.
    pub reason: String,
}

impl Decision {
    /// A decision from its three parts.
    pub fn new(subject: &'static str, choice: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { subject, choice: choice.into(), reason: reason.into() }
    }
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} ({})", self.subject, self.choice, self.reason)
    }
}

/// Who computes the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Backend {
    /// Projected tetrahedra on all cores, 32-bit floats per pixel.
    #[default]
    Cpu,
    /// Every pixel's ray against every tetrahedron in 64-bit floats: slow, and what the others are compared with. It
    /// orders the cells along each ray by itself and takes no [`OrderMethod`].
    Reference,
}

impl Backend {
    /// All back ends.
    pub const ALL: [Self; 2] = [Self::Cpu, Self::Reference];
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cpu => "cpu",
            Self::Reference => "reference",
        })
    }
}

/// A name that is none of the back ends'.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no back end named \"{name}\"; there are cpu and reference")]
pub struct UnknownBackend {
    /// The name.
    pub name: String,
}

impl FromStr for Backend {
    type Err = UnknownBackend;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .into_iter()
            .find(|backend| backend.to_string() == name)
            .ok_or_else(|| UnknownBackend { name: name.to_owned() })
    }
}

/// The steps of a back end, in the order in which they are taken. A back end may skip some.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// What depends on mesh and field but not on the camera.
    Prepare,
    /// Points into the camera's space.
    Transform,
    /// Visibility order.
    Order,
    /// Cells into fans of triangles.
    SetUp,
    /// Fans into tiles of the picture.
    Bin,
    /// Fans into pixels.
    Rasterize,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Prepare => "prepare",
            Self::Transform => "transform",
            Self::Order => "order",
            Self::SetUp => "set up",
            Self::Bin => "bin",
            Self::Rasterize => "rasterize",
        })
    }
}

/// Told how far a back end has come; called from any thread.
pub trait Progress: Sync {
    /// `done` of `total` steps of a stage are finished; `total` is the same in every call of one stage.
    ///
    /// Calls of one stage may arrive out of order.
    fn report(&self, stage: Stage, done: u64, total: u64);
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _stage: Stage, _done: u64, _total: u64) {}
}
