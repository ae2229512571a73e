//! The fast renderer: one set-up per tetrahedron, tiles, eight pixels at a time in f32, all cores.
//!
//! A frame runs through five stages:
//! 1. transform: every point once into pixel space (f64);
//! 2. order: the cells that can be seen, sorted front to back by the plan's order;
//! 3. set up: each cell becomes a [`record::CellRecord`] in that order: four planes in f32 about a reference inside the cell;
//! 4. bin: which tiles each record touches;
//! 5. rasterize: each tile, on one core, blends its records front to back; where the plan says so, pixels hold segments back and sort
//!    them by themselves (`held`).
//!
//! Cells stay in one order from stage 2 on and every tile is drawn by one thread, so that the picture does not depend on the number of
//! threads. What depends on the transfer function alone is kept from frame to frame.

mod blocks;
mod careful;
mod cell;
mod cover;
mod deal;
mod effects;
mod fan;
mod gradient;
mod held;
mod interpolation;
mod lookup;
mod maps;
mod methods;
mod model;
mod optics;
mod record;
mod sample;
mod setup;
mod sharp;
mod sides;
mod surfaces;
mod survey;
mod tile;

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use fearless_simd::Level;
use glam::DVec3;
use rayon::prelude::*;

use tetrascope_integrate::{Integration, Isosurfaces};
use tetrascope_mesh::{
    CellId, ChordLengths, Frame, TetMesh, VertexId, ascending, point_gradients, scalar_base, scalar_factor,
    scalar_range, segment_lengths,
};
use tetrascope_order::{Cells, CycleRemedy, Guarantee, MeshVisibility, OrderMethod, PixelSort, VisibilityOrder};
use tetrascope_scene::{
    Counts, Gradients, Interpolation, OrderReport, Plan, PlanError, Progress, Rendered, Sharpness, Stage, Stopwatch,
    check_scalars,
};

use crate::RenderError;
use crate::error::on_threads;
use crate::geometry::{PixelSpace, Points};
use crate::grid::{Bins, TileGrid};
use cell::{NOWHERE, Outline};
use effects::Effects;
use held::Held;
use lookup::Lookup;
use maps::Maps;
use optics::Optics;
use record::{CellRecord, Records};
use setup::SetUp;
use survey::Sorting;

/// Pixels a side of a tile: color, opacity, transmittance and ray of its pixels take 24 KiB, which leaves room in a first-level cache.
const TILE_SIDE: u32 = 32;

/// Cells that one task sets up: enough to hide its start, few enough to spread over the cores.
const CHUNK: usize = 4096;

/// Transfer functions, tables and maps that are remembered, so that going back and forth between two costs nothing.
const KEPT: usize = 2;

/// Draws one field on one mesh, again and again.
///
/// Holds its own copy of what it needs: 17 bytes a tetrahedron and 32 a point, and up to 13 more a tetrahedron for each of
/// the last two transfer functions. The memory of a frame is kept for the next one: about 140 bytes a visible tetrahedron. Where
/// plans ask for them, also 24 bytes a point of gradients, up to 112 a visible tetrahedron for segments by fans, and the last two tables
/// and maps; and where pixels sort by themselves, for each thread 32 bytes for every fragment of the fullest tile of 32 by 32 pixels, or
/// with a window, of those that it holds back.
#[derive(Debug)]
pub struct CpuRenderer {
    frame: Frame,
    positions: Vec<DVec3>,
    /// From a scalar near them, in a unit in which their range is about one.
    scalars: Vec<f64>,
    /// That scalar: 0 unless the field's values are large against their differences.
    scalar_base: f64,
    /// Scalars of the plan's transfer function less the base, times this, are in that unit; a power of two.
    scalar_factor: f64,
    /// Vertices in ascending order.
    tetrahedra: Vec<[VertexId; 4]>,
    /// The same over points that neighbors share, where they do not.
    joined: Option<Vec<[VertexId; 4]>>,
    /// Points that are there once; others follow.
    joined_points: usize,
    /// Whether the volume in that order is positive.
    is_positive: Vec<bool>,
    /// The instructions that the processor has.
    level: Level,
    /// Lowest and highest scalar, in that unit.
    scalar_range: [f64; 2],
    /// Of the last transfer functions, the latest first.
    optics: Mutex<Vec<Arc<Optics>>>,
    /// Likewise the tables of integrations that have one, and the maps of isosurfaces.
    lookups: Mutex<Vec<Arc<Lookup>>>,
    maps: Mutex<Vec<Arc<Maps>>>,
    /// What visibility orders learned of the mesh, and the last of them.
    visibility: Arc<MeshVisibility>,
    orders: Mutex<Vec<Arc<Prepared>>>,
    /// Lengths of segments, only if a table asked for them; `None` if no cell has a volume.
    lengths: OnceLock<Option<ChordLengths>>,
    /// One a point, along the mesh's axes; only if a plan asked for them.
    gradients: OnceLock<Vec<DVec3>>,
    /// Memory of the last frame: asking the system for it anew costs a fifth of a frame.
    scratch: Mutex<Option<Scratch>>,
}

