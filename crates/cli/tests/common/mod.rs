//! What tests of several commands share.

use std::path::{Path, PathBuf};

/// Fails where a text lacks one of the parts.
pub(crate) fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "\"{part}\" is not in:\n{text}");
    }
}

/// The folder of shared files; `None`, said loudly, where it is absent.
#[expect(clippy::print_stderr, reason = "a test that was skipped has to say so")]
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")).join(path);
    if path.exists() {
        return Some(path);
    }
    assert!(std::env::var_os("TETRASCOPE_REQUIRE_SHARED").is_none(), "{} is required", path.display());
    eprintln!("SKIPPED: {} is not here", path.display());
    None
}
