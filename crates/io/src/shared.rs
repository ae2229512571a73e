//! Where the tests find the data set that lies beside the checkout.

use std::path::PathBuf;

/// The path of a file or folder under the shared folder; `None`, said loudly, where it is not there.
///
/// # Panics
/// If it is not there while `TETRASCOPE_REQUIRE_SHARED` is set.
pub(crate) fn shared(relative: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")).join(relative);
    if path.exists() {
        return Some(path);
    }
    assert!(std::env::var_os("TETRASCOPE_REQUIRE_SHARED").is_none(), "{} is not there", path.display());
    eprintln!("SKIPPED: {} is not there", path.display());
    None
}
