//! Ctrl-C and the request to end, sent to the program at work.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A child that does not end is killed after this, and the test fails: no measure of anything.
const DEADLINE: Duration = Duration::from_secs(120);

fn start(folder: &Path, args: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tetrascope"));
    command.args(args).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
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
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
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
    let begin = Instant::now();
    while !folder.path().join("a/b").exists() && begin.elapsed() < DEADLINE {
        std::thread::sleep(Duration::from_millis(20));
    }
    // In the reference by now, as a rule.
    std::thread::sleep(Duration::from_secs(1));
    signal(&child, "-INT");
    assert_eq!(end(child), (Some(130), "interrupted: nothing was written\n".to_owned()));
    assert_eq!(names(folder.path()), Vec::<String>::new());

    let old = folder.path().join("a/b");
    std::fs::create_dir_all(&old).unwrap();
    for name in ["study.csv", "study.html", "study.json", "study.svg"] {
        std::fs::write(old.join(name), name).unwrap();
    }
    let child = start(folder.path(), &args);
    std::thread::sleep(Duration::from_secs(1));
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
    assert!(text.ends_with("interrupted: nothing was written\n"), "{text}");
    assert_eq!(names(folder.path()), ["map.png"]);
    assert_eq!(std::fs::read(folder.path().join("map.png")).unwrap(), b"old");
}
