//! Fills what a scene file leaves open with numbers, and turns it into a [`Scene`].

mod quality;
mod surfaces;
mod transfer;

use glam::DVec3;
use tetrascope_integrate::{Integration, TableSettings};
use tetrascope_order::{CycleRemedy, OrderMethod};
use tetrascope_view::{Camera, Projection};

use crate::file::{Choice, ProjectionName, QualitySection, SceneFile};
use crate::text::short;
use crate::{Backend, Decision, GpuOptions, MeshFacts, Scene, SceneError, defaults};

use quality::{
    drop_what_the_order_has_not, fill_cycles, fill_gpu, fill_isosurface_method, fill_order, fill_tables, finds_rings,
    name_tables,
};
use surfaces::{fill_isosurfaces, fill_light};
use transfer::fill_transfer;

/// The largest error wanted in a channel when a scene does not say: one step of 8 bits.
pub const MAX_ERROR: f64 = 0.00392;

/// A scene file with nothing left open.
#[derive(Clone, Debug, PartialEq)]
pub struct Completed {
    /// The file with every default as a number and every `"auto"` as a name: drawn again it gives the same picture.
    pub file: SceneFile,
    /// The same, ready to be planned.
    pub scene: Scene,
    /// The defaults that were chosen, with their reasons.
    pub decisions: Vec<Decision>,
    /// What the user should know: keys without an effect, a constant field.
    pub warnings: Vec<String>,
    /// Whether the scene itself said what is done about rings.
    has_asked_for_cycles: bool,
    /// Whether the scene itself said which error is wanted.
    has_asked_for_error: bool,
}

impl Completed {
    /// Whether the order is still open: the scene leaves it to the mesh, which the scene alone does not know.
    ///
    /// [`Scene::plan`] then takes `bsp-xmpvo`, which is right for every mesh; a cheaper one may be right for this one.
    pub fn leaves_order_open(&self) -> bool {
        self.scene.order.is_none() && self.scene.backend != Some(Backend::Reference) && !self.scene.commutes()
    }

    /// Whether the back end is still open: the scene leaves it to the machine.
    ///
    /// [`Scene::plan`] then takes the CPU, which every machine has.
    pub const fn leaves_backend_open(&self) -> bool {
        self.scene.backend.is_none()
    }

    /// Gives a back end that was left open its name, in the scene and in the file, with the reason.
    ///
    /// What the scene asks of a GPU is dropped, with no word, if another back end is taken.
    ///
    /// # Errors
    /// Those of [`Scene::plan`] with this back end.
    pub fn settle_backend(&mut self, backend: Backend, reason: &str) -> Result<(), SceneError> {
        self.scene.backend = Some(backend);
        self.file.quality.backend = Choice::Named(backend);
        if backend != Backend::Gpu {
            self.scene.gpu = GpuOptions::default();
            let quality = &mut self.file.quality;
            (quality.gpu_path, quality.target_bits, quality.adapter) = (None, None, None);
        }
        self.decisions.push(Decision::new("backend", backend.to_string(), reason));
        // What the back end brings with it, and no other decision, is new.
        let said = self.scene.plan()?.decisions.into_iter().filter(|decision| decision.subject == "path");
        self.decisions.extend(said);
        Ok(())
    }

    /// Whether the integration is still open: the scene leaves it to the wanted error.
    ///
    /// [`Scene::plan`] then takes `exact`, which has none; a cheaper one may be near enough for this mesh and field.
    pub fn leaves_integration_open(&self) -> bool {
        // Isosurfaces that end an integral in a table have it chosen already.
        self.scene.integration.is_none() && self.scene.chosen_integration().0 == Integration::Exact
    }

    /// The largest error wanted in a channel, 0 to 1.
    pub fn max_error(&self) -> f64 {
        self.file.quality.max_error.unwrap_or(MAX_ERROR)
    }

    /// Whether the scene itself said which: then time may be traded for all of it.
    pub const fn asks_for_error(&self) -> bool {
        self.has_asked_for_error
    }

