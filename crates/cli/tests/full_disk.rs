//! Files and reports that cannot be written: an error that names them, nothing half-written, and what was there as it was.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const PROGRAM: &str = env!("CARGO_BIN_EXE_tetrascope");

/// Runs the program from a shell that has done `before`: `$0` is the program and `$@` what follows.
fn run_after(folder: &Path, before: &str, args: &[&str]) -> Output {
    let script = format!("{before}; exec \"$0\" \"$@\"");
    Command::new("sh").args(["-c", &script, PROGRAM]).args(args).current_dir(folder).output().unwrap()
}

fn run(folder: &Path, args: &[&str]) -> Output {
    Command::new(PROGRAM).args(args).current_dir(folder).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// All files below a folder, with what is in them.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        if entry.file_type().unwrap().is_dir() {
            all.extend(contents(&entry.path()).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            all.insert(name, std::fs::read(entry.path()).unwrap());
        }
    }
    all
}

/// Runs what must fail with 1, naming `file` and leaving the folder as it is but for `written`; what was said.
fn refused(folder: &Path, before: &str, args: &[&str], file: &str, written: &[&str]) -> String {
    let was = contents(folder);
    let output = run_after(folder, before, args);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{before} {args:?}: {text}");
    let error = text.lines().find(|line| line.starts_with("error: ")).unwrap_or_else(|| panic!("{args:?}: {text}"));
    assert!(error.contains(file), "{args:?} does not name {file}: {text}");
    assert!(!text.contains("panicked"), "{text}");
    let mut is = contents(folder);
    written.iter().for_each(|name| assert!(is.remove(*name).is_some(), "{args:?} did not write {name}"));
    assert_eq!(is, was, "{before} {args:?}");
    text
}

/// Old files in the place of everything that is written, and two pictures to compare.
fn old_files() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, size) in [("1.exr", "24"), ("2.exr", "24")] {
        let integration = if name == "1.exr" { "exact" } else { "average" };
        let args = ["render", "builtin:rings", "--size", size, "--integration", integration, "-o", name];
        assert!(run(folder.path(), &args).status.success());
    }
    std::fs::create_dir(folder.path().join("study")).unwrap();
    for name in ["a.vtu", "a.png", "a.exr", "a.toml", "a.json", "e.png", "e.exr", "study/study.csv", "study/study.html"]
    {
        std::fs::write(folder.path().join(name), format!("old {name}")).unwrap();
    }
    folder
}

/// Everything that is written, with the file that is named where there is no room for it.
const WRITERS: [(&[&str], &str); 11] = [
    (&["render", "builtin:rings", "--size", "64", "-o", "a.png"], "a.png"),
    (&["render", "builtin:rings", "--size", "64", "-o", "a.exr"], "a.exr"),
    (&["render", "builtin:rings", "--size", "64", "-o", "new.exr", "-o", "a.png"], "new.exr"),
    (&["check", "builtin:rings", "--size", "64", "--order", "none", "--map", "a.png"], "a.png"),
    (&["convert", "builtin:rings", "a.vtu"], "a.vtu"),
    (&["convert", "builtin:rings", "new.vtu", "--tetrahedra", "--encoding", "zlib"], "new.vtu"),
    (&["compare", "1.exr", "2.exr", "-o", "e.png"], "e.png"),
    (&["compare", "1.exr", "2.exr", "-o", "e.exr"], "e.exr"),
    (&["study", "builtin:rings", "--quick", "--size", "16", "--frames", "1"], "study.csv"),
    (&["study", "builtin:rings", "--quick", "--size", "16", "--frames", "1", "-o", "new/one"], "study.csv"),
    (&["study", "builtin:rings", "--quick", "--size", "16", "--frames", "1", "--json"], "study.csv"),
];

/// With these the picture of 14 by 14 pixels has room, and what comes after it has not.
const AFTER_A_PICTURE: [(&[&str], &str); 4] = [
    (&["--write-scene", "a.toml"], "a.toml"),
    (&["--write-scene", "a.json"], "a.json"),
    (&["--integration", "average", "--error-map", "e.exr"], "e.exr"),
    (&["-o", "a.exr"], "a.exr"),
];

/// A limit on the size of files fails a write in its middle, as a full disk does.
#[test]
fn there_is_no_room_for_the_whole_file() {
    let folder = old_files();
    for before in ["ulimit -f 1", "trap '' XFSZ; ulimit -f 1"] {
        for (args, file) in WRITERS {
            let text = refused(folder.path(), before, args, file, &[]);
            assert!(text.contains("free some space"), "{text}");
        }
    }
    for (more, file) in AFTER_A_PICTURE {
        let args = [&["render", "builtin:rings", "--size", "14", "-o", "small.png"], more].concat();
        refused(folder.path(), "ulimit -f 1", &args, file, &["small.png"]);
        std::fs::remove_file(folder.path().join("small.png")).unwrap();
    }
}

