//! What every back end relies on: methods of a plan that go together, and scalars that fit the mesh.

use tetrascope_integrate::Integration;
use tetrascope_mesh::TetMesh;
use tetrascope_order::{CycleRemedy, PixelSort};

use crate::{GpuPath, Interpolation, IsosurfaceMethod, Mixing, Plan, memory_text};

/// Why a plan is not drawn, whichever back end is asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// Whoever is told of the progress wants no more of it ([`crate::Progress::is_stopped`]).
    #[error("interrupted; there is no picture")]
    Interrupted,
    /// The memory that the system gives is at its end.
    #[error(
        "{what} takes {}, more memory than the system gives; ask for a smaller one (image.width and image.height), or free some memory",
        memory_text(*.bytes)
    )]
    Memory {
        /// What it was wanted for.
        what: &'static str,
        /// Bytes at least.
        bytes: u64,
    },
    /// The field does not fit the mesh.
    #[error("the field has {scalars} values for {points} points; pass one value a point")]
    ScalarCount {
        /// Number of scalars given.
        scalars: usize,
        /// Number of points of the mesh.
        points: usize,
    },
    /// A scalar that a tetrahedron uses is NaN or infinite.
    #[error("the scalar of point {point} is {value}, and tetrahedron {cell} uses it; leave such cells out first")]
    ScalarNotFinite {
        /// Index of the tetrahedron.
        cell: u32,
        /// Index of the point.
        point: u32,
        /// The scalar.
        value: f64,
    },
    /// The integration does not go with the optical model, or its table has no possible size.
    #[error(transparent)]
    Method(#[from] tetrascope_integrate::MethodError),
    /// Isosurfaces have no possible map.
    #[error(transparent)]
    Isosurfaces(#[from] tetrascope_integrate::IsosurfaceError),
    /// The light has a coefficient that is none.
    #[error(transparent)]
    Light(#[from] tetrascope_integrate::PhongError),
    /// A cell can be cut at isosurfaces along a ray, not as a fan of triangles.
    #[error(
        "\"vertex\" integrates a fan of triangles, which cannot be cut at isosurfaces; use another integration, or isosurfaces by \"map-smooth\""
    )]
    FanWithIsosurfaces,
    /// A piece of a cell has no fan of triangles.
    #[error(
        "\"vertex\" integrates a fan of triangles, which a piece of a cell does not have; use another integration, or the remedy \"per-pixel\" for cycles"
    )]
    FanWithCut,
    /// Fans interpolate colors, and no segments.
    #[error(
        "\"vertex\" interpolates colors over a fan of triangles in a way of its own, and interpolation \"{interpolation}\" is one of segments; use \
         interpolation \"exact\", or another integration"
    )]
    FanWithInterpolation {
        /// The interpolation.
        interpolation: Interpolation,
    },
    /// An integral stops at isosurfaces in a table; this integration has none.
    #[error(
        "integration \"{integration}\" has no table in which it could stop; use \"table-2d\" or \"table-3d\", or isosurfaces by \"exact\" or \"map-smooth\""
    )]
    NoTableToStop {
        /// The integration.
        integration: Integration,
    },
    /// Behind a transparent isosurface the integral goes on.
    #[error(
        "only opaque isosurfaces end an integral in a table; use isosurfaces by \"exact\", which go with every table, or \"map-smooth\""
    )]
    StoppedByTransparent,
    /// A k-buffer that holds nothing back has nothing to blend.
    #[error("a \"k-buffer\" with a window of 0 cells holds nothing; ask for 1 or more")]
    EmptyWindow,
    /// The GPU draws whole cells.
    #[error(
        "the back end \"gpu\" draws whole cells, and the remedy \"cut\" for cycles leaves pieces; use the remedy \"per-pixel\", or the back \
         end \"cpu\""
    )]
    CutOnGpu,
    /// The GPU has segments as the planes have them.
    #[error(
        "the back end \"gpu\" has segments exactly, and not by interpolation \"{interpolation}\"; use the back end \"cpu\", or interpolation \
         \"exact\""
    )]
    InterpolationOnGpu {
        /// The interpolation.
        interpolation: Interpolation,
    },
    /// Only triangles have corners whose colors could be interpolated.
    #[error(
        "\"vertex\" integrates a fan of triangles, which the path \"compute\" of the back end \"gpu\" does not have; use the path \
         \"triangles\", or another integration"
    )]
    FanOnComputePath,
    /// Fans on a GPU have light of their own and nothing else.
    #[error(
        "\"vertex\" on the back end \"gpu\" draws the volume alone; use the back end \"cpu\" for isosurfaces by \"map-smooth\" or a lit volume with it, \
         or another integration"
    )]
    FanWithEffectsOnGpu,
}

