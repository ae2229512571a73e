//! What goes on from frame to frame: lookups until the plan changes, orders until the view does, memory until more is needed.

use std::sync::Arc;

use tetrascope_order::OrderMethod;
use tetrascope_scene::{BufferRole, Plan, TargetBits};
use tetrascope_shaders::layout::{Block, Frame, TILE_SIDE};
use tetrascope_view::View;
use wgpu::{Buffer, BufferUsages, TextureFormat, TextureView};

use crate::bins::{Bins, BinsKernels, BinsSize};
use crate::compact::Compact;
use crate::draw::{Drawing, Means, Path};
use crate::effects::{Effects, ScalarUnit, point_gradients};
use crate::kernel::Named;
use crate::kernels::Variant;
use crate::keys::{CentroidOrder, KeysKernels, PowerOrder, SortedOrder};
use crate::lookups::{FieldUnits, Lookups};
use crate::mesh::MeshBuffers;
use crate::power_functions::{NotResolved, PowerFrame, PowerFunctions};
use crate::renderer::GpuRenderer;
use crate::scan::{ListKernels, words};
use crate::sorting::{DeviceOrder, InPixels, MadeOrder, Source};
use crate::targets::{Display, Target};
use crate::triangles::{LightAt, TrianglePath};
use crate::view::Part;
use crate::work::{BlockPlan, LEAST_IN_BLOCK, Work, half_slice, most_in_block, most_in_slice};
use crate::{Gpu, GpuError};

/// Transfer functions whose lookups are remembered, so that going back and forth between two costs nothing.
const KEPT_LOOKUPS: usize = 2;

/// Words of `totals`.
pub(crate) const TOTALS: usize = 8;

/// What is kept, to be compared.
#[cfg(test)]
#[derive(Debug)]
pub(crate) struct KeptBuffers {
    pub(crate) permutation: Option<Buffer>,
    pub(crate) order: Option<Buffer>,
    /// Where they are on the host.
    pub(crate) lookups: Option<*const Lookups>,
    pub(crate) kernels: usize,
}

/// What goes on from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Kept {
    /// Number of the last frame, from 1.
    pub(crate) frame: u64,
    lookups: Vec<Arc<Lookups>>,
    effects: Option<Arc<Effects>>,
    gradients: Option<Buffer>,
    made: Option<MadeOrder>,
    /// Functions of the power order, or why the device cannot sort by them; once asked for.
    power: Option<Result<PowerFunctions, NotResolved>>,
    order: Option<OrderMemory>,
    triangles: Option<TriangleMemory>,
    display: Option<(TextureFormat, Display)>,
    /// How the order is cut, and whether all cells must be together.
    plan: Option<(BlockPlan, bool)>,
    /// Cells of a tile that a run of pixels that sort looks at, once loops were ended.
    pub(crate) slice: Option<u32>,
    work: Option<Work>,
    tiles: Option<TileMemory>,
}

/// The cells of each tile.
#[derive(Debug)]
pub(crate) struct TileMemory {
    size: BinsSize,
    starts: Buffer,
    items: Buffer,
    pub(crate) bins: Bins,
}

/// Pipelines of the triangle path, and the target that they draw into.
#[derive(Debug)]
pub(crate) struct TriangleMemory {
    light_at: LightAt,
    variant: Variant,
    cells: u32,
    pub(crate) path: TrianglePath,
    pub(crate) target: Target,
}

/// What a frame works on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Memory<'a> {
    /// Number of the frame.
    pub(crate) frame: u64,
    pub(crate) plan: BlockPlan,
    pub(crate) order: &'a OrderMemory,
    pub(crate) work: &'a Work,
    pub(crate) tiles: Option<&'a TileMemory>,
    pub(crate) triangles: Option<&'a TriangleMemory>,
    permutation: Option<&'a Buffer>,
}

