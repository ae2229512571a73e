//! The device of tests: a driver of Vulkan, asked for by name, as a GL adapter may be there that blends no 32-bit floats.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use tetrascope::{AdapterChoice, Gpu};

/// What the adapter of tests is asked for by, unless the environment variable `TETRASCOPE_TEST_ADAPTER` has another name.
const ADAPTER: &str = "vulkan";

/// The name by which the tests' adapter is asked for, in plans and scenes too.
pub fn adapter() -> String {
    std::env::var("TETRASCOPE_TEST_ADAPTER").unwrap_or_else(|_| ADAPTER.to_owned())
}

/// The device, opened once for all tests and with no more than every browser gives, or `None` with a loud word where there is none.
///
/// # Panics
/// If it is not there while the environment variable `TETRASCOPE_REQUIRE_GPU` is set, as it is where nothing may be skipped.
pub fn gpu(test: &str) -> Option<Arc<Gpu>> {
    static SHARED: OnceLock<Result<Arc<Gpu>, String>> = OnceLock::new();
    let opened = SHARED.get_or_init(|| {
        let choice = AdapterChoice { name: Some(adapter()), default_limits: true, ..AdapterChoice::default() };
        Gpu::open(&choice).map(Arc::new).map_err(|error| error.to_string())
    });
    match opened {
        Ok(gpu) => Some(Arc::clone(gpu)),
        Err(problem) => {
            assert!(
                std::env::var_os("TETRASCOPE_REQUIRE_GPU").is_none(),
                "{test} needs a GPU or Mesa's software driver of Vulkan, and TETRASCOPE_REQUIRE_GPU forbids to skip it: {problem}"
            );
            announce_skip(test, problem);
            None
        }
    }
}

#[expect(clippy::print_stderr, reason = "a skipped test must be seen")]
fn announce_skip(test: &str, problem: &str) {
    static SKIPPED: AtomicUsize = AtomicUsize::new(0);
    let count = SKIPPED.fetch_add(1, Ordering::Relaxed) + 1;
    eprintln!("SKIPPED: {test}: {problem}; {count} skipped for want of a GPU so far");
}
