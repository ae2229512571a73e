//! Lists sorted by keys.

use std::sync::Arc;

use tetrascope_shaders::layout::{RADIX_BITS, Work};
use wgpu::{BindGroup, Buffer, ComputePass};

use crate::scan::{ListKernels, Scan, blocks_of, words};
use crate::{Gpu, GpuError};

/// Passes that 32 bits take.
const PASSES: u32 = u32::BITS.div_ceil(RADIX_BITS);

/// What is sorted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RadixLists<'a> {
    /// Ascending afterwards.
    pub(crate) keys: &'a Buffer,
    /// Goes with the keys.
    pub(crate) order: &'a Buffer,
    /// Has the number of entries.
    pub(crate) totals: &'a Buffer,
    /// Where.
    pub(crate) count_at: u32,
}

/// Sorts a list by 32-bit keys, lowest first; entries with equal keys stay as they come. The same bits every time.
///
/// Longer keys: sort by their lower words, make the higher words for the entries as they lie then, and sort again. Takes 8.5 bytes an
/// entry beside the lists.
#[derive(Debug)]
pub(crate) struct RadixSort {
    kernels: Arc<ListKernels>,
    groups: u32,
    passes: Vec<Pass>,
    scan: Scan,
    bytes: u64,
}

#[derive(Debug)]
struct Pass {
    count: BindGroup,
    scatter: BindGroup,
    /// As its lists are.
    copy: BindGroup,
}

impl RadixSort {
    /// For lists of up to `most` entries.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub(crate) fn new(
        gpu: &Gpu,
        kernels: &Arc<ListKernels>,
        lists: RadixLists<'_>,
        most: u32,
    ) -> Result<Self, GpuError> {
        let groups = blocks_of(most);
        let other_keys = words(gpu, "keys, half sorted", most.into())?;
        let other_order = words(gpu, "entries, half sorted", most.into())?;
        // At most 2³² entries, and so no more than 2²⁹.
        let digits = groups << RADIX_BITS;
        let counts = words(gpu, "digits of blocks", digits.into())?;
        let scan = Scan::new(gpu, kernels, &counts, digits)?;
        let pass = |number: u32| {
            let work = Work { most, count_at: lists.count_at, shift: number * RADIX_BITS, ..Work::default() };
            let work = gpu.uniform_of("radix", &work);
            let (own, other) = ([lists.keys, lists.order], [&other_keys, &other_order]);
            let (from, to) = if number.is_multiple_of(2) { (own, other) } else { (other, own) };
            let named = [
                ("radix_keys_in", from[0].as_entire_binding()),
                ("radix_order_in", from[1].as_entire_binding()),
                ("radix_keys_out", to[0].as_entire_binding()),
                ("radix_order_out", to[1].as_entire_binding()),
                ("radix_counts", counts.as_entire_binding()),
                ("totals", lists.totals.as_entire_binding()),
                ("work", work.as_entire_binding()),
            ];
            Pass {
                count: kernels.radix_count.bind(gpu, &named),
                scatter: kernels.radix_scatter.bind(gpu, &named),
                copy: kernels.radix_copy.bind(gpu, &named),
            }
        };
        Ok(Self {
            kernels: Arc::clone(kernels),
            groups,
            passes: (0..PASSES).map(pass).collect(),
            bytes: other_keys.size() + other_order.size() + counts.size() + scan.bytes(),
            scan,
        })
    }

    /// Appends the stages that sort by the lower `bits` bits of the keys; the higher ones are 0.
    pub(crate) fn record(&self, pass: &mut ComputePass<'_>, bits: u32) {
        let count = bits.div_ceil(RADIX_BITS).min(PASSES) as usize;
        for digit in &self.passes[..count] {
            self.kernels.radix_count.run(pass, &digit.count, self.groups);
            self.scan.record(pass);
            self.kernels.radix_scatter.run(pass, &digit.scatter, self.groups);
        }
        if !count.is_multiple_of(2) {
            // The next pass would begin with the lists that the last one wrote, and write those that were given.
            self.kernels.radix_copy.run(pass, &self.passes[count].copy, self.groups);
        }
    }

    /// Bytes on the device beside the lists.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}
