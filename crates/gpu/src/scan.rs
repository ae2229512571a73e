//! Prefix sums of lists.

use std::sync::Arc;

use tetrascope_shaders::Program;
use tetrascope_shaders::layout::{LIST_BLOCK, Work};
use wgpu::{BindGroup, Buffer, ComputePass};

use crate::kernel::Kernel;
use crate::{Gpu, GpuError};

/// Stages over lists, made once for all that scan and sort.
#[derive(Debug)]
pub(crate) struct ListKernels {
    scan_reduce: Kernel,
    scan_apply: Kernel,
    scan_top: Kernel,
    pub(crate) compact_count: Kernel,
    pub(crate) compact_write: Kernel,
    pub(crate) radix_count: Kernel,
    pub(crate) radix_scatter: Kernel,
    pub(crate) radix_copy: Kernel,
}

impl ListKernels {
    /// Builds the pipelines.
    ///
    /// # Errors
    /// [`GpuError::Shader`]: a defect.
    pub(crate) fn new(gpu: &Gpu) -> Result<Arc<Self>, GpuError> {
        let scan = Program::compose("order/scan.wgsl", &[], &[])?;
        let compact = Program::compose("order/compact.wgsl", &[], &[])?;
        let radix = Program::compose("order/radix.wgsl", &[], &[])?;
        Ok(Arc::new(Self {
            scan_reduce: Kernel::new(gpu, &scan, "scan_reduce"),
            scan_apply: Kernel::new(gpu, &scan, "scan_apply"),
            scan_top: Kernel::new(gpu, &scan, "scan_top"),
            compact_count: Kernel::new(gpu, &compact, "compact_count"),
            compact_write: Kernel::new(gpu, &compact, "compact_write"),
            radix_count: Kernel::new(gpu, &radix, "radix_count"),
            radix_scatter: Kernel::new(gpu, &radix, "radix_scatter"),
            radix_copy: Kernel::new(gpu, &radix, "radix_copy"),
        }))
    }
}

/// Groups for a list of so many entries; at least one.
pub(crate) fn blocks_of(length: u32) -> u32 {
    length.div_ceil(LIST_BLOCK).max(1)
}

/// A storage buffer of so many words, if the device can bind it.
///
/// # Errors
/// [`GpuError::TooLarge`].
pub(crate) fn words(gpu: &Gpu, what: &'static str, count: u64) -> Result<Buffer, GpuError> {
    let (needed, limit) = (count * size_of::<u32>() as u64, gpu.largest_binding());
    if needed > limit {
        return Err(GpuError::TooLarge { what, needed, limit, adapter: gpu.description().name.clone() });
    }
    Ok(gpu.storage(what, needed))
}

/// Exclusive prefix sums of one buffer of `u32`, in place; what exceeds 32 bits becomes the largest number.
///
/// Sums of blocks of [`LIST_BLOCK`] entries, sums of those, and so on; then down again. Takes 1/2000 of the list's memory.
#[derive(Debug)]
pub(crate) struct Scan {
    kernels: Arc<ListKernels>,
    /// From the list up to what one group does; the last has no stage that reduces.
    levels: Vec<Level>,
    bytes: u64,
}

#[derive(Debug)]
struct Level {
    groups: u32,
    /// None at the top.
    reduce: Option<BindGroup>,
    apply: BindGroup,
}

impl Scan {
    /// For the first `length` entries of a buffer.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub(crate) fn new(
        gpu: &Gpu,
        kernels: &Arc<ListKernels>,
        values: &Buffer,
        mut length: u32,
    ) -> Result<Self, GpuError> {
        let mut levels = Vec::new();
        let mut bytes = 0;
        let mut values = values.clone();
        loop {
            let work = gpu.uniform_of("scan", &Work { most: length, ..Work::default() });
            let groups = blocks_of(length);
            let mut named = vec![("scan_values", values.as_entire_binding()), ("work", work.as_entire_binding())];
            if groups == 1 {
                let apply = kernels.scan_top.bind(gpu, &named);
                levels.push(Level { groups, reduce: None, apply });
                return Ok(Self { kernels: Arc::clone(kernels), levels, bytes });
            }
            let sums = words(gpu, "sums of blocks", groups.into())?;
            bytes += sums.size();
            named.push(("scan_sums", sums.as_entire_binding()));
            let reduce = Some(kernels.scan_reduce.bind(gpu, &named));
            levels.push(Level { groups, reduce, apply: kernels.scan_apply.bind(gpu, &named) });
            (values, length) = (sums, groups);
        }
    }

    /// Appends its stages.
    pub(crate) fn record(&self, pass: &mut ComputePass<'_>) {
        for level in &self.levels {
            if let Some(reduce) = &level.reduce {
                self.kernels.scan_reduce.run(pass, reduce, level.groups);
            }
        }
        for level in self.levels.iter().rev() {
            let kernel = if level.reduce.is_some() { &self.kernels.scan_apply } else { &self.kernels.scan_top };
            kernel.run(pass, &level.apply, level.groups);
        }
    }

    /// Bytes on the device beside the list.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}
