//! The plan: everything that a back end needs to draw one picture, and why each choice was made.

use std::fmt;

use glam::DVec3;
use tetrascope_integrate::{
    Integration, Isosurfaces, OpticalModel, Phong, SurfaceShading, TableSettings, TransferFunction,
};
use tetrascope_order::{CycleRemedy, OrderMethod};
use tetrascope_view::{LinearImage, View};

use crate::{Backend, GpuOptions, Interpolation, PlanError};

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
    /// How what a ray has inside a cell is found at a pixel.
    pub interpolation: Interpolation,
    /// Sizes of the table that the integration looks light up in; `None` takes the usual ones, see
    /// [`Plan::table_settings`].
    pub tables: Option<TableSettings>,
    /// Surfaces of one value in the volume; `None` if there are none, and then nothing of them is computed.
    pub isosurfaces: Option<IsosurfacePlan>,
    /// The light; `None` if nothing is lit, and then no gradient is computed.
    pub lighting: Option<Lighting>,
    /// In which order cells are blended.
    pub order: OrderMethod,
    /// What is done about cells that hide one another in rings, where the order finds them.
    pub cycles: CycleRemedy,
    /// Who computes.
    pub backend: Backend,
    /// What a scene asks of the GPU; without meaning for the other back ends.
    pub gpu: GpuOptions,
    /// Number of threads; `None` leaves it to the back end, which takes one a core.
    pub threads: Option<usize>,
    /// Transmittance, 0 to 1, below which a back end that goes front to back may end a pixel; 0 never ends one early.
    /// The error that it makes in any channel is at most this number times the largest color behind.
    pub termination: f32,
    /// What was chosen and what was left out, with the reason.
    pub decisions: Vec<Decision>,
}

/// Isosurfaces, and how they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct IsosurfacePlan {
    /// The surfaces; at least one.
    pub surfaces: Isosurfaces,
    /// How a ray meets them.
    pub method: IsosurfaceMethod,
}

/// How isosurfaces are found along a ray and mixed with the volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IsosurfaceMethod {
    /// Crossings by analysis: the segment is cut there, and the volume integrated in front of and behind each surface.
    #[default]
    Exact,
    /// Looked up in maps over the scalars at both ends ([Röttger 2000], sections 7 to 9).
    Map {
        /// Samples along each side of the map.
        size: u32,
        /// How the volume comes in.
        mixing: Mixing,
    },
}

impl IsosurfaceMethod {
    /// The usual number of samples along a side of a map: as in [Röttger 2000], figure 13.
    pub const MAP_SIZE: u32 = 256;
    /// The least number.
    pub const LEAST_MAP_SIZE: u32 = 2;
    /// The largest number: a map of it takes 256 MiB.
    pub const MOST_MAP_SIZE: u32 = 4096;

    /// The name in a scene file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Map { mixing: Mixing::Smooth, .. } => "map-smooth",
            Self::Map { mixing: Mixing::Stopped, .. } => "map-stopped",
        }
    }
}

/// How isosurfaces out of maps are mixed with the volume ([Röttger 2000], section 10).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mixing {
    /// The whole cell's volume is blended between a pass for the back faces and one for the front faces, weighted by how near
    /// the surface is to each. Works with every integration.
    Smooth,
    /// The integral stops at the surface, in the table itself. Needs an integration by table.
    Stopped,
}

/// The light in a scene in which something is lit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// How much of it comes back.
    pub phong: Phong,
    /// From the surface towards the light, world coordinates, of length 1; `None` is a light at the eye.
    pub direction: Option<DVec3>,
    /// Whether the volume is lit too, by its gradients ([Marroquim 2008], figure 11 b).
    pub volume: bool,
}

/// A light at the eye that falls on shaded surfaces only.
impl Default for Lighting {
    fn default() -> Self {
        let phong = Phong { ambient: 0.2, diffuse: 0.7, specular: 0.3, shininess: 32.0 };
        Self { phong, direction: None, volume: false }
    }
}

/// Which gradients a plan needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gradients {
    /// None are computed.
    None,
    /// The constant one of each cell.
    Cells,
    /// One a point, interpolated inside the cells.
    Points,
}

