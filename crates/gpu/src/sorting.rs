//! Where the order of a frame comes from.

use std::sync::Arc;

use tetrascope_order::{CycleRemedy, Guarantee, OrderMethod, PixelSort, VisibilityOrder};
use tetrascope_scene::Plan;
use tetrascope_shaders::layout::RING_BIT;
use tetrascope_view::Viewpoint;
use wgpu::Buffer;

use crate::Gpu;
use crate::keys::{CentroidOrder, PowerOrder};

/// Who sorts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// Nobody: cells are drawn as they come.
    AsTheyCome,
    /// The device, by centroids.
    Centroids,
    /// The device, by one proven key a cell.
    Power,
    /// The CPU; the permutation is uploaded when it changed.
    Made,
}

impl Source {
    /// That of a method.
    pub(crate) fn of(method: OrderMethod) -> Self {
        match method {
            OrderMethod::None | OrderMethod::PerPixel => Self::AsTheyCome,
            OrderMethod::Centroid | OrderMethod::KBuffer { .. } => Self::Centroids,
            OrderMethod::Power => Self::Power,
            _ => Self::Made,
        }
    }
}

/// Segments that a pixel can hold back on a device.
pub(crate) const MOST_HELD: u32 = 64;
/// Segments that it holds back where it runs through its cells as often as it takes: the larger, the fewer runs, and the more registers.
pub(crate) const HELD_IN_LAYERS: u32 = 16;

/// What pixels sort by themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InPixels {
    /// Nothing.
    Nothing,
    /// All, where cells in rings are.
    Rings,
    /// Everything.
    All,
    /// Within a window of so many cells.
    Window(u32),
}

impl InPixels {
    pub(crate) fn of(plan: &Plan, has_rings: bool) -> Self {
        match plan.order.pixel_sort() {
            PixelSort::All => Self::All,
            PixelSort::Window(window) => Self::Window(window),
            PixelSort::None if has_rings && plan.cycles == CycleRemedy::PerPixel => Self::Rings,
            PixelSort::None => Self::Nothing,
        }
    }

    /// Segments that a pixel holds back; `None` if none sorts.
    pub(crate) fn held(self) -> Option<u32> {
        match self {
            Self::Nothing => None,
            Self::Rings | Self::All => Some(HELD_IN_LAYERS),
            // One more is on its way.
            Self::Window(window) => Some(window + 1),
        }
    }

    /// What a pixel has to know from run to run, in pixels: where it was, and in slices also the segments that it holds back, two in one.
    pub(crate) fn state(self, slice: u32) -> u32 {
        self.held().map_or(0, |held| if slice > 0 { 2 + held.div_ceil(2) } else { 2 })
    }
}

/// A permutation that was made on the CPU, on the device.
#[derive(Debug)]
pub(crate) struct MadeOrder {
    method: OrderMethod,
    viewpoint: Viewpoint,
    order: Arc<dyn VisibilityOrder>,
    /// All cells front to back, with [`RING_BIT`].
    pub(crate) permutation: Buffer,
    pub(crate) guarantee: Guarantee,
    pub(crate) rings: u64,
    pub(crate) cyclic: u64,
}

impl MadeOrder {
    /// Sorts all cells and uploads the permutation.
    pub(crate) fn new(
        gpu: &Gpu,
        method: OrderMethod,
        order: Arc<dyn VisibilityOrder>,
        cells: tetrascope_order::Cells<'_>,
        viewpoint: Viewpoint,
    ) -> Self {
        let count = cells.tetrahedra.len();
        let permutation = gpu.storage("permutation", count as u64 * 4);
        let mut made =
            Self { method, viewpoint, order, permutation, guarantee: Guarantee::Unsorted, rings: 0, cyclic: 0 };
        made.sort(gpu, cells);
        made
    }

    /// The same from another side; nothing is done if it is the same one.
    pub(crate) fn update(&mut self, gpu: &Gpu, cells: tetrascope_order::Cells<'_>, viewpoint: Viewpoint) {
        if self.viewpoint != viewpoint {
            self.viewpoint = viewpoint;
            self.sort(gpu, cells);
        }
    }

    /// Whether it is by this method.
    pub(crate) fn is_by(&self, method: OrderMethod) -> bool {
        self.method == method
    }

    fn sort(&mut self, gpu: &Gpu, cells: tetrascope_order::Cells<'_>) {
        let all: Vec<_> = (0..cells.tetrahedra.len() as u32).map(tetrascope_mesh::CellId).collect();
        let order = self.order.order(cells, self.viewpoint, &all);
        let mut in_ring = vec![0_u32; if order.cycles.is_empty() { 0 } else { all.len() }];
        for cell in order.cycles.iter().flatten() {
            in_ring[cell.index()] = RING_BIT;
        }
        let numbers: Vec<u32> = order
            .front_to_back
            .iter()
            .map(|cell| cell.0 | in_ring.get(cell.index()).copied().unwrap_or_default())
            .collect();
        gpu.queue.write_buffer(&self.permutation, 0, bytemuck::cast_slice(&numbers));
        self.guarantee = order.guarantee;
        self.rings = order.cycles.len() as u64;
        self.cyclic = order.cycles.iter().map(|ring| ring.len() as u64).sum();
    }
}

/// What the device sorts by.
#[derive(Debug)]
pub(crate) enum DeviceOrder {
    Centroids(CentroidOrder),
    Power(PowerOrder),
}

impl DeviceOrder {
    /// Bytes on the device beside the order.
    pub(crate) fn bytes(&self) -> u64 {
        match self {
            Self::Centroids(order) => order.bytes(),
            Self::Power(order) => order.bytes(),
        }
    }
}
