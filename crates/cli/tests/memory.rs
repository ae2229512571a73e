//! More memory is asked for than there is: an error before the work, with numbers, and no abort.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;
use std::process::{Command, Output};

const PROGRAM: &str = env!("CARGO_BIN_EXE_tetrascope");

/// Runs the program with so much address space, KiB.
fn run_within(kib: u64, folder: &Path, args: &[&str]) -> Output {
    let script = format!("ulimit -v {kib} && exec \"$0\" \"$@\"");
    Command::new("sh").args(["-c", &script, PROGRAM]).args(args).current_dir(folder).output().unwrap()
}

fn refused(output: &Output, args: &[&str], folder: &Path) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{args:?}: {text}");
    assert!(text.contains("error: ") && !text.contains("panicked"), "{args:?}: {text}");
    assert_eq!(std::fs::read_dir(folder).unwrap().count(), 0, "{args:?}");
    text
}

const GIB: u64 = 1 << 30;
const KIB_OF_GIB: u64 = 1 << 20;

#[test]
fn a_limit_of_the_process_is_an_error_and_no_abort() {
    let folder = tempfile::tempdir().unwrap();
    let huge = ["--size", "32768"];
    for (args, part) in [
        ([&["render", "builtin:rings", "-o", "a.exr"], &huge[..]].concat(), "a smaller picture"),
        ([&["render", "builtin:rings", "--backend", "reference"], &huge[..]].concat(), "a smaller picture"),
        ([&["check", "builtin:rings", "--order", "none"], &huge[..]].concat(), "a smaller picture"),
        ([&["study", "builtin:rings"], &huge[..]].concat(), "a smaller picture"),
        (vec!["render", "builtin:rings", "--integration", "table-3d", "--table-size", "1024"], "a smaller table"),
    ] {
        // What the program itself takes, and threads, fits many times.
        let text = refused(&run_within(8 * KIB_OF_GIB, folder.path(), &args), &args, folder.path());
        assert!(text.contains("GiB of memory are needed") && text.contains(part), "{args:?}: {text}");
    }
    let args = ["render", "builtin:rings", "--size", "64", "-o", "a.png"];
    let small = run_within(8 * KIB_OF_GIB, folder.path(), &args);
    assert_eq!(small.status.code(), Some(0), "{}", String::from_utf8_lossy(&small.stderr));
}

#[test]
fn more_than_the_machine_has_is_refused_with_both_numbers() {
    // 32768 by 32768 pixels of the fast renderer, and an OpenEXR file of them: 68 bytes each.
    let needed = 68 * GIB;
    let Some(left) = tetrascope::memory_left().filter(|left| *left < needed) else {
        eprintln!("SKIPPED: this machine has {needed} bytes of memory left, or does not say how much");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let args = ["render", "builtin:rings", "--size", "32768", "-o", "a.exr"];
    let output = Command::new(PROGRAM).args(args).current_dir(folder.path()).output().unwrap();
    let text = refused(&output, &args, folder.path());
    let refusal = text.contains("72 GiB of memory are needed") && text.contains("are left; ask for a smaller picture");
    assert!(refusal, "{left} bytes are left: {text}");
    // A plan says the same, and is no failure.
    let output = Command::new(PROGRAM).args(["plan", "builtin:rings", "--size", "32768"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    if left < 40 * GIB {
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(text.contains("warning: the picture will be refused: 40"), "{text}");
    }
}

/// What a scene may ask for is a matter of its format, and not of this machine.
#[test]
fn the_largest_sizes_of_the_format_are_planned() {
    for args in [
        &["plan", "builtin:rings", "--size", "32768"][..],
        &["plan", "builtin:rings", "--integration", "table-3d", "--table-size", "1024"],
    ] {
        assert_eq!(Command::new(PROGRAM).args(args).output().unwrap().status.code(), Some(0), "{args:?}");
    }
}