/// A visibility order that knows the mesh.
#[derive(Debug)]
struct Prepared {
    method: OrderMethod,
    order: Arc<dyn VisibilityOrder>,
}

/// What a frame fills and the next one fills again.
#[derive(Debug, Default)]
struct Scratch {
    points: Points,
    outlines: Vec<Outline>,
    records: Vec<Records>,
    tiles: Vec<tile::Pixels>,
    /// One a thread, where pixels sort.
    held: Mutex<Vec<Held>>,
}

impl CpuRenderer {
    /// Prepares a mesh and a field.
    ///
    /// - `scalars`: one a point of the mesh
    ///
    /// # Errors
    /// [`RenderError`] if `scalars` does not fit the mesh or holds a value that is not finite where a tetrahedron uses it.
    pub fn new(mesh: &TetMesh, scalars: &[f64]) -> Result<Self, RenderError> {
        Self::with_visibility(mesh, scalars, Arc::default())
    }

    /// The same with what is known of the mesh already; what is learned is shared with whoever else has it.
    ///
    /// - `visibility`: of the same mesh, as [`TetMesh::joined_tetrahedra`] has its cells
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn with_visibility(
        mesh: &TetMesh,
        scalars: &[f64],
        visibility: Arc<MeshVisibility>,
    ) -> Result<Self, RenderError> {
        check_scalars(mesh, scalars)?;
        let (tetrahedra, is_positive) = mesh
            .tetrahedra()
            .par_iter()
            .map(|t| {
                let (vertices, is_positive) = ascending(t.map(|v| v.0));
                (vertices.map(VertexId), is_positive)
            })
            .unzip();
        let range = scalar_range(mesh.tetrahedra(), scalars);
        let scalar_base = scalar_base(range);
        let range = range.map(|scalar| scalar - scalar_base);
        let scalar_factor = scalar_factor(range);
        Ok(Self {
            frame: mesh.frame(),
            positions: mesh.positions().to_vec(),
            scalars: scalars.iter().map(|s| (s - scalar_base) * scalar_factor).collect(),
            scalar_base,
            scalar_factor,
            scalar_range: range.map(|scalar| scalar * scalar_factor),
            tetrahedra,
            joined: mesh.has_points_of_cells().then(|| mesh.joined_tetrahedra()),
            joined_points: mesh.joined_positions().len(),
            is_positive,
            level: Level::new(),
            optics: Mutex::new(Vec::new()),
            lookups: Mutex::new(Vec::new()),
            maps: Mutex::new(Vec::new()),
            visibility,
            orders: Mutex::new(Vec::new()),
            lengths: OnceLock::new(),
            gradients: OnceLock::new(),
            scratch: Mutex::new(None),
        })
    }

    /// Draws a picture as the plan says; the plan's back end is ignored.
    ///
    /// The same plan gives the same bits, whatever the number of threads.
    ///
    /// # Errors
    /// [`RenderError::Threads`] if the plan asks for threads that cannot be started, [`RenderError::Plan`] if its methods do not go together or its tables have no possible size,
    /// [`PlanError::Interrupted`] between two steps, and [`PlanError::Memory`] for a picture that is too large. What is kept from frame to frame is as good as before.
    pub fn render(&self, plan: &Plan, progress: &dyn Progress) -> Result<Rendered, RenderError> {
        plan.check()?;
        on_threads(plan.threads, || self.render_here(plan, progress))?
    }

