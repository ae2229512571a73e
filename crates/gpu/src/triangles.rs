//! The triangle path: cells are classified in a compute pass, and their silhouettes or fans blended by hardware, back to front.

use tetrascope_scene::{Plan, Stage, TargetBits};
use tetrascope_shaders::layout::{GROUP, TILE_SIDE};
use tetrascope_shaders::{Constant, Program, Slot};
use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState, Buffer, BufferUsages, CommandEncoder};

use crate::kernel::{Kernel, Named};
use crate::stopwatch::Laps;
use crate::targets::{Drawing, Target, format_of, most_light};
use crate::{Gpu, GpuError};

/// Bytes of what is drawn of a cell, at most.
pub(crate) const LARGEST_RECORD: u64 = 160;

/// Where the light of a cell is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightAt {
    /// In every pixel, along its own ray: a cell is a polygon over its silhouette.
    Pixels,
    /// At the vertices of a fan, and interpolated: `Integration::Vertex`.
    Vertices,
}

impl LightAt {
    pub(crate) fn of(plan: &Plan) -> Self {
        if plan.integration.needs_fan() { Self::Vertices } else { Self::Pixels }
    }

    /// The program that draws.
    pub(crate) fn file(self) -> &'static str {
        match self {
            Self::Pixels => "triangles/draw_rays.wgsl",
            Self::Vertices => "triangles/draw_fans.wgsl",
        }
    }

    /// The program that prepares cells, and its entry point.
    fn preparation(self) -> [&'static str; 2] {
        match self {
            Self::Pixels => ["triangles/outlines.wgsl", "outlines_of_block"],
            Self::Vertices => ["triangles/fans.wgsl", "fans_of_block"],
        }
    }

    /// The list of what is prepared, and the bytes of a cell in it.
    fn list(self) -> (&'static str, u64) {
        match self {
            Self::Pixels => ("outlined", LARGEST_RECORD),
            Self::Vertices => ("fans", 16),
        }
    }

    /// A cell whose nearest point is closer than this share of its farthest has no silhouette: it reaches the plane of the eye, or nearly,
    /// and is found within a box. Where the fan is what defines the light, as few cells as f32 allows.
    fn near_share(self) -> f32 {
        match self {
            Self::Pixels => 1e-2,
            Self::Vertices => 1e-4,
        }
    }
}

/// Light and opacity of what lies before over what lies behind.
const OVER: BlendComponent = BlendComponent {
    src_factor: BlendFactor::One,
    dst_factor: BlendFactor::OneMinusSrcAlpha,
    operation: BlendOperation::Add,
};

/// Pipelines of the triangle path, and its memory on the device.
#[derive(Debug)]
pub(crate) struct TrianglePath {
    light_at: LightAt,
    prepare: Kernel,
    empty: Kernel,
    accumulate: Kernel,
    drawing: Drawing,
    precision: TargetBits,
    prepared: Buffer,
    arguments: Buffer,
    capacity: u32,
}

/// A draw block: blocks are recorded back to front.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockToDraw {
    /// Cells that it may have; the uniform `block` and `totals` say how many there are.
    pub(crate) cells: u32,
    /// Whether it is the first that is recorded: the picture is emptied.
    pub(crate) is_first: bool,
    /// Whether it is the last that is recorded: the picture is complete.
    pub(crate) is_last: bool,
    /// Width and height of the part of the picture that is drawn, as in `frame`.
    pub(crate) extent: [u32; 2],
}

