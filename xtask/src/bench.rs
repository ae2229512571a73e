//! `cargo xtask bench`: milliseconds a frame of the CPU renderer, measured side by side.
//!
//! The camera turns about the mesh in steps of 3 degrees (`--step`), the mesh's bounding sphere filling the picture. All settings are drawn
//! in turn at every step, so that a machine whose speed drifts slows all of them alike; medians are over the turn. Nothing ends
//! early and nothing is left out: every cell is at least a little opaque in the smooth transfer function.
//!
//! The settings are all ways to integrate, with `--interpolations` to find a segment at a pixel, or with `--isosurfaces` to draw isosurfaces.
//! `--orders` measures visibility orders alone, `--effects` what effects cost that are off, `--backend gpu` a graphics card, `--read` reading.

mod effects;
mod gpu;
mod orders;
mod read;
mod vtu_file;

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use glam::DVec3;
use tetrascope::integrate::{Isosurface, Isosurfaces, Phong, SurfaceShading};
use tetrascope::scene::{IsosurfaceMethod, IsosurfacePlan, Lighting, Mixing, defaults};
use tetrascope::{
    Backend, Camera, Counts, CpuRenderer, Integration, Interpolation, OpticalModel, OrderMethod, Plan, Projection,
    ReadOptions, Silent, Stage, TransferFunction, View, Volume, VolumeField,
};

use crate::Failure;

/// What to measure.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Grid and solution of a PLOT3D mesh, or one file of another kind; without it a built-in mesh of the blunt fin's size.
    mesh: Vec<PathBuf>,
    /// The field; the first scalar without it.
    #[arg(long)]
    field: Option<String>,
    /// Pixels a side.
    #[arg(long, default_value_t = 512)]
    size: u32,
    /// Threads; one a core without it.
    #[arg(long)]
    threads: Option<usize>,
    /// Only the settings whose names contain this, such as "exact".
    #[arg(long, default_value = "")]
    only: String,
    /// Visibility order.
    #[arg(long, default_value = "mpvo")]
    order: OrderMethod,
    /// Frames of the turn.
    #[arg(long, default_value_t = 30)]
    frames: u32,
    /// Isosurfaces in place of ways to integrate: 1, 10, 100 and 1000 of them, by every method.
    #[arg(long)]
    isosurfaces: bool,
    /// Ways to find a segment at a pixel in place of ways to integrate, which is exact.
    #[arg(long, conflicts_with = "isosurfaces")]
    interpolations: bool,
    /// Visibility orders alone; without a mesh on built-in ones of 10⁴ to 5·10⁶ tetrahedra.
    #[arg(long, conflicts_with_all = ["isosurfaces", "interpolations"])]
    orders: bool,
    /// Effects that are switched off, beside scenes that never had them, counted and timed; by the order that `auto` takes.
    #[arg(long, conflicts_with_all = ["isosurfaces", "orders"])]
    effects: bool,
    /// Who draws: cpu or gpu. With gpu without a mesh on built-in ones of 1, 4 and 16 million tetrahedra.
    #[arg(long, default_value = "cpu", conflicts_with_all = ["isosurfaces", "interpolations", "orders", "effects"])]
    backend: Backend,
    /// The adapter of --backend gpu: a part of its name, or its number in `tetrascope devices`.
    #[arg(long)]
    adapter: Option<String>,
    /// The largest of the built-in meshes of --backend gpu, million tetrahedra.
    #[arg(long, default_value_t = 16.0)]
    most: f64,
    /// Degrees between two frames.
    #[arg(long, default_value_t = 3.0)]
    step: f64,
    #[command(flatten)]
    reading: read::Args,
}

/// Numbers of isosurfaces.
const SURFACES: [u32; 4] = [1, 10, 100, 1000];

/// How much each of them hides: little enough that rays go on through a hundred.
const SURFACE_OPACITY: f64 = 0.3;

/// Texels along a side of their maps.
const MAP_SIZE: u32 = 256;

/// Milliseconds that nothing can beat on two cores with 8 lanes, a million fragments: 110 operations each at half-filled lanes and
/// 230 GFLOP/s.
const FLOOR_MS_PER_M_FRAGMENTS: f64 = 8.0 / 9.5;

/// Likewise a million tetrahedra: set-up, order and memory.
const FLOOR_MS_PER_M_CELLS: f64 = 3.0 / 0.187;

struct Setting {
    name: String,
    plan: Plan,
    times: Vec<Duration>,
    stages: Vec<(Stage, Duration)>,
    counts: Counts,
}

impl Setting {
    fn new(name: String, plan: Plan) -> Self {
        Self { name, plan, times: Vec::new(), stages: Vec::new(), counts: Counts::default() }
    }
}

