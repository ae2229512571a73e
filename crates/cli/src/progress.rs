//! The progress bar: on standard error, only on a terminal, only for work that takes a while.

use std::io::IsTerminal;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tetrascope::{Progress, ReadProgress, ReadStage, Stage};
use tetrascope_study::StudyProgress;

use crate::interrupt;

/// A bar that shows one step at a time.
#[derive(Debug)]
pub(crate) struct Bar {
    bar: ProgressBar,
    stage: Mutex<Option<Stage>>,
}

impl Bar {
    /// A bar, or nothing at all when `quiet` or when nobody watches.
    pub(crate) fn new(quiet: bool) -> Self {
        let target = if quiet || !std::io::stderr().is_terminal() {
            ProgressDrawTarget::hidden()
        } else {
            // Ten times a second; a back end reports thousands of times.
            ProgressDrawTarget::stderr_with_hz(10)
        };
        let bar = ProgressBar::with_draw_target(None, target);
        interrupt::shows(&bar);
        Self { bar, stage: Mutex::new(None) }
    }

    /// A step of which only the beginning and the end are known.
    pub(crate) fn step(&self, name: &'static str) {
        spin(&self.bar, name);
    }

    /// Shows what is read of files, for [`ReadOptions::progress`](tetrascope::ReadOptions); in between what [`step`](Self::step) showed.
    pub(crate) fn reading(&self) -> Option<Arc<dyn ReadProgress>> {
        Some(Arc::new(Reading { bar: self.bar.clone(), shown: Mutex::new(None) }))
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.bar.disable_steady_tick();
        self.bar.finish_and_clear();
    }
}

fn spin(bar: &ProgressBar, name: impl Into<std::borrow::Cow<'static, str>>) {
    bar.set_style(ProgressStyle::default_spinner());
    bar.set_message(name);
    bar.enable_steady_tick(Duration::from_millis(100));
}

/// The same bar while files are read.
#[derive(Debug)]
struct Reading {
    bar: ProgressBar,
    /// The stage and the file's length that are shown, and what was there before.
    shown: Mutex<Option<(ReadStage, u64, String)>>,
}

impl ReadProgress for Reading {
    fn report(&self, stage: ReadStage, done: u64, total: u64) {
        if self.bar.is_hidden() {
            return;
        }
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        if done >= total {
            // What comes now is not counted.
            if let Some((_, _, before)) = shown.take() {
                spin(&self.bar, before);
            }
            return;
        }
        if !shown.as_ref().is_some_and(|shown| (shown.0, shown.1) == (stage, total)) {
            let before = shown.take().map_or_else(|| self.bar.message(), |(_, _, before)| before);
            *shown = Some((stage, total, before));
            self.bar.disable_steady_tick();
            if let Ok(style) = ProgressStyle::with_template("{msg:10} [{bar:40}] {bytes} of {total_bytes} {eta}") {
                self.bar.set_style(style.progress_chars("=> "));
            }
            self.bar.set_message(stage.to_string());
            self.bar.set_length(total);
        }
        self.bar.set_position(done);
    }

    fn is_stopped(&self) -> bool {
        interrupt::is_stopped()
    }
}

impl StudyProgress for Bar {
    fn report(&self, step: &str, done: u64, total: u64) {
        if self.bar.is_hidden() {
            return;
        }
        if self.bar.length() != Some(total) {
            self.bar.disable_steady_tick();
            if let Ok(style) = ProgressStyle::with_template("[{bar:40}] {percent:>3} % {eta:4} {msg}") {
                self.bar.set_style(style.progress_chars("=> "));
            }
            self.bar.set_length(total);
        }
        self.bar.set_message(step.to_owned());
        self.bar.set_position(done);
    }

    fn is_stopped(&self) -> bool {
        interrupt::is_stopped()
    }
}

impl Progress for Bar {
    fn report(&self, stage: Stage, done: u64, total: u64) {
        if self.bar.is_hidden() {
            return;
        }
        let mut last = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        if *last != Some(stage) {
            *last = Some(stage);
            self.bar.disable_steady_tick();
            if let Ok(style) = ProgressStyle::with_template("{msg:10} [{bar:40}] {percent:>3} % {eta}") {
                self.bar.set_style(style.progress_chars("=> "));
            }
            self.bar.set_message(stage.to_string());
            self.bar.set_length(total);
            self.bar.set_position(done);
        }
        // Reports of one stage arrive out of order: the bar only grows.
        if done > self.bar.position() {
            self.bar.set_position(done);
        }
    }
    fn is_stopped(&self) -> bool {
        interrupt::is_stopped()
    }
}