/// A disk that is full, in a name space of the test's own.
#[test]
fn a_disk_is_full() {
    let folder = old_files();
    let disk = folder.path().join("disk");
    std::fs::create_dir(&disk).unwrap();
    let enter = "mount -t tmpfs -o size=64k tmpfs disk && cd disk && echo old > a.exr && cp a.exr study.csv";
    let script = format!("{enter} && {{ \"$0\" \"$@\"; echo \"code $?\"; ls -A; cat a.exr study.csv; }}");
    let inside = |args: &[&str]| {
        let sh = ["--user", "--map-root-user", "--mount", "sh", "-c", &script, PROGRAM];
        Command::new("unshare").args(sh).args(args).current_dir(folder.path()).output()
    };
    let usable = inside(&["--version"]).is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains("code 0"));
    if !usable {
        let may_skip = std::env::var_os("TETRASCOPE_REQUIRE_FULL_DISK").is_none();
        assert!(may_skip, "no file system can be mounted here, and TETRASCOPE_REQUIRE_FULL_DISK forbids to skip");
        eprintln!("SKIPPED: no file system can be mounted here, and no disk is full but by a limit");
        return;
    }
    for args in [
        &["render", "builtin:rings", "--size", "256", "-o", "a.exr"][..],
        &["study", "builtin:rings", "--quick", "--size", "24", "--frames", "1", "-o", "."],
    ] {
        let output = inside(args).unwrap();
        let (said, text) = (String::from_utf8_lossy(&output.stdout), stderr(&output));
        assert!(said.ends_with("code 1\na.exr\nstudy.csv\nold\nold\n"), "{args:?}: {said}{text}");
        assert!(text.contains("No space left") && text.contains("free some space"), "{args:?}: {text}");
    }
}

#[test]
fn folders_that_take_no_file_are_said_before_the_work() {
    let folder = old_files();
    // No right of the user's makes a folder of a file, or writes to these.
    let mut places = vec!["a.toml/x"];
    if cfg!(target_os = "linux") {
        places.push("/proc/x");
    }
    for place in places {
        let [png, exr, toml] = ["png", "exr", "toml"].map(|extension| format!("{place}.{extension}"));
        let render = ["render", "builtin:rings", "--size", "8"];
        for (args, file) in [
            ([&render[..], &["-o", &png]].concat(), &png),
            ([&render[..], &["-o", "new.png", "-o", &exr]].concat(), &exr),
            ([&render[..], &["-o", "new.png", "--write-scene", &toml]].concat(), &toml),
            ([&render[..], &["-o", "new.png", "--error-map", &exr]].concat(), &exr),
            (vec!["check", "builtin:rings", "--size", "8", "--map", &png], &png),
            (vec!["compare", "1.exr", "2.exr", "-o", &png], &png),
            (vec!["study", "builtin:rings", "--quick", "--size", "8", "-o", place], &place.to_owned()),
        ] {
            // Before the work: the picture that could be written is not, either.
            refused(folder.path(), ":", &args, file, &[]);
        }
    }
}

#[test]
fn a_device_in_the_place_of_a_picture_stays() {
    let folder = old_files();
    let link = folder.path().join("link.png");
    std::os::unix::fs::symlink("/dev/full", &link).unwrap();
    let output = run(folder.path(), &["render", "builtin:rings", "--size", "8", "-o", "link.png"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("not a regular file"), "{}", stderr(&output));
    assert_eq!(std::fs::read_link(&link).unwrap(), Path::new("/dev/full"));
}

/// What is said on standard output by each command.
const REPORTS: [&[&str]; 8] = [
    &["--help"],
    &["--version"],
    &["render", "builtin:rings", "--size", "8"],
    &["render", "builtin:rings", "--size", "8", "--json"],
    &["plan", "builtin:rings"],
    &["check", "builtin:rings", "--size", "8", "--order", "none"],
    &["compare", "1.exr", "2.exr"],
    &["study", "builtin:rings", "--quick", "--size", "8", "--frames", "1", "-o", "new"],
];

#[test]
fn a_report_that_cannot_be_written_is_an_error() {
    if !Path::new("/dev/full").exists() {
        eprintln!("SKIPPED: there is no /dev/full here");
        return;
    }
    let folder = old_files();
    for args in REPORTS {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = Command::new(PROGRAM).args(args).current_dir(folder.path()).stdout(full).output().unwrap();
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{args:?}: {text}");
        assert!(text.contains("error: standard output: cannot be written"), "{args:?}: {text}");
        assert!(!text.contains("panicked"), "{args:?}: {text}");
    }
}

#[test]
fn a_reader_that_went_away_is_no_error() {
    let folder = old_files();
    for args in REPORTS {
        let mut command = Command::new(PROGRAM);
        command.args(args).current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), stderr(&output).contains("panicked")), (Some(0), false), "{args:?}");
    }
}
