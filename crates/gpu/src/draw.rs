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

use tetrascope_integrate::Integration;
use tetrascope_order::Guarantee;
use tetrascope_scene::{Counts, GpuPath, OrderReport, Plan, Progress, Rendered, Stage, Stopwatch, TargetBits};
use tetrascope_shaders::layout::TILE_OPEN;
use tetrascope_view::{LinearImage, View};
use wgpu::Buffer;

use crate::GpuError;
use crate::effects::Effects;
use crate::kept::{Kept, TOTALS};
use crate::kernels::Variant;
use crate::lookups::Lookups;
use crate::part::{halves, parts};
use crate::power_functions::PowerFrame;
use crate::renderer::GpuRenderer;
use crate::sorting::{InPixels, MOST_HELD, Source};
use crate::targets::{Target, best_target};
use crate::view::Part;

/// Places of `totals`: cells that are drawn, pairs that were needed, and what was left out.
const DRAWN: usize = 0;
pub(crate) const PAIRS: usize = 1;
const TRANSPARENT: usize = 2;
const OUTSIDE: usize = 3;

/// A picture that is about to be drawn.
pub(crate) struct Drawing<'a> {
    pub(crate) renderer: &'a GpuRenderer,
    pub(crate) plan: &'a Plan,
    pub(crate) progress: &'a dyn Progress,
    /// In the mesh's own coordinates.
    pub(crate) view: View,
    pub(crate) path: Path,
    pub(crate) source: Source,
    /// Of a frame that the device sorts by keys.
    pub(crate) power: Option<PowerFrame>,
}

/// How cells become pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Path {
    /// Tiles, by compute programs.
    Compute,
    /// Fans of triangles, blended into a target of so many bits.
    Triangles(TargetBits),
}

/// What a plan asks of the device besides the order.
pub(crate) struct Means {
    pub(crate) lookups: Arc<Lookups>,
    pub(crate) effects: Arc<Effects>,
    pub(crate) gradients: Option<Buffer>,
    /// Files and constants of everything that shades.
    pub(crate) variant: Variant,
}

/// A part of the picture that was drawn, or why it was not.
pub(crate) enum Outcome {
    Drawn {
        pixels: Vec<[f32; 4]>,
        tiles: Vec<[u32; 4]>,
        totals: [u32; TOTALS],
        stages: Vec<(Stage, Duration)>,
    },
    /// So many pairs of tiles and cells were needed.
    NoRoom(u64),
}

impl Outcome {
    /// Whether some pixels are to be run again.
    pub(crate) fn is_open(&self) -> bool {
        matches!(self, Self::Drawn { tiles, .. } if tiles.iter().any(|tile| tile[3] & TILE_OPEN != 0))
    }

    /// With the times of what came before.
    pub(crate) fn after(mut self, before: Self) -> Self {
        if let (Self::Drawn { stages, .. }, Self::Drawn { stages: earlier, .. }) = (&mut self, before) {
            add_times(stages, earlier);
        }
        self
    }
}

impl<'a> Drawing<'a> {
    /// Decides what the device is to do.
    ///
    /// # Errors
    /// [`GpuError::TargetNotBlended`] for a target that the device does not blend.
    pub(crate) fn new(renderer: &'a GpuRenderer, plan: &'a Plan, progress: &'a dyn Progress) -> Result<Self, GpuError> {
        let path = choose_path(renderer, plan)?;
        let view = plan.view.in_frame(renderer.frame.origin, renderer.frame.scale);
        Ok(Self { renderer, plan, progress, view, path, source: Source::of(plan.order), power: None })
    }

