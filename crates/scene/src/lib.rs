//! The scene file, its defaults, and the plan of what will be computed.

mod blank;
#[cfg(feature = "file")]
mod complete;
pub mod defaults;
mod error;
mod facts;
#[cfg(feature = "file")]
mod file;
#[cfg(feature = "file")]
mod parse;
mod plan;
mod scene;
mod text;

pub use blank::explain_blank;
#[cfg(feature = "file")]
pub use complete::{Completed, MAX_ERROR};
pub use error::SceneError;
pub use facts::MeshFacts;
#[cfg(feature = "file")]
pub use file::{
    CameraSection, Choice, ImageSection, IsosurfaceSection, LightDirection, LightName, LightSection, MeshSection,
    OpticsSection, ProjectionName, QualitySection, SceneFile, Shading, SurfaceSection, TransferSection,
};
#[cfg(feature = "file")]
pub use parse::{Position, SceneSyntaxError, WriteSceneError};
pub use plan::{Backend, Decision, Plan, Progress, Silent, Stage, UnknownBackend};
pub use scene::Scene;
pub use text::short;
