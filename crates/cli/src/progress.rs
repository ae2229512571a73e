//! The progress bar: on standard error, only on a terminal, only for work that takes a while.

use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tetrascope::{Progress, Stage};
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
        self.bar.set_style(ProgressStyle::default_spinner());
        self.bar.set_message(name);
        self.bar.enable_steady_tick(Duration::from_millis(100));
    }

    /// Takes the bar away.
    pub(crate) fn clear(&self) {
        self.bar.disable_steady_tick();
        self.bar.finish_and_clear();
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