impl Plan {
    /// A plan of the plainest kind: exact integration, centroid order, CPU, black background, no isosurface, no light,
    /// every pixel drawn to its end.
    pub fn new(view: View, transfer: TransferFunction, model: OpticalModel) -> Self {
        Self {
            view,
            background: [0.0; 3],
            transfer,
            model,
            integration: Integration::Exact,
            interpolation: Interpolation::Exact,
            tables: None,
            isosurfaces: None,
            lighting: None,
            order: OrderMethod::Centroid,
            cycles: CycleRemedy::Report,
            backend: Backend::Cpu,
            gpu: GpuOptions::default(),
            threads: None,
            termination: 0.0,
            decisions: Vec::new(),
        }
    }

    /// Whether the picture is the same whatever is blended first: a surface hides what is behind it in every optical model.
    pub const fn commutes(&self) -> bool {
        self.model.is_commutative() && self.isosurfaces.is_none()
    }

    /// A transparent picture of the plan's size, to be filled.
    ///
    /// # Errors
    /// [`PlanError::Memory`] if it cannot be had.
    pub fn empty_picture(&self) -> Result<LinearImage, PlanError> {
        let (width, height) = (self.view.width, self.view.height);
        let bytes = 16 * u64::from(width) * u64::from(height);
        LinearImage::try_transparent(width, height).ok_or(PlanError::Memory { what: "the picture", bytes })
    }

    /// Sizes of the integration's table: those of the plan, else [`TableSettings::of`] the method; `None` if it has none.
    pub fn table_settings(&self) -> Option<TableSettings> {
        let usual = TableSettings::of(self.integration)?;
        Some(self.tables.unwrap_or(usual))
    }

    /// The same plan for a field that counts from another scalar: transfer function and isosurfaces at their scalars less `base`.
    #[must_use]
    pub fn with_scalars_from(&self, base: f64) -> Self {
        let mut plan = self.clone();
        if base != 0.0 {
            plan.transfer = plan.transfer.with_scalars_from(base);
            if let Some(isosurfaces) = &mut plan.isosurfaces {
                isosurfaces.surfaces = isosurfaces.surfaces.with_scalars_from(base);
            }
        }
        plan
    }

    /// The gradients that its light needs; surfaces of opacity 0 need none.
    pub fn gradients(&self) -> Gradients {
        let Some(lighting) = &self.lighting else { return Gradients::None };
        let of_surfaces = self.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.surfaces.visible().shading());
        match of_surfaces {
            _ if lighting.volume => Gradients::Points,
            Some(SurfaceShading::Smooth) => Gradients::Points,
            Some(SurfaceShading::Flat) => Gradients::Cells,
            Some(SurfaceShading::None) | None => Gradients::None,
        }
    }
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

/// The steps of a back end, in the order in which they are taken. A back end may skip some.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// What depends on mesh and field but not on the camera.
    Prepare,
    /// Pre-integration into a table.
    Tabulate,
    /// Points into the camera's space.
    Transform,
    /// Visibility order.
    Order,
    /// Cells into what the back end draws: planes, or fans of triangles.
    SetUp,
    /// Cells into tiles of the picture.
    Bin,
    /// Cells into pixels.
    Rasterize,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Prepare => "prepare",
            Self::Tabulate => "tabulate",
            Self::Transform => "transform",
            Self::Order => "order",
            Self::SetUp => "set up",
            Self::Bin => "bin",
            Self::Rasterize => "rasterize",
        })
    }
}

/// Told how far a back end has come, and asked whether it is to go on; called from any thread.
pub trait Progress: Sync {
    /// `done` of `total` steps of a stage are finished; `total` is the same in every call of one stage.
    ///
    /// Calls of one stage may arrive out of order.
    fn report(&self, stage: Stage, done: u64, total: u64);

    /// Whether the work is to be given up. Asked between tiles and steps; where it is, back ends give [`PlanError::Interrupted`] and no
    /// picture.
    /// Whoever says so once goes on saying it.
    fn is_stopped(&self) -> bool {
        false
    }

    /// Nothing, or that the work is to be given up.
    ///
    /// # Errors
    /// [`PlanError::Interrupted`] where [`Self::is_stopped`] says so.
    fn go_on(&self) -> Result<(), PlanError> {
        if self.is_stopped() { Err(PlanError::Interrupted) } else { Ok(()) }
    }
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _stage: Stage, _done: u64, _total: u64) {}
}
