//! Why a picture was not drawn.

use tetrascope_integrate::Integration;
use tetrascope_order::{CycleRemedy, PixelSort};
use tetrascope_scene::{IsosurfaceMethod, Mixing, Plan};

/// Why a picture was not drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
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
    /// The integration is defined on a fan of triangles, which the reference does not have.
    #[error(
        "the reference clips rays and has no fan of triangles, on which \"vertex\" is defined; use \"exact\", or the back end \"cpu\""
    )]
    IntegrationNeedsFan,
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
    /// The operating system gave no threads.
    #[error("{threads} threads could not be started: {problem}; ask for fewer")]
    Threads {
        /// Number of threads wanted.
        threads: usize,
        /// What went wrong.
        problem: String,
    },
}

/// Checks that a plan's methods go together; a plan of a scene always passes.
pub(crate) fn check_methods(plan: &Plan) -> Result<(), RenderError> {
    let integration = plan.integration;
    integration.check(plan.model)?;
    if plan.cycles == CycleRemedy::Cut && integration.needs_fan() {
        return Err(RenderError::FanWithCut);
    }
    if plan.order.pixel_sort() == PixelSort::Window(0) {
        return Err(RenderError::EmptyWindow);
    }
    if let Some(lighting) = &plan.lighting {
        lighting.phong.check()?;
    }
    let Some(isosurfaces) = &plan.isosurfaces else { return Ok(()) };
    match isosurfaces.method {
        IsosurfaceMethod::Exact if integration.needs_fan() => Err(RenderError::FanWithIsosurfaces),
        IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. } if !integration.needs_table() => {
            Err(RenderError::NoTableToStop { integration })
        }
        IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. } if !isosurfaces.surfaces.visible().are_opaque() => {
            Err(RenderError::StoppedByTransparent)
        }
        _ => Ok(()),
    }
}

/// Checks once what both renderers rely on.
pub(crate) fn check_scalars(mesh: &tetrascope_mesh::TetMesh, scalars: &[f64]) -> Result<(), RenderError> {
    let points = mesh.positions().len();
    if scalars.len() != points {
        return Err(RenderError::ScalarCount { scalars: scalars.len(), points });
    }
    for (cell, corners) in mesh.tetrahedra().iter().enumerate() {
        if let Some(point) = corners.iter().find(|v| !scalars[v.index()].is_finite()) {
            return Err(RenderError::ScalarNotFinite {
                cell: cell as u32,
                point: point.0,
                value: scalars[point.index()],
            });
        }
    }
    Ok(())
}

/// Runs `work` on the number of threads that the plan asks for.
pub(crate) fn on_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, RenderError> {
    let Some(threads) = threads else { return Ok(work()) };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| RenderError::Threads { threads, problem: e.to_string() })?;
    Ok(pool.install(work))
}
