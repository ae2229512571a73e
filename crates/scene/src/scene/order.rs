//! In which order cells are blended, and what is done where no order is right.

use tetrascope_integrate::Integration;
use tetrascope_order::{CycleRemedy, OrderMethod};

use super::Scene;
use crate::{Backend, Decision, SceneError};

impl Scene {
    /// [`Plan::commutes`](crate::Plan::commutes) of the plan that this scene leads to.
    pub fn commutes(&self) -> bool {
        self.model.is_commutative() && self.isosurfaces.iter().all(|surface| surface.opacity <= 0.0)
    }

    /// The order that [`Scene::plan`] takes.
    pub(crate) fn decided_order(&self) -> OrderMethod {
        match self.order {
            Some(asked) => asked,
            None if self.commutes() => OrderMethod::None,
            // Right on any mesh; on a convex one it costs what mpvo does.
            None => OrderMethod::BspXmpvo,
        }
    }

    /// Refuses a remedy for rings that the integration does not allow.
    pub(super) fn check_cycles(&self, integration: Integration) -> Result<(), SceneError> {
        if self.cycles == CycleRemedy::Cut && integration.needs_fan() {
            return Err(SceneError::Conflict {
                key: "quality.cycles",
                value: self.cycles.to_string(),
                problem: format!(
                    "leaves pieces of cells, and quality.integration = \"{integration}\" paints triangles, which a piece does not have"
                ),
                remedy: "use quality.cycles = \"per-pixel\" or another integration, such as \"exact\"",
            });
        }
        Ok(())
    }

    pub(super) fn decide_order(&self, decisions: &mut Vec<Decision>) -> Result<OrderMethod, SceneError> {
        match self.order {
            Some(OrderMethod::Bucket { slabs: 0 }) => {
                return Err(SceneError::value("quality.slabs", 0, "give one or more"));
            }
            Some(OrderMethod::KBuffer { window: 0 }) => {
                return Err(SceneError::value("quality.window", 0, "give one or more"));
            }
            _ => {}
        }
        let order = self.decided_order();
        if self.backend == Some(Backend::Reference) {
            decisions.push(Decision::new("order", "per pixel", "the reference sorts the cells along every ray"));
            return Ok(order);
        }
        let reason = match (self.order, order) {
            (Some(_), OrderMethod::None) if !self.commutes() => {
                "asked for; cells are blended as they come, which is wrong where they overlap"
            }
            (Some(_), _) => "asked for",
            (None, OrderMethod::None) => "this optical model gives the same sum in any order",
            (None, _) => "right for every mesh: neighbors by their faces, and across gaps by the boundary's",
        };
        let choice = match order {
            OrderMethod::Bucket { slabs } => format!("bucket, {slabs} slabs"),
            OrderMethod::KBuffer { window } => format!("k-buffer, {window} cells a pixel"),
            other => other.to_string(),
        };
        decisions.push(Decision::new("order", choice, reason));
        if matches!(order, OrderMethod::Mpvo | OrderMethod::BspXmpvo) {
            let reason = match self.cycles {
                CycleRemedy::Report => "cells in rings are blended by the distance of their centers",
                CycleRemedy::Cut => "cells in rings are cut, where they can be, until none hides another in a ring",
                CycleRemedy::PerPixel => {
                    "where cells hide one another in rings every pixel sorts them; elsewhere it costs nothing"
                }
            };
            decisions.push(Decision::new("cycles", self.cycles.to_string(), reason));
        }
        Ok(order)
    }
}
