//! What is left of a list, close together.

use std::sync::Arc;

use tetrascope_shaders::layout::Work;
use wgpu::{BindGroup, Buffer, ComputePass};

use crate::scan::{ListKernels, Scan, blocks_of, words};
use crate::{Gpu, GpuError};

/// Moves the entries of `kept` that are not `0xffffffff` to `order`, in the order in which they come; how many, to `totals[0]`.
#[derive(Debug)]
pub(crate) struct Compact {
    kernels: Arc<ListKernels>,
    groups: u32,
    count: BindGroup,
    scan: Scan,
    write: BindGroup,
    bytes: u64,
}

impl Compact {
    /// For the first `length` entries of `kept`; `order` has room for as many.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub(crate) fn new(
        gpu: &Gpu,
        kernels: &Arc<ListKernels>,
        kept: &Buffer,
        order: &Buffer,
        totals: &Buffer,
        length: u32,
    ) -> Result<Self, GpuError> {
        let groups = blocks_of(length);
        let counts = words(gpu, "entries kept of blocks", groups.into())?;
        let work = gpu.uniform_of("compact", &Work { most: length, ..Work::default() });
        let named = [
            ("kept", kept.as_entire_binding()),
            ("order", order.as_entire_binding()),
            ("totals", totals.as_entire_binding()),
            ("compact_counts", counts.as_entire_binding()),
            ("work", work.as_entire_binding()),
        ];
        let scan = Scan::new(gpu, kernels, &counts, groups)?;
        Ok(Self {
            kernels: Arc::clone(kernels),
            groups,
            count: kernels.compact_count.bind(gpu, &named),
            write: kernels.compact_write.bind(gpu, &named),
            bytes: counts.size() + scan.bytes(),
            scan,
        })
    }

    /// Appends its stages.
    pub(crate) fn record(&self, pass: &mut ComputePass<'_>) {
        self.kernels.compact_count.run(pass, &self.count, self.groups);
        self.scan.record(pass);
        self.kernels.compact_write.run(pass, &self.write, self.groups);
    }

    /// Bytes on the device beside the lists.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}
