//! A scene with nothing left open, and the plan that follows from it.

mod gpu;
mod light;
mod methods;
mod order;

use tetrascope_integrate::{Integration, Isosurface, Isosurfaces, OpticalModel, TableSettings, TransferFunction};
use tetrascope_order::{CycleRemedy, OrderMethod};
use tetrascope_view::{Camera, View};

use crate::{
    Backend, Decision, GpuOptions, Interpolation, IsosurfaceMethod, IsosurfacePlan, Lighting, Plan, SceneError,
};

/// Everything one picture depends on besides mesh and field, as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// From where the mesh is seen; world coordinates.
    pub camera: Camera,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear RGB.
    pub background: [f64; 3],
    /// What color and extinction mean.
    pub model: OpticalModel,
    /// Scalar and linear R, G, B.
    pub color: Vec<[f64; 4]>,
    /// Scalar and extinction per world unit of length.
    pub extinction: Vec<[f64; 2]>,
    /// Surfaces of one value, in any order. Those of opacity 0 are left out of the plan.
    pub isosurfaces: Vec<Isosurface>,
    /// How a ray meets them.
    pub isosurface_method: IsosurfaceMethod,
    /// The light, its direction of any length; `None` is [`Lighting::default`] where a surface is shaded.
    pub lighting: Option<Lighting>,
    /// How a segment becomes color and opacity; `None` leaves it to [`Scene::plan`].
    pub integration: Option<Integration>,
    /// How what a ray has inside a cell is found at a pixel; `None` leaves it to [`Scene::plan`], which takes the exact way: it costs less than
    /// fans and has no error.
    pub interpolation: Option<Interpolation>,
    /// Sizes of the integration's table; `None` takes the usual ones. Without effect for an integration without a table.
    pub tables: Option<TableSettings>,
    /// In which order cells are blended; `None` leaves it to [`Scene::plan`], which knows the optical model and not the mesh.
    pub order: Option<OrderMethod>,
    /// What is done about cells that hide one another in rings.
    pub cycles: CycleRemedy,
    /// Who computes; `None` leaves it to [`Scene::plan`], which knows no device and takes the CPU.
    pub backend: Option<Backend>,
    /// What is asked of the GPU.
    pub gpu: GpuOptions,
    /// Number of threads; `None` leaves it to the back end.
    pub threads: Option<usize>,
}

impl Scene {
    /// Transmittance at which a pixel is ended. A thousandth of what an 8-bit channel can show, and a twentieth of the
    /// 2e-5 that the f32 renderer may be off in the easiest of the reference pictures: not worth a setting.
    pub const TERMINATION: f32 = 1e-6;

    /// Decides what is computed for this scene and what is left out.
    ///
    /// # Errors
    /// [`SceneError`] if the camera, the picture's size, the background, the transfer function, an isosurface, the light or
    /// a table's size has numbers that make no picture, and for methods that do not go together.
    pub fn plan(&self) -> Result<Plan, SceneError> {
        let view = View::new(&self.camera, self.width, self.height)?;
        let transfer = self.transfer()?;
        if !self.background.iter().all(|c| c.is_finite() && *c >= 0.0) {
            let value = format!("{:?}", self.background);
            return Err(SceneError::value("image.background", value, "give three finite numbers, zero or more"));
        }
        let isosurfaces = self.isosurfaces()?;
        let lighting = self.lighting(isosurfaces.as_ref())?;
        let mut decisions = Vec::new();
        let (integration, tables) = self.decide_integration(&mut decisions)?;
        let interpolation = self.decide_interpolation(integration, &mut decisions)?;
        self.check_isosurface_method(integration, isosurfaces.as_ref())?;
        self.check_cycles(integration)?;
        self.check_gpu(integration)?;
        self.decide_isosurfaces(isosurfaces.as_ref(), &mut decisions);
        let order = self.decide_order(&mut decisions)?;
        let plan = Plan {
            view,
            background: self.background.map(|c| c as f32),
            transfer,
            model: self.model,
            integration,
            interpolation,
            tables,
            isosurfaces,
            lighting,
            order,
            cycles: self.cycles,
            backend: self.backend.unwrap_or_default(),
            gpu: self.gpu_options(integration, &mut decisions),
            threads: self.threads,
            termination: Self::TERMINATION,
            decisions,
        };
        Ok(self.say_what_light_needs(plan))
    }

    /// The transfer function, checked; without the half that the optical model ignores, whose control points would cut cells into pieces.
    fn transfer(&self) -> Result<TransferFunction, SceneError> {
        let all = TransferFunction::new(&self.color, &self.extinction)?;
        Ok(if !self.model.needs_extinction() {
            TransferFunction::new(&self.color, &[[0.0, 0.0]])?
        } else if !self.model.needs_emission() {
            TransferFunction::new(&[[0.0, 0.0, 0.0, 0.0]], &self.extinction)?
        } else {
            all
        })
    }

    /// The isosurfaces that hide anything, checked.
    fn isosurfaces(&self) -> Result<Option<IsosurfacePlan>, SceneError> {
        // All are checked, with the indices of the scene, before any is left out.
        let all = Isosurfaces::new(self.isosurfaces.clone())?;
        let seen: Vec<_> = all.as_slice().iter().copied().filter(|surface| surface.opacity > 0.0).collect();
        if seen.is_empty() {
            return Ok(None);
        }
        if let IsosurfaceMethod::Map { size, .. } = self.isosurface_method {
            let (least, most) = (IsosurfaceMethod::LEAST_MAP_SIZE, IsosurfaceMethod::MOST_MAP_SIZE);
            if !(least..=most).contains(&size) {
                return Err(SceneError::value("quality.map_size", size, format!("give {least} to {most}")));
            }
        }
        Ok(Some(IsosurfacePlan { surfaces: Isosurfaces::new(seen)?, method: self.isosurface_method }))
    }

    /// Adds the decisions on light, gradients and the half of the transfer function that is not looked at.
    fn say_what_light_needs(&self, mut plan: Plan) -> Plan {
        let mut said = light::decisions(&plan);
        if !self.model.needs_emission() {
            said.push(Decision::new("color", "none", "absorption ignores it"));
        }
        if !self.model.needs_extinction() {
            said.push(Decision::new("extinction", "none", "emission ignores it"));
        }
        plan.decisions.append(&mut said);
        plan
    }
}