    /// Gives an integration that was left open its name, in the scene and in the file, with the reason.
    ///
    /// - `tables`: where it looks light up
    ///
    /// # Errors
    /// Those of [`Scene::plan`] with this integration.
    pub fn settle_integration(
        &mut self,
        integration: Integration,
        tables: Option<TableSettings>,
        reason: &str,
    ) -> Result<(), SceneError> {
        let mut scene = self.scene.clone();
        (scene.integration, scene.tables) = (Some(integration), tables);
        let plan = scene.plan()?;
        self.scene = scene;
        self.file.quality.integration = Choice::Named(integration);
        name_tables(&mut self.file.quality, integration, tables);
        self.decisions.retain(|decision| !matches!(decision.subject, "integration" | "tables"));
        let said = plan.decisions.into_iter().filter(|decision| matches!(decision.subject, "integration" | "tables"));
        self.decisions.extend(said.map(|mut decision| {
            if decision.subject == "integration" {
                reason.clone_into(&mut decision.reason);
            }
            decision
        }));
        Ok(())
    }

    /// Gives an order that was left open its name, in the scene and in the file, with the reason.
    ///
    /// Keys of the scene that have no effect with this order are dropped with a warning.
    pub fn settle_order(&mut self, order: OrderMethod, reason: &str) {
        self.scene.order = Some(order);
        name_order(&mut self.file.quality, order);
        let decision = Decision::new("order", order.to_string(), reason);
        match self.decisions.iter_mut().find(|decision| decision.subject == "order") {
            Some(said) => *said = decision,
            None => self.decisions.push(decision),
        }
        if !finds_rings(order) {
            self.scene.cycles = CycleRemedy::Report;
            self.decisions.retain(|decision| decision.subject != "cycles");
            if !self.has_asked_for_cycles {
                // The default: nobody misses it.
                self.file.quality.cycles = None;
            }
        }
        drop_what_the_order_has_not(&mut self.file.quality, order, &mut self.warnings);
    }
}

/// Writes an order into the file with the number that it goes by.
fn name_order(section: &mut QualitySection, order: OrderMethod) {
    section.order = Choice::Named(order);
    match order {
        OrderMethod::Bucket { slabs } => section.slabs = Some(slabs),
        OrderMethod::KBuffer { window } => section.window = Some(window),
        _ => {}
    }
}

impl SceneFile {
    /// Fills everything that the file leaves open from the mesh and its field.
    ///
    /// # Errors
    /// [`SceneError`] for effects that are not there yet and for numbers out of range.
    pub fn complete(&self, facts: &MeshFacts) -> Result<Completed, SceneError> {
        self.refuse_what_is_not_there()?;
        let mut file = self.clone();
        let (mut decisions, mut warnings) = (Vec::new(), Vec::new());
        let camera = fill_camera(&mut file, facts, &mut decisions, &mut warnings)?;
        let (color, extinction) = fill_transfer(&mut file.transfer, facts, &mut decisions, &mut warnings)?;
        let isosurfaces = fill_isosurfaces(&mut file, facts, &mut warnings);
        let lighting = fill_light(&mut file, &mut warnings);
        let isosurface_method = fill_isosurface_method(&mut file, &mut warnings);
        let order = fill_order(&mut file.quality, &mut warnings);
        let max_error = *file.quality.max_error.get_or_insert(MAX_ERROR);
        if !(0.0..=1.0).contains(&max_error) {
            return Err(SceneError::value("quality.max_error", max_error, "give a number from 0 to 1"));
        }
        let mut scene = Scene {
            camera,
            width: file.image.width,
            height: file.image.height,
            background: file.image.background,
            model: file.optics.model,
            color,
            extinction,
            isosurfaces,
            isosurface_method,
            lighting,
            integration: match file.quality.integration {
                Choice::Auto => None,
                Choice::Named(integration) => Some(integration),
            },
            interpolation: match file.quality.interpolation {
                Choice::Auto => None,
                Choice::Named(interpolation) => Some(interpolation),
            },
            tables: None,
            order,
            cycles: CycleRemedy::Report,
            backend: match file.quality.backend {
                Choice::Auto => None,
                Choice::Named(backend) => Some(backend),
            },
            gpu: fill_gpu(&mut file.quality, &mut warnings)?,
            threads: None,
        };
        scene.tables = fill_tables(&mut file.quality, scene.chosen_integration().0, &mut warnings);
        let has_asked_for_cycles = file.quality.cycles.is_some();
        let has_asked_for_error = self.quality.max_error.is_some();
        scene.cycles = fill_cycles(&mut file.quality, scene.decided_order(), &mut warnings);
        let plan = scene.plan()?;
        decisions.extend(plan.decisions);
        file.quality.integration = Choice::Named(plan.integration);
        file.quality.interpolation = Choice::Named(plan.interpolation);
        name_order(&mut file.quality, plan.order);
        Ok(Completed { file, scene, decisions, warnings, has_asked_for_cycles, has_asked_for_error })
    }

