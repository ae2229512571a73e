//! What a cell has besides its volume: isosurfaces that may cut it, and light.

use std::sync::Arc;

use glam::DVec3;
use tetrascope_integrate::{Isosurface, Isosurfaces, Phong, SurfaceShading};
use tetrascope_scene::{Gradients, Plan, surfaces_near};

use super::cell::Cell;
use super::gradient::CellGradient;
use super::maps::Maps;
use super::record::CellRecord;
use crate::geometry::PixelSpace;

/// What a cell has besides its volume.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellEffects {
    /// The isosurfaces whose values lie in its range of scalars: `first .. first + count`.
    pub(crate) first: u32,
    pub(crate) count: u32,
    /// How far the depths of its faces may be off, so that a joint with the next cell is still seen as one; pixel space.
    pub(crate) slack: f32,
}

/// How far below the value of a surface a scalar still counts as on it, as a share of the cell's range and of the field's: above
/// what a scalar at a face rounds to in f32 (in the steepest cells, see `STEEP` in set-up, 1.5e-5 of the cell's range, rarely more
/// than a tenth of that), far below what a picture shows.
///
/// It says whether a segment ends on the far side of a surface and changes nothing else: segments are cut at the value itself, or at the end
/// that is nearest to it. Without it, a surface in the faces of cells, or in the mesh's boundary, would be there or not as each pixel rounds.
const ON_SURFACE: [f64; 2] = [1e-5, 2e-6];

/// Depths are off by at most this share of a cell's own range of depths (a steep plane, see `STEEP` in set-up, has 2e-5 of it), and
/// by this share of the depth itself, which counts from where the mesh begins (a few roundings).
const SLACK: [f64; 2] = [1e-4, 1e-6];

/// Most of it, as a share of a cell's own range of depths: where f32 does not tell one cell's depth from the next one's, cells in
/// a wrong order would take each other's sides. Then each has its own.
const MOST_SLACK: f64 = 0.05;

/// The isosurfaces and the light of a frame.
#[derive(Debug)]
pub(crate) struct Effects {
    /// By ascending value, in the renderer's unit; those that are drawn along rays.
    pub(crate) surfaces: Isosurfaces,
    /// How they are drawn, where by maps.
    pub(crate) maps: Option<Arc<Maps>>,
    pub(crate) light: Option<Lamp>,
    pub(crate) gradients: Gradients,
    /// Depth that depths count from, see [`PixelSpace::start`].
    start: f64,
}

/// The light of a frame, in the camera's axes: right, down, forward.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lamp {
    pub(crate) phong: Phong,
    /// From the surface towards the light, of length 1; `None` is a light at the eye.
    pub(crate) direction: Option<[f32; 3]>,
    /// Whether the volume is lit.
    pub(crate) volume: bool,
}

/// An isosurface as one cell sees it: its value relative to the cell's reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalSurface {
    /// From which on a scalar counts as above it, see [`ON_SURFACE`].
    pub(crate) above: f32,
    /// Where segments are cut.
    pub(crate) value: f32,
    /// The same, not relative to anything.
    pub(crate) scalar: f64,
    /// Of the side that faces rising scalars, and of the other.
    pub(crate) colors: [[f32; 3]; 2],
    pub(crate) opacity: f32,
    pub(crate) shading: SurfaceShading,
}

impl Lamp {
    /// The light of a plan; `None` if nothing is lit.
    pub(crate) fn new(plan: &Plan, space: &PixelSpace) -> Option<Self> {
        let lighting = plan.lighting.filter(|_| plan.gradients() != Gradients::None)?;
        let direction = lighting.direction.map(|d| space.direction_in_view(d).to_array().map(|x| x as f32));
        Some(Self { phong: lighting.phong, direction, volume: lighting.volume })
    }
}

impl Effects {
    /// Those of a plan; `None` if it has none that are drawn along rays.
    ///
    /// - `surfaces`: those to be seen, in the renderer's unit
    /// - `maps`: where they are drawn by maps
    pub(crate) fn new(
        plan: &Plan,
        surfaces: &Isosurfaces,
        maps: Option<Arc<Maps>>,
        space: &PixelSpace,
    ) -> Option<Self> {
        let light = Lamp::new(plan, space);
        if surfaces.is_empty() && !light.is_some_and(|light| light.volume) {
            return None;
        }
        Some(Self { surfaces: surfaces.clone(), maps, light, gradients: plan.gradients(), start: space.start })
    }

    /// Which cells have effects: those that an isosurface may cut, and all where the volume is lit.
    ///
    /// - `scalars`, `depths`: at the cell's corners, in the renderer's units
    pub(crate) fn of_cell(&self, scalars: &[f64; 4], depths: [f64; 4]) -> Option<CellEffects> {
        let bounds = |values: &[f64; 4]| {
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| (low.min(v), high.max(v)))
        };
        let (low, high) = bounds(scalars);
        let near = surfaces_near(&self.surfaces, low, high);
        if near.is_empty() && !self.light.is_some_and(|light| light.volume) {
            return None;
        }
        let (nearest, farthest) = bounds(&depths.map(|depth| depth - self.start));
        let range = farthest - nearest;
        let slack = (SLACK[0] * range + SLACK[1] * farthest.abs().max(nearest.abs())).min(MOST_SLACK * range);
        Some(CellEffects { first: near.start as u32, count: near.len() as u32, slack: slack as f32 })
    }

    /// The surfaces that may cut a cell, ascending, as it sees them.
    pub(crate) fn localize(&self, record: &CellRecord, cell: &CellEffects, local: &mut Vec<LocalSurface>) {
        let first = cell.first as usize;
        let [low, high] = record.scalar_range;
        let tolerance = ON_SURFACE[0] * f64::from(high - low) + ON_SURFACE[1];
        let to_local = |surface: &Isosurface| LocalSurface {
            above: (surface.value - record.scalar_reference - tolerance) as f32,
            value: (surface.value - record.scalar_reference) as f32,
            scalar: surface.value,
            colors: [surface.color, surface.back_color].map(|color| color.map(|c| c as f32)),
            opacity: surface.opacity as f32,
            shading: surface.shading,
        };
        local.clear();
        local.extend(self.surfaces.as_slice()[first..first + cell.count as usize].iter().map(to_local));
    }

    /// The constant gradient of a cell with effects, where [`Self::gradient`] is another one and surfaces are lit flat.
    pub(crate) fn flat_gradient(&self, cell: &Cell, space: &PixelSpace) -> Option<CellGradient> {
        let any_flat = || self.surfaces.as_slice().iter().any(|surface| surface.shading == SurfaceShading::Flat);
        (self.gradients == Gradients::Points && any_flat()).then(|| CellGradient::constant(cell, space))
    }

    /// The gradient of a cell with effects, where anything is lit.
    pub(crate) fn gradient(
        &self,
        cell: &Cell,
        at_points: impl FnOnce() -> [DVec3; 4],
        space: &PixelSpace,
    ) -> Option<CellGradient> {
        match self.gradients {
            Gradients::None => None,
            Gradients::Cells => Some(CellGradient::constant(cell, space)),
            Gradients::Points => Some(CellGradient::linear(cell, at_points(), space)),
        }
    }
}
