//! One picture, from the plan to its pixels.
//!
//! The stages of a frame, each a pass of its own on the device:
//! 1. transform: every point along the camera's axes, in whole numbers;
//! 2. order: candidates are culled (transparent, out of view), what is left is drawn close together, and sorted, unless the order was made
//!    on the CPU: then the candidates come in it;
//! 3. bin, or set up: for each block of the order its cells are fetched, and dealt to tiles (compute path) or made fans of triangles;
//! 4. rasterize.
//!
//! How many cells and pairs of tiles and cells there are is known on the device alone. Where there is no room for the pairs, nothing is drawn: the
//! counts come back with the picture, and the part is drawn again with more room, in smaller blocks, or in halves.

use std::sync::Arc;
use std::time::Duration;

use tetrascope_order::{CycleRemedy, Guarantee};
use tetrascope_scene::{
    BufferRole, Counts, DeviceBuffer, DeviceReport, GpuPath, OrderReport, Plan, Progress, Rendered, Stage, Stopwatch,
    TargetBits,
};
use tetrascope_shaders::Constant;
use tetrascope_shaders::layout::{Block, GROUP};
use tetrascope_view::{LinearImage, View};
use wgpu::{Buffer, CommandEncoder, ComputePassDescriptor};

use crate::GpuError;
use crate::effects::Effects;
use crate::kept::{Kept, OrderMemory, TOTALS};
use crate::kernel::Named;
use crate::kernels::Variant;
use crate::lookups::Lookups;
use crate::part::{halves, parts, picture_bytes};
use crate::renderer::GpuRenderer;
use crate::sorting::{InPixels, Source};
use crate::stopwatch::Laps;
use crate::view::{Part, frame_of};
use crate::work::{BlockPlan, Work};

/// Places of `totals`.
const DRAWN: usize = 0;
const PAIRS: usize = 1;
const TRANSPARENT: usize = 2;
const OUTSIDE: usize = 3;

/// A picture that is about to be drawn.
pub(crate) struct Drawing<'a> {
    renderer: &'a GpuRenderer,
    plan: &'a Plan,
    progress: &'a dyn Progress,
    /// In the mesh's own coordinates.
    view: View,
    path: GpuPath,
    source: Source,
}

/// What a plan asks of the device besides the order.
struct Means {
    lookups: Arc<Lookups>,
    effects: Arc<Effects>,
    gradients: Option<Buffer>,
    /// Files and constants of everything that shades.
    variant: Variant,
}

/// A part of the picture that was drawn, or why it was not.
enum Outcome {
    Drawn { pixels: Vec<[f32; 4]>, tiles: Vec<[u32; 4]>, totals: [u32; TOTALS], stages: Vec<(Stage, Duration)> },
    /// So many pairs of tiles and cells were needed.
    NoRoom(u64),
}

impl<'a> Drawing<'a> {
    /// Decides what the device is to do.
    ///
    /// # Errors
    /// [`GpuError::Unsupported`] for what no device path draws.
    pub(crate) fn new(
        renderer: &'a GpuRenderer,
        plan: &'a Plan,
        progress: &'a dyn Progress,
    ) -> Result<Self, GpuError> {
        let path = choose_path(plan)?;
        let view = plan.view.in_frame(renderer.frame.origin, renderer.frame.scale);
        Ok(Self { renderer, plan, progress, view, path, source: Source::of(plan.order) })
    }

    /// Draws it.
    ///
    /// # Errors
    /// [`GpuError`].
    pub(crate) fn draw(mut self, kept: &mut Kept) -> Result<Rendered, GpuError> {
        let mut watch = Stopwatch::start();
        let renderer = self.renderer;
        let mut notes = Vec::new();
        let means = self.means(kept, &mut watch)?;
        let (mut guarantee, mut rings, mut cyclic) = (Guarantee::Unsorted, 0, 0);
        match self.source {
            Source::AsTheyCome => {}
            Source::Centroids => guarantee = Guarantee::Approximate,
            Source::Power => {
                let power = Arc::clone(renderer.visibility.power(renderer.cells()));
                guarantee = power.certificate().guarantee();
                if let Err(reason) = kept.power(renderer, &power) {
                    notes.push(format!("the order was made on the CPU: {reason}"));
                    self.source = Source::Made;
                }
            }
            Source::Made => {}
        }
        if self.source == Source::Made {
            let made = kept.made(renderer, self.plan.order, &self.view);
            (guarantee, rings, cyclic) = (made.guarantee, made.rings, made.cyclic);
        }
        watch.lap(Stage::Order);

        let sort = InPixels::of(self.plan, rings > 0);
        if self.path == GpuPath::Triangles && sort != InPixels::Nothing {
            return Err(GpuError::TrianglesCannotSort);
        }
        let size = [self.plan.view.width, self.plan.view.height];
        let mut waiting = parts(size, renderer.gpu.largest_binding());
        waiting.reverse();
        let mut image = LinearImage::transparent(size[0], size[1]);
        let mut counts = Counts { cells: u64::from(renderer.mesh.cell_count), cyclic, ..Counts::default() };
        let mut stages = Vec::new();
        let mut is_first = true;
        while let Some(part) = waiting.pop() {
            match self.draw_part(kept, &means, sort, part)? {
                Outcome::Drawn { pixels, tiles, totals, stages: times } => {
                    copy(&mut image, part, &pixels);
                    add_counts(&mut counts, &tiles, &totals, is_first);
                    add_times(&mut stages, times);
                    is_first = false;
                }
                Outcome::NoRoom(pairs) => match kept.make_room(pairs, sort == InPixels::Nothing, &renderer.gpu) {
                    Ok(()) => waiting.push(part),
                    // All cells of a pixel must be there together: fewer pixels, then.
                    Err(error) => waiting.extend(halves(part).ok_or(error)?.into_iter().rev()),
                },
            }
        }
        watch.lap(Stage::Rasterize);
        let guarantee = if sort == InPixels::All { Guarantee::Exact } else { guarantee };
        let rings_left = rings;
        Ok(Rendered {
            image,
            timings: watch.finish(),
            counts,
            order: OrderReport { guarantee, rings, rings_left },
            device: Some(self.report(kept, &means, stages, notes)),
        })
    }

    /// Lookups, effects and the programs that they ask for.
    fn means(&self, kept: &mut Kept, watch: &mut Stopwatch) -> Result<Means, GpuError> {
        let (renderer, plan) = (self.renderer, self.plan);
        let effects = kept.effects(renderer, plan)?;
        let gradients = if effects.needs_gradients() { Some(kept.gradients(renderer)?) } else { None };
        watch.lap(Stage::Prepare);
        let report = |done, total| self.progress.report(Stage::Tabulate, done, total);
        let lookups = kept.lookups(renderer, plan, &report)?;
        watch.lap(Stage::Tabulate);
        let mut slots = lookups.slots().to_vec();
        slots.extend(effects.slots());
        let constants = effects.constants(self.path == GpuPath::Compute);
        Ok(Means { lookups, effects, gradients, variant: Variant { slots, constants } })
    }
}
