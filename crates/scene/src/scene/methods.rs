//! Which integration, which table and which way to isosurfaces, and whether they go together.

use tetrascope_integrate::{Integration, LengthAxis, TableSettings};
use tetrascope_view::Projection;

use super::Scene;
use crate::text::short;
use crate::{Backend, Decision, Interpolation, IsosurfaceMethod, IsosurfacePlan, Mixing, SceneError};

impl Scene {
    /// The integration, and why.
    pub(crate) fn chosen_integration(&self) -> (Integration, &'static str) {
        let stops = matches!(self.isosurface_method, IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. });
        match self.integration {
            Some(asked) => (asked, "asked for"),
            None if stops && self.isosurfaces.iter().any(|surface| surface.opacity > 0.0) => {
                (Integration::Table3d, "isosurfaces by \"map-stopped\" need a table, and this one knows the length")
            }
            None => (Integration::Exact, "closed form in every piece of the transfer function: no error to trade"),
        }
    }

    pub(super) fn decide_integration(
        &self,
        decisions: &mut Vec<Decision>,
    ) -> Result<(Integration, Option<TableSettings>), SceneError> {
        let (integration, reason) = self.chosen_integration();
        integration.check(self.model)?;
        let tables = TableSettings::of(integration).map(|usual| self.tables.unwrap_or(usual));
        let choice = match &tables {
            None => integration.to_string(),
            Some(tables) => {
                tables.check()?;
                format!("{integration}, {}", size_of(integration, tables))
            }
        };
        decisions.push(Decision::new("integration", choice, reason));
        if tables.is_none() {
            decisions.push(Decision::new("tables", "none", "the integration looks nothing up"));
        }
        Ok((integration, tables))
    }

    /// The interpolation: exact where none was asked for, and where there is no perspective.
    pub(super) fn chosen_interpolation(&self) -> Interpolation {
        match self.camera.projection {
            Projection::Perspective { .. } => self.interpolation.unwrap_or_default(),
            Projection::Orthographic { .. } => Interpolation::Exact,
        }
    }

    pub(super) fn decide_interpolation(
        &self,
        integration: Integration,
        decisions: &mut Vec<Decision>,
    ) -> Result<Interpolation, SceneError> {
        let Some(asked) = self.interpolation else { return Ok(Interpolation::Exact) };
        let chosen = self.chosen_interpolation();
        if chosen != Interpolation::Exact && integration.needs_fan() {
            return Err(SceneError::Conflict {
                key: "quality.interpolation",
                value: asked.to_string(),
                problem: format!(
                    "is a way to segments, and quality.integration = \"{integration}\" interpolates colors in a way of its own"
                ),
                remedy: "use quality.interpolation = \"exact\" or another integration, such as \"exact\"",
            });
        }
        let (choice, reason) = if chosen != asked {
            (chosen, "there is no perspective to correct: all ways give the same")
        } else if asked != Interpolation::Exact && self.backend == Some(Backend::Reference) {
            (Interpolation::Exact, "the reference clips every ray")
        } else {
            (chosen, "asked for")
        };
        decisions.push(Decision::new("interpolation", choice.name(), reason));
        Ok(chosen)
    }

    /// Refuses ways to isosurfaces that the integration or the opacities do not allow.
    pub(super) fn check_isosurface_method(
        &self,
        integration: Integration,
        isosurfaces: Option<&IsosurfacePlan>,
    ) -> Result<(), SceneError> {
        let Some(IsosurfacePlan { surfaces, method }) = isosurfaces else { return Ok(()) };
        let refuse = |problem: String, remedy| SceneError::Conflict {
            key: "quality.isosurfaces",
            value: method.name().to_owned(),
            problem,
            remedy,
        };
        match method {
            IsosurfaceMethod::Exact if integration.needs_fan() => Err(SceneError::Conflict {
                key: "quality.integration",
                value: integration.to_string(),
                problem: "paints triangles, which isosurfaces by \"exact\" cannot cut".to_owned(),
                remedy: "use another integration, such as \"exact\", or quality.isosurfaces = \"map-smooth\"",
            }),
            IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. } if !integration.needs_table() => Err(refuse(
                format!("stops the integral in a table, and quality.integration = \"{integration}\" has none"),
                "use integration \"table-2d\" or \"table-3d\", or isosurfaces \"exact\" or \"map-smooth\"",
            )),
            IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. } if !surfaces.are_opaque() => Err(refuse(
                "ends the integral at isosurfaces, and behind a transparent one it goes on".to_owned(),
                "make all opacities 1, or use isosurfaces \"exact\", which go with every table, or \"map-smooth\"",
            )),
            _ => Ok(()),
        }
    }

    pub(super) fn decide_isosurfaces(&self, isosurfaces: Option<&IsosurfacePlan>, decisions: &mut Vec<Decision>) {
        let Some(IsosurfacePlan { surfaces, method }) = isosurfaces else {
            let reason = if self.isosurfaces.is_empty() { "no map, no crossing" } else { "the opacity of all is 0" };
            decisions.push(Decision::new("isosurfaces", "none", reason));
            return;
        };
        let count = surfaces.as_slice().len();
        let (maps, reason) = match method {
            IsosurfaceMethod::Exact => (String::new(), "rays are cut where they cross them; no map"),
            IsosurfaceMethod::Map { size, mixing: Mixing::Smooth } => {
                (format!(", {size} x {size} samples"), "looked up; the volume is blended between front and back faces")
            }
            IsosurfaceMethod::Map { size, mixing: Mixing::Stopped } => {
                (format!(", {size} x {size} samples"), "looked up; the table's integral stops at them")
            }
        };
        let invisible = self.isosurfaces.len() - count;
        let left_out = if invisible == 0 { String::new() } else { format!("; {invisible} of opacity 0 left out") };
        let choice = format!("{count} by {}{maps}", method.name());
        decisions.push(Decision::new("isosurfaces", choice, format!("{reason}{left_out}")));
    }
}

/// Samples along each axis, and memory.
fn size_of(integration: Integration, tables: &TableSettings) -> String {
    /// Red, green, blue and opacity in 32 bits each.
    const BYTES_AN_ENTRY: f64 = 16.0;
    let TableSettings { scalars, lengths, length_axis } = *tables;
    let plane = f64::from(scalars) * f64::from(scalars) * BYTES_AN_ENTRY;
    let megabytes = |bytes: f64| format!("{} MiB", short(bytes / f64::from(1 << 20)));
    if integration == Integration::Table2d {
        return format!("{scalars} x {scalars} samples, {}", megabytes(plane));
    }
    let spacing = match length_axis {
        LengthAxis::Linear => "",
        LengthAxis::Logarithmic => ", logarithmic lengths",
    };
    format!("{scalars} x {scalars} x {lengths} samples{spacing}, {}", megabytes(plane * f64::from(lengths)))
}
