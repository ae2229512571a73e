//! Ctrl-C and the request to end, sent to the program at work.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// A child that does not end is killed after this, and the test fails: no measure of anything.
const DEADLINE: Duration = Duration::from_secs(120);

/// The program, waiting for all signals even where the tests themselves ignore some, as in a script's background.
fn program() -> Command {
    let path = env!("CARGO_BIN_EXE_tetrascope");
    if !cfg!(target_os = "linux") {
        return Command::new(path);
    }
    let mut command = Command::new("env");
    command.args(["--default-signal=INT", "--default-signal=TERM", "--default-signal=HUP", path]);
    command
}

fn start(folder: &Path, args: &[&str]) -> Child {
    let mut command = program();
    command.args(args).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// Waits until something is seen.
fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < DEADLINE, "{what} never came");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Reads the report up to a line that begins so.
fn wait_for(child: &mut Child, start: &str) {
    let mut lines = BufReader::new(child.stdout.as_mut().unwrap()).lines();
    assert!(lines.any(|line| line.unwrap().starts_with(start)), "the report has no line {start}");
}

/// The exit code and standard error.
fn end(mut child: Child) -> (Option<i32>, String) {
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begin.elapsed() > DEADLINE {
            child.kill().unwrap();
            panic!("the program went on after the signal");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let mut text = String::new();
    child.stderr.take().unwrap().read_to_string(&mut text).unwrap();
    (status.code(), text)
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Minutes of work, on any machine.
const LONG: [&str; 6] = ["render", "builtin:rings", "--backend", "reference", "--size", "6000"];

#[test]
fn an_interrupted_picture_leaves_the_old_one() {
    let closed_terminal = cfg!(target_os = "linux").then_some(("-HUP", 129));
    for (name, code) in [("-INT", 130), ("-TERM", 143)].into_iter().chain(closed_terminal) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("old.png"), "old").unwrap();
        let mut child = start(folder.path(), &[&LONG[..], &["-o", "old.png", "-o", "new.exr"]].concat());
        wait_for(&mut child, "backend");
        signal(&child, name);
        let (found, text) = end(child);
        assert_eq!((found, text.as_str()), (Some(code), "interrupted: nothing was written; old.png is as it was\n"));
        assert_eq!(names(folder.path()), ["old.png"]);
        assert_eq!(std::fs::read(folder.path().join("old.png")).unwrap(), b"old");
    }
}

#[test]
fn what_was_written_before_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["render", "builtin:rings", "--size", "4000", "-o", "a.png", "--error-map", "map.exr"];
    std::fs::write(folder.path().join("map.exr"), "old").unwrap();
    let mut child = start(folder.path(), &args);
    wait_for(&mut child, "wrote");
    signal(&child, "-INT");
    let (code, text) = end(child);
    assert_eq!(code, Some(130), "{text}");
    assert!(text.ends_with("interrupted: a.png was written before; map.exr is as it was\n"), "{text}");
    assert_eq!(names(folder.path()), ["a.png", "map.exr"]);
    assert_eq!(std::fs::read(folder.path().join("map.exr")).unwrap(), b"old");
    let picture = tetrascope::read_png(&folder.path().join("a.png")).unwrap();
    assert_eq!((picture.width, picture.height), (4000, 4000));
}

#[test]
fn a_second_signal_ends_it_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = start(folder.path(), &[&LONG[..], &["-o", "a.png"]].concat());
    wait_for(&mut child, "backend");
    signal(&child, "-INT");
    // It may have ended by the first.
    let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status();
    let (code, text) = end(child);
    assert_eq!((code, text.as_str()), (Some(130), "interrupted: nothing was written\n"));
    assert_eq!(names(folder.path()), Vec::<String>::new());
}

#[test]
fn an_interrupted_study_leaves_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["study", "builtin:rings", "--size", "2000", "-o", "a/b"];
    // Nothing was there: the folders that were made go again.
    let child = start(folder.path(), &args);
    wait_until("the folder", || folder.path().join("a/b").exists());
    signal(&child, "-INT");
    assert_eq!(end(child), (Some(130), "interrupted: nothing was written\n".to_owned()));
    assert_eq!(names(folder.path()), Vec::<String>::new());

    let old = folder.path().join("a/b");
    std::fs::create_dir_all(&old).unwrap();
    for name in ["study.csv", "study.html", "study.json", "study.svg"] {
        std::fs::write(old.join(name), name).unwrap();
    }
    // That files can be written there is tried before the work.
    std::fs::File::open(&old).unwrap().set_modified(SystemTime::UNIX_EPOCH).unwrap();
    let child = start(folder.path(), &args);
    wait_until("a file in the folder", || {
        std::fs::metadata(&old).unwrap().modified().unwrap() != SystemTime::UNIX_EPOCH
    });
    signal(&child, "-TERM");
    assert_eq!(end(child), (Some(143), "interrupted: nothing was written; the study in a/b is as it was\n".to_owned()));
    assert_eq!(names(&old), ["study.csv", "study.html", "study.json", "study.svg"]);
    for name in names(&old) {
        assert_eq!(std::fs::read(old.join(&name)).unwrap(), name.as_bytes());
    }
}

