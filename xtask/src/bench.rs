//! `cargo xtask bench`: milliseconds a frame of the CPU renderer, measured side by side.
//!
//! The camera turns about the mesh in steps of 3 degrees, the mesh's bounding sphere filling the picture. All settings are drawn
//! in turn at every step, so that a machine whose speed drifts slows all of them alike; medians are over the turn. Nothing ends
//! early and nothing is left out: every cell is at least a little opaque in the smooth transfer function.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use glam::DVec3;
use tetrascope::{
    Backend, Camera, Counts, CpuRenderer, Integration, OpticalModel, OrderMethod, Plan, Projection, Silent, Stage,
    TransferFunction, View, Volume, scene::defaults,
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
    /// Frames of the turn, each 3 degrees on.
    #[arg(long, default_value_t = 30)]
    frames: u32,
}

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

/// Runs the benchmark and prints a table.
pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let volume = match args.mesh.as_slice() {
        [] => Volume::from_dataset(tetrascope::mesh::rings_sample(33), "built-in sample")?,
        [mesh, rest @ ..] => Volume::load(mesh, rest.first().map(PathBuf::as_path))?,
    };
    let field = volume.field(args.field.as_deref())?;
    let (low, high) = field.facts.scalar_range;
    let diagonal = field.facts.diagonal();
    let camera = |degrees: f64| {
        let angle = degrees / 360.0 * TAU;
        let radius = diagonal / 2.0;
        let fov_y = 30.0_f64.to_radians();
        let away = DVec3::new(angle.cos(), angle.sin(), 0.35).normalize() * (radius / (fov_y / 2.0).sin());
        let center = field.facts.center();
        Camera { eye: center + away, target: center, up: DVec3::Z, projection: Projection::Perspective { fov_y } }
    };
    let at = |share: f64| low + (high - low) * share;
    // Six control points, as scientists set them; and the default, whose color has many.
    let smooth = TransferFunction::new(
        &[
            [at(0.0), 0.05, 0.10, 0.60],
            [at(0.09), 0.10, 0.45, 0.90],
            [at(0.17), 0.75, 0.80, 0.85],
            [at(0.29), 0.95, 0.80, 0.25],
            [at(0.50), 0.95, 0.35, 0.08],
            [at(1.0), 0.80, 0.05, 0.05],
        ],
        &[[at(0.0), 0.5 / diagonal], [at(0.17), 2.0 / diagonal], [at(1.0), 40.0 / diagonal]],
    )?;
    let default = TransferFunction::new(&defaults::color((low, high)), &defaults::extinction(&field.facts))?;
    let mut settings = Vec::new();
    for (transfer_name, transfer) in [("6 points", &smooth), ("default", &default)] {
        for integration in [Integration::Vertex, Integration::Average, Integration::Exact] {
            settings.push(Setting {
                name: format!("{integration}, {transfer_name}"),
                plan: Plan {
                    integration,
                    ..Plan::new(
                        View::new(&camera(0.0), args.size, args.size)?,
                        transfer.clone(),
                        OpticalModel::DensityEmitter,
                    )
                },
                times: Vec::new(),
                stages: Vec::new(),
                counts: Counts::default(),
            });
        }
    }

    settings.retain(|setting| setting.name.contains(&args.only));
    let threads = args.threads.unwrap_or_else(rayon::current_num_threads);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|e| e.to_string())?;
    let renderer = CpuRenderer::new(field.on_mesh.mesh.as_ref(), &field.on_mesh.scalars)?;
    for frame in 0..args.frames + 2 {
        for setting in &mut settings {
            setting.plan.view = View::new(&camera(3.0 * f64::from(frame)), args.size, args.size)?;
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

fn print(volume: &Volume, args: &Args, threads: usize, settings: Vec<Setting>) {
    println!(
        "{}: {} tetrahedra, {size} x {size}, centroid, {threads} threads, {} frames of 3 degrees",
        volume.source_name,
        volume.decomposition.mesh.tetrahedra().len(),
        args.frames,
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
            "{:20} {median:6.1} ({:.1} to {:.1}) | {:3.0} % | {:5.2} | {:5.0} | {:5.2} | {:6.0} | {}",
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