impl<'a> Memory<'a> {
    /// All of it, and the mesh but for its cells, by name.
    pub(crate) fn resources(&self, mesh: &'a MeshBuffers) -> Vec<Named<'a>> {
        let Self { order, work, .. } = *self;
        let mut all = vec![
            ("frame", order.frame.as_entire_binding()),
            ("block", order.block.as_entire_binding()),
            ("totals", order.totals.as_entire_binding()),
            ("kept", order.kept.as_entire_binding()),
            ("order", order.order.as_entire_binding()),
            ("vertices", mesh.vertices.as_entire_binding()),
            ("points", mesh.points.as_entire_binding()),
            ("drawn", work.drawn.as_entire_binding()),
            ("picture", work.picture.as_entire_binding()),
        ];
        all.extend(self.permutation.map(|permutation| ("permutation", permutation.as_entire_binding())));
        if let Some(tiles) = self.tiles {
            all.extend([
                ("tile_starts", tiles.starts.as_entire_binding()),
                ("tile_items", tiles.items.as_entire_binding()),
            ]);
        }
        all
    }

    /// Where the blocks of an order begin.
    ///
    /// - `back_to_front`: whether the farthest comes first
    pub(crate) fn block_starts(&self, cells: u32, back_to_front: bool) -> Vec<u32> {
        let mut starts: Vec<u32> = (0..cells.max(1)).step_by(self.plan.cells as usize).collect();
        if back_to_front {
            starts.reverse();
        }
        starts
    }

    /// Tiles of the part that is drawn.
    pub(crate) fn tile_count(&self) -> u32 {
        self.tiles.map_or(0, |tiles| tiles.size.tiles)
    }
}

impl TileMemory {
    fn new(gpu: &Gpu, order: &OrderMemory, work: &Work, points: &Buffer, size: BinsSize) -> Result<Self, GpuError> {
        let starts = words(gpu, "where tiles begin", u64::from(size.tiles) + 1)?;
        let items = words(gpu, "cells of tiles", size.pairs.into())?;
        let kernels = BinsKernels::new(gpu, "cell/outline.wgsl")?;
        let resources = [
            ("frame", order.frame.as_entire_binding()),
            ("block", order.block.as_entire_binding()),
            ("drawn", work.drawn.as_entire_binding()),
            ("tile_starts", starts.as_entire_binding()),
            ("points", points.as_entire_binding()),
        ];
        let bins = Bins::new(gpu, &order.lists, &kernels, [&items, &order.totals], &resources, size)?;
        Ok(Self { size, starts, items, bins })
    }

    fn bytes(&self) -> u64 {
        self.starts.size() + self.items.size() + self.bins.bytes()
    }
}

/// The order of the cells that are drawn, and what makes it.
#[derive(Debug)]
pub(crate) struct OrderMemory {
    pub(crate) lists: Arc<ListKernels>,
    pub(crate) frame: Buffer,
    pub(crate) block: Buffer,
    pub(crate) totals: Buffer,
    /// What becomes of each candidate.
    pub(crate) kept: Buffer,
    pub(crate) order: Buffer,
    pub(crate) compact: Compact,
    /// Where the device sorts: the last one that did.
    pub(crate) sorter: Option<DeviceOrder>,
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
            sorter: None,
        })
    }

    /// Makes ready what the device sorts by.
    ///
    /// - `power`: the functions of the mesh, for that order
    fn sort_by(
        &mut self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        source: Source,
        power: Option<&PowerFunctions>,
    ) -> Result<(), GpuError> {
        let is_there = matches!(
            (&self.sorter, source),
            (_, Source::AsTheyCome | Source::Made)
                | (Some(DeviceOrder::Centroids(_)), Source::Centroids)
                | (Some(DeviceOrder::Power(_)), Source::Power)
        );
        let [part] = mesh.parts.as_slice() else { return Ok(()) };
        if is_there {
            return Ok(());
        }
        // Two at a time would take twice the memory.
        self.sorter = None;
        let kernels = KeysKernels::new(gpu)?;
        let sorted = SortedOrder { order: &self.order, totals: &self.totals, most: mesh.cell_count };
        self.sorter = match power {
            Some(functions) if source == Source::Power => {
                Some(DeviceOrder::Power(PowerOrder::new(gpu, &self.lists, &kernels, sorted, functions)?))
            }
            _ => {
                let resources = [
                    ("frame", self.frame.as_entire_binding()),
                    ("points", mesh.points.as_entire_binding()),
                    ("cells", part.cells.as_entire_binding()),
                ];
                let order = CentroidOrder::new(gpu, &self.lists, &kernels, sorted, &resources)?;
                Some(DeviceOrder::Centroids(order))
            }
        };
        Ok(())
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        let sorter = self.sorter.as_ref().map_or(0, DeviceOrder::bytes);
        self.kept.size() + self.order.size() + self.compact.bytes() + sorter
    }
}

