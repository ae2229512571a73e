//! Ctrl-C, and the system's request to end.
//!
//! The first signal asks the work to stop, which it does between two tiles, frames or steps, and ends all writing ([`end_writing`]);
//! what does not ask is ended after [`PATIENCE`]. A second signal ends at once. No file is half-written in any of these: files are
//! renamed when they are complete.
//!
//! Whoever takes signals waits for nothing: disks, terminals and locks may hang, and it is then that somebody wants the program to end.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::ProgressBar;
#[cfg(unix)]
use signal_hook::consts::SIGHUP;
use signal_hook::consts::{SIGINT, SIGTERM};
use tetrascope::end_writing;

use crate::{Failure, report};

/// How long the work may take to stop by itself: far more than a tile takes, and as long as somebody at a terminal waits without a second Ctrl-C.
const PATIENCE: Duration = Duration::from_secs(1);

/// How long the last line may take: a terminal may be stopped, and a pipe full.
const WORDS: Duration = Duration::from_secs(1);

/// The first signal; 0 as long as there was none.
static SIGNAL: AtomicI32 = AtomicI32::new(0);

static STATE: Mutex<State> =
    Mutex::new(State { bar: None, kept: Vec::new(), written: Vec::new(), folders: Vec::new(), is_said: false });

/// What the last line has to say, and what has to be cleared away before.
struct State {
    bar: Option<ProgressBar>,
    /// Files that are there and are to be replaced.
    kept: Vec<String>,
    written: Vec<String>,
    /// Folders that were made for what is to be written, the innermost first.
    folders: Vec<PathBuf>,
    is_said: bool,
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for signals from now on.
///
/// # Errors
/// The system's, where they cannot be waited for; then they end the program as they end any.
pub(crate) fn watch() -> io::Result<()> {
    #[cfg(unix)]
    {
        // A limit on the size of files is an error of whoever writes one, as a full disk is.
        let unread = std::sync::Arc::default();
        signal_hook::flag::register(signal_hook::consts::SIGXFSZ, unread)?;
        let mut signals = signal_hook::iterator::Signals::new(watched(ignored()))?;
        std::thread::Builder::new().name("signals".to_owned()).spawn(move || signals.forever().for_each(take))?;
    }
    #[cfg(not(unix))]
    {
        use std::sync::{Arc, atomic::AtomicUsize};
        let raised = Arc::new(AtomicUsize::new(0));
        for signal in [SIGINT, SIGTERM] {
            signal_hook::flag::register_usize(signal, Arc::clone(&raised), signal as usize)?;
        }
        let poll = move || {
            loop {
                std::thread::sleep(Duration::from_millis(50));
                match raised.swap(0, Ordering::Relaxed) {
                    0 => {}
                    signal => take(signal as i32),
                }
            }
        };
        std::thread::Builder::new().name("signals".to_owned()).spawn(poll)?;
    }
    Ok(())
}

/// The signals that are waited for, given those that are ignored, a bit each from the lowest on; `None` where nobody says.
///
/// What whoever started the program wants ignored stays so: the closed terminal after `nohup`, Ctrl-C in a script's background. Where
/// that is not known, a closed terminal ends the program as it ends any.
#[cfg(unix)]
fn watched(ignored: Option<u64>) -> Vec<i32> {
    let is_ignored = |signal: i32| ignored.map_or(signal == SIGHUP, |mask| mask >> (signal - 1) & 1 == 1);
    [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| !is_ignored(signal)).collect()
}

/// Signals that this process was started to ignore.
#[cfg(unix)]
fn ignored() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
    u64::from_str_radix(mask.trim(), 16).ok()
}

/// What one signal does.
fn take(signal: i32) {
    if SIGNAL.compare_exchange(0, signal, Ordering::SeqCst, Ordering::SeqCst).is_err() {
        end_now();
    }
    let wait = || {
        std::thread::sleep(PATIENCE);
        end_now();
    };
    let start = |name: &str, work: fn()| std::thread::Builder::new().name(name.to_owned()).spawn(work).is_ok();
    // With no thread to be had nobody waits. A file that is being put in its place may take long on a disk far away.
    if !start("patience", wait) || !start("end of writing", end_writing) {
        end_now();
    }
}

