//! What a scene asks of the GPU, and what it cannot do.

use tetrascope_integrate::Integration;
use tetrascope_order::{CycleRemedy, OrderMethod, PixelSort};

use super::Scene;
use crate::{Backend, Decision, GpuOptions, GpuPath, Interpolation, SceneError};

/// Cells that a pixel can hold back on a GPU.
const MOST_WINDOW: u32 = 63;

impl Scene {
    /// Why the back end `gpu` cannot draw this scene, whatever the device; `None` if it can.
    pub fn why_not_on_gpu(&self) -> Option<SceneError> {
        self.gpu_conflict(self.chosen_integration().0)
    }

    pub(super) fn check_gpu(&self, integration: Integration) -> Result<(), SceneError> {
        match self.backend {
            Some(Backend::Gpu) => self.gpu_conflict(integration).map_or(Ok(()), Err),
            _ => Ok(()),
        }
    }

    fn gpu_conflict(&self, integration: Integration) -> Option<SceneError> {
        if self.cycles == CycleRemedy::Cut {
            return Some(SceneError::Conflict {
                key: "quality.cycles",
                value: self.cycles.to_string(),
                problem: "leaves pieces of cells, and the back end \"gpu\" draws whole ones".to_owned(),
                remedy: "use quality.cycles = \"per-pixel\" or quality.backend = \"cpu\"",
            });
        }
        let interpolation = self.chosen_interpolation();
        if interpolation != Interpolation::Exact {
            return Some(SceneError::Conflict {
                key: "quality.interpolation",
                value: interpolation.to_string(),
                problem: "is drawn on the back end \"cpu\" alone".to_owned(),
                remedy: "use quality.backend = \"cpu\" or quality.interpolation = \"exact\"",
            });
        }
        let has_effects = self.isosurfaces.iter().any(|surface| surface.opacity > 0.0)
            || self.lighting.is_some_and(|lighting| lighting.volume);
        if integration.needs_fan() && has_effects {
            return Some(SceneError::Conflict {
                key: "quality.integration",
                value: integration.to_string(),
                problem: "draws the volume alone on the back end \"gpu\", without isosurfaces and light".to_owned(),
                remedy: "use quality.backend = \"cpu\" or another integration, such as \"exact\"",
            });
        }
        let sort = self.order.map_or(PixelSort::None, OrderMethod::pixel_sort);
        if let PixelSort::Window(window) = sort
            && window > MOST_WINDOW
        {
            return Some(SceneError::Conflict {
                key: "quality.window",
                value: window.to_string(),
                problem: format!(
                    "is more than the {MOST_WINDOW} cells that a pixel holds back on the back end \"gpu\""
                ),
                remedy: "use a smaller window, quality.order = \"per-pixel\" or quality.backend = \"cpu\"",
            });
        }
        if sort != PixelSort::None && (self.gpu.path == Some(GpuPath::Triangles) || integration.needs_fan()) {
            return Some(SceneError::Conflict {
                key: "quality.order",
                value: self.order.map_or_else(String::new, |order| order.to_string()),
                problem: "is sorted in the pixels, which triangles on the back end \"gpu\" cannot".to_owned(),
                remedy: "use quality.gpu_path = \"compute\", another order or quality.backend = \"cpu\"",
            });
        }
        (integration.needs_fan() && self.gpu.path == Some(GpuPath::Compute)).then(|| SceneError::Conflict {
            key: "quality.integration",
            value: integration.to_string(),
            problem: "paints triangles, which the path \"compute\" of the back end \"gpu\" does not have".to_owned(),
            remedy: "use quality.gpu_path = \"triangles\" or another integration, such as \"exact\"",
        })
    }

    /// What the plan asks of the GPU; nothing if another back end draws.
    pub(super) fn gpu_options(&self, integration: Integration, decisions: &mut Vec<Decision>) -> GpuOptions {
        if self.backend != Some(Backend::Gpu) {
            return GpuOptions::default();
        }
        let mut options = self.gpu.clone();
        if options.path.is_none() && integration.needs_fan() {
            options.path = Some(GpuPath::Triangles);
            let reason = format!("the integration {integration} is defined on fans of triangles");
            decisions.push(Decision::new("path", GpuPath::Triangles.to_string(), reason));
        }
        options
    }
}