    /// The mesh as visibility orders see it: in the mesh's own coordinates, each cell's points in ascending order.
    pub fn cells(&self) -> Cells<'_> {
        Cells {
            positions: &self.positions[..self.joined_points],
            tetrahedra: self.joined.as_ref().unwrap_or(&self.tetrahedra),
        }
    }

    /// What visibility orders know of [`Self::cells`].
    pub fn visibility(&self) -> &Arc<MeshVisibility> {
        &self.visibility
    }

    fn render_here(&self, plan: &Plan, progress: &dyn Progress) -> Result<Rendered, RenderError> {
        let mut watch = Stopwatch::start();
        let view = plan.view.in_frame(self.frame.origin, self.frame.scale);
        let space = PixelSpace::new(&view, self.frame.scale);
        let surfaces = self.surfaces(plan);
        let maps = self.maps(plan, &surfaces)?;
        // Maps have surfaces at the boundaries of texels; the cells that may show them, and tables that stop at them, go by that.
        let surfaces = maps.as_ref().map_or(surfaces, |maps| maps.surfaces());
        let optics = self.optics(plan, &surfaces);
        let effects = Effects::new(plan, &surfaces, maps, &space);
        let gradients = match &effects {
            Some(effects) if effects.gradients == Gradients::Points => self.gradients(),
            _ => &[],
        };
        watch.lap(Stage::Prepare);
        let lookup = self.lookup(plan, &surfaces, &optics, progress)?;
        if lookup.is_some() {
            watch.lap(Stage::Tabulate);
        }
        progress.go_on()?;
        // Before the work: afterwards it would be lost.
        let mut image = plan.empty_picture()?;

        let mut scratch = self.scratch.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default();
        let Scratch { points, outlines, records, tiles, held } = &mut scratch;
        points.project(&space, &self.positions, &self.scalars);
        watch.lap(Stage::Transform);

        let outline = |cell: &[VertexId; 4]| points.pixel_box(&space, cell.map(|v| v.0));
        self.tetrahedra
            .par_iter()
            .zip(optics.is_shown())
            // Where a cell is that shows nothing, nobody asks.
            .map(|(cell, is_shown)| {
                is_shown.then(|| outline(cell)).flatten().map_or(NOWHERE, |outline| outline.map(|p| p as u16))
            })
            .collect_into_vec(outlines);
        let seen: Vec<CellId> =
            optics.visible().par_iter().copied().filter(|cell| outlines[cell.index()] != NOWHERE).collect();
        let cells = self.cells();
        let mut order = self.order(plan.order, cells).order.order(cells, view.viewpoint(), &seen);
        let rings = order.cycles.len() as u64;
        let cyclic = order.cycles.iter().map(|ring| ring.len() as u64).sum();
        if plan.cycles == CycleRemedy::Cut {
            order = order.cut_cycles(cells, view.viewpoint());
        }
        watch.lap(Stage::Order);
        progress.go_on()?;

        // Rings that could not be cut are left to the pixels.
        let rings_sort = plan.cycles != CycleRemedy::Report && !order.cycles.is_empty();
        let mut in_ring = vec![false; if rings_sort { self.tetrahedra.len() } else { 0 }];
        if rings_sort {
            for cell in order.cycles.iter().flatten() {
                in_ring[cell.index()] = true;
            }
        }
        let with_fans = plan.integration == Integration::Vertex;
        let effects = effects.as_ref();
        let longest_depth = space.ray_stretch(0.5 * f64::from(space.size[0]), 0.5 * f64::from(space.size[1]));
        // Local coordinates are at most 1 long, so that no chord is longer than 2.
        let longest_chord = 2.0 * self.frame.scale * longest_depth / space.world_per_depth;
        let densest = optics.transfer().max_extinction(f64::NEG_INFINITY, f64::INFINITY);
        // Maps have parts of the volume that no scalars bound.
        let has_maps = effects.is_some_and(|effects| effects.maps.is_some());
        let is_sharp = !has_maps
            && plan.interpolation == Interpolation::Exact
            && (optics.sharpness().may_be_beyond_32_bits(longest_chord)
                || (plan.model.needs_extinction() && Sharpness::is_chord_beyond_32_bits(densest, longest_chord)));
        let sharp = if is_sharp { sharp::integrator(plan.integration, &optics)? } else { None };
        let setup = SetUp {
            renderer: self,
            points,
            space: &space,
            outlines,
            optics: &optics,
            with_fans,
            sharpness: sharp.is_some().then(|| optics.sharpness()),
            longest_depth,
            interpolation: plan.interpolation,
            effects,
            gradients,
            pieces: &order.pieces,
            in_ring: &in_ring,
        };
        records.resize_with(order.front_to_back.len().div_ceil(CHUNK), Records::default);
        records.par_iter_mut().zip(order.front_to_back.par_chunks(CHUNK)).enumerate().try_for_each(
            |(chunk, (records, cells))| {
                progress.go_on()?;
                setup.fill(chunk * CHUNK, cells, records);
                Ok::<_, PlanError>(())
            },
        )?;
        watch.lap(Stage::SetUp);

        let sorting = Sorting::of(plan, rings_sort, held);
        let grid = TileGrid::new(space.size, TILE_SIDE);
        let bins: Vec<Bins> = records
            .par_iter()
            .map(|records| {
                grid.bin(records.cells.iter().map(CellRecord::pixel_box), |item, tile| {
                    records.may_show(item, tile, &space)
                })
            })
            .collect();
        watch.lap(Stage::Bin);
        progress.go_on()?;

        let [fragments, crossings, sorted, most_held, lit] = [0; 5].map(AtomicU64::new);
        let done = AtomicU64::new(0);
        let job = tile::Job {
            records,
            bins: &bins,
            grid,
            space: &space,
            optics: &optics,
            plan,
            lookup: lookup.as_deref(),
            sharp: sharp.as_ref(),
            effects,
            sorting,
            level: self.level,
        };
        tiles.resize_with(grid.len(), tile::Pixels::default);
        tiles.par_iter_mut().enumerate().with_max_len(1).try_for_each(|(index, pixels)| {
            progress.go_on()?;
            let drawn = job.draw(index, pixels);
            fragments.fetch_add(drawn.fragments, Ordering::Relaxed);
            crossings.fetch_add(drawn.crossings, Ordering::Relaxed);
            sorted.fetch_add(drawn.sorted, Ordering::Relaxed);
            most_held.fetch_max(drawn.most_held, Ordering::Relaxed);
            lit.fetch_add(drawn.lit, Ordering::Relaxed);
            progress.report(Stage::Rasterize, done.fetch_add(1, Ordering::Relaxed) + 1, grid.len() as u64);
            Ok::<_, PlanError>(())
        })?;
        let width = space.size[0] as usize;
        image.pixels_mut().par_chunks_mut(width).enumerate().for_each(|(y, line)| {
            let side = TILE_SIDE as usize;
            let row_of_tiles = &tiles[y / side * width.div_ceil(side)..];
            for (line, tile) in line.chunks_mut(side).zip(row_of_tiles) {
                tile.copy_row((y % side) as u32, line);
            }
        });
        watch.lap(Stage::Rasterize);

        let all = self.tetrahedra.len() as u64;
        let visible = optics.visible().len() as u64;
        let sum = |of: &dyn Fn(&Records) -> usize| records.iter().map(|records| of(records) as u64).sum::<u64>();
        let counts = Counts {
            cells: all,
            transparent: all - visible,
            outside: visible - seen.len() as u64,
            drawn: sum(&|r| r.cells.len()),
            careful: sum(&|r| r.careful.len()),
            fragments: fragments.into_inner(),
            crossings: crossings.into_inner(),
            cyclic,
            sorted: sorted.into_inner(),
            most_held: most_held.into_inner(),
            counts_fragments: true,
            ordered: if plan.order.sorts_cells() { seen.len() as u64 } else { 0 },
            table_entries: lookup.as_ref().map_or(0, |lookup| lookup.entries()),
            map_entries: effects.and_then(|effects| effects.maps.as_ref()).map_or(0, |maps| maps.entries()),
            point_gradients: gradients.len() as u64,
            cell_gradients: Some(sum(&|r| r.gradients.len() + r.flat_gradients.len())),
            with_effects: Some(sum(&|r| r.effects.len())),
            lit: Some(lit.into_inner()),
            fans: sum(&|r| {
                r.fans.iter().flatten().count()
                    + r.perspective.iter().flatten().count()
                    + r.screen.iter().flatten().count()
            }),
        };
        *self.scratch.lock().unwrap_or_else(PoisonError::into_inner) = Some(scratch);
        let guarantee = match plan.order.pixel_sort() {
            PixelSort::All => Guarantee::Exact,
            PixelSort::None | PixelSort::Window(_) => order.guarantee,
        };
        let order = OrderReport { guarantee, rings, rings_left: order.cycles.len() as u64 };
        Ok(Rendered { image, timings: watch.finish(), counts, order, device: None })
    }

    /// A visibility order, made ready for the mesh when first asked for.
    fn order(&self, method: OrderMethod, cells: Cells<'_>) -> Arc<Prepared> {
        recall(&self.orders, |order| order.method == method).unwrap_or_else(|| {
            remember(&self.orders, Prepared { method, order: self.visibility.prepare(cells, method) })
        })
    }

    /// The isosurfaces that are to be seen, in the renderer's unit.
    fn surfaces(&self, plan: &Plan) -> Isosurfaces {
        plan.isosurfaces.as_ref().map_or_else(Isosurfaces::default, |isosurfaces| {
            let seen = isosurfaces.surfaces.visible();
            seen.with_scalars_from(self.scalar_base).with_scalars_scaled(self.scalar_factor)
        })
    }

    /// The gradient at every point, along the mesh's axes; computed when first asked for.
    fn gradients(&self) -> &[DVec3] {
        self.gradients.get_or_init(|| point_gradients(&self.positions, &self.tetrahedra, &self.scalars))
    }

    /// What the plan's transfer function makes of the cells; made anew only when it changed.
    fn optics(&self, plan: &Plan, surfaces: &Isosurfaces) -> Arc<Optics> {
        let is_right = |optics: &Optics| optics.is_for(&plan.transfer, plan.model, surfaces);
        recall(&self.optics, is_right).unwrap_or_else(|| {
            let unit = (self.scalar_base, self.scalar_factor);
            let optics = Optics::new(&plan.transfer, unit, plan.model, surfaces, &self.tetrahedra, &self.scalars);
            remember(&self.optics, optics)
        })
    }

    /// The table of the plan's integration, if it has one; made anew only when what it depends on changed.
    fn lookup(
        &self,
        plan: &Plan,
        surfaces: &Isosurfaces,
        optics: &Optics,
        progress: &dyn Progress,
    ) -> Result<Option<Arc<Lookup>>, RenderError> {
        let Some(key) = lookup::Key::of(plan, surfaces) else { return Ok(None) };
        if let Some(lookup) = recall(&self.lookups, |lookup| lookup.is_for(&key)) {
            return Ok(Some(lookup));
        }
        // Only a mesh without volume has none: nothing is looked up in it, whatever the table covers.
        let lengths = self.lengths().unwrap_or(ChordLengths { mean: 1.0, longest: 1.0 });
        let report = |done, total| progress.report(Stage::Tabulate, done, total);
        let lookup = Lookup::new(key, optics.transfer(), surfaces, self.scalar_range, lengths, &report)?;
        Ok(Some(remember(&self.lookups, lookup)))
    }

    /// The maps of the plan's isosurfaces, if they are drawn by maps; made anew only when the surfaces changed.
    fn maps(&self, plan: &Plan, surfaces: &Isosurfaces) -> Result<Option<Arc<Maps>>, RenderError> {
        let Some(key) = maps::Key::of(plan, surfaces) else { return Ok(None) };
        if let Some(maps) = recall(&self.maps, |maps| maps.is_for(&key)) {
            return Ok(Some(maps));
        }
        Ok(Some(remember(&self.maps, Maps::new(key, self.scalar_range)?)))
    }

    /// Lengths of segments, world length; computed when first asked for. `None` if no cell has a volume.
    fn lengths(&self) -> Option<ChordLengths> {
        *self.lengths.get_or_init(|| {
            let local = segment_lengths(&self.positions, &self.tetrahedra)?;
            let scale = self.frame.scale;
            let lengths = ChordLengths { mean: local.mean * scale, longest: local.longest * scale };
            (lengths.mean > 0.0 && lengths.longest.is_finite()).then_some(lengths)
        })
    }
}

/// The one of those kept that fits; it becomes the first, since the last one used stays longest.
fn recall<T>(kept: &Mutex<Vec<Arc<T>>>, fits: impl Fn(&T) -> bool) -> Option<Arc<T>> {
    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
    let place = kept.iter().position(|one| fits(one))?;
    kept[..=place].rotate_right(1);
    Some(Arc::clone(&kept[0]))
}

/// Keeps something new in the place of what was not used for longest.
fn remember<T>(kept: &Mutex<Vec<Arc<T>>>, new: T) -> Arc<T> {
    let new = Arc::new(new);
    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
    kept.insert(0, Arc::clone(&new));
    kept.truncate(KEPT);
    new
}

#[cfg(test)]
mod interpolation_tests;
#[cfg(test)]
mod pieces_tests;
#[cfg(test)]
mod sorting_tests;
#[cfg(test)]
mod surfaces_tests;
#[cfg(test)]
mod tests;
