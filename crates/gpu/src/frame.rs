//! One part of a picture on the device: its passes, and what comes back.

use tetrascope_scene::Stage;
use tetrascope_shaders::layout::{Block, GROUP, TILE_CUT};
use tetrascope_shaders::{Constant, Slot};
use wgpu::{CommandEncoder, ComputePass, ComputePassDescriptor};

use crate::GpuError;
use crate::draw::{Drawing, Means, Outcome, PAIRS, Path};
use crate::kept::{Kept, Memory, TOTALS};
use crate::kernel::Named;
use crate::kernels::Variant;
use crate::mesh::MeshPart;
use crate::part::picture_bytes;
use crate::sorting::{DeviceOrder, InPixels, Source};
use crate::stopwatch::Laps;
use crate::triangles::BlockToDraw;
use crate::view::{Part, frame_of};

impl Drawing<'_> {
    /// Draws a part of the picture.
    ///
    /// # Errors
    /// [`GpuError`].
    pub(crate) fn draw_part(
        &self,
        kept: &mut Kept,
        means: &Means,
        sort: InPixels,
        part: Part,
    ) -> Result<Outcome, GpuError> {
        let renderer = self.renderer;
        let (gpu, mesh) = (&renderer.gpu, &renderer.mesh);
        kept.prepare(self, means, sort, part)?;
        let slice = kept.slice(gpu);
        let Some(memory) = kept.memory() else {
            return Err(GpuError::defect(gpu, "memory that was prepared is not there"));
        };
        let frame = frame_of(&self.view, part, self.plan.termination, mesh.cell_count, mesh.point_count);
        gpu.queue.write_buffer(&memory.order.frame, 0, bytemuck::bytes_of(&frame));
        let mut resources = memory.resources(mesh);
        resources.extend(means.resources());

        let mut laps = Laps::new(renderer.stopwatch.as_ref());
        let mut encoder = gpu.encoder("frame");
        encoder.clear_buffer(&memory.order.totals, 0, None);
        let pixels = (memory.work.picture.size() / 16) as u32;
        self.transform(&mut encoder, &mut laps, &resources, pixels)?;
        self.order(&mut encoder, &mut laps, means, &memory, &resources)?;
        let blocks = memory.block_starts(mesh.cell_count, self.path != Path::Compute);
        for (number, &first) in blocks.iter().enumerate() {
            self.progress.go_on()?;
            if number > 0 {
                // What a block is told is written between two submissions.
                let full = std::mem::replace(&mut encoder, gpu.encoder("block"));
                gpu.queue.submit([full.finish()]);
            }
            let block = Block { first, count: memory.plan.cells, capacity: memory.plan.pairs, unused: 0 };
            gpu.queue.write_buffer(&memory.order.block, 0, bytemuck::bytes_of(&block));
            match self.path {
                Path::Compute => {
                    self.bin(&mut encoder, &mut laps, &memory, &resources, sort)?;
                    self.rasterize(&mut encoder, &mut laps, means, &resources, (sort, slice), frame.tiles)?;
                }
                Path::Triangles(_) => {
                    let is_ends = [number == 0, number + 1 == blocks.len()];
                    self.draw_triangles(&mut encoder, &mut laps, &memory, &resources, part, is_ends)?;
                }
            }
        }
        let mut outcome = self.read(memory, encoder, laps, part)?;
        // Pixels that sort by themselves are run until none is open.
        while outcome.is_open() {
            self.progress.go_on()?;
            let mut encoder = gpu.encoder("sort on");
            let mut laps = Laps::new(renderer.stopwatch.as_ref());
            self.run_sorted(&mut encoder, &mut laps, means, &resources, (sort, slice), frame.tiles)?;
            outcome = self.read(memory, encoder, laps, part)?.after(outcome);
        }
        Ok(outcome)
    }

    /// Points along the camera's axes, and an empty picture.
    ///
    /// - `pixels`: of the part that is drawn, and its tiles
    fn transform(
        &self,
        encoder: &mut CommandEncoder,
        laps: &mut Laps<'_>,
        resources: &[Named<'_>],
        pixels: u32,
    ) -> Result<(), GpuError> {
        let renderer = self.renderer;
        let kernel = renderer.kernels.get(&renderer.gpu, "cell/project.wgsl", "project", &Variant::default())?;
        let group = kernel.bind(&renderer.gpu, resources);
        let mut pass = begin(encoder, laps, Stage::Transform);
        kernel.run(&mut pass, &group, renderer.mesh.point_count.div_ceil(GROUP));
        let clear = renderer.kernels.get(&renderer.gpu, "raster/clear.wgsl", "clear", &Variant::default())?;
        clear.run(&mut pass, &clear.bind(&renderer.gpu, resources), pixels.div_ceil(GROUP));
        Ok(())
    }

    /// The cells that are drawn, in their order.
    fn order(
        &self,
        encoder: &mut CommandEncoder,
        laps: &mut Laps<'_>,
        means: &Means,
        memory: &Memory<'_>,
        resources: &[Named<'_>],
    ) -> Result<(), GpuError> {
        let renderer = self.renderer;
        let (gpu, mesh) = (&renderer.gpu, &renderer.mesh);
        let candidate: Slot<'static> = match self.source {
            Source::Made => ("candidate", "order/candidate_permuted.wgsl"),
            _ => ("candidate", "order/candidate_own.wgsl"),
        };
        let cull = renderer.kernels.get(gpu, "order/cull.wgsl", "cull", &means.variant.with_slots(&[candidate]))?;
        let groups = mesh.cell_count.div_ceil(GROUP);
        let mut pass = begin(encoder, laps, Stage::Order);
        for part in &mesh.parts {
            cull.run(&mut pass, &cull.bind(gpu, &with_part(resources, part)), groups);
        }
        memory.order.compact.record(&mut pass);
        match (&memory.order.sorter, self.power) {
            (Some(DeviceOrder::Centroids(centroids)), _) if self.source == Source::Centroids => {
                centroids.record(&mut pass);
            }
            (Some(DeviceOrder::Power(power)), Some(view)) if self.source == Source::Power => {
                power.record(gpu, &mut pass, &view);
            }
            _ => {}
        }
        Ok(())
    }

    /// The cells of a block, and of its tiles.
    fn bin(
        &self,
        encoder: &mut CommandEncoder,
        laps: &mut Laps<'_>,
        memory: &Memory<'_>,
        resources: &[Named<'_>],
        sort: InPixels,
    ) -> Result<(), GpuError> {
        let renderer = self.renderer;
        let mut pass = begin(encoder, laps, Stage::Bin);
        self.gather(&mut pass, memory, resources)?;
        if let Some(tiles) = memory.tiles {
            tiles.bins.record(&mut pass);
        }
        if sort == InPixels::Rings {
            let kernel =
                renderer.kernels.get(&renderer.gpu, "raster/find_rings.wgsl", "find_rings", &Variant::default())?;
            kernel.run(&mut pass, &kernel.bind(&renderer.gpu, resources), memory.tile_count());
        }
        Ok(())
    }

    fn gather(&self, pass: &mut ComputePass<'_>, memory: &Memory<'_>, resources: &[Named<'_>]) -> Result<(), GpuError> {
        let renderer = self.renderer;
        let gather = renderer.kernels.get(&renderer.gpu, "order/gather.wgsl", "gather", &Variant::default())?;
        for part in &renderer.mesh.parts {
            let group = gather.bind(&renderer.gpu, &with_part(resources, part));
            gather.run(pass, &group, memory.plan.cells.div_ceil(GROUP));
        }
        Ok(())
    }

    /// Tiles, by compute programs.
    ///
    /// - `slice`: cells of a tile that a run of pixels that sort looks at; 0 for all
    fn rasterize(
        &self,
        encoder: &mut CommandEncoder,
        laps: &mut Laps<'_>,
        means: &Means,
        resources: &[Named<'_>],
        (sort, slice): (InPixels, u32),
        tiles: [u32; 2],
    ) -> Result<(), GpuError> {
        let renderer = self.renderer;
        let gpu = &renderer.gpu;
        if let Some((file, variant)) = ordered(means, sort) {
            let mut pass = begin(encoder, laps, Stage::Rasterize);
            let kernel = renderer.kernels.get(gpu, file, "draw", &variant)?;
            kernel.run(&mut pass, &kernel.bind(gpu, resources), tiles[0] * tiles[1]);
        }
        self.run_sorted(encoder, laps, means, resources, (sort, slice), tiles)
    }

    /// Tiles whose pixels sort by themselves: some runs of them.
    fn run_sorted(
        &self,
        encoder: &mut CommandEncoder,
        laps: &mut Laps<'_>,
        means: &Means,
        resources: &[Named<'_>],
        (sort, slice): (InPixels, u32),
        tiles: [u32; 2],
    ) -> Result<(), GpuError> {
        let Some((file, variant)) = sorted(means, sort, slice) else { return Ok(()) };
        let gpu = &self.renderer.gpu;
        let kernel = self.renderer.kernels.get(gpu, file, "draw", &variant)?;
        let group = kernel.bind(gpu, resources);
        let runs = if matches!(sort, InPixels::Window(_)) && slice == 0 { 1 } else { RUNS_AT_ONCE };
        let mut pass = begin(encoder, laps, Stage::Rasterize);
        for _ in 0..runs {
            kernel.run(&mut pass, &group, tiles[0] * tiles[1]);
        }
        Ok(())
    }

    /// Silhouettes of cells, rasterized and blended by hardware; fans for the integration that is defined on them.
    ///
    /// - `is_ends`: whether the block is the first and the last that is drawn
    fn draw_triangles(
        &self,
        encoder: &mut CommandEncoder,
        laps: &mut Laps<'_>,
        memory: &Memory<'_>,
        resources: &[Named<'_>],
        part: Part,
        [is_first, is_last]: [bool; 2],
    ) -> Result<(), GpuError> {
        {
            let mut pass = begin(encoder, laps, Stage::SetUp);
            self.gather(&mut pass, memory, resources)?;
        }
        let gpu = &self.renderer.gpu;
        let Some(triangles) = memory.triangles else {
            return Err(GpuError::defect(gpu, "triangles were not prepared"));
        };
        let block = BlockToDraw { cells: memory.plan.cells, is_first, is_last, extent: part.extent };
        triangles.path.record(gpu, encoder, laps, resources, &triangles.target, block);
        Ok(())
    }

    /// Submits the last commands, and waits for the picture.
    fn read(
        &self,
        memory: Memory<'_>,
        mut encoder: CommandEncoder,
        laps: Laps<'_>,
        part: Part,
    ) -> Result<Outcome, GpuError> {
        let renderer = self.renderer;
        let gpu = &renderer.gpu;
        let stages = laps.resolve(&mut encoder);
        let (read_back, picture_bytes) = (&memory.work.read_back, picture_bytes(part));
        encoder.copy_buffer_to_buffer(&memory.work.picture, 0, read_back, 0, picture_bytes);
        let totals_bytes = (TOTALS * size_of::<u32>()) as u64;
        encoder.copy_buffer_to_buffer(&memory.order.totals, 0, read_back, picture_bytes, totals_bytes);
        let times_at = picture_bytes + totals_bytes;
        let times_bytes = stages.len() as u64 * 16;
        if let Some(watch) = renderer.stopwatch.as_ref().filter(|_| !stages.is_empty()) {
            encoder.copy_buffer_to_buffer(watch.resolved(), 0, read_back, times_at, times_bytes);
        }
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.contents(read_back, times_at + times_bytes).map_err(|problem| GpuError::Driver {
            adapter: gpu.description().name.clone(),
            frame: memory.frame,
            problem,
        })?;

        let (picture, rest) = bytes.split_at(picture_bytes as usize);
        let (totals, times) = rest.split_at(totals_bytes as usize);
        let totals: [u32; TOTALS] = bytemuck::pod_read_unaligned(totals);
        let needed = u64::from(totals[PAIRS]);
        if self.path == Path::Compute && needed > u64::from(memory.plan.pairs) {
            return Ok(Outcome::NoRoom(needed));
        }
        let (pixels, tiles) = picture.split_at(part.extent[0] as usize * part.extent[1] as usize * 16);
        let tiles: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(tiles);
        if self.path == Path::Compute && tiles.iter().any(|tile| tile[3] & TILE_CUT != 0) {
            return Err(GpuError::LoopCut { adapter: gpu.description().name.clone() });
        }
        let times = renderer.stopwatch.as_ref().map_or_else(Vec::new, |watch| watch.stages(&stages, times));
        Ok(Outcome::Drawn { pixels: bytemuck::pod_collect_to_vec(pixels), tiles, totals, stages: times })
    }
}

/// Runs of the pixels that sort before the device is asked whether there are open ones: enough for a hundred layers.
const RUNS_AT_ONCE: u32 = 8;

/// A program and its variant.
type Rasterizer = (&'static str, Variant);

/// What draws tiles in the order of the cells, if any are drawn so.
pub(crate) fn ordered(means: &Means, sort: InPixels) -> Option<Rasterizer> {
    let rings = match sort {
        InPixels::Nothing => "raster/no_rings.wgsl",
        InPixels::Rings => "raster/rings.wgsl",
        InPixels::All | InPixels::Window(_) => return None,
    };
    Some(("raster/ordered.wgsl", means.variant.with_slots(&[("rings", rings)])))
}

/// What draws tiles whose pixels sort, if any do.
///
/// - `slice`: cells of a tile that a run looks at; 0 for all
pub(crate) fn sorted(means: &Means, sort: InPixels, slice: u32) -> Option<Rasterizer> {
    let held = sort.held()?;
    let rings = if sort == InPixels::Rings { "raster/rings.wgsl" } else { "raster/every_tile.wgsl" };
    let constants = [
        ("LAYERS", Constant::Bool(!matches!(sort, InPixels::Window(_)))),
        ("HELD", Constant::U32(held)),
        ("SLICE", Constant::U32(slice)),
        ("STATE", Constant::U32(sort.state(slice))),
    ];
    Some(("raster/sorted.wgsl", means.variant.with_slots(&[("rings", rings)]).with_constants(&constants)))
}

/// A compute pass of a stage.
fn begin<'a>(encoder: &'a mut CommandEncoder, laps: &mut Laps<'_>, stage: Stage) -> ComputePass<'a> {
    let label = stage.to_string();
    encoder.begin_compute_pass(&ComputePassDescriptor { label: Some(&label), timestamp_writes: laps.compute(stage) })
}

/// What there is, with a part of the mesh.
fn with_part<'a>(resources: &[Named<'a>], part: &'a MeshPart) -> Vec<Named<'a>> {
    let mut all = resources.to_vec();
    all.extend([
        ("cells", part.cells.as_entire_binding()),
        ("ranges", part.ranges.as_entire_binding()),
        ("chunk", part.chunk.as_entire_binding()),
    ]);
    all
}
