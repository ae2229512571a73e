//! How far a study has come.

use std::sync::{Mutex, PoisonError};

use tetrascope::{Progress, Stage};

/// Told how far a study has come; called from any thread.
pub trait StudyProgress: Sync {
    /// `done` of `total` parts are finished, and `step` is under way. `total` is the same in every call, `done` never less than before.
    fn report(&self, step: &str, done: u64, total: u64);

    /// Whether the study is to be given up, as [`Progress::is_stopped`].
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Tells nobody.
impl StudyProgress for tetrascope::Silent {
    fn report(&self, _step: &str, _done: u64, _total: u64) {}
}

/// Parts of the whole: as fine as a bar can show.
const TOTAL: u64 = 1000;
/// Of these, for the reference, which takes as long as some dozens of frames.
const REFERENCE: u64 = 200;

/// Counts reference and frames together.
pub(crate) struct Meter<'a> {
    told: &'a dyn StudyProgress,
    /// Held while somebody is told, so that no thread tells of less after another told of more.
    done: Mutex<u64>,
}

impl<'a> Meter<'a> {
    pub(crate) fn new(told: &'a dyn StudyProgress) -> Self {
        Self { told, done: Mutex::new(0) }
    }

    /// So many frames of all are drawn.
    pub(crate) fn frames(&self, step: &str, done: u64, total: u64) {
        self.at(step, REFERENCE + (TOTAL - REFERENCE) * done.min(total) / total.max(1));
    }

    fn at(&self, step: &str, done: u64) {
        let mut last = self.done.lock().unwrap_or_else(PoisonError::into_inner);
        if done >= *last {
            *last = done;
            self.told.report(step, done, TOTAL);
        }
    }
}

/// The reference alone: only its last stage takes long.
impl Progress for Meter<'_> {
    fn report(&self, stage: Stage, done: u64, total: u64) {
        if stage == Stage::Rasterize {
            self.at("the reference", REFERENCE * done / total.max(1));
        }
    }

    fn is_stopped(&self) -> bool {
        self.told.is_stopped()
    }
}

/// Frames, of which nobody is told how far each has come; they end where the study is to be given up.
pub(crate) struct Untold<'a>(pub(crate) &'a Meter<'a>);

impl Progress for Untold<'_> {
    fn report(&self, _stage: Stage, _done: u64, _total: u64) {}

    fn is_stopped(&self) -> bool {
        self.0.is_stopped()
    }
}
