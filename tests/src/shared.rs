//! Files that lie beside the repository and are not part of it.

use std::path::PathBuf;

/// The folder beside the repository with real meshes and reference pictures, or `None` with a loud word where it is absent.
///
/// # Panics
/// If it is absent while the environment variable `TETRASCOPE_REQUIRE_SHARED` is set, as it is where nothing may be skipped.
pub fn folder(test: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared"));
    if path.is_dir() {
        return Some(path);
    }
    assert!(
        std::env::var_os("TETRASCOPE_REQUIRE_SHARED").is_none(),
        "{test} needs the folder ../shared beside the repository, and TETRASCOPE_REQUIRE_SHARED forbids to skip it"
    );
    announce_skip(test);
    None
}

#[expect(clippy::print_stderr, reason = "a skipped test must be seen")]
fn announce_skip(test: &str) {
    eprintln!("SKIPPED: {test}: the folder ../shared is not there");
}