/// Ends the process under whatever is still at work.
fn end_now() -> ! {
    let (said, is_said) = std::sync::mpsc::channel();
    let speak = move || {
        say();
        // Nobody listens any more if it took too long.
        let _ = said.send(());
    };
    if std::thread::Builder::new().name("last words".to_owned()).spawn(speak).is_ok() {
        // Said or not, it ends.
        let _ = is_said.recv_timeout(WORDS);
    }
    // Nothing that runs at a regular exit may wait for the work, a driver's least of all.
    signal_hook::low_level::exit(128 + SIGNAL.load(Ordering::SeqCst))
}

/// Whether the work is to be given up.
pub(crate) fn is_stopped() -> bool {
    SIGNAL.load(Ordering::Relaxed) != 0
}

/// Between two steps of a command.
///
/// # Errors
/// [`Failure::Interrupted`] once there was a signal.
pub(crate) fn go_on() -> Result<(), Failure> {
    if is_stopped() { Err(Failure::Interrupted) } else { Ok(()) }
}

/// The exit code after a signal: 130 for Ctrl-C, 143 for the request to end, 129 for a closed terminal. `None` without one.
pub(crate) fn exit_code() -> Option<u8> {
    let signal = SIGNAL.load(Ordering::SeqCst);
    (signal != 0).then(|| u8::try_from(128 + signal).unwrap_or(130))
}

/// A bar that has to be taken away.
pub(crate) fn shows(bar: &ProgressBar) {
    state().bar = Some(bar.clone());
}

/// A file that is to be written, or replaced.
pub(crate) fn will_write(path: &Path) {
    if path.exists() {
        will_replace(path.display().to_string());
    }
}

/// Something that is there and is to be replaced.
pub(crate) fn will_replace(what: String) {
    state().kept.push(what);
}

/// A file that is written.
pub(crate) fn wrote(path: &Path) {
    has_replaced(path.display().to_string());
}

/// Something that is written, and called as in [`will_replace`].
pub(crate) fn has_replaced(name: String) {
    let mut state = state();
    state.kept.retain(|kept| *kept != name);
    state.written.push(name);
}

/// What is said of something that was written, in place of what was said of it before.
pub(crate) fn replaces(before: &str, name: String) {
    let mut state = state();
    state.written.retain(|written| written != before);
    state.written.push(name);
}

/// A folder that was made and goes again where nothing is written into it.
pub(crate) fn made_folder(path: &Path) {
    state().folders.insert(0, path.to_owned());
}

/// Removes the folders that were made and are still empty.
pub(crate) fn remove_empty_folders() {
    for folder in state().folders.drain(..) {
        // One with something in it stays.
        let _ = std::fs::remove_dir(folder);
    }
}

/// Says once what became of the files; the bar is taken away before.
pub(crate) fn say() {
    remove_empty_folders();
    let mut state = state();
    if std::mem::replace(&mut state.is_said, true) {
        return;
    }
    if let Some(bar) = state.bar.take() {
        bar.finish_and_clear();
    }
    report::interrupted(&text(&state.kept, &state.written));
}

fn text(kept: &[String], written: &[String]) -> String {
    let mut parts = vec![match written {
        [] => "nothing was written".to_owned(),
        [one] => format!("{one} was written before"),
        several => format!("{} were written before", list(several)),
    }];
    match kept {
        [] => {}
        [one] => parts.push(format!("{one} is as it was")),
        several => parts.push(format!("{} are as they were", list(several))),
    }
    parts.join("; ")
}

fn list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn signals_that_were_ignored_stay_so() {
        let mask = |signal: i32| 1 << (signal - 1);
        assert_eq!(watched(Some(0)), [SIGINT, SIGTERM, SIGHUP]);
        assert_eq!(watched(Some(mask(SIGHUP))), [SIGINT, SIGTERM]);
        assert_eq!(watched(Some(mask(SIGINT))), [SIGTERM, SIGHUP]);
        assert_eq!(watched(None), [SIGINT, SIGTERM]);
    }

    #[test]
    fn the_last_line_says_what_became_of_the_files() {
        let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let (a, b, c) = ("a.png", "b.exr", "c.toml");
        for (kept, written, said) in [
            (&[][..], &[][..], "nothing was written"),
            (&[a], &[], "nothing was written; a.png is as it was"),
            (&[a, b, c], &[], "nothing was written; a.png, b.exr and c.toml are as they were"),
            (&[], &[a], "a.png was written before"),
            (&[c], &[a, b], "a.png and b.exr were written before; c.toml is as it was"),
        ] {
            assert_eq!(text(&names(kept), &names(written)), said);
        }
    }
}
