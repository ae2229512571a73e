//! The cells of each tile.

use std::sync::Arc;

use tetrascope_shaders::Program;
use tetrascope_shaders::layout::{GROUP, PAIRS_WRITTEN, Work};
use wgpu::{BindGroup, Buffer, ComputePass};

use crate::kernel::{Kernel, Named};
use crate::radix::{RadixLists, RadixSort};
use crate::scan::{ListKernels, Scan, words};
use crate::{Gpu, GpuError};

/// Stages of binning, for one way to find outlines.
#[derive(Debug)]
pub(crate) struct BinsKernels {
    count: Kernel,
    write: Kernel,
    starts: Kernel,
}

impl BinsKernels {
    /// Builds the pipelines.
    ///
    /// - `outline`: the shader file that finds outlines
    ///
    /// # Errors
    /// [`GpuError::Shader`].
    pub(crate) fn new(gpu: &Gpu, outline: &str) -> Result<Arc<Self>, GpuError> {
        let pairs = Program::compose("order/pairs.wgsl", &[("outline", outline)], &[])?;
        let tiles = Program::compose("order/tiles.wgsl", &[], &[])?;
        Ok(Arc::new(Self {
            count: Kernel::new(gpu, &pairs, "pairs_count"),
            write: Kernel::new(gpu, &pairs, "pairs_write"),
            starts: Kernel::new(gpu, &tiles, "find_starts"),
        }))
    }
}

/// How much there is room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BinsSize {
    /// Cells of a draw block.
    pub(crate) cells: u32,
    /// Pairs of tile and cell.
    pub(crate) pairs: u32,
    /// Tiles of the part that is drawn.
    pub(crate) tiles: u32,
}

/// Lists the cells of a draw block tile by tile, in their order: `tile_starts` and `tile_items`.
///
/// If `totals[1]` is beyond `block.capacity` afterwards, or beyond the room here, all tiles are empty, and it is how many pairs are
/// needed. It keeps the most of all draws until it is cleared.
///
/// Takes 12.5 bytes a pair and 4 a cell beside the lists.
#[derive(Debug)]
pub(crate) struct Bins {
    kernels: Arc<BinsKernels>,
    size: BinsSize,
    count: BindGroup,
    scan: Scan,
    write: BindGroup,
    sort: RadixSort,
    starts: BindGroup,
    bytes: u64,
}

impl Bins {
    /// Binds what is there.
    ///
    /// - `items`: room for `size.pairs`; bound as `tile_items`
    /// - `totals`: as the name says
    /// - `resources`: all else that the stages use, by name: `frame`, `block`, `drawn`, `tile_starts`, and what the outline's file takes
    ///
    /// # Errors
    /// [`GpuError::TooLarge`].
    pub(crate) fn new(
        gpu: &Gpu,
        lists: &Arc<ListKernels>,
        kernels: &Arc<BinsKernels>,
        [items, totals]: [&Buffer; 2],
        resources: &[Named<'_>],
        size: BinsSize,
    ) -> Result<Self, GpuError> {
        // One more, for the sum of all.
        let entries = size.cells.saturating_add(1);
        let pair_starts = words(gpu, "pairs of cells", entries.into())?;
        let pair_tiles = words(gpu, "tiles of pairs", size.pairs.into())?;
        let work = gpu.uniform_of("pairs", &Work { most: size.cells, ..Work::default() });
        let mut named = resources.to_vec();
        named.extend([
            ("tile_items", items.as_entire_binding()),
            ("totals", totals.as_entire_binding()),
            ("pair_starts", pair_starts.as_entire_binding()),
            ("pair_tiles", pair_tiles.as_entire_binding()),
            ("work", work.as_entire_binding()),
        ]);
        let sorted = RadixLists { keys: &pair_tiles, order: items, totals, count_at: PAIRS_WRITTEN };
        let scan = Scan::new(gpu, lists, &pair_starts, entries)?;
        let sort = RadixSort::new(gpu, lists, sorted, size.pairs)?;
        Ok(Self {
            kernels: Arc::clone(kernels),
            size,
            count: kernels.count.bind(gpu, &named),
            write: kernels.write.bind(gpu, &named),
            starts: kernels.starts.bind(gpu, &named),
            bytes: pair_starts.size() + pair_tiles.size() + scan.bytes() + sort.bytes(),
            scan,
            sort,
        })
    }

    /// Appends its stages.
    pub(crate) fn record(&self, pass: &mut ComputePass<'_>) {
        let groups = self.size.cells.saturating_add(1).div_ceil(GROUP);
        self.kernels.count.run(pass, &self.count, groups);
        self.scan.record(pass);
        self.kernels.write.run(pass, &self.write, groups);
        self.sort.record(pass, u32::BITS - self.size.tiles.saturating_sub(1).leading_zeros());
        self.kernels.starts.run(pass, &self.starts, self.size.tiles.saturating_add(1).div_ceil(GROUP));
    }

    /// Bytes on the device beside the lists.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}
