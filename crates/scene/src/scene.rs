//! A scene with nothing left open, and the plan that follows from it.

use tetrascope_integrate::{Integration, OpticalModel, TableSettings, TransferFunction};
use tetrascope_order::OrderMethod;
use tetrascope_view::{Camera, View};

use crate::{Backend, Decision, Plan, SceneError};

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
    /// How a segment becomes color and opacity; `None` leaves it to [`Scene::plan`].
    pub integration: Option<Integration>,
    /// In which order cells are blended; `None` leaves it to [`Scene::plan`].
    pub order: Option<OrderMethod>,
    /// Who computes.
    pub backend: Backend,
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
    /// [`SceneError`] if the camera, the picture's size, the background or the transfer function has numbers that make no
    /// picture.
    pub fn plan(&self) -> Result<Plan, SceneError> {
        let view = View::new(&self.camera, self.width, self.height)?;
        let transfer = TransferFunction::new(&self.color, &self.extinction)?;
        if !self.background.iter().all(|c| c.is_finite() && *c >= 0.0) {
            let value = format!("{:?}", self.background);
            return Err(SceneError::Value {
                key: "image.background",
                value,
                expected: "give three finite numbers, zero or more",
            });
        }
        if let Some(OrderMethod::Bucket { slabs: 0 }) = self.order {
            return Err(SceneError::Value {
                key: "quality.slabs",
                value: "0".to_owned(),
                expected: "give one or more",
            });
        }
        let mut decisions = Vec::new();
        let integration = self.decide_integration(&mut decisions);
        let order = self.decide_order(&mut decisions);
        self.say_what_is_left_out(&mut decisions);
        Ok(Plan {
            view,
            background: self.background.map(|c| c as f32),
            transfer,
            model: self.model,
            integration,
            tables: TableSettings::of(integration),
            isosurfaces: None,
            lighting: None,
            order,
            backend: self.backend,
            threads: self.threads,
            termination: Self::TERMINATION,
            decisions,
        })
    }

    fn decide_integration(&self, decisions: &mut Vec<Decision>) -> Integration {
        let (integration, reason) = match self.integration {
            Some(asked) => (asked, "asked for"),
            None => (Integration::Exact, "closed form in every piece of the transfer function: no error to trade"),
        };
        decisions.push(Decision::new("integration", integration.to_string(), reason));
        integration
    }

    fn decide_order(&self, decisions: &mut Vec<Decision>) -> OrderMethod {
        let commutes = self.model.is_commutative();
        let (order, reason) = match self.order {
            Some(OrderMethod::None) if !commutes => {
                (OrderMethod::None, "asked for; cells are blended as they come, which is wrong where they overlap")
            }
            Some(asked) => (asked, "asked for"),
            None if commutes => (OrderMethod::None, "this optical model gives the same sum in any order"),
            None => {
                (OrderMethod::Centroid, "distance of the cells' centers; may be wrong between cells of unlike shape")
            }
        };
        let choice = match order {
            OrderMethod::Bucket { slabs } => format!("bucket, {slabs} slabs"),
            other => other.to_string(),
        };
        if self.backend == Backend::Reference {
            decisions.push(Decision::new("order", "per pixel", "the reference sorts the cells along every ray"));
        } else {
            decisions.push(Decision::new("order", choice, reason));
        }
        order
    }

    fn say_what_is_left_out(&self, decisions: &mut Vec<Decision>) {
        decisions.push(Decision::new("gradients", "none", "no lighting"));
        if !self.model.needs_emission() {
            decisions.push(Decision::new("color", "none", "absorption ignores it"));
        }
        if !self.model.needs_extinction() {
            decisions.push(Decision::new("extinction", "none", "emission ignores it"));
        }
    }
}
