//! What cells have besides their volume: isosurfaces and light. Which shaders a plan needs for them, and what those bind.

use std::sync::Arc;

use glam::DVec3;
use tetrascope_integrate::{Isosurface, Isosurfaces, SurfaceShading};
use tetrascope_mesh::VertexId;
use tetrascope_scene::{Gradients, IsosurfaceMethod, Lighting, Plan};
use tetrascope_shaders::layout::{
    EFFECT_CONSTANTS, LATTICE_STEP, Lamp, MAP_BEHIND, SHADING_FLAT, SHADING_NONE, SHADING_SMOOTH, Surface,
};
use tetrascope_shaders::{Constant, Slot};
use wgpu::Buffer;

use crate::kernel::Named;
use crate::maps::Maps;
use crate::{Gpu, GpuError};

/// The unit of a field's scalars.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ScalarUnit {
    /// Scalars of the plan times this are in the renderer's unit.
    pub(crate) factor: f64,
    /// Lowest and highest scalar, in that unit.
    pub(crate) range: [f64; 2],
    /// The scalar that the lattice counts from, in that unit.
    pub(crate) middle: f64,
}

impl ScalarUnit {
    /// A scalar in the renderer's unit as lattice steps. Those far beyond the field's range end beyond it, so that differences stay whole
    /// numbers of 32 bits.
    pub(crate) fn to_lattice(self, scalar: f64) -> i32 {
        const FARTHEST: f64 = (1u64 << 30) as f64;
        ((scalar - self.middle) / LATTICE_STEP).round().clamp(-FARTHEST, FARTHEST) as i32
    }
}

/// What effects depend on.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    /// Those to be seen, in the renderer's unit.
    surfaces: Isosurfaces,
    method: Option<IsosurfaceMethod>,
    lighting: Option<Lighting>,
    unit: ScalarUnit,
}

impl Key {
    fn of(plan: &Plan, unit: ScalarUnit) -> Self {
        let surfaces = plan.isosurfaces.as_ref().map_or_else(Isosurfaces::default, |isosurfaces| {
            isosurfaces.surfaces.visible().with_scalars_scaled(unit.factor)
        });
        let method = plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.method).filter(|_| !surfaces.is_empty());
        // A light that falls on nothing is none.
        let is_lit = |light: &Lighting| light.volume || surfaces.shading() != SurfaceShading::None;
        let lighting = plan.lighting.filter(is_lit);
        Self { surfaces, method, lighting, unit }
    }

    fn has_lit_volume(&self) -> bool {
        self.lighting.is_some_and(|lighting| lighting.volume)
    }

    fn has_lit_surfaces(&self) -> bool {
        self.lighting.is_some() && self.surfaces.shading() != SurfaceShading::None
    }

    fn gradients(&self) -> Gradients {
        match (self.has_lit_volume(), self.has_lit_surfaces(), self.surfaces.shading()) {
            (true, ..) | (_, true, SurfaceShading::Smooth) => Gradients::Points,
            (_, true, SurfaceShading::Flat) => Gradients::Cells,
            _ => Gradients::None,
        }
    }

    /// Whether any surface is lit with one normal a cell. Maps light all alike, as the most demanding of them asks for.
    fn has_flat_surfaces(&self) -> bool {
        match self.method {
            Some(IsosurfaceMethod::Map { .. }) => self.surfaces.shading() == SurfaceShading::Flat,
            _ => self.surfaces.as_slice().iter().any(|surface| surface.shading == SurfaceShading::Flat),
        }
    }
}

/// The isosurfaces and the light of a plan, on the device; view independent.
#[derive(Debug)]
pub(crate) struct Effects {
    key: Key,
    /// Those that are drawn, where they are drawn.
    drawn: Isosurfaces,
    surfaces: Option<Buffer>,
    maps: Option<Arc<Maps>>,
    lamp: Option<Buffer>,
}

