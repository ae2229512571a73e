//! What is left of files when a program is told to end, in a process of its own: writing has ended for good then.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails here")]

use std::path::Path;

use tetrascope_io::{IoError, check_writable, end_writing, write_bytes, write_files};

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// One after the other: what ends writing ends it for all.
#[test]
fn files_are_as_they_were_after_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let [a, b, taken] = ["a.csv", "b.csv", "taken"].map(path);
    write_bytes(&a, b"old a").unwrap();
    std::fs::create_dir(&taken).unwrap();
    check_writable(&a).unwrap();
    check_writable(&path("new")).unwrap();
    assert!(check_writable(&taken).is_err() && check_writable(&a.join("below/a/file")).is_err());

    // The second cannot be written: the first is not put in its place.
    let error = write_files([(a.as_path(), &b"new a"[..]), (taken.as_path(), b"x")]).unwrap_err();
    assert!(error.to_string().contains("taken"), "{error}");
    assert_eq!(
        (names(folder.path()), std::fs::read(&a).unwrap()),
        (vec!["a.csv".into(), "taken".into()], b"old a".to_vec())
    );

    // While the first lies there complete, the program is told to end.
    let mut told = false;
    let files = [(a.as_path(), &b"new a"[..]), (b.as_path(), b"new b")].into_iter().inspect(|(path, _)| {
        if *path == b.as_path() {
            assert_eq!(names(folder.path()).len(), 3, "the first lies under its temporary name");
            end_writing();
            assert_eq!(names(folder.path()), ["a.csv", "taken"]);
            told = true;
        }
    });
    let error = write_files(files).unwrap_err();
    assert!(told && matches!(error, IoError::Write { .. }), "{error}");
    assert!(error.to_string().ends_with("the program was told to end; run it again"), "{error}");
    assert!(write_bytes(&a, b"new a").is_err() && check_writable(&a).is_err());
    end_writing();
    assert_eq!(
        (names(folder.path()), std::fs::read(&a).unwrap()),
        (vec!["a.csv".into(), "taken".into()], b"old a".to_vec())
    );
}