impl Plan {
    /// Checks that the methods go together; a plan of a scene always passes.
    ///
    /// # Errors
    /// [`PlanError`], but for what is wrong with scalars.
    pub fn check(&self) -> Result<(), PlanError> {
        let integration = self.integration;
        integration.check(self.model)?;
        if self.cycles == CycleRemedy::Cut && integration.needs_fan() {
            return Err(PlanError::FanWithCut);
        }
        if self.interpolation != Interpolation::Exact && integration.needs_fan() {
            return Err(PlanError::FanWithInterpolation { interpolation: self.interpolation });
        }
        if self.order.pixel_sort() == PixelSort::Window(0) {
            return Err(PlanError::EmptyWindow);
        }
        if let Some(lighting) = &self.lighting {
            lighting.phong.check()?;
        }
        let Some(isosurfaces) = &self.isosurfaces else { return Ok(()) };
        match isosurfaces.method {
            IsosurfaceMethod::Exact if integration.needs_fan() => Err(PlanError::FanWithIsosurfaces),
            IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. } if !integration.needs_table() => {
                Err(PlanError::NoTableToStop { integration })
            }
            IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. } if !isosurfaces.surfaces.visible().are_opaque() => {
                Err(PlanError::StoppedByTransparent)
            }
            _ => Ok(()),
        }
    }

    /// Checks what the back end `gpu` cannot do, besides what [`Self::check`] looks at. The plan's back end is not looked at.
    ///
    /// # Errors
    /// [`PlanError::CutOnGpu`], [`PlanError::InterpolationOnGpu`], [`PlanError::FanOnComputePath`] and [`PlanError::FanWithEffectsOnGpu`].
    pub fn check_on_gpu(&self) -> Result<(), PlanError> {
        if self.cycles == CycleRemedy::Cut {
            return Err(PlanError::CutOnGpu);
        }
        if self.interpolation != Interpolation::Exact {
            return Err(PlanError::InterpolationOnGpu { interpolation: self.interpolation });
        }
        if self.integration.needs_fan() && self.gpu.path == Some(GpuPath::Compute) {
            return Err(PlanError::FanOnComputePath);
        }
        let has_effects = self.isosurfaces.is_some() || self.lighting.is_some_and(|lighting| lighting.volume);
        if self.integration.needs_fan() && has_effects {
            return Err(PlanError::FanWithEffectsOnGpu);
        }
        Ok(())
    }
}

/// Checks once what every renderer relies on: one scalar a point, finite where a tetrahedron uses it.
///
/// # Errors
/// [`PlanError::ScalarCount`] and [`PlanError::ScalarNotFinite`].
pub fn check_scalars(mesh: &TetMesh, scalars: &[f64]) -> Result<(), PlanError> {
    let points = mesh.positions().len();
    if scalars.len() != points {
        return Err(PlanError::ScalarCount { scalars: scalars.len(), points });
    }
    for (cell, corners) in mesh.tetrahedra().iter().enumerate() {
        if let Some(point) = corners.iter().find(|v| !scalars[v.index()].is_finite()) {
            return Err(PlanError::ScalarNotFinite {
                cell: cell as u32,
                point: point.0,
                value: scalars[point.index()],
            });
        }
    }
    Ok(())
}
