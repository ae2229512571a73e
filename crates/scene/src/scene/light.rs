//! The light of a scene: checked, brought to length 1, and left out where nothing is lit.

use glam::DVec3;
use tetrascope_integrate::{Phong, SurfaceShading};

use super::Scene;
use crate::text::short;
use crate::{Decision, Gradients, IsosurfacePlan, Lighting, Plan, SceneError};

impl Scene {
    /// The light where anything is lit.
    pub(super) fn lighting(&self, isosurfaces: Option<&IsosurfacePlan>) -> Result<Option<Lighting>, SceneError> {
        let Lighting { phong, direction, volume } = self.lighting.unwrap_or_default();
        check(&phong)?;
        let direction = direction.map(of_length_one).transpose()?;
        // Absorption sends no light that could be brighter or darker.
        let volume = volume && self.model.needs_emission();
        let has_shaded = isosurfaces.is_some_and(|plan| plan.surfaces.shading() != SurfaceShading::None);
        Ok((volume || has_shaded).then_some(Lighting { phong, direction, volume }))
    }
}

fn check(phong: &Phong) -> Result<(), SceneError> {
    let Phong { ambient, diffuse, specular, shininess } = *phong;
    for (key, value) in [
        ("light.ambient", ambient),
        ("light.diffuse", diffuse),
        ("light.specular", specular),
        ("light.shininess", shininess),
    ] {
        if !(value.is_finite() && value >= 0.0) {
            return Err(SceneError::value(key, value, "give a finite number, zero or more"));
        }
    }
    Ok(())
}

fn of_length_one(direction: DVec3) -> Result<DVec3, SceneError> {
    let largest = direction.abs().max_element();
    if !(direction.is_finite() && largest > 0.0) {
        let expected = "give \"headlight\", or three finite numbers that are not all 0";
        return Err(SceneError::value("light.direction", format!("{:?}", direction.to_array()), expected));
    }
    // Divided by its largest component first, so that the squares of 1e-200 or 1e200 stay numbers.
    let scaled = direction / largest;
    Ok(scaled / scaled.length())
}

/// What is said of the light and the gradients that it needs.
pub(super) fn decisions(plan: &Plan) -> Vec<Decision> {
    let gradients = |choice: &str, reason: &str| Decision::new("gradients", choice, reason);
    let Some(Lighting { phong, direction, volume }) = plan.lighting else {
        return vec![gradients("none", "no lighting")];
    };
    let from = match direction {
        None => "headlight".to_owned(),
        Some(d) => format!("from the direction ({}, {}, {})", short(d.x), short(d.y), short(d.z)),
    };
    let shading = plan.isosurfaces.as_ref().map_or(SurfaceShading::None, |isosurfaces| isosurfaces.surfaces.shading());
    let on = match (volume, shading) {
        (true, SurfaceShading::None) => "on the volume",
        (true, _) => "on volume and isosurfaces",
        (false, _) => "on isosurfaces",
    };
    let [ambient, diffuse, specular, shininess] =
        [phong.ambient, phong.diffuse, phong.specular, phong.shininess].map(short);
    let reason = format!("{on}; ambient {ambient}, diffuse {diffuse}, specular {specular}, shininess {shininess}");
    let needed = match plan.gradients() {
        Gradients::None => gradients("none", "nothing is lit"),
        Gradients::Cells => gradients("one a cell", "flat shading has one normal a cell"),
        Gradients::Points if volume => gradients("one a point", "the volume is lit by its gradients"),
        Gradients::Points => gradients("one a point", "smooth shading interpolates them"),
    };
    vec![Decision::new("light", from, reason), needed]
}
