//! Why a picture was not drawn.

use tetrascope_integrate::{IsosurfaceError, MethodError};
use tetrascope_scene::PlanError;

/// Why a picture was not drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The plan or the scalars, for a reason that holds for every back end.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The integration is defined on a fan of triangles, which the reference does not have.
    #[error(
        "the reference clips rays and has no fan of triangles, on which \"vertex\" is defined; use \"exact\", or the back end \"cpu\""
    )]
    IntegrationNeedsFan,
    /// The operating system gave no threads.
    #[error("{threads} threads could not be started: {problem}; ask for fewer")]
    Threads {
        /// Number of threads wanted.
        threads: usize,
        /// What went wrong.
        problem: String,
    },
}

impl From<MethodError> for RenderError {
    fn from(error: MethodError) -> Self {
        PlanError::from(error).into()
    }
}

impl From<IsosurfaceError> for RenderError {
    fn from(error: IsosurfaceError) -> Self {
        PlanError::from(error).into()
    }
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