/// Runs the benchmark and prints a table.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.reading.is_asked_for() {
        return read::run(&args.reading);
    }
    let threads = args.threads.unwrap_or_else(rayon::current_num_threads);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|e| e.to_string())?;
    let volume = match args.mesh.as_slice() {
        [] => None,
        [mesh, rest @ ..] => Some(Volume::load(mesh, &ReadOptions::with_solution(rest.first().map(PathBuf::as_path)))?),
    };
    if args.orders {
        let run = || orders::run(volume.as_ref(), &args.only, args.frames, args.step).map_err(|e| e.to_string());
        return Ok(pool.install(run)?);
    }
    if args.backend == Backend::Gpu {
        return gpu::run(volume.as_ref(), args);
    }
    let volume = match volume {
        Some(volume) => volume,
        None => Volume::from_dataset(tetrascope::mesh::rings_sample(33), "built-in sample")?,
    };
    if args.effects {
        let run = || effects::run(&volume, args.field.as_deref(), &args.only, args.size, args.frames);
        return Ok(pool.install(|| run().map_err(|e| e.to_string()))?);
    }
    let field = volume.field(args.field.as_deref())?;
    let diagonal = field.facts.diagonal();
    let camera = |degrees: f64| {
        let angle = degrees / 360.0 * TAU;
        let radius = diagonal / 2.0;
        let fov_y = 30.0_f64.to_radians();
        let away = DVec3::new(angle.cos(), angle.sin(), 0.35).normalize() * (radius / (fov_y / 2.0).sin());
        let center = field.facts.center();
        Camera { eye: center + away, target: center, up: DVec3::Z, projection: Projection::Perspective { fov_y } }
    };
    let view = View::new(&camera(0.0), args.size, args.size)?;
    let mut settings = match (args.isosurfaces, args.interpolations) {
        (true, _) => surfaces(&field, view)?,
        (_, true) => interpolations(&field, view)?,
        _ => integrations(&field, view)?,
    };
    settings.retain(|setting| setting.name.contains(&args.only));
    if settings.is_empty() {
        return Err(format!("no setting's name contains \"{}\"", args.only).into());
    }
    // One a setting: a renderer remembers two transfer functions, tables and maps, and would make them anew in every frame.
    let make = |_: &Setting| CpuRenderer::new(field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars);
    let renderers = settings.iter().map(make).collect::<Result<Vec<_>, _>>()?;
    for frame in 0..args.frames + 2 {
        for (setting, renderer) in settings.iter_mut().zip(&renderers) {
            setting.plan.order = args.order;
            setting.plan.view = View::new(&camera(args.step * f64::from(frame)), args.size, args.size)?;
            let start = Instant::now();
            let rendered = pool.install(|| renderer.render(&setting.plan, &Silent))?;
            let time = start.elapsed();
            // The first two frames warm caches up.
            if frame >= 2 {
                setting.times.push(time);
                setting.stages.extend(rendered.timings);
                setting.counts.drawn += rendered.counts.drawn;
                setting.counts.fragments += rendered.counts.fragments;
                setting.counts.careful += rendered.counts.careful;
            }
        }
    }
    print(&volume, args, threads, settings);
    Ok(())
}

/// Every way to integrate, with a transfer function of few pieces and one of many.
fn integrations(field: &VolumeField<'_>, view: View) -> Result<Vec<Setting>, Failure> {
    let mut settings = Vec::new();
    for (name, transfer) in [("6 points", smooth(field)?), ("default", default(field)?)] {
        for integration in Integration::ALL {
            let plan = Plan { integration, ..Plan::new(view, transfer.clone(), OpticalModel::DensityEmitter) };
            settings.push(Setting::new(format!("{integration}, {name}"), plan));
        }
    }
    Ok(settings)
}

/// Every way to find a segment at a pixel, with the exact integration and the same two transfer functions.
fn interpolations(field: &VolumeField<'_>, view: View) -> Result<Vec<Setting>, Failure> {
    let mut settings = Vec::new();
    for (name, transfer) in [("6 points", smooth(field)?), ("default", default(field)?)] {
        for interpolation in Interpolation::ALL {
            let plan = Plan { interpolation, ..Plan::new(view, transfer.clone(), OpticalModel::DensityEmitter) };
            settings.push(Setting::new(format!("{interpolation}, {name}"), plan));
        }
    }
    Ok(settings)
}