    /// Draws it.
    ///
    /// # Errors
    /// [`GpuError`].
    pub(crate) fn draw(mut self, kept: &mut Kept) -> Result<Rendered, GpuError> {
        let mut watch = Stopwatch::start();
        let renderer = self.renderer;
        let mut notes = Vec::new();
        let power_bytes = u64::from(renderer.mesh.cell_count) * 32;
        let is_power_large = self.source == Source::Power && power_bytes > renderer.gpu.largest_binding();
        if is_power_large || renderer.mesh.parts.len() > 1 && matches!(self.source, Source::Centroids | Source::Power) {
            notes.push("the order was made on the CPU: the cells do not fit into one binding".to_owned());
            self.source = Source::Made;
        }
        let means = self.means(kept, &mut watch)?;
        self.progress.go_on()?;
        let (mut guarantee, mut rings, mut cyclic) = (Guarantee::Unsorted, 0, 0);
        match self.source {
            Source::AsTheyCome => {}
            Source::Centroids => guarantee = Guarantee::Approximate,
            Source::Power => match kept.power_frame(renderer, &self.view) {
                Ok(frame) => {
                    self.power = Some(frame);
                    guarantee = renderer.visibility.power(renderer.cells()).guarantee();
                }
                Err(reason) => {
                    notes.push(format!("the order was made on the CPU: {reason}"));
                    self.source = Source::Made;
                }
            },
            Source::Made => {}
        }
        if self.source == Source::Made {
            let made = kept.made(renderer, self.plan.order, &self.view);
            (guarantee, rings, cyclic) = (made.guarantee, made.rings, made.cyclic);
        }
        watch.lap(Stage::Order);
        self.progress.go_on()?;

        let sort = InPixels::of(self.plan, rings > 0);
        if let InPixels::Window(window) = sort
            && window >= MOST_HELD
        {
            return Err(GpuError::WindowTooLarge { window, most: MOST_HELD - 1 });
        }
        if self.path != Path::Compute && sort != InPixels::Nothing {
            return Err(GpuError::TrianglesCannotSort);
        }
        let size = [self.plan.view.width, self.plan.view.height];
        let state = sort.state(kept.slice(&renderer.gpu));
        let mut waiting = parts(size, renderer.gpu.largest_binding(), Target::largest_side(&renderer.gpu), state);
        waiting.reverse();
        let mut image = self.plan.empty_picture()?;
        let mut counts = Counts { cells: u64::from(renderer.mesh.cell_count), cyclic, ..Counts::default() };
        let mut stages = Vec::new();
        let mut is_first = true;
        while let Some(part) = waiting.pop() {
            self.progress.go_on()?;
            let outcome = match self.draw_part(kept, &means, sort, part) {
                // Fewer cells at a time make shorter loops.
                Err(GpuError::LoopCut { .. }) if kept.shorten_loops(&renderer.gpu) => {
                    waiting.push(part);
                    continue;
                }
                outcome => outcome?,
            };
            match outcome {
                Outcome::Drawn { pixels, tiles, totals, stages: times } => {
                    copy(&mut image, part, &pixels);
                    add_counts(&mut counts, &tiles, &totals, is_first);
                    add_times(&mut stages, times);
                    is_first = false;
                }
                Outcome::NoRoom(pairs) => match kept.make_room(renderer, pairs) {
                    Ok(()) => waiting.push(part),
                    // All cells of a pixel must be there together: fewer pixels, then.
                    Err(error) => waiting.extend(halves(part).ok_or(error)?.into_iter().rev()),
                },
            }
        }
        watch.lap(Stage::Rasterize);
        counts.counts_fragments = self.path == Path::Compute;
        counts.ordered = match self.source {
            Source::AsTheyCome => 0,
            Source::Centroids | Source::Power => counts.drawn,
            // All of the mesh, whatever the view shows: the order is kept until the view changes.
            Source::Made => counts.cells,
        };
        counts.table_entries = means.lookups.table_entries();
        counts.map_entries = means.effects.map_entries();
        counts.point_gradients = if means.gradients.is_some() { u64::from(renderer.mesh.point_count) } else { 0 };
        counts.fans = if self.plan.integration.needs_fan() { counts.drawn } else { 0 };
        let guarantee = if sort == InPixels::All { Guarantee::Exact } else { guarantee };
        let rings_left = rings;
        Ok(Rendered {
            image,
            timings: watch.finish(),
            counts,
            order: OrderReport { guarantee, rings, rings_left },
            device: Some(self.report(kept, &means, sort, stages, notes)),
        })
    }