#[test]
fn an_interrupted_check_leaves_the_old_map() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("map.png"), "old").unwrap();
    let args = ["check", "builtin:rings", "--order", "mpvo", "--size", "5000", "--map", "map.png"];
    let mut child = start(folder.path(), &args);
    wait_for(&mut child, "mesh");
    signal(&child, "-INT");
    let (code, text) = end(child);
    assert_eq!(code, Some(130), "{text}");
    assert!(text.ends_with("interrupted: nothing was written; map.png is as it was\n"), "{text}");
    assert_eq!(names(folder.path()), ["map.png"]);
    assert_eq!(std::fs::read(folder.path().join("map.png")).unwrap(), b"old");
}

/// A pipe or a terminal that takes nothing: work that does not ask whether it is to go on, and words that cannot be said.
#[cfg(target_os = "linux")]
mod blocked {
    use super::*;
    use std::io::Write;
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixStream;

    /// Where writing waits for ever, and the reader that has to live as long.
    fn full() -> (UnixStream, UnixStream) {
        let (mut writer, reader) = UnixStream::pair().unwrap();
        writer.set_nonblocking(true).unwrap();
        while writer.write(&[b'.'; 1]).is_ok() {}
        writer.set_nonblocking(false).unwrap();
        (writer, reader)
    }

    /// A tetrahedron in a file of the folder, for `info`, which never asks.
    fn mesh_in(folder: &Path) {
        let text = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n\
                    CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS s float 1\nLOOKUP_TABLE default\n0 1 2 3\n";
        std::fs::write(folder.join("a.vtk"), text).unwrap();
    }

    /// Whether a signal is caught, Ctrl-C being 2.
    fn catches(child: &Child, signal: u32) -> bool {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
        u64::from_str_radix(mask.trim(), 16).unwrap() >> (signal - 1) & 1 == 1
    }

    #[test]
    fn what_does_not_ask_is_ended() {
        let folder = tempfile::tempdir().unwrap();
        mesh_in(folder.path());
        for signals in 1..=2 {
            let (writer, _reader) = full();
            let mut command = program();
            command
                .args(["info", "a.vtk"])
                .current_dir(folder.path())
                .stdout(OwnedFd::from(writer))
                .stderr(Stdio::piped());
            let child = command.spawn().unwrap();
            wait_until("the watch for signals", || catches(&child, 2));
            (0..signals).for_each(|_| signal(&child, "-INT"));
            assert_eq!(end(child), (Some(130), "interrupted: nothing was written\n".to_owned()), "{signals} signals");
        }
    }

    #[test]
    fn the_last_line_is_not_waited_for() {
        let folder = tempfile::tempdir().unwrap();
        mesh_in(folder.path());
        let (output, _reader) = full();
        let (errors, _reader_of_errors) = full();
        let mut command = program();
        command
            .args(["info", "a.vtk"])
            .current_dir(folder.path())
            .stdout(OwnedFd::from(output))
            .stderr(OwnedFd::from(errors));
        let mut child = command.spawn().unwrap();
        wait_until("the watch for signals", || catches(&child, 2));
        signal(&child, "-INT");
        wait_until("the end", || child.try_wait().unwrap().is_some());
        assert_eq!(child.wait().unwrap().code(), Some(130));
    }

    #[test]
    fn signals_that_were_ignored_stay_ignored() {
        let folder = tempfile::tempdir().unwrap();
        let mut command = Command::new("sh");
        command.args(["-c", "trap '' INT HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_tetrascope")]);
        command.args(LONG).args(["-o", "a.png"]).current_dir(folder.path());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        wait_for(&mut child, "backend");
        assert!(!catches(&child, 1) && !catches(&child, 2) && catches(&child, 15));
        signal(&child, "-TERM");
        assert_eq!(end(child).0, Some(143));
    }
}

#[test]
fn an_interrupted_animation_keeps_its_frames_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["animate", "builtin:rings", "--size", "300", "--frames", "400", "-o", "film"];
    let film = folder.path().join("film");
    let child = start(folder.path(), &args);
    wait_until("the second frame", || film.join("frame_0001.png").exists());
    signal(&child, "-INT");
    let (code, text) = end(child);
    assert_eq!(code, Some(130), "{text}");
    let frames = names(&film).iter().filter(|name| name.starts_with("frame_")).count();
    let said = format!("interrupted: film ({frames} of 400 frames; the same command goes on) was written before\n");
    assert!((2..400).contains(&frames) && text == said, "{frames}: {text}");
    for frame in 0..frames {
        tetrascope::read_png(&film.join(format!("frame_{frame:04}.png"))).unwrap();
    }
    // Nothing that is there is drawn again.
    let first = film.join("frame_0000.png");
    std::fs::write(&first, "kept").unwrap();
    let child = start(folder.path(), &args);
    wait_until("one more frame", || film.join(format!("frame_{frames:04}.png")).exists());
    signal(&child, "-INT");
    assert_eq!(end(child).0, Some(130));
    assert_eq!(std::fs::read(&first).unwrap(), b"kept");
}
