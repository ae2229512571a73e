//! What goes on from frame to frame: lookups until the plan changes, orders until the view does, memory until more is needed.

use std::sync::Arc;

use tetrascope_order::OrderMethod;
use tetrascope_scene::Plan;
use tetrascope_shaders::layout::{Block, Frame};
use wgpu::{Buffer, BufferUsages};

use crate::compact::Compact;
use crate::effects::{Effects, ScalarUnit, point_gradients};
use crate::lookups::{FieldUnits, Lookups};
use crate::mesh::MeshBuffers;
use crate::radix::{RadixLists, RadixSort};
use crate::renderer::GpuRenderer;
use crate::scan::{ListKernels, words};
use crate::sorting::MadeOrder;
use crate::{Gpu, GpuError};

/// Transfer functions whose lookups are remembered, so that going back and forth between two costs nothing.
const KEPT_LOOKUPS: usize = 2;

/// Words of `totals`.
pub(crate) const TOTALS: usize = 8;

/// What goes on from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Kept {
    /// Number of the last frame, from 1.
    pub(crate) frame: u64,
    lookups: Vec<Arc<Lookups>>,
    effects: Option<Arc<Effects>>,
    gradients: Option<Buffer>,
    made: Option<MadeOrder>,
    order: Option<OrderMemory>,
    /// Pairs of tile and cell that the last block needed at most.
    pub(crate) pairs: u64,
}

/// The order of the cells that are drawn, and what makes it.
#[derive(Debug)]
pub(crate) struct OrderMemory {
    pub(crate) lists: Arc<ListKernels>,
    pub(crate) frame: Buffer,
    pub(crate) block: Buffer,
    pub(crate) totals: Buffer,
    /// What becomes of each candidate; once the order is there, its keys.
    pub(crate) kept: Buffer,
    pub(crate) order: Buffer,
    pub(crate) compact: Compact,
    /// Where the device sorts.
    pub(crate) sort: Option<RadixSort>,
}

impl OrderMemory {
    fn new(gpu: &Gpu, mesh: &MeshBuffers) -> Result<Self, GpuError> {
        let lists = ListKernels::new(gpu)?;
        let uniform = |label, bytes| gpu.buffer(label, bytes, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let totals = gpu.storage("totals", TOTALS as u64 * 4);
        let kept = words(gpu, "what is kept", mesh.cell_count.into())?;
        let order = words(gpu, "the order", mesh.cell_count.into())?;
        let compact = Compact::new(gpu, &lists, &kept, &order, &totals, mesh.cell_count)?;
        Ok(Self {
            lists,
            frame: uniform("frame", size_of::<Frame>() as u64),
            block: uniform("block", size_of::<Block>() as u64),
            totals,
            kept,
            order,
            compact,
            sort: None,
        })
    }

    /// Makes room for sorting.
    fn sorts(&mut self, gpu: &Gpu, mesh: &MeshBuffers) -> Result<(), GpuError> {
        if self.sort.is_none() {
            let lists = RadixLists { keys: &self.kept, order: &self.order, totals: &self.totals, count_at: 0 };
            self.sort = Some(RadixSort::new(gpu, &self.lists, lists, mesh.cell_count)?);
        }
        Ok(())
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        let sort = self.sort.as_ref().map_or(0, RadixSort::bytes);
        self.kept.size() + self.order.size() + self.compact.bytes() + sort
    }
}

impl Kept {
    /// What the plan's integration looks up; made anew only when it changed.
    pub(crate) fn lookups(
        &mut self,
        renderer: &GpuRenderer,
        plan: &Plan,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Arc<Lookups>, GpuError> {
        match self.lookups.iter().position(|lookups| lookups.is_for(plan)) {
            Some(place) => self.lookups[..=place].rotate_right(1),
            None => {
                let field = FieldUnits {
                    scalar_factor: renderer.field.scalar_factor,
                    scalar_middle: renderer.field.scalar_middle,
                    scalar_range: renderer.field.scalar_range,
                    world_per_local: renderer.frame.scale,
                    chord_lengths: &|| renderer.chord_lengths(),
                };
                let lookups = Lookups::new(&renderer.gpu, plan, &field, progress)?;
                self.lookups.insert(0, Arc::new(lookups));
                self.lookups.truncate(KEPT_LOOKUPS);
            }
        }
        Ok(Arc::clone(&self.lookups[0]))
    }

    /// The plan's isosurfaces and light; made anew only when they changed.
    pub(crate) fn effects(&mut self, renderer: &GpuRenderer, plan: &Plan) -> Result<Arc<Effects>, GpuError> {
        let unit = ScalarUnit {
            factor: renderer.field.scalar_factor,
            range: renderer.field.scalar_range,
            middle: renderer.field.scalar_middle,
        };
        if let Some(effects) = self.effects.as_ref().filter(|effects| effects.is_for(plan, unit)) {
            return Ok(Arc::clone(effects));
        }
        let effects = Arc::new(Effects::new(&renderer.gpu, plan, unit, self.effects.as_deref())?);
        self.effects = Some(Arc::clone(&effects));
        Ok(effects)
    }

    /// The gradient at every point; computed when first asked for.
    pub(crate) fn gradients(&mut self, renderer: &GpuRenderer) -> Result<Buffer, GpuError> {
        if let Some(gradients) = &self.gradients {
            return Ok(gradients.clone());
        }
        let gradients =
            point_gradients(&renderer.gpu, &renderer.positions, &renderer.tetrahedra, &renderer.scalars)?;
        self.gradients = Some(gradients.clone());
        Ok(gradients)
    }

    /// Bytes of the gradients, if a plan asked for them.
    pub(crate) fn gradient_bytes(&self) -> Option<u64> {
        self.gradients.as_ref().map(Buffer::size)
    }

    /// The permutation of a method that the CPU sorts by; sorted and uploaded only when the view changed.
    pub(crate) fn made(&mut self, renderer: &GpuRenderer, method: OrderMethod, view: &tetrascope_view::View) -> &MadeOrder {
        let (gpu, cells, viewpoint) = (&renderer.gpu, renderer.cells(), view.viewpoint());
        match self.made.take().filter(|made| made.is_by(method)) {
            Some(mut made) => {
                made.update(gpu, cells, viewpoint);
                self.made.insert(made)
            }
            None => {
                let order = renderer.visibility.prepare(cells, method);
                self.made.insert(MadeOrder::new(gpu, method, order, cells, viewpoint))
            }
        }
    }

    /// Memory of the order.
    pub(crate) fn order(&mut self, renderer: &GpuRenderer, sorts: bool) -> Result<&OrderMemory, GpuError> {
        let (gpu, mesh) = (&renderer.gpu, &renderer.mesh);
        let mut order = match self.order.take() {
            Some(order) => order,
            None => OrderMemory::new(gpu, mesh)?,
        };
        if sorts {
            order.sorts(gpu, mesh)?;
        }
        Ok(self.order.insert(order))
    }
}
