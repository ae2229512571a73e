//! Projected Tetrahedra volume rendering, from mesh file to picture.
//!
//! This crate joins the others and computes nothing itself. A [`Volume`] is a mesh that was read and cut into tetrahedra;
//! [`Volume::field`] chooses the scalar to show; a [`SceneFile`] says how; its [`Plan`] says what will be computed and why;
//! a back end draws it into a [`LinearImage`]. [`render_scene`] takes all these steps.
//!
//! ```
//! use tetrascope::{SceneFile, Silent, render_scene};
//!
//! // A path such as "case.vtu" in place of the built-in sample draws a file.
//! let mut scene = SceneFile::of_mesh(tetrascope::SAMPLE);
//! (scene.image.width, scene.image.height) = (64, 64);
//! let picture = render_scene(&scene, ".".as_ref(), &Silent)?;
//! for decision in &picture.plan.decisions {
//!     println!("{decision}");
//! }
//! picture.save(std::env::temp_dir().join("tetrascope-example.png"))?;
//! # assert!(picture.image.pixel(32, 32)[3] > 0.1);
//! # std::fs::remove_file(std::env::temp_dir().join("tetrascope-example.png"))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Every step is public: keep the [`Volume`] to draw other fields, and a [`VolumeField`] to draw one from many sides: it keeps its
//! [`CpuRenderer`] or [`GpuRenderer`]. A scene that leaves its back end open is drawn by a graphics card if [`adapters`] has one that
//! takes it, with a [`Decision`] that says so; one that asks for the GPU is drawn by that or not at all.
//! Isosurfaces and the light are sections of the scene ([`IsosurfaceSection`], [`LightSection`]). What the back ends
//! compute with is there for itself too: every way to integrate behind its name ([`Integrator`]), tables and maps
//! ([`Table2d`], [`Table3d`], [`IsosurfaceMap`], [`SmoothMaps`]), and how far a way is from the exact light
//! ([`deviation()`]).
//!
//! Limits: surfaces from files are not there yet and refused by name.

mod animation;
mod backend;
mod check;
mod error;
mod errors;
mod heights;
mod made;
mod memory;
mod order_worth;
mod precision;
mod render;
mod section;
mod threads;
mod volume;

pub use animation::{Frame, frames_of, turned_camera};
pub use backend::adapter_of_auto;
pub use check::{MeshCheck, OrderCheck, seen_pixels};
pub use error::Error;
pub use memory::{MemoryError, memory_left};
pub use order_worth::OrderWorth;
pub use render::{Picture, is_blank, render_scene, render_volume, warn_of_non_finite};
pub use section::{read_options, read_preset};
pub use volume::{SAMPLE, Volume, VolumeField, is_builtin, resolve_path};

pub use tetrascope_colors::{
    ColorError, ColorMap, ColorSpace, Opacity, OpacityUnit, Presets, all_names, opacity_names, read_presets,
};
pub use tetrascope_cpu::{CpuRenderer, RenderError, reference};
pub use tetrascope_estimate::{BlendingOrder, Cause, ErrorEstimate, ErrorPart, EstimateError};
pub use tetrascope_gpu::{AdapterChoice, AdapterDescription, Gpu, GpuError, GpuRenderer, adapters};
pub use tetrascope_integrate::{
    Crossing, Deviation, Integration, Integrator, Isosurface, IsosurfaceError, IsosurfaceMap, Isosurfaces, LengthAxis,
    MethodError, OpticalModel, Phong, PhongError, PsiTable, RgbaAssoc, RunningIntegrals, ScalarAxis, Segment,
    SmoothMaps, SurfaceRole, SurfaceShading, Table2d, Table3d, TableDomain, TableSettings, TexelAxis, TransferFunction,
    deviation,
};
pub use tetrascope_io::{
    ByteOrder, IoError, Loaded, PictureFile, PngImage, RawVolume, ReadOptions, ReadProgress, ReadStage, SampleType,
    StepChoice, VtuEncoding, VtuOptions, WrittenVtu, check_writable, encode_png, end_writing, make_folder, read_exr,
    read_heights, read_mesh, read_picture, read_png, readers, write_bytes, write_exr, write_files, write_heights,
    write_image, write_png, write_vtu, write_vtu_with,
};
pub use tetrascope_mesh::{
    ArrayValues, CellKind, Cells, ChordLengths, DataArray, Dataset, Decomposition, MeshError, StructuredBlock, TetMesh,
    UnstructuredCells, chord_lengths, decompose, vertex_gradients,
};
pub use tetrascope_order::{
    CycleRemedy, Guarantee, MeshVisibility, OrderChoice, OrderMethod, Overlaps, PowerCertificate, Relations, Verdict,
};
pub use tetrascope_scene::{
    ArraySummary, Association, Backend, BufferRole, Bytes, CameraSection, Choice, Completed, Counts, Decision,
    DeviceBuffer, DeviceReport, Field, FieldError, FieldOnMesh, Fragments, GpuOptions, GpuPath, Gradients,
    Interpolation, IsosurfaceMethod, IsosurfaceMethodName, IsosurfacePlan, IsosurfaceSection, LengthAxisName,
    LightDirection, LightName, LightSection, Lighting, MapWork, MeshFacts, MeshSection, Mixing, OpacityName,
    OrderReport, Plan, PlanError, Progress, ProjectionName, Rendered, Scene, SceneError, SceneFile, SceneSyntaxError,
    Shading, Sharpness, Silent, Stage, TableWork, TargetBits, TransferSection, Work, WorkBuffer, explain_blank,
    foresee_blank, rough, select_cell_field, select_field, short, summarize_arrays,
};
pub use tetrascope_view::{Camera, ErrorFigures, LinearImage, PixelDifference, Projection, View, ViewError};

pub use {
    tetrascope_classify as classify, tetrascope_colors as colors, tetrascope_cpu as cpu, tetrascope_gpu as gpu,
    tetrascope_integrate as integrate, tetrascope_io as io, tetrascope_mesh as mesh, tetrascope_order as order,
    tetrascope_scene as scene, tetrascope_view as view,
};

#[cfg(test)]
mod tests;
