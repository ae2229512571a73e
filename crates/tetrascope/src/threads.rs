//! Work on as many threads as a scene asks for.

use rayon::ThreadPoolBuilder;
use tetrascope_cpu::RenderError;

use crate::Error;

/// Runs work on this many threads; `None` leaves it to the threads that are there, one a core.
///
/// # Errors
/// [`RenderError::Threads`] if they cannot be started; nothing is done then.
pub(crate) fn on_threads<T: Send>(threads: Option<usize>, work: impl FnOnce() -> T + Send) -> Result<T, Error> {
    let Some(threads) = threads else { return Ok(work()) };
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| RenderError::Threads { threads, problem: e.to_string() })?;
    Ok(pool.install(work))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_has_the_threads_that_it_is_given() {
        for threads in [1, 3, 5] {
            assert_eq!(on_threads(Some(threads), rayon::current_num_threads).unwrap(), threads);
        }
        let usual = rayon::current_num_threads();
        assert_eq!(on_threads(None, rayon::current_num_threads).unwrap(), usual);
    }
}