/// No isosurface; then some, evenly over the field's range, by every method and with every shading.
fn surfaces(field: &VolumeField<'_>, view: View) -> Result<Vec<Setting>, Failure> {
    let (low, high) = field.facts.scalar_range;
    let plain = Plan::new(view, smooth(field)?, OpticalModel::DensityEmitter);
    let mut settings = vec![Setting::new("none".to_owned(), plain.clone())];
    let map = IsosurfaceMethod::Map { size: MAP_SIZE, mixing: Mixing::Smooth };
    for count in SURFACES {
        for (method, method_name) in [(IsosurfaceMethod::Exact, "exact"), (map, "map")] {
            for (shading, shading_name) in
                [(SurfaceShading::None, "none"), (SurfaceShading::Flat, "flat"), (SurfaceShading::Smooth, "smooth")]
            {
                let surface = |index: u32| {
                    let share = (f64::from(index) + 0.5) / f64::from(count);
                    let color = [0.2 + 0.7 * share, 0.4, 0.9 - 0.7 * share];
                    let value = low + (high - low) * share;
                    Isosurface { value, color, back_color: color, opacity: SURFACE_OPACITY, shading }
                };
                let surfaces = Isosurfaces::new((0..count).map(surface).collect())?;
                let phong = Phong { ambient: 0.2, diffuse: 0.7, specular: 0.3, shininess: 32.0 };
                let light = Lighting { phong, direction: None, volume: false };
                let plan = Plan {
                    isosurfaces: Some(IsosurfacePlan { surfaces, method }),
                    lighting: (shading != SurfaceShading::None).then_some(light),
                    ..plain.clone()
                };
                settings.push(Setting::new(format!("{count} {method_name}, shading {shading_name}"), plan));
            }
        }
    }
    Ok(settings)
}

/// Six control points, as scientists set them.
fn smooth(field: &VolumeField<'_>) -> Result<TransferFunction, Failure> {
    let (low, high) = field.facts.scalar_range;
    let diagonal = field.facts.diagonal();
    let at = |share: f64| low + (high - low) * share;
    let color = [
        [at(0.0), 0.05, 0.10, 0.60],
        [at(0.09), 0.10, 0.45, 0.90],
        [at(0.17), 0.75, 0.80, 0.85],
        [at(0.29), 0.95, 0.80, 0.25],
        [at(0.50), 0.95, 0.35, 0.08],
        [at(1.0), 0.80, 0.05, 0.05],
    ];
    let extinction = [[at(0.0), 0.5 / diagonal], [at(0.17), 2.0 / diagonal], [at(1.0), 40.0 / diagonal]];
    Ok(TransferFunction::new(&color, &extinction)?)
}

/// That of scenes that name none, whose color has many control points.
fn default(field: &VolumeField<'_>) -> Result<TransferFunction, Failure> {
    Ok(TransferFunction::new(&defaults::color(field.facts.scalar_range), &defaults::extinction(&field.facts))?)
}

fn print(volume: &Volume, args: &Args, threads: usize, settings: Vec<Setting>) {
    println!(
        "{}: {} tetrahedra, {size} x {size}, {}, {threads} threads, {} frames of {} degrees",
        volume.source_name,
        volume.decomposition.mesh.tetrahedra().len(),
        args.order,
        args.frames,
        args.step,
        size = args.size,
    );
    println!(
        "median ms (fastest to slowest) | share of floor | M tet/s | M fragments/s | fragments, M | careful cells | share of each stage"
    );
    for mut setting in settings {
        setting.times.sort();
        let ms = |d: Duration| d.as_secs_f64() * 1e3;
        let median = ms(setting.times[setting.times.len() / 2]);
        let frames = f64::from(args.frames);
        let (drawn, fragments) = (setting.counts.drawn as f64 / frames, setting.counts.fragments as f64 / frames);
        let total: f64 = setting.stages.iter().map(|(_, d)| ms(*d)).sum();
        let mut stages: Vec<(Stage, f64)> = Vec::new();
        for (stage, time) in &setting.stages {
            match stages.iter_mut().find(|(s, _)| s == stage) {
                Some((_, sum)) => *sum += ms(*time),
                None => stages.push((*stage, ms(*time))),
            }
        }
        let shares: Vec<String> = stages.iter().map(|(s, t)| format!("{s} {:.0} %", 100.0 * t / total)).collect();
        println!(
            "{:24} {median:6.1} ({:.1} to {:.1}) | {:3.0} % | {:5.2} | {:5.0} | {:5.2} | {:6.0} | {}",
            setting.name,
            ms(setting.times[0]),
            ms(setting.times[setting.times.len() - 1]),
            100.0 * (FLOOR_MS_PER_M_FRAGMENTS * fragments + FLOOR_MS_PER_M_CELLS * drawn) / 1e6 / median,
            drawn / median / 1e3,
            fragments / median / 1e3,
            fragments / 1e6,
            setting.counts.careful as f64 / frames,
            shares.join(", "),
        );
    }
}
