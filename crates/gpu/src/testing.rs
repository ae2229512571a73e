//! The device of this crate's tests: a driver of Vulkan, asked for by name.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use bytemuck::Pod;

use crate::{AdapterChoice, Gpu};

/// The name by which it is asked for.
pub(crate) fn adapter() -> String {
    std::env::var("TETRASCOPE_TEST_ADAPTER").unwrap_or_else(|_| "vulkan".to_owned())
}

/// The device, or `None` where there is none: the test then says that it is skipped. With `TETRASCOPE_REQUIRE_GPU` in the environment a
/// missing device fails it.
pub(crate) fn gpu() -> Option<Arc<Gpu>> {
    static SHARED: OnceLock<Option<Arc<Gpu>>> = OnceLock::new();
    let gpu = SHARED.get_or_init(|| {
        let name = adapter();
        match Gpu::open(&AdapterChoice { name: Some(name), default_limits: true, ..AdapterChoice::default() }) {
            Ok(gpu) => Some(Arc::new(gpu)),
            Err(error) if std::env::var_os("TETRASCOPE_REQUIRE_GPU").is_some() => panic!("{error}"),
            Err(error) => {
                println!("{error}");
                None
            }
        }
    });
    if gpu.is_none() {
        static SKIPPED: AtomicUsize = AtomicUsize::new(0);
        println!("SKIPPED for want of a GPU: {} tests so far", SKIPPED.fetch_add(1, Ordering::Relaxed) + 1);
    }
    gpu.clone()
}

/// Runs `work` and fails if the driver finds anything wrong with what it was asked.
pub(crate) fn checked<T>(gpu: &Gpu, work: impl FnOnce() -> T) -> T {
    let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
    let done = work();
    if let Some(error) = pollster::block_on(scope.pop()) {
        panic!("{error}");
    }
    done
}

/// The first `count` things in a buffer, after commands.
pub(crate) fn contents<T: Pod>(
    gpu: &Gpu,
    encoder: wgpu::CommandEncoder,
    buffer: &wgpu::Buffer,
    count: usize,
) -> Vec<T> {
    let bytes = gpu.read(encoder, buffer, (count * size_of::<T>()) as u64).expect("the device answers");
    bytemuck::pod_collect_to_vec(&bytes[..count * size_of::<T>()])
}

/// Random numbers that are the same every time.
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Below `end`.
    pub(crate) fn below(&mut self, end: u32) -> u32 {
        // splitmix64.
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((((mixed ^ (mixed >> 31)) >> 32) * u64::from(end)) >> 32) as u32
    }

    /// From 0 to below 1.
    pub(crate) fn unit(&mut self) -> f64 {
        f64::from(self.below(u32::MAX)) / f64::from(u32::MAX)
    }
}
