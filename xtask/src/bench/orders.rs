//! What visibility orders cost: milliseconds and bytes a tetrahedron, over meshes of 10⁴ to 5·10⁶ tetrahedra.
//!
//! All cells are drawn, so that a number a tetrahedron is one of the mesh. Orders take turns at every step of the camera. The floor is
//! the time in which the bytes that a method cannot help moving stream through memory, at a speed measured in the same run.

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use rayon::prelude::*;
use tetrascope::Volume;
use tetrascope::mesh::{CellId, rings_sample};
use tetrascope::order::{Cells, MeshVisibility, OrderMethod, VisibilityOrder};
use tetrascope::view::Viewpoint;

use crate::Failure;

/// Cells along a side of the cubes of five tetrahedra each: 10⁴ to 5·10⁶ tetrahedra.
const LADDER: [usize; 6] = [13, 27, 40, 59, 79, 100];

/// An order with its times.
struct Subject {
    method: OrderMethod,
    order: Arc<dyn VisibilityOrder>,
    prepared: Duration,
    times: Vec<Duration>,
}

/// Measures the orders on a mesh, or on the ladder of built-in ones.
///
/// - `only`: part of the names of the orders
/// - `step`: degrees between two frames
pub(super) fn run(volume: Option<&Volume>, only: &str, frames: u32, step: f64) -> Result<(), Failure> {
    let bandwidth = bandwidth();
    println!("memory streams at {:.1} GB/s on {} threads", bandwidth / 1e9, rayon::current_num_threads());
    println!(
        "{:>10} {:12} {:>11} {:>26} {:>8} {:>9} {:>9}",
        "tetrahedra", "order", "prepare, ms", "ms (fastest to slowest)", "ns/tet", "floor, ns", "kept B/tet"
    );
    match volume {
        Some(volume) => measure(Cells::from(&volume.decomposition.mesh), only, frames, step, bandwidth),
        None => {
            for side in LADDER {
                let volume = Volume::from_dataset(rings_sample(side), "built-in sample")?;
                measure(Cells::from(&volume.decomposition.mesh), only, frames, step, bandwidth);
            }
        }
    }
    Ok(())
}

fn measure(cells: Cells<'_>, only: &str, frames: u32, step: f64, bandwidth: f64) {
    let count = cells.tetrahedra.len();
    let drawn: Vec<CellId> = (0..count as u32).map(CellId).collect();
    let names = ["bucket", "centroid", "power", "mpvo", "bsp-xmpvo"];
    let methods = names.iter().filter(|name| name.contains(only)).filter_map(|name| name.parse().ok());
    let mut subjects: Vec<Subject> = methods
        .map(|method| {
            let start = Instant::now();
            // Each learns the mesh by itself, so that its time to prepare is all that it needs.
            let order = MeshVisibility::new().prepare(cells, method);
            Subject { method, order, prepared: start.elapsed(), times: Vec::new() }
        })
        .collect();
    let used = || cells.tetrahedra.par_iter().flatten().map(|v| cells.positions[v.index()]);
    let low = used().reduce(|| DVec3::INFINITY, DVec3::min);
    let high = used().reduce(|| DVec3::NEG_INFINITY, DVec3::max);
    for frame in 0..frames + 2 {
        let angle = f64::from(frame) * step.to_radians();
        let away = DVec3::new(angle.cos(), angle.sin(), 0.35).normalize();
        let viewpoint = Viewpoint::Eye((low + high) * 0.5 + away * (high - low).length() * 1.9);
        for subject in &mut subjects {
            let start = Instant::now();
            black_box(subject.order.order(cells, viewpoint, &drawn));
            // The first two frames warm caches up.
            if frame >= 2 {
                subject.times.push(start.elapsed());
            }
        }
    }
    for Subject { method, order, prepared, mut times } in subjects {
        times.sort();
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        let median = ms(times[times.len() / 2]);
        println!(
            "{count:>10} {:12} {:>11.1} {:>26} {:>8.1} {:>9.1} {:>9.1}",
            method.to_string(),
            ms(prepared),
            format!("{median:.2} ({:.2} to {:.2})", ms(times[0]), ms(times[times.len() - 1])),
            median * 1e6 / count as f64,
            moved_bytes(method) / bandwidth * 1e9,
            order.kept_bytes() as f64 / count as f64,
        );
    }
}

/// Bytes a tetrahedron that a method reads and writes at least.
fn moved_bytes(method: OrderMethod) -> f64 {
    // A word of key and cell is dealt into buckets, and read again bucket by bucket, in a cache; then the cell is written.
    const SORT: f64 = 8.0 + 8.0 + 4.0;
    // Four point numbers; a fifth of a point of 24 bytes.
    const CORNERS: f64 = 16.0 + 5.0;
    match method {
        OrderMethod::Bucket { .. } => CORNERS + 8.0 + 8.0 + 8.0 + 4.0,
        OrderMethod::Centroid => CORNERS + SORT,
        // A gradient and a constant.
        OrderMethod::Power => 32.0 + SORT,
        // Planes and sides of the faces; the state, written and read; the neighbors; the order, written, read and written.
        _ => 32.0 + 1.0 + 4.0 + 16.0 + 12.0,
    }
}

/// Bytes a second that all threads read together, from far more memory than caches hold.
fn bandwidth() -> f64 {
    let words = vec![1_u64; 1 << 25];
    let mut best = 0.0_f64;
    for _ in 0..5 {
        let start = Instant::now();
        black_box(words.par_chunks(1 << 16).map(|chunk| chunk.iter().sum::<u64>()).sum::<u64>());
        best = best.max((words.len() * 8) as f64 / start.elapsed().as_secs_f64());
    }
    best
}
