//! The reference: every pixel's ray against every tetrahedron, in f64, sorted along the ray.
//!
//! Nothing is approximated but by rounding: segments come from clipping the ray against the four half-spaces of a cell,
//! each is cut where it meets an isosurface, what is between is integrated as the plan says, and the fragments of a pixel are
//! sorted along the ray, so that no order of whole cells is needed and cycles are drawn rightly. Cells that overlap
//! in space are composed one after the other, the one whose middle is nearer first.

mod light;
pub(crate) mod ray;
pub(crate) mod vertex;

use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use tetrascope_integrate::{Integrator, TableDomain};
use tetrascope_mesh::{TetMesh, ascending, scalar_base};
use tetrascope_order::Guarantee;
use tetrascope_scene::{Counts, OrderReport, Plan, PlanError, Progress, Rendered, Stage, Stopwatch, check_scalars};

use crate::RenderError;
use crate::domain::table_domain;
use crate::error::on_threads;
use crate::geometry::{ClipCell, PixelBox, PixelSpace, Points, is_outside_rectangle};
use crate::grid::{Bins, Tile, TileGrid};
use ray::{Fragment, Ray, RayComposer};

/// Pixels a side of a tile: the fragments of all its pixels are in memory at once, 40 bytes each.
const TILE_SIDE: u32 = 16;

/// Draws a mesh as the plan says, in f64.
///
/// - `scalars`: one a point of the mesh
///
/// The plan's order, back end, interpolation and termination are ignored, and so is the method of its isosurfaces: the reference has
/// segments exactly, and cuts rays where they meet a surface, which is what interpolation and maps approximate.
///
/// # Errors
/// [`RenderError`] if `scalars` does not fit the mesh, holds a value that is not finite where a tetrahedron uses it, or if
/// the plan's integration has no meaning with its optical model, is out of range in the size of its table, or is the one that is
/// defined on a fan of triangles ([`Integration::Vertex`]) and has no meaning along a ray; [`PlanError::Interrupted`] between two tiles,
/// [`PlanError::Memory`] for a picture that is too large.
///
/// [`Integration::Vertex`]: tetrascope_integrate::Integration::Vertex
pub fn render(mesh: &TetMesh, scalars: &[f64], plan: &Plan, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    check_scalars(mesh, scalars)?;
    on_threads(plan.threads, || {
        // An interpolated scalar keeps the digits in which large values differ.
        let base = base_of(mesh, scalars);
        if base == 0.0 {
            render_here(mesh, scalars, plan, progress)
        } else {
            render_here(mesh, &from_base(scalars, base), &plan.with_scalars_from(base), progress)
        }
    })?
}

/// What scalars are counted from, see [`scalar_base`].
pub(crate) fn base_of(mesh: &TetMesh, scalars: &[f64]) -> f64 {
    scalar_base(tetrascope_mesh::scalar_range(mesh.tetrahedra(), scalars))
}

/// Scalars less a base.
pub(crate) fn from_base(scalars: &[f64], base: f64) -> Vec<f64> {
    scalars.iter().map(|scalar| scalar - base).collect()
}

struct Job<'a> {
    cells: Vec<[u32; 4]>,
    points: Points,
    space: PixelSpace,
    grid: TileGrid,
    bins: Bins,
    /// For every entry of the bins the tetrahedron; only those that can be seen are there.
    seen: Vec<(u32, PixelBox)>,
    plan: &'a Plan,
    composer: RayComposer<'a>,
    fragments: AtomicU64,
    crossings: AtomicU64,
}

/// By the middles of what the ray has in each, as the other renderers sort pixels: that is the order of entry unless cells overlap. Of two with
/// one middle the one that begins first.
pub(crate) fn nearer_first(a: &Fragment, b: &Fragment) -> std::cmp::Ordering {
    let middle = |fragment: &Fragment| fragment.depth[0] * 0.5 + fragment.depth[1] * 0.5;
    middle(a).total_cmp(&middle(b)).then(a.depth[0].total_cmp(&b.depth[0]))
}

/// The plan's integration along rays, its table over the mesh's scalars and lengths.
pub(crate) fn integrator(
    mesh: &TetMesh,
    scalars: &[f64],
    plan: &Plan,
    progress: &dyn Progress,
) -> Result<Integrator, RenderError> {
    if plan.integration.needs_fan() {
        return Err(RenderError::IntegrationNeedsFan);
    }
    // Only a mesh without volume has none: nothing is looked up in it, whatever the table covers.
    const NOTHING: TableDomain = TableDomain { scalars: [0.0; 2], mean_length: 1.0, max_length: 1.0 };
    let domain = plan.integration.needs_table().then(|| table_domain(mesh, scalars).unwrap_or(NOTHING));
    let settings = plan.table_settings();
    let tell = |done, total| progress.report(Stage::Tabulate, done, total);
    Ok(Integrator::new(plan.integration, &plan.transfer, plan.model, settings.as_ref().zip(domain.as_ref()), &tell)?)
}

