//! The GPU back end: frames and tetrahedra a second, and where the device's time goes, on meshes of a ladder or one that is given.
//!
//! Paths and orders take turns at every step of the camera. The floors are the bytes that a frame cannot help moving at a stated speed of the memory,
//! and the fragments that it blends at a stated speed of arithmetic; both speeds are those of the device's maker or are left out.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use tetrascope::mesh::rings_sample;
use tetrascope::order::{MeshVisibility, OrderMethod};
use tetrascope::{AdapterChoice, Gpu, GpuRenderer};
use tetrascope::{
    Backend, Camera, GpuOptions, GpuPath, OpticalModel, Plan, Projection, Rendered, Silent, View, Volume, VolumeField,
};

use super::{Args, smooth};
use crate::Failure;

/// Cells along a side of the cubes of five tetrahedra each: 1, 4 and 16 million tetrahedra.
const LADDER: [usize; 3] = [59, 93, 147];

/// Bytes of memory traffic a drawn tetrahedron of the compute path: culled, gathered, keyed; sorted in eight passes; drawn in 1.4 tiles.
const BYTES_PER_CELL: f64 = 20.0 + 16.0 * 4.0 / 5.0 + 8.0 * 24.0 + 1.4 * (16.0 + 16.0);

struct Subject {
    name: String,
    plan: Plan,
    walls: Vec<Duration>,
    devices: Vec<Duration>,
    last: Option<Rendered>,
}

/// Measures a mesh, or the ladder of built-in ones.
pub(super) fn run(volume: Option<&Volume>, args: &Args) -> Result<(), Failure> {
    let choice = AdapterChoice { name: args.adapter.clone(), ..AdapterChoice::default() };
    let gpu = Arc::new(Gpu::open(&choice)?);
    let about = gpu.description();
    println!("{} ({}, {}, {})", about.name, about.driver, about.backend, about.kind);
    println!(
        "{:>10} {:26} {:>9} {:>24} {:>9} {:>9} {:>9} {:>11}",
        "tetrahedra",
        "path, order",
        "device, ms",
        "wall, ms (fastest to slowest)",
        "frames/s",
        "M tet/s",
        "M frag",
        "least MB"
    );
    match volume {
        Some(volume) => measure(&gpu, volume, args),
        None => {
            for side in LADDER {
                if 5e-6 * side.pow(3) as f64 > args.most {
                    break;
                }
                measure(&gpu, &Volume::from_dataset(rings_sample(side), "built-in sample")?, args)?;
            }
            Ok(())
        }
    }
}

fn subjects(field: &VolumeField<'_>, view: View, args: &Args) -> Result<Vec<Subject>, Failure> {
    let mut subjects = Vec::new();
    for path in GpuPath::ALL {
        for order in [args.order, OrderMethod::Centroid] {
            let name = format!("{path}, {order}");
            if subjects.iter().any(|subject: &Subject| subject.name == name) || !name.contains(&args.only) {
                continue;
            }
            let plain = Plan::new(view, smooth(field)?, OpticalModel::DensityEmitter);
            let gpu = GpuOptions { path: Some(path), ..GpuOptions::default() };
            let plan = Plan { backend: Backend::Gpu, order, gpu, ..plain };
            subjects.push(Subject { name, plan, walls: Vec::new(), devices: Vec::new(), last: None });
        }
    }
    Ok(subjects)
}

fn measure(gpu: &Arc<Gpu>, volume: &Volume, args: &Args) -> Result<(), Failure> {
    let field = volume.field(args.field.as_deref())?;
    let (center, diagonal) = (field.facts.center(), field.facts.diagonal());
    let camera = |degrees: f64| {
        let angle = degrees.to_radians();
        let fov_y = 30.0_f64.to_radians();
        let away = DVec3::new(angle.cos(), angle.sin(), 0.35).normalize() * (0.5 * diagonal / (fov_y / 2.0).sin());
        Camera { eye: center + away, target: center, up: DVec3::Z, projection: Projection::Perspective { fov_y } }
    };
    let mut subjects = subjects(&field, View::new(&camera(0.0), args.size, args.size)?, args)?;
    let visibility = Arc::new(MeshVisibility::new());
    let mesh = field.on_mesh.mesh.as_ref();
    let renderer = GpuRenderer::new(Arc::clone(gpu), mesh, &field.on_mesh.scalars, visibility)?;
    for frame in 0..args.frames + 2 {
        for subject in &mut subjects {
            subject.plan.view = View::new(&camera(args.step * f64::from(frame)), args.size, args.size)?;
            let start = Instant::now();
            let rendered = renderer.render(&subject.plan, &Silent)?;
            // The first two frames build pipelines and find sizes.
            if frame >= 2 {
                subject.walls.push(start.elapsed());
                let clocked = rendered.device.as_ref().filter(|device| !device.stages.is_empty());
                let stages = clocked.map(|device| device.stages.iter().map(|(_, time)| *time).sum::<Duration>());
                subject.devices.extend(stages);
                subject.last = Some(rendered);
            }
        }
    }
    for subject in subjects {
        print(mesh.tetrahedra().len(), subject);
    }
    Ok(())
}

fn print(cells: usize, mut subject: Subject) {
    let Some(rendered) = subject.last else { return };
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    subject.walls.sort();
    subject.devices.sort();
    let wall = ms(subject.walls[subject.walls.len() / 2]);
    // A device without a clock has none of its own.
    let device = subject.devices.get(subject.devices.len() / 2).map(|time| ms(*time));
    let time = device.unwrap_or(wall);
    let drawn = rendered.counts.drawn as f64;
    println!(
        "{cells:>10} {:26} {:>9} {:>24} {:>9.2} {:>9.2} {:>9.2} {:>11.0}",
        subject.name,
        device.map_or_else(|| "no clock".to_owned(), |device| format!("{device:.2}")),
        format!("{wall:.2} ({:.2} to {:.2})", ms(subject.walls[0]), ms(subject.walls[subject.walls.len() - 1])),
        1e3 / time,
        drawn / time / 1e3,
        rendered.counts.fragments as f64 / 1e6,
        drawn * BYTES_PER_CELL / 1e6,
    );
    let Some(report) = rendered.device else { return };
    let total: f64 = report.stages.iter().map(|(_, time)| ms(*time)).sum();
    let shares: Vec<String> = report
        .stages
        .iter()
        .map(|(stage, time)| format!("{stage} {:.2} ms ({:.0} %)", ms(*time), 100.0 * ms(*time) / total))
        .collect();
    println!("{:>10} {}", "", shares.join(", "));
}