impl Effects {
    /// Those of a plan.
    ///
    /// - `before`: others, of which what is the same is taken over
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] and [`GpuError::Isosurfaces`] for maps.
    pub(crate) fn new(gpu: &Gpu, plan: &Plan, unit: ScalarUnit, before: Option<&Self>) -> Result<Self, GpuError> {
        let key = Key::of(plan, unit);
        let maps = match key.method {
            Some(IsosurfaceMethod::Map { size, mixing }) => {
                let kept = before.and_then(|before| before.maps.as_ref());
                Some(match kept.filter(|maps| maps.is_for(&key.surfaces, size, mixing, unit)) {
                    Some(maps) => Arc::clone(maps),
                    None => Arc::new(Maps::new(gpu, &key.surfaces, size, mixing, unit)?),
                })
            }
            Some(IsosurfaceMethod::Exact) | None => None,
        };
        // Maps have surfaces at the boundaries of texels; the cells that may show them, and tables that stop at them, go by that.
        let drawn = maps.as_ref().map_or_else(|| key.surfaces.clone(), |maps| maps.surfaces().clone());
        let surfaces = (!drawn.is_empty()).then(|| {
            let on_device = |surface: &Isosurface| Surface {
                color: surface.color.map(narrow),
                opacity: narrow(surface.opacity),
                back_color: surface.back_color.map(narrow),
                value: unit.to_lattice(surface.value),
                shading: shading_code(surface.shading),
                padding: [0; 3],
            };
            let surfaces: Vec<Surface> = drawn.as_slice().iter().map(on_device).collect();
            gpu.storage_of("surfaces", &surfaces)
        });
        let lamp = key.lighting.map(|lighting| gpu.uniform_of("lamp", &lamp(&lighting)));
        Ok(Self { key, drawn, surfaces, maps, lamp })
    }

    /// Whether they are what a plan asks for.
    pub(crate) fn is_for(&self, plan: &Plan, unit: ScalarUnit) -> bool {
        self.key == Key::of(plan, unit)
    }

    /// The isosurfaces where they are drawn, in the renderer's unit; none where the plan has none that can be seen.
    pub(crate) fn surfaces(&self) -> &Isosurfaces {
        &self.drawn
    }

    /// Whether `gradients` are bound, see [`point_gradients`].
    pub(crate) fn needs_gradients(&self) -> bool {
        self.key.gradients() == Gradients::Points
    }

    /// The files that draw them; one for every slot, whatever uses it.
    pub(crate) fn slots(&self) -> Vec<Slot<'static>> {
        let key = &self.key;
        let effects = match key.method {
            Some(IsosurfaceMethod::Exact) => "effects/surfaces.wgsl",
            Some(IsosurfaceMethod::Map { .. }) => "effects/maps.wgsl",
            None if key.has_lit_volume() => "effects/lit.wgsl",
            None => "effects/none.wgsl",
        };
        let choose = |is: bool, yes, no| if is { yes } else { no };
        let gradient = match key.gradients() {
            Gradients::Points if key.has_flat_surfaces() => "effects/gradient_mixed.wgsl",
            Gradients::Points => "effects/gradient_points.wgsl",
            Gradients::Cells | Gradients::None => "effects/gradient_cell.wgsl",
        };
        let visible = choose(key.method.is_some(), "effects/visible_surfaces.wgsl", "effects/visible_none.wgsl");
        vec![
            ("effects", effects),
            ("surface_visibility", visible),
            ("volume_light", choose(key.has_lit_volume(), "effects/volume_lit.wgsl", "effects/volume_plain.wgsl")),
            ("surface_light", choose(key.has_lit_surfaces(), "effects/surface_lit.wgsl", "effects/surface_plain.wgsl")),
            ("gradient", gradient),
        ]
    }

    /// The constants that those files know.
    ///
    /// - `carries_joints`: whether each ray meets its cells one after the other and hands on what it left the last one with
    pub(crate) fn constants(&self, carries_joints: bool) -> Vec<(&'static str, Constant)> {
        let passes = self.maps.as_ref().map_or(MAP_BEHIND, |maps| maps.passes());
        let own = [("CARRIES_JOINTS", Constant::Bool(carries_joints)), ("MAP_PASSES", Constant::U32(passes))];
        EFFECT_CONSTANTS.iter().copied().chain(own).collect()
    }

    /// Texels of the maps of isosurfaces; 0 without one.
    pub(crate) fn map_entries(&self) -> u64 {
        self.maps.as_ref().map_or(0, |maps| maps.entries())
    }

    /// Bytes on the device, but for `gradients`.
    pub(crate) fn bytes(&self) -> u64 {
        let maps = self.maps.as_ref().map(|maps| maps.buffer());
        [self.surfaces.as_ref(), maps, self.lamp.as_ref()].into_iter().flatten().map(Buffer::size).sum()
    }

    /// What they bind, but for `gradients`.
    pub(crate) fn resources(&self) -> Vec<Named<'_>> {
        let maps = self.maps.as_ref().map(|maps| maps.buffer());
        let buffers = [("surfaces", self.surfaces.as_ref()), ("maps", maps), ("lamp", self.lamp.as_ref())];
        buffers.into_iter().filter_map(|(name, buffer)| Some((name, buffer?.as_entire_binding()))).collect()
    }
}

/// The field's gradient at every point, along the mesh's axes, ready to be bound as `gradients`.
///
/// - `scalars`: in the renderer's unit
///
/// # Errors
/// [`GpuError::TooLarge`].
pub(crate) fn point_gradients(
    gpu: &Gpu,
    positions: &[DVec3],
    tetrahedra: &[[VertexId; 4]],
    scalars: &[f64],
) -> Result<Buffer, GpuError> {
    check_size(gpu, "the gradients of the points", positions.len() as u64 * 16)?;
    // Sums of three products of them stay finite.
    let bounded = |g: f64| g.clamp(-1e30, 1e30) as f32;
    let gradients: Vec<[f32; 4]> = tetrascope_mesh::point_gradients(positions, tetrahedra, scalars)
        .iter()
        .map(|g| [bounded(g.x), bounded(g.y), bounded(g.z), 0.0])
        .collect();
    Ok(gpu.storage_of("gradients", &gradients))
}

/// Refuses what cannot be bound at once.
pub(crate) fn check_size(gpu: &Gpu, what: &'static str, needed: u64) -> Result<(), GpuError> {
    let limit = gpu.largest_binding();
    let adapter = || gpu.description().name.clone();
    if needed > limit { Err(GpuError::TooLarge { what, needed, limit, adapter: adapter() }) } else { Ok(()) }
}

/// As the shaders know it.
pub(crate) fn shading_code(shading: SurfaceShading) -> u32 {
    match shading {
        SurfaceShading::None => SHADING_NONE,
        SurfaceShading::Flat => SHADING_FLAT,
        SurfaceShading::Smooth => SHADING_SMOOTH,
    }
}

fn lamp(lighting: &Lighting) -> Lamp {
    let phong = &lighting.phong;
    Lamp {
        direction: lighting.direction.unwrap_or_default().to_array().map(narrow),
        is_at_eye: u32::from(lighting.direction.is_none()),
        ambient: narrow(phong.ambient),
        diffuse: narrow(phong.diffuse),
        specular: narrow(phong.specular),
        // Times a logarithm it stays finite.
        shininess: narrow(phong.shininess.min(1e36)),
    }
}

/// To f32 without becoming infinite.
fn narrow(x: f64) -> f32 {
    x.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}

#[cfg(test)]
#[path = "effects_tests.rs"]
mod tests;