fn render_here(mesh: &TetMesh, scalars: &[f64], plan: &Plan, progress: &dyn Progress) -> Result<Rendered, RenderError> {
    let mut watch = Stopwatch::start();
    let integrator = integrator(mesh, scalars, plan, progress)?;
    if plan.integration.needs_table() {
        watch.lap(Stage::Tabulate);
    }
    progress.go_on()?;
    let composer = RayComposer::new(integrator, plan, mesh, scalars);
    watch.lap(Stage::Prepare);

    let frame = mesh.frame();
    let space = PixelSpace::new(&plan.view.in_frame(frame.origin, frame.scale), frame.scale);
    let mut points = Points::default();
    points.project(&space, mesh.positions(), scalars);
    watch.lap(Stage::Transform);

    let cells: Vec<[u32; 4]> = mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect();
    let seen: Vec<(u32, PixelBox)> = (0..cells.len())
        .into_par_iter()
        .filter_map(|cell| Some((cell as u32, points.pixel_box(&space, cells[cell])?)))
        .collect();
    let grid = TileGrid::new(space.size, TILE_SIDE);
    let may_show = |item: usize, tile: Tile| {
        !space.is_perspective || {
            let [u0, w0] = [PixelSpace::center(tile.x, space.size[0]), PixelSpace::center(tile.y, space.size[1])];
            let [u1, w1] = [u0 + f64::from(tile.width - 1), w0 + f64::from(tile.height - 1)];
            // Half a pixel of margin: rounding moves an outline by far less.
            !is_outside_rectangle(
                &points.corners(cells[seen[item].0 as usize]),
                [u0 - 0.5, u1 + 0.5],
                [w0 - 0.5, w1 + 0.5],
            )
        }
    };
    let bins = grid.bin(seen.iter().map(|&(_, outline)| outline), may_show);
    watch.lap(Stage::Bin);

    let job = Job {
        space,
        grid,
        bins,
        cells,
        points,
        seen,
        plan,
        composer,
        fragments: AtomicU64::new(0),
        crossings: AtomicU64::new(0),
    };
    progress.go_on()?;
    let done = AtomicU64::new(0);
    let total = grid.len() as u64;
    // Before the work: afterwards it would be lost.
    let mut image = plan.empty_picture()?;
    let tiles: Vec<Vec<[f32; 4]>> = (0..grid.len())
        .into_par_iter()
        .map(|index| {
            progress.go_on()?;
            let pixels = job.draw_tile(index);
            progress.report(Stage::Rasterize, done.fetch_add(1, Ordering::Relaxed) + 1, total);
            Ok(pixels)
        })
        .collect::<Result<_, PlanError>>()?;

    for (index, pixels) in tiles.iter().enumerate() {
        let tile = grid.tile(index);
        for (row, line) in pixels.chunks_exact(tile.width as usize).enumerate() {
            let start = (tile.y as usize + row) * space.size[0] as usize + tile.x as usize;
            image.pixels_mut()[start..start + line.len()].copy_from_slice(line);
        }
    }
    watch.lap(Stage::Rasterize);
    let cells = job.cells.len() as u64;
    let drawn = job.seen.len() as u64;
    let (fragments, crossings) = (job.fragments.into_inner(), job.crossings.into_inner());
    let counts = Counts {
        cells,
        transparent: 0,
        outside: cells - drawn,
        drawn,
        careful: drawn,
        fragments,
        crossings,
        cyclic: 0,
        sorted: fragments,
        most_held: 0,
        counts_fragments: true,
        ordered: 0,
        table_entries: job.composer.integrator.table_entries(),
        // It cuts rays at the surfaces where other back ends look them up.
        map_entries: 0,
        point_gradients: job.composer.point_gradients(),
        cell_gradients: None,
        with_effects: None,
        lit: None,
        fans: 0,
    };
    let order = OrderReport { guarantee: Guarantee::Exact, rings: 0, rings_left: 0 };
    Ok(Rendered { image, timings: watch.finish(), counts, order, device: None })
}

impl Job<'_> {
    fn draw_tile(&self, index: usize) -> Vec<[f32; 4]> {
        let tile = self.grid.tile(index);
        let mut pixels: Vec<Vec<Fragment>> = vec![Vec::new(); (tile.width * tile.height) as usize];
        for &item in self.bins.of(index) {
            let (cell, [x0, x1, y0, y1]) = self.seen[item as usize];
            let (vertices, is_positive) = ascending(self.cells[cell as usize]);
            let points = self.points.gather(vertices);
            let (corners, scalars) = (points.map(|p| p.position), points.map(|p| p.scalar));
            let Some(clip) = ClipCell::new(&corners, &scalars, is_positive) else { continue };
            for y in y0.max(tile.y)..=y1.min(tile.y + tile.height - 1) {
                let w = PixelSpace::center(y, self.space.size[1]);
                for x in x0.max(tile.x)..=x1.min(tile.x + tile.width - 1) {
                    let u = PixelSpace::center(x, self.space.size[0]);
                    if let Some(span) = clip.span(self.space.is_perspective, u, w) {
                        let pixel = (y - tile.y) * tile.width + x - tile.x;
                        pixels[pixel as usize].push(Fragment { depth: span.depth, scalar: span.scalar, cell });
                    }
                }
            }
        }
        let (mut fragments_drawn, mut crossings) = (0, 0);
        let compose = |(pixel, fragments): (usize, &mut Vec<Fragment>)| {
            let at = [tile.x + pixel as u32 % tile.width, tile.y + pixel as u32 / tile.width];
            let ray = Ray::of_pixel(&self.space, &self.plan.view, at);
            fragments.sort_by(nearer_first);
            let corners = |cell: u32| self.points.corners(self.cells[cell as usize]);
            let composed = self.composer.compose(&ray, fragments, corners);
            fragments_drawn += composed.fragments;
            crossings += composed.crossings;
            let [r, g, b] = composed.light.rgb;
            [r as f32, g as f32, b as f32, composed.light.opacity as f32]
        };
        let colors = pixels.iter_mut().enumerate().map(compose).collect();
        self.fragments.fetch_add(fragments_drawn, Ordering::Relaxed);
        self.crossings.fetch_add(crossings, Ordering::Relaxed);
        colors
    }
}
