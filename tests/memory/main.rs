//! What hostile files cost: a binary of its own, whose allocator counts.
//!
//! All bytes that are asked for are counted and none that are given back, so that no more was ever held at once than is counted here, and
//! work that grows with the square of a file shows too.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a panic is a failure, and measured maxima are said")]

mod bombs;
mod formats;
mod fuzz;
mod growth;
mod real_files;

use std::alloc::System;
use std::sync::{Mutex, MutexGuard, PoisonError};

use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Bytes that were allocated since the program began.
fn allocated() -> usize {
    COUNTED.stats().bytes_allocated
}

/// Held by every test: what another one allocates at the same time would be counted as well.
fn alone() -> MutexGuard<'static, ()> {
    static LOCK: Mutex<()> = Mutex::new(());
    LOCK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Bytes that something allocates, and what it gives.
fn counted<T>(work: impl FnOnce() -> T) -> (usize, T) {
    let before = allocated();
    let result = work();
    (allocated() - before, result)
}
