//! The triangle path: cells are classified in a compute pass, and their fans blended by hardware, back to front.

use tetrascope_scene::{Stage, TargetBits};
use tetrascope_shaders::layout::{GROUP, TILE_SIDE};
use tetrascope_shaders::{Constant, Program, Slot};
use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState, Buffer, BufferUsages, CommandEncoder};

use crate::kernel::{Kernel, Named};
use crate::stopwatch::Laps;
use crate::targets::{Drawing, Target, format_of, most_light};
use crate::{Gpu, GpuError};

/// Bytes of a fan's record.
const FAN_BYTES: u64 = 16;

/// What is interpolated over the triangles of a fan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interpolated {
    /// Where rays enter and leave: every pixel integrates along its own.
    Rays,
    /// Color and opacity, from the thick vertex: `Integration::Vertex`.
    Light,
}

impl Interpolated {
    fn file(self) -> &'static str {
        match self {
            Self::Rays => "triangles/rays.wgsl",
            Self::Light => "triangles/thick.wgsl",
        }
    }

    /// A cell whose nearest point is closer than this share of its farthest has no fan: it reaches the plane of the eye, or nearly, and is
    /// found ray by ray. Where the fan is what defines the light, as few cells as f32 allows.
    fn near_share(self) -> f32 {
        match self {
            Self::Rays => 1e-2,
            Self::Light => 1e-4,
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
    fans_kernel: Kernel,
    empty: Kernel,
    accumulate: Kernel,
    drawing: Drawing,
    precision: TargetBits,
    fans: Buffer,
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
        interpolated: Interpolated,
        slots: &[Slot<'_>],
        constants: &[(&str, Constant)],
        precision: TargetBits,
        capacity: u32,
    ) -> Result<Self, GpuError> {
        let (needed, limit) = (u64::from(capacity) * FAN_BYTES, gpu.largest_binding());
        if needed > limit {
            let adapter = gpu.description().name.clone();
            return Err(GpuError::TooLarge { what: "a block of fans", needed, limit, adapter });
        }
        let mut constants = constants.to_vec();
        constants.push(("MOST_LIGHT", Constant::F32(most_light(precision))));
        constants.push(("NEAR_SHARE", Constant::F32(interpolated.near_share())));
        let mut slots = slots.to_vec();
        slots.extend([("triangle", interpolated.file()), ("pieces", "integrate/pieces.wgsl")]);
        let fans = Program::compose("triangles/fans.wgsl", &slots, &constants)?;
        let accumulate = Program::compose("triangles/accumulate.wgsl", &slots, &constants)?;
        let draw = Program::compose("triangles/draw.wgsl", &slots, &constants)?;
        let blend = BlendState { color: OVER, alpha: OVER };
        Ok(Self {
            fans_kernel: Kernel::new(gpu, &fans, "fans_of_block"),
            empty: Kernel::new(gpu, &accumulate, "empty"),
            accumulate: Kernel::new(gpu, &accumulate, "accumulate"),
            drawing: Drawing::new(gpu, &draw, ["vertex", "fragment"], format_of(precision), Some(blend)),
            precision,
            fans: gpu.storage("fans", needed),
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
        all.push(("fans", self.fans.as_entire_binding()));
        all.push(("arguments", self.arguments.as_entire_binding()));
        all.push(("blended", wgpu::BindingResource::TextureView(&target.view)));

        // A group is there even for no cells: it writes that there is nothing to draw.
        let groups = block.cells.div_ceil(GROUP).max(1);
        self.fans_kernel.run_alone(encoder, &self.fans_kernel.bind(gpu, &all), groups);
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
        u64::from(self.capacity) * FAN_BYTES + 16
    }
}
