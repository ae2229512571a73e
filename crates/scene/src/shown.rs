//! In which cells a plan shows anything: one rule for all who ask.

use std::ops::Range;

use tetrascope_integrate::{IsosurfaceError, Isosurfaces, OpticalModel, TransferFunction, surface::TexelAxis};

use crate::{IsosurfaceMethod, Plan};

/// Isosurfaces whose values lie this share of a cell's own range, or this share of the field's, beyond the cell's range count as
/// inside: rounding may put a scalar at its faces there. Too many cost a little time and nothing else.
const MARGIN: [f64; 2] = [1e-4, 4e-6];

/// What a plan shows of a field, by the scalars of a cell.
///
/// A cell that shows nothing is transparent, whatever the view is: no back end sets it up, sorts or draws it.
/// All scalars here are in the renderer's unit, in which the field's range is about one ([`tetrascope_mesh::scalar_factor`]).
#[derive(Clone, Debug)]
pub struct Shown {
    transfer: TransferFunction,
    model: OpticalModel,
    surfaces: Isosurfaces,
}

impl Shown {
    /// - `transfer`: over scalars in the renderer's unit
    /// - `surfaces`: those that are to be seen, where they are drawn, in that unit
    pub fn new(transfer: TransferFunction, model: OpticalModel, surfaces: Isosurfaces) -> Self {
        Self { transfer, model, surfaces }
    }

    /// What a plan shows.
    ///
    /// - `factor`: scalars of the plan times this are in the renderer's unit
    /// - `range`: lowest and highest scalar, in that unit
    ///
    /// # Errors
    /// [`IsosurfaceError`] for a map of no possible size.
    pub fn of(plan: &Plan, factor: f64, range: [f64; 2]) -> Result<Self, IsosurfaceError> {
        let mut surfaces = Isosurfaces::default();
        if let Some(isosurfaces) = &plan.isosurfaces {
            surfaces = isosurfaces.surfaces.visible().with_scalars_scaled(factor);
            if let IsosurfaceMethod::Map { size, .. } = isosurfaces.method
                && !surfaces.is_empty()
            {
                // Maps have surfaces at the boundaries of texels.
                surfaces = surfaces.on_texels(&TexelAxis::new(range, size)?);
            }
        }
        Ok(Self::new(plan.transfer.with_scalars_scaled(factor), plan.model, surfaces))
    }

    /// The transfer function, over scalars in the renderer's unit.
    pub fn transfer(&self) -> &TransferFunction {
        &self.transfer
    }

    /// The isosurfaces that are to be seen.
    pub fn surfaces(&self) -> &Isosurfaces {
        &self.surfaces
    }

    /// What color and extinction mean.
    pub fn model(&self) -> OpticalModel {
        self.model
    }

    /// Whether a cell of these scalars, lowest and highest, shows anything.
    pub fn shows(&self, low: f64, high: f64) -> bool {
        // Whatever may round to a surface: a ray that crosses it in a neighbor takes the side at the joint from here.
        !surfaces_near(&self.surfaces, low, high).is_empty()
            || (self.model.needs_extinction() && self.transfer.max_extinction(low, high) > 0.0)
            || (!self.model.is_dark_without_extinction() && self.transfer.max_emission(low, high) > 0.0)
    }
}

/// The surfaces, by their place, that rays may cross in a cell of these scalars, lowest and highest, in the renderer's unit.
pub fn surfaces_near(surfaces: &Isosurfaces, low: f64, high: f64) -> Range<usize> {
    // The field's range is about one in the renderer's unit.
    let margin = MARGIN[0] * (high - low) + MARGIN[1];
    let surfaces = surfaces.as_slice();
    let first = surfaces.partition_point(|surface| surface.value < low - margin);
    first..first + surfaces[first..].partition_point(|surface| surface.value <= high + margin)
}
