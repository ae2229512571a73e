//! Every program composed and validated, and every structure laid out as in Rust.

use std::path::Path;

use super::*;

/// Every file of a folder with this ending, as paths within it.
fn files(folder: &Path, below: &str, found: &mut Vec<String>) {
    let mut entries: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap()).collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let name = format!("{below}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            files(&entry.path(), &format!("{name}/"), found);
        } else if name.ends_with(".wgsl") {
            found.push(name);
        }
    }
}

#[test]
fn every_file_is_among_the_sources() {
    let mut found = Vec::new();
    files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders"), "", &mut found);
    found.sort();
    let mut listed: Vec<_> = SOURCES.iter().map(|(path, _)| (*path).to_owned()).collect();
    listed.sort();
    assert_eq!(found, listed);
}
