//! The scene file, its defaults, and the plan of what will be computed.
//!
//! A picture is made in four steps, each of which only fills in what the one before left open:
//!
//! 1. `SceneFile` (feature `file`): what the user wrote, key by key. Unknown keys are errors with a line.
//! 2. [`select_field`] and [`place_on_mesh`]: the scalar that is shown, on the tetrahedra where it is a number; and the
//!    [`MeshFacts`] that defaults are made from: the box around the mesh and the field's range.
//! 3. [`Scene`]: all numbers. `SceneFile::complete` fills defaults that do not depend on the unit of length, and gives
//!    back a file with which the same picture can be made again.
//! 4. [`Plan`]: methods chosen, with a [`Decision`] for everything done or left out; methods that do not go together are
//!    an error here. Back ends take it and report their [`Progress`] by [`Stage`]. What a scene does not ask for is not
//!    in it: [`Plan::isosurfaces`], [`Plan::lighting`], [`Plan::table_settings`], [`Plan::gradients`].
//!
//! An order and a back end that a scene leaves open depend on the mesh and the machine: whoever knows these settles them, in the scene and
//! in the file (`Completed::settle_order`, `Completed::settle_backend`). What back ends have in common is here, since they do not see each
//! other: [`Plan::check`], [`check_scalars`] and [`Rendered`].
//!
//! ```
//! # #[cfg(feature = "file")] {
//! use tetrascope_scene::{MeshFacts, SceneFile};
//!
//! let text = "[mesh]\npath = \"engine.vtu\"\n[optics]\nmodel = \"absorption\"\n";
//! let file = SceneFile::parse(text, "engine.toml".as_ref())?;
//! let (lowest, highest) = (glam::DVec3::ZERO, glam::DVec3::new(4.0, 2.0, 1.0));
//! let completed = file.complete(&MeshFacts { lowest, highest, scalar_range: (0.0, 10.0) })?;
//! let plan = completed.scene.plan()?;
//! assert_eq!(plan.order.to_string(), "none");
//! assert!(plan.decisions.iter().any(|d| d.to_string().contains("same sum in any order")));
//! assert!(completed.file.to_toml()?.contains("order = \"none\""));
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Limits: surfaces from files and color map files are read and refused by name. The crate opens no file and draws
//! nothing. Without the feature `file` it needs no serde and is the plan, the scene and the fields alone.

mod backend;
mod blank;
mod check;
#[cfg(feature = "file")]
mod complete;
pub mod defaults;
mod error;
mod facts;
mod field;
#[cfg(feature = "file")]
mod file;
mod finite;
mod interpolation;
#[cfg(feature = "file")]
mod parse;
mod plan;
mod rendered;
mod scene;
mod sharpness;
mod shown;
mod text;
mod work;

pub use backend::{Backend, GpuOptions, GpuPath, TargetBits, UnknownBackend, UnknownGpuPath};
pub use blank::{explain_blank, foresee_blank};
pub use check::{PlanError, check_scalars};
#[cfg(feature = "file")]
pub use complete::{Completed, MAX_ERROR};
pub use error::SceneError;
pub use facts::MeshFacts;
pub use field::{
    ArraySummary, Association, Field, FieldError, Part, select_cell_field, select_field, summarize_arrays,
};
#[cfg(feature = "file")]
pub use file::{
    CameraSection, Choice, ImageSection, IsosurfaceMethodName, IsosurfaceSection, LengthAxisName, LightDirection,
    LightName, LightSection, MeshSection, OpacityName, OpticsSection, PresetMap, ProjectionName, QualitySection,
    SceneFile, Shading, SurfaceSection, TransferSection,
};
pub use finite::{FieldOnMesh, place_on_mesh};
pub use interpolation::{Interpolation, UnknownInterpolation};
#[cfg(feature = "file")]
pub use parse::{Position, SceneSyntaxError, WriteSceneError};
pub use plan::{
    Decision, Gradients, IsosurfaceMethod, IsosurfacePlan, Lighting, Mixing, Plan, Progress, Silent, Stage,
};
pub use rendered::{BufferRole, Counts, DeviceBuffer, DeviceReport, OrderReport, Rendered, Stopwatch};
pub use scene::Scene;
pub use sharpness::Sharpness;
pub use shown::{Shown, surfaces_near};
pub use text::{memory_text, rough, short};
pub use work::{Bytes, Fragments, MapWork, TableWork, Work, WorkBuffer};

#[cfg(all(test, feature = "file"))]
mod defaults_tests;
#[cfg(test)]
mod field_tests;
#[cfg(all(test, feature = "file"))]
mod file_tests;
#[cfg(all(test, feature = "file"))]
mod gpu_tests;
#[cfg(all(test, feature = "file"))]
mod interpolation_tests;
#[cfg(all(test, feature = "file"))]
mod order_tests;
#[cfg(all(test, feature = "file"))]
mod surface_tests;
#[cfg(all(test, feature = "file"))]
mod transfer_tests;