impl TrianglePath {
    /// - `slots`: files for `effects`, `volume` and `model`, and for the slots of those
    /// - `constants`: those that these ask for; rays hand on nothing from cell to cell here, so that CARRIES_JOINTS is false
    /// - `capacity`: most cells of a draw block
    ///
    /// # Errors
    /// [`GpuError::Shader`], and [`GpuError::TooLarge`] for blocks that no binding takes.
    pub(crate) fn new(
        gpu: &Gpu,
        light_at: LightAt,
        slots: &[Slot<'_>],
        constants: &[(&str, Constant)],
        precision: TargetBits,
        capacity: u32,
    ) -> Result<Self, GpuError> {
        let (list, bytes) = light_at.list();
        let (needed, limit) = (u64::from(capacity) * bytes, gpu.largest_binding());
        if needed > limit {
            let adapter = gpu.description().name.clone();
            return Err(GpuError::TooLarge { what: "a block of triangles", needed, limit, adapter });
        }
        let mut constants = constants.to_vec();
        constants.push(("MOST_LIGHT", Constant::F32(most_light(precision))));
        constants.push(("NEAR_SHARE", Constant::F32(light_at.near_share())));
        let mut slots = slots.to_vec();
        slots.push(("pieces", "integrate/pieces.wgsl"));
        let [file, entry_point] = light_at.preparation();
        let prepare = Program::compose(file, &slots, &constants)?;
        let accumulate = Program::compose("triangles/accumulate.wgsl", &slots, &constants)?;
        let draw = Program::compose(light_at.file(), &slots, &constants)?;
        let blend = BlendState { color: OVER, alpha: OVER };
        Ok(Self {
            light_at,
            prepare: Kernel::new(gpu, &prepare, entry_point),
            empty: Kernel::new(gpu, &accumulate, "empty"),
            accumulate: Kernel::new(gpu, &accumulate, "accumulate"),
            drawing: Drawing::new(gpu, &draw, ["vertex", "fragment"], format_of(precision), Some(blend)),
            precision,
            prepared: gpu.storage(list, needed),
            arguments: gpu.buffer(
                "arguments",
                16,
                BufferUsages::STORAGE | BufferUsages::INDIRECT | BufferUsages::COPY_SRC,
            ),
            capacity,
        })
    }

    /// Records the drawing of a block into `target` and, where it is complete, into `picture`.
    ///
    /// - `resources`: `frame`, `points`, `drawn`, `totals`, `block`, `picture`, and what the light of cells asks for
    ///
    /// `target` has the path's precision and is not smaller than the part that is drawn; a block has no more cells than the path takes.
    /// Otherwise the driver refuses the commands, or cells are left out: defects here.
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        laps: &mut Laps<'_>,
        resources: &[Named<'_>],
        target: &Target,
        block: BlockToDraw,
    ) {
        debug_assert!(block.cells <= self.capacity, "a block fits");
        debug_assert!(target.precision == self.precision, "the target is one of the path's");
        let [width, height] = block.extent;
        if width == 0 || height == 0 {
            return;
        }
        let mut all = resources.to_vec();
        all.push((self.light_at.list().0, self.prepared.as_entire_binding()));
        all.push(("arguments", self.arguments.as_entire_binding()));
        all.push(("blended", wgpu::BindingResource::TextureView(&target.view)));

        // A group is there even for no cells: it writes that there is nothing to draw.
        let groups = block.cells.div_ceil(GROUP).max(1);
        self.prepare.run_alone(encoder, &self.prepare.bind(gpu, &all), groups);
        if block.is_first {
            self.over_pixels(encoder, &self.empty, &self.empty.bind(gpu, &all), block.extent);
        }
        let sums_up = self.precision == TargetBits::Sixteen;
        {
            let group = self.drawing.bind(gpu, &all);
            let mut pass =
                self.drawing.pass(encoder, &target.view, block.is_first || sums_up, laps.render(Stage::Rasterize));
            pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
            pass.set_scissor_rect(0, 0, width, height);
            pass.set_pipeline(&self.drawing.pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw_indirect(&self.arguments, 0);
        }
        if block.is_last || sums_up {
            self.over_pixels(encoder, &self.accumulate, &self.accumulate.bind(gpu, &all), block.extent);
        }
    }

    /// Runs a kernel with one thread a pixel.
    fn over_pixels(&self, encoder: &mut CommandEncoder, kernel: &Kernel, group: &wgpu::BindGroup, extent: [u32; 2]) {
        let [x, y] = extent.map(|side| side.div_ceil(TILE_SIDE));
        kernel.run_over(encoder, group, [x, y]);
    }

    /// Memory that it takes on the device, without targets.
    pub(crate) fn bytes(&self) -> u64 {
        u64::from(self.capacity) * self.light_at.list().1 + 16
    }
}