impl Kept {
    /// What the plan's integration looks up; made anew only when it changed.
    ///
    /// - `effects`: those of the plan: a table that stops at isosurfaces stops where the map has them
    pub(crate) fn lookups(
        &mut self,
        renderer: &GpuRenderer,
        plan: &Plan,
        effects: &Effects,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Arc<Lookups>, GpuError> {
        let mut plan = plan.clone();
        if let Some(isosurfaces) = &mut plan.isosurfaces {
            isosurfaces.surfaces = effects.surfaces().with_scalars_scaled(1.0 / renderer.field.scalar_factor);
        }
        let plan = &plan;
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
        let gradients = point_gradients(&renderer.gpu, &renderer.positions, &renderer.tetrahedra, &renderer.scalars)?;
        self.gradients = Some(gradients.clone());
        Ok(gradients)
    }

    /// Bytes of the gradients, if a plan asked for them.
    pub(crate) fn gradient_bytes(&self) -> Option<u64> {
        self.gradients.as_ref().map(Buffer::size)
    }

    /// The permutation of a method that the CPU sorts by; sorted and uploaded only when the view changed.
    pub(crate) fn made(&mut self, renderer: &GpuRenderer, method: OrderMethod, view: &View) -> &MadeOrder {
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

    /// Makes ready what a part of a frame works on.
    pub(crate) fn prepare(
        &mut self,
        drawing: &Drawing<'_>,
        means: &Means,
        sort: InPixels,
        part: Part,
    ) -> Result<(), GpuError> {
        let renderer = drawing.renderer;
        let (gpu, mesh) = (&renderer.gpu, &renderer.mesh);
        let limit = gpu.largest_binding();
        let whole = sort != InPixels::Nothing;
        self.order(renderer, drawing.source)?;
        let most = most_in_block(gpu, drawing.path, mesh.cell_count);
        let plan = match self.plan {
            Some((plan, was_whole)) if was_whole == whole && (whole || plan.cells <= most) => plan,
            _ => BlockPlan::new(mesh.cell_count, whole, limit, most),
        };
        if whole && plan.cells < mesh.cell_count {
            return Err(GpuError::TooLarge {
                what: "all tetrahedra, which pixels sort and so must be together,",
                needed: u64::from(mesh.cell_count) * 16,
                limit,
                adapter: gpu.description().name.clone(),
            });
        }
        self.plan = Some((plan, whole));
        let state = sort.state(self.slice(gpu));
        if !self.work.as_ref().is_some_and(|work| work.fits(plan.cells, part, state)) {
            // What is bound to it goes with it.
            (self.work, self.tiles) = (None, None);
            self.work = Some(Work::new(gpu, plan.cells, part, state));
        }
        let (Some(order), Some(work)) = (&self.order, &self.work) else { return Ok(()) };
        match drawing.path {
            Path::Compute => {
                let [columns, rows] = part.extent.map(|side| side.div_ceil(TILE_SIDE));
                let size = BinsSize { cells: plan.cells, pairs: plan.pairs, tiles: columns * rows };
                if self.tiles.as_ref().is_none_or(|tiles| tiles.size != size) {
                    self.tiles = None;
                    self.tiles = Some(TileMemory::new(gpu, order, work, &mesh.points, size)?);
                }
            }
            Path::Triangles(bits) => {
                let fits = |memory: &TriangleMemory| memory.fits(drawing.plan, &means.variant, bits, plan.cells, part);
                if !self.triangles.as_ref().is_some_and(fits) {
                    self.triangles = None;
                    let memory = TriangleMemory::new(gpu, drawing.plan, &means.variant, bits, plan.cells, part)?;
                    self.triangles = Some(memory);
                }
            }
        }
        Ok(())
    }

    #[cfg(test)]
    pub(crate) fn buffers(&self, kernels: usize) -> KeptBuffers {
        KeptBuffers {
            permutation: self.made.as_ref().map(|made| made.permutation.clone()),
            order: self.order.as_ref().map(|order| order.order.clone()),
            lookups: self.lookups.first().map(Arc::as_ptr),
            kernels,
        }
    }

    /// Bytes on the device of the order and of a frame.
    pub(crate) fn bytes(&self) -> Vec<(BufferRole, &'static str, u64)> {
        let mut all = Vec::new();
        if let Some(order) = &self.order {
            all.push((BufferRole::Order, "sorting", order.bytes()));
        }
        if let Some(made) = &self.made {
            all.push((BufferRole::Order, "permutation", made.permutation.size()));
        }
        if let Some(work) = &self.work {
            all.extend(work.bytes().map(|(label, bytes)| (BufferRole::Frame, label, bytes)));
        }
        if let Some(tiles) = &self.tiles {
            all.push((BufferRole::Frame, "tiles", tiles.bytes()));
        }
        if let Some(triangles) = &self.triangles {
            all.push((BufferRole::Frame, "fans", triangles.path.bytes()));
            all.push((BufferRole::Frame, "target", triangles.target.bytes()));
        }
        all
    }

    /// Makes room for more pairs of tiles and cells, or takes fewer cells at a time.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if neither helps.
    pub(crate) fn make_room(&mut self, renderer: &GpuRenderer, pairs: u64) -> Result<(), GpuError> {
        let limit = renderer.gpu.largest_binding();
        let Some((plan, whole)) = self.plan else { return Ok(()) };
        let plan = plan.with_room(pairs, whole, limit).ok_or_else(|| GpuError::TooLarge {
            what: "the tetrahedra of the picture's tiles",
            needed: pairs * 4,
            limit,
            adapter: renderer.gpu.description().name.clone(),
        })?;
        self.plan = Some((plan, whole));
        Ok(())
    }

    /// Shows the last picture over a background.
    pub(crate) fn show(
        &mut self,
        gpu: &Gpu,
        size: [u32; 2],
        background: [f32; 3],
        view: &TextureView,
        format: TextureFormat,
    ) -> Result<(), GpuError> {
        let (Some(order), Some(work)) = (&self.order, &self.work) else { return Err(GpuError::NotWhole) };
        if work.extent() != size {
            return Err(GpuError::NotWhole);
        }
        let display = match self.display.take().filter(|(known, _)| *known == format) {
            Some((_, display)) => display,
            None => Display::new(gpu, format)?,
        };
        let [r, g, b] = background;
        let background = gpu.uniform_of("background", &[r, g, b, 0.0]);
        let resources = [
            ("frame", order.frame.as_entire_binding()),
            ("picture", work.picture.as_entire_binding()),
            ("background", background.as_entire_binding()),
        ];
        let mut encoder = gpu.encoder("display");
        display.record(gpu, &mut encoder, &resources, view);
        gpu.queue.submit([encoder.finish()]);
        self.display = Some((format, display));
        Ok(())
    }

    /// Cells of a tile that a run of pixels that sort looks at; 0 for all.
    pub(crate) fn slice(&self, gpu: &Gpu) -> u32 {
        self.slice.unwrap_or_else(|| most_in_slice(gpu))
    }

    /// Takes half of the cells at a time, or where they must be together looks at half as many in a run; false if they are few.
    pub(crate) fn shorten_loops(&mut self, gpu: &Gpu) -> bool {
        let half = half_slice(self.slice(gpu));
        let Some((plan, whole)) = &mut self.plan else { return false };
        if *whole {
            self.slice = half.or(self.slice);
            return half.is_some();
        }
        let is_possible = plan.cells > LEAST_IN_BLOCK;
        if is_possible {
            plan.cells = plan.cells.div_ceil(2);
        }
        is_possible
    }

    /// What a part of a frame works on, once it is prepared.
    pub(crate) fn memory(&self) -> Option<Memory<'_>> {
        Some(Memory {
            frame: self.frame,
            plan: self.plan?.0,
            order: self.order.as_ref()?,
            work: self.work.as_ref()?,
            tiles: self.tiles.as_ref(),
            triangles: self.triangles.as_ref(),
            permutation: self.made.as_ref().map(|made| &made.permutation),
        })
    }

    /// What a frame in the power order sorts by on the device, or why it cannot.
    pub(crate) fn power_frame(&mut self, renderer: &GpuRenderer, view: &View) -> Result<PowerFrame, NotResolved> {
        let functions = self.power.get_or_insert_with(|| {
            let (visibility, cells) = (&renderer.visibility, renderer.cells());
            PowerFunctions::new(visibility.power(cells), cells, visibility.adjacency(cells))
        });
        match functions {
            Ok(functions) => functions.view(view.viewpoint()).ok_or(NotResolved::OutOfRange),
            Err(reason) => Err(*reason),
        }
    }

    /// Memory of the order.
    fn order(&mut self, renderer: &GpuRenderer, source: Source) -> Result<(), GpuError> {
        let (gpu, mesh) = (&renderer.gpu, &renderer.mesh);
        let order = match &mut self.order {
            Some(order) => order,
            None => self.order.insert(OrderMemory::new(gpu, mesh)?),
        };
        let power = self.power.as_ref().and_then(|functions| functions.as_ref().ok());
        order.sort_by(gpu, mesh, source, power)
    }
}

impl TriangleMemory {
    fn new(
        gpu: &Gpu,
        plan: &Plan,
        variant: &Variant,
        bits: TargetBits,
        cells: u32,
        part: Part,
    ) -> Result<Self, GpuError> {
        let light_at = LightAt::of(plan);
        let path = TrianglePath::new(gpu, light_at, &variant.slots, &variant.constants, bits, cells)?;
        let target = Target::new(gpu, part.extent, bits)?;
        Ok(Self { light_at, variant: variant.clone(), cells, path, target })
    }

    /// Whether it is what a plan asks for, with room enough.
    fn fits(&self, plan: &Plan, variant: &Variant, bits: TargetBits, cells: u32, part: Part) -> bool {
        let [width, height] = self.target.size();
        LightAt::of(plan) == self.light_at
            && self.variant == *variant
            && self.target.precision == bits
            && self.cells >= cells
            && width >= part.extent[0]
            && height >= part.extent[1]
    }
}