    /// Lookups, effects and the programs that they ask for.
    fn means(&self, kept: &mut Kept, watch: &mut Stopwatch) -> Result<Means, GpuError> {
        let (renderer, plan) = (self.renderer, self.plan);
        let effects = kept.effects(renderer, plan)?;
        let gradients = if effects.needs_gradients() { Some(kept.gradients(renderer)?) } else { None };
        let has_table = plan.table_settings().is_some();
        if has_table {
            watch.lap(Stage::Prepare);
        }
        let report = |done, total| self.progress.report(Stage::Tabulate, done, total);
        let lookups = kept.lookups(renderer, plan, &effects, &report)?;
        watch.lap(if has_table { Stage::Tabulate } else { Stage::Prepare });
        let pieces = match plan.integration {
            // Their light is in the table, and bindings are few.
            Integration::Table2d | Integration::Table3d => "integrate/no_pieces.wgsl",
            _ => "integrate/pieces.wgsl",
        };
        let mut slots = vec![("pieces", pieces)];
        slots.extend(lookups.slots());
        slots.extend(effects.slots());
        let constants = effects.constants(self.path == Path::Compute);
        Ok(Means { lookups, effects, gradients, variant: Variant { slots, constants } })
    }
}

impl Means {
    /// What shading binds.
    pub(crate) fn resources(&self) -> Vec<crate::kernel::Named<'_>> {
        let mut all = self.lookups.resources();
        all.extend(self.effects.resources());
        all.extend(self.gradients.as_ref().map(|gradients| ("gradients", gradients.as_entire_binding())));
        all
    }
}

/// The path that a plan asks for, or the one that fits it.
fn choose_path(renderer: &GpuRenderer, plan: &Plan) -> Result<Path, GpuError> {
    let needs_fan = plan.integration.needs_fan();
    let path = plan.gpu.path.unwrap_or(if needs_fan { GpuPath::Triangles } else { GpuPath::Compute });
    match path {
        GpuPath::Compute => Ok(Path::Compute),
        GpuPath::Triangles => {
            let best = best_target(&renderer.gpu);
            match plan.gpu.target_bits {
                Some(bits) if bits > best => Err(GpuError::TargetNotBlended {
                    bits: bits.bits(),
                    adapter: renderer.gpu.description().name.clone(),
                }),
                asked => Ok(Path::Triangles(asked.unwrap_or(best))),
            }
        }
    }
}

/// The opacity of a pixel as the device keeps it, see `include/opacity.wgsl`.
pub(crate) fn opacity_of(packed: f32) -> f32 {
    if packed < 0.0 { 1.0 + packed } else { packed }
}

/// Puts a part into the picture: pixels have packed opacities.
fn copy(image: &mut LinearImage, part: Part, pixels: &[[f32; 4]]) {
    let width = image.width() as usize;
    let [column, row] = part.origin.map(|first| first as usize);
    for (y, line) in pixels.chunks_exact(part.extent[0] as usize).enumerate() {
        let first = (row + y) * width + column;
        for (target, &[r, g, b, packed]) in image.pixels_mut()[first..].iter_mut().zip(line) {
            *target = [r, g, b, opacity_of(packed)];
        }
    }
}

fn add_counts(counts: &mut Counts, tiles: &[[u32; 4]], totals: &[u32; TOTALS], is_first: bool) {
    for &[fragments, crossings, sorted, most] in tiles {
        counts.fragments += u64::from(fragments);
        counts.crossings += u64::from(crossings);
        counts.sorted += u64::from(sorted);
        counts.most_held = counts.most_held.max(u64::from(most));
    }
    counts.transparent = u64::from(totals[TRANSPARENT]);
    // A cell may lie in one part and outside of another: at least so many are drawn, at most so many are not.
    let (drawn, outside) = (u64::from(totals[DRAWN]), u64::from(totals[OUTSIDE]));
    counts.drawn = counts.drawn.max(drawn);
    counts.outside = if is_first { outside } else { counts.outside.min(outside) };
}

fn add_times(stages: &mut Vec<(Stage, Duration)>, times: Vec<(Stage, Duration)>) {
    for (stage, time) in times {
        match stages.iter_mut().find(|(known, _)| *known == stage) {
            Some((_, sum)) => *sum += time,
            None => stages.push((stage, time)),
        }
    }
}
