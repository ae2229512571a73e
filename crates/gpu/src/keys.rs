//! Keys that cells are sorted by, and the sort.

use std::sync::Arc;

use tetrascope_shaders::Program;
use tetrascope_shaders::layout::{GROUP, PowerView, Work};
use wgpu::{BindGroup, Buffer, ComputePass};

use crate::kernel::{Kernel, Named};
use crate::power_functions::{PowerFrame, PowerFunctions};
use crate::radix::{RadixLists, RadixSort};
use crate::scan::{ListKernels, words};
use crate::{Gpu, GpuError};

/// Stages that make keys.
#[derive(Debug)]
pub(crate) struct KeysKernels {
    centroid: Kernel,
    power: [Kernel; 2],
}

impl KeysKernels {
    /// Builds the pipelines.
    ///
    /// # Errors
    /// [`GpuError::Shader`]: a defect.
    pub(crate) fn new(gpu: &Gpu) -> Result<Arc<Self>, GpuError> {
        let centroid = Program::compose("order/centroid_keys.wgsl", &[], &[])?;
        let power = Program::compose("order/power_keys.wgsl", &[], &[])?;
        Ok(Arc::new(Self {
            centroid: Kernel::new(gpu, &centroid, "centroid_keys"),
            power: ["power_keys_low", "power_keys_high"].map(|entry| Kernel::new(gpu, &power, entry)),
        }))
    }
}

/// A list of cells that is sorted in place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SortedOrder<'a> {
    /// Numbers of cells, some with the ring's bit.
    pub(crate) order: &'a Buffer,
    /// How many, at place 0.
    pub(crate) totals: &'a Buffer,
    /// How many there may be.
    pub(crate) most: u32,
}

/// Sorts `order` by the distance of the centroids, or by their depth.
#[derive(Debug)]
pub(crate) struct CentroidOrder {
    kernels: Arc<KeysKernels>,
    keys: BindGroup,
    groups: u32,
    sort: RadixSort,
    bytes: u64,
}

impl CentroidOrder {
    /// Binds what is there.
    ///
    /// - `resources`: `frame`, `points` and `cells`
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub(crate) fn new(
        gpu: &Gpu,
        lists: &Arc<ListKernels>,
        kernels: &Arc<KeysKernels>,
        sorted: SortedOrder<'_>,
        resources: &[Named<'_>],
    ) -> Result<Self, GpuError> {
        let Sorting { sort, keys, work } = Sorting::new(gpu, lists, sorted)?;
        let mut named = resources.to_vec();
        named.extend(named_of(&sorted, &keys, &work));
        Ok(Self {
            kernels: Arc::clone(kernels),
            keys: kernels.centroid.bind(gpu, &named),
            groups: sorted.most.div_ceil(GROUP),
            bytes: keys.size() + sort.bytes(),
            sort,
        })
    }

    /// Appends its stages.
    pub(crate) fn record(&self, pass: &mut ComputePass<'_>) {
        self.kernels.centroid.run(pass, &self.keys, self.groups);
        self.sort.record(pass, u32::BITS);
    }

    /// Bytes on the device beside the order.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// Sorts `order` by the functions of the power order.
#[derive(Debug)]
pub(crate) struct PowerOrder {
    kernels: Arc<KeysKernels>,
    view: Buffer,
    keys: [BindGroup; 2],
    groups: u32,
    sort: RadixSort,
    bytes: u64,
}

impl PowerOrder {
    /// Brings the functions to the device: 32 bytes a cell.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub(crate) fn new(
        gpu: &Gpu,
        lists: &Arc<ListKernels>,
        kernels: &Arc<KeysKernels>,
        sorted: SortedOrder<'_>,
        functions: &PowerFunctions,
    ) -> Result<Self, GpuError> {
        let Sorting { sort, keys, work } = Sorting::new(gpu, lists, sorted)?;
        let contents: &[u32] = functions.words.as_flattened();
        let power_cells = words(gpu, "functions of the power order", contents.len() as u64)?;
        gpu.queue.write_buffer(&power_cells, 0, bytemuck::cast_slice(contents));
        let view = gpu.uniform_of("view of the power order", &PowerView::default());
        let mut named = named_of(&sorted, &keys, &work).to_vec();
        named.push(("power_cells", power_cells.as_entire_binding()));
        named.push(("power_view", view.as_entire_binding()));
        Ok(Self {
            kernels: Arc::clone(kernels),
            keys: kernels.power.each_ref().map(|kernel| kernel.bind(gpu, &named)),
            groups: sorted.most.div_ceil(GROUP),
            bytes: keys.size() + power_cells.size() + sort.bytes(),
            view,
            sort,
        })
    }

    /// Appends its stages, and notes the view for the commands that are submitted next.
    pub(crate) fn record(&self, gpu: &Gpu, pass: &mut ComputePass<'_>, frame: &PowerFrame) {
        gpu.queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&frame.view));
        // By the lower words first: the sort is stable.
        let bits = [frame.bits.min(u32::BITS), frame.bits.saturating_sub(u32::BITS)];
        for ((kernel, keys), bits) in self.kernels.power.iter().zip(&self.keys).zip(bits) {
            if bits > 0 {
                kernel.run(pass, keys, self.groups);
                self.sort.record(pass, bits);
            }
        }
    }

    /// Bytes on the device beside the order.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}

struct Sorting {
    sort: RadixSort,
    keys: Buffer,
    work: Buffer,
}

impl Sorting {
    fn new(gpu: &Gpu, lists: &Arc<ListKernels>, sorted: SortedOrder<'_>) -> Result<Self, GpuError> {
        let keys = words(gpu, "keys", sorted.most.into())?;
        let work = gpu.uniform_of("keys", &Work { most: sorted.most, ..Work::default() });
        let radix = RadixLists { keys: &keys, order: sorted.order, totals: sorted.totals, count_at: 0 };
        Ok(Self { sort: RadixSort::new(gpu, lists, radix, sorted.most)?, keys, work })
    }
}

fn named_of<'a>(sorted: &SortedOrder<'a>, keys: &'a Buffer, work: &'a Buffer) -> [Named<'a>; 4] {
    [
        ("order", sorted.order.as_entire_binding()),
        ("totals", sorted.totals.as_entire_binding()),
        ("keys", keys.as_entire_binding()),
        ("work", work.as_entire_binding()),
    ]
}
