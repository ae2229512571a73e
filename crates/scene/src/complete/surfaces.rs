//! Isosurfaces and the light that falls on them.

use tetrascope_integrate::Isosurface;

use crate::file::{IsosurfaceSection, SceneFile, Shading};
use crate::text::short;
use crate::{Lighting, MeshFacts};

/// Gives every isosurface its second color, and says which of them cannot be seen.
pub(super) fn fill_isosurfaces(file: &mut SceneFile, facts: &MeshFacts, warnings: &mut Vec<String>) -> Vec<Isosurface> {
    let (low, high) = facts.scalar_range;
    for (index, section) in file.isosurface.iter_mut().enumerate() {
        section.back_color.get_or_insert(section.color);
        // A ray crosses a surface between a scalar below its value and one that is not: none is below the lowest.
        let is_crossed = low < section.value && section.value <= high;
        if section.value.is_finite() && !is_crossed {
            warnings.push(format!(
                "isosurface[{index}].value is {}, and the field goes from {} to {}: this surface is not seen",
                section.value,
                short(low),
                short(high)
            ));
        }
    }
    if !file.isosurface.is_empty() && file.isosurface.iter().all(|section| section.opacity == 0.0) {
        warnings.push("the opacity of every isosurface is 0: none is seen".to_owned());
    }
    file.isosurface.iter().map(Isosurface::from).collect()
}

/// Writes the light out where something is lit, and takes it away where nothing is.
pub(super) fn fill_light(file: &mut SceneFile, warnings: &mut Vec<String>) -> Option<Lighting> {
    let is_lit = |section: &IsosurfaceSection| section.shading != Shading::None && section.opacity != 0.0;
    let has_lit_surface = file.isosurface.iter().any(is_lit);
    let asks_volume = file.light.as_ref().is_some_and(|light| light.volume);
    let has_lit_volume = asks_volume && file.optics.model.needs_emission();
    if asks_volume && !has_lit_volume {
        warnings.push(format!("light.volume has no effect: the model {} has no color to light", file.optics.model));
    } else if file.light.is_some() && !has_lit_surface && !has_lit_volume {
        warnings.push(
            "[light] has no effect: nothing is lit; give an isosurface a shading, or set light.volume = true"
                .to_owned(),
        );
    }
    if !has_lit_surface && !has_lit_volume {
        file.light = None;
        return None;
    }
    let light = file.light.get_or_insert_default();
    light.volume = has_lit_volume;
    Some(Lighting::from(&*light))
}