    /// Keys that are part of the contract but whose effect is not built: better no picture than another one.
    fn refuse_what_is_not_there(&self) -> Result<(), SceneError> {
        let not_supported =
            |key: &str, what, remedy| Err(SceneError::NotSupported { key: key.to_owned(), what, remedy });
        if let Some(first) = self.surface.first() {
            let key = format!("[[surface]] (path = \"{}\")", first.path.display());
            return not_supported(&key, "opaque geometry inside the volume", "remove the section");
        }
        Ok(())
    }
}

fn fill_camera(
    file: &mut SceneFile,
    facts: &MeshFacts,
    decisions: &mut Vec<Decision>,
    warnings: &mut Vec<String>,
) -> Result<Camera, SceneError> {
    let (width, height) = (file.image.width, file.image.height);
    let section = &mut file.camera;
    let target = DVec3::from(*section.target.get_or_insert_with(|| facts.center().to_array()));
    let (projection, distance) = match section.projection {
        ProjectionName::Perspective => {
            if section.height.take().is_some() {
                warnings.push("camera.height has no effect: the projection is perspective".to_owned());
            }
            let fov_y = *section.fov_y.get_or_insert(defaults::FOV_Y_DEGREES);
            if !(fov_y > 0.0 && fov_y < 180.0) {
                return Err(SceneError::value(
                    "camera.fov_y",
                    fov_y,
                    "give an angle in degrees, above 0 and below 180",
                ));
            }
            let fit = defaults::fit_perspective(facts, fov_y, width, height);
            (Projection::Perspective { fov_y: fov_y.to_radians() }, fit.distance)
        }
        ProjectionName::Orthographic => {
            if section.fov_y.take().is_some() {
                warnings.push("camera.fov_y has no effect: the projection is orthographic".to_owned());
            }
            let fitted = defaults::fit_orthographic(facts, width, height);
            // Rays start at the plane through the eye, so it stands clear of the sphere whatever the target is.
            let clear = facts.diagonal() + (target - facts.center()).length();
            (Projection::Orthographic { height: *section.height.get_or_insert(fitted) }, clear)
        }
    };
    let open_eye = section.eye.is_none();
    let eye = DVec3::from(*section.eye.get_or_insert_with(|| {
        let backwards = match section.up {
            // Seen along z, an up of z would be a point: then from the front, as tools with z upwards have it.
            Some([x, y, z]) if x.hypot(y) <= 1e-3 * z.abs() => DVec3::NEG_Y,
            _ => DVec3::Z,
        };
        (target + backwards * distance).to_array()
    }));
    let up = DVec3::from(*section.up.get_or_insert_with(|| defaults::up_for(target - eye).to_array()));
    if open_eye {
        let along = if eye.y < target.y && eye.z == target.z { "+y" } else { "-z" };
        decisions.push(Decision::new(
            "camera",
            format!("from ({}, {}, {})", short(eye.x), short(eye.y), short(eye.z)),
            format!("looks along {along}, the mesh's bounding sphere fills the picture"),
        ));
    }
    Ok(Camera { eye, target, up, projection })
}
