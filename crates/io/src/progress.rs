//! Who is told how far a reader is, and may stop it.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::{IoError, ReadOptions};

/// What a reader is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadStage {
    /// Taking the bytes of a file from the system; of files that need not be in memory whole, decoding them too.
    Reading,
    /// Making numbers of the bytes in memory.
    Decoding,
}

impl fmt::Display for ReadStage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reading => "reading",
            Self::Decoding => "decoding",
        })
    }
}

/// Watches a reader.
pub trait ReadProgress: Send + Sync + fmt::Debug {
    /// So many of a file's bytes are done. Within a stage of one file the number only grows, and ends at the total where nothing fails. Files
    /// that name others begin anew with each; formats whose numbers are made in one go have no stage [`ReadStage::Decoding`].
    fn report(&self, stage: ReadStage, done: u64, total: u64);

    /// Whether to give up, asked after every few million bytes; the reader then ends with [`IoError::Interrupted`].
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Counts the bytes of one stage of one file.
#[derive(Debug)]
pub(crate) struct Meter {
    path: PathBuf,
    progress: Option<Arc<dyn ReadProgress>>,
    stage: ReadStage,
    done: AtomicU64,
    total: u64,
}

impl Meter {
    /// A stage of which nothing is done yet.
    pub(crate) fn new(path: &Path, options: &ReadOptions, stage: ReadStage, total: u64) -> Self {
        Self { path: path.to_owned(), progress: options.progress.clone(), stage, done: AtomicU64::new(0), total }
    }

    /// Reports so many more bytes. What is read twice counts twice, up to the total.
    ///
    /// # Errors
    /// [`IoError::Interrupted`].
    pub(crate) fn advance(&self, bytes: usize) -> Result<(), IoError> {
        let Some(progress) = &self.progress else { return Ok(()) };
        // One thread reports; it is shared with others all the same.
        let done = self.done.load(Ordering::Relaxed).saturating_add(bytes as u64).min(self.total);
        self.done.store(done, Ordering::Relaxed);
        progress.report(self.stage, done, self.total);
        if progress.is_stopped() {
            return Err(IoError::Interrupted { path: self.path.clone() });
        }
        Ok(())
    }

    /// Reports that nothing of this stage is left, whatever was passed over.
    ///
    /// # Errors
    /// [`IoError::Interrupted`].
    pub(crate) fn finish(&self) -> Result<(), IoError> {
        self.advance(usize::MAX)
    }
}
