//! Why a picture was not drawn.

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
    /// The back end has not got the integration yet.
    #[error("this back end has not got the integration \"{integration}\" yet; use \"exact\"")]
    NotBuilt {
        /// The integration.
        integration: tetrascope_integrate::Integration,
    },
    /// The integration cannot be used as the plan asks for it.
    #[error(transparent)]
    Method(#[from] tetrascope_integrate::MethodError),
    /// The operating system gave no threads.
    #[error("{threads} threads could not be started: {problem}; ask for fewer")]
    Threads {
        /// Number of threads wanted.
        threads: usize,
        /// What went wrong.
        problem: String,
    },
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
