//! Single cells.

use glam::DVec3;
use tetrascope_shaders::layout::{LATTICE_STEP, NEGATIVE_BIT};
use tetrascope_view::View;

use super::{Random, stage, twin, twin::Twin, view};
use crate::testing::gpu;
use crate::view::{Part, frame_of};

const SIZE: [u32; 2] = [400, 300];

/// Cells of a size about a place, as the lattice holds them. Every fourth is a sliver, every fourth of even scalars.
fn cells(random: &mut Random, center: DVec3, size: f64, count: usize) -> (Vec<[i32; 4]>, Vec<[u32; 4]>) {
    let (mut vertices, mut cells) = (Vec::new(), Vec::new());
    for index in 0..count {
        let middle = center + random.vector() * size;
        let flat = random.direction();
        let even = random.between(-0.9, 0.9);
        let corners = [0; 4].map(|_| {
            let edge = random.vector() * size;
            let edge = if index % 4 == 1 { edge - flat * flat.dot(edge) * (1.0 - 1e-4) } else { edge };
            let scalar = if index % 4 == 2 { even } else { random.between(-0.99, 0.99) };
            let place = (middle + edge).clamp(DVec3::splat(-0.99), DVec3::splat(0.99));
            [place.x, place.y, place.z, scalar].map(|x| (x / LATTICE_STEP).round() as i32)
        });
        let place = corners.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
        let volume = (place[1] - place[0]).cross(place[2] - place[0]).dot(place[3] - place[0]);
        let first = vertices.len() as u32;
        vertices.extend(corners);
        cells.push([first, first + 1, first + 2, (first + 3) | if volume < 0.0 { NEGATIVE_BIT } else { 0 }]);
    }
    (vertices, cells)
}

/// Errors over tolerances, and how many cells went which way.
#[derive(Debug, Default)]
struct Tally {
    covered: usize,
    by_corners: usize,
    worst_depth: f64,
    worst_scalar: f64,
    worst_length: f64,
    median: Vec<f64>,
}

fn check_samples(
    name: &str,
    view: &View,
    vertices: &[[i32; 4]],
    cells: &[[u32; 4]],
    random: &mut Random,
    tally: &mut Tally,
) {
    let Some(gpu) = gpu() else { return };
    let part = Part { origin: [16, 32], extent: [SIZE[0] - 40, SIZE[1] - 50] };
    let frame = frame_of(view, part, 0.0, cells.len() as u32, vertices.len() as u32);
    let points = stage::project(&gpu, &frame, vertices);
    for (vertex, point) in vertices.iter().zip(&points) {
        assert_eq!(twin::project(&frame, *vertex), *point, "{name}");
        let place = DVec3::new(vertex[0].into(), vertex[1].into(), vertex[2].into());
        let exact = [view.right, -view.up, view.forward].map(|axis| axis.dot(place));
        for (axis, base) in [frame.right[3], frame.down[3], frame.forward[3]].into_iter().enumerate() {
            let off = f64::from(point[axis]) + f64::from(base) - exact[axis];
            assert!(off.abs() <= 2.0, "{name}: {off} steps");
        }
    }
    let twin = Twin::new(view, &frame);
    let mut asked = Vec::new();
    for (index, cell) in cells.iter().enumerate() {
        let corners = twin::corners(&points, *cell);
        for _ in 0..40 {
            let mut weights = [0; 4].map(|_| random.between(0.0, 1.0).powi(3));
            let sum: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|w| *w /= sum);
            let inside = corners.iter().zip(weights).map(|(p, w)| *p * w).sum::<DVec3>();
            let [x, y] = twin.pixel(inside + random.vector() * random.between(0.0, 1.0).powi(9) * 0.1);
            if (16..SIZE[0] as i32 - 24).contains(&x) && (32..SIZE[1] as i32 - 18).contains(&y) {
                asked.push([index as i32, x, y, 0]);
            }
        }
    }
    if asked.is_empty() {
        return;
    }
    for (asked, told) in asked.iter().zip(stage::sample(&gpu, &frame, &points, cells, &asked)) {
        let [index, x, y, _] = *asked;
        let cell = cells[index as usize];
        let found = twin.span(&points, cell, [x, y]);
        let context = || format!("{name}: {asked:?} {:?} {told:?} {found:?}", twin::corners(&points, cell));
        if told.covered {
            let [x0, y0, x1, y1] = told.outline;
            let (x, y) = (x as f32, y as f32);
            assert!(x0 <= x && x <= x1 && y0 <= y && y <= y1 && told.may_show, "{}", context());
        }
        let Some(found) = found else {
            if told.covered && f64::from(told.length) > 1e-6 {
                assert!(twin.nearest_edge(&points, cell, [x, y]) < 2.0 * twin.rounding, "{}", context());
            }
            continue;
        };
        if !told.covered {
            let is_slight = found.length <= 4.0 * found.tolerance;
            assert!(is_slight || twin.nearest_edge(&points, cell, [x, y]) < 2.0 * twin.rounding, "{}", context());
            continue;
        }
        tally.covered += 1;
        tally.by_corners += usize::from(told.entry_count == 0);
        let stretch = twin.ray([x, y]).1.length();
        for end in 0..2 {
            let depth = (f64::from(told.depth[end]) - found.depth[end]).abs() / (found.tolerance + 1.2e-7);
            let scalar = (f64::from(told.scalar[end]) - found.scalar[end]).abs() / found.scalar_tolerance;
            tally.worst_depth = tally.worst_depth.max(depth);
            tally.worst_scalar = tally.worst_scalar.max(scalar);
            if depth > 2.0 || scalar > 2.0 {
                println!("{}", context());
            }
        }
        let length = (f64::from(told.length) - found.length).abs() / (found.tolerance * stretch);
        tally.median.push((f64::from(told.length) - found.length).abs() / found.length);
        if length > 2.0 {
            println!("{}", context());
        }
        tally.worst_length = tally.worst_length.max(length);
    }
}

fn check_many(name: &str, is_perspective: bool, distance: impl Fn(&mut Random, f64) -> f64) {
    let mut random = Random(name.len() as u64);
    let mut tally = Tally::default();
    for _ in 0..24 {
        let size = random.between(-4.0, -0.6).exp2().powf(3.32);
        let center = random.vector() * 0.5;
        let (vertices, cells) = cells(&mut random, center, size, 64);
        let target = center + random.vector() * size;
        let distance = distance(&mut random, size);
        let pixel = (size * random.between(0.01, 1.0)).min(distance / 200.0);
        let view = view(target + random.direction() * distance, target, is_perspective, pixel, SIZE);
        check_samples(name, &view, &vertices, &cells, &mut random, &mut tally);
    }
    tally.median.sort_by(f64::total_cmp);
    let at = |share: f64| tally.median.get((tally.median.len() as f64 * share) as usize).copied().unwrap_or(0.0);
    println!(
        "{name}: {} covered, {} by corners; worst over tolerance: depth {:.2}, scalar {:.2}, length {:.2}; length, relative: median {:.1e}, 99 % {:.1e}",
        tally.covered,
        tally.by_corners,
        tally.worst_depth,
        tally.worst_scalar,
        tally.worst_length,
        at(0.5),
        at(0.99)
    );
    assert!(tally.worst_depth <= 1.0 && tally.worst_scalar <= 1.0 && tally.worst_length <= 1.0);
}

#[test]
fn cells_in_perspective() {
    check_many("perspective", true, |random, _| random.between(1.0, 4.0));
}

#[test]
fn cells_in_orthographic_views() {
    check_many("orthographic", false, |random, _| random.between(1.0, 4.0));
}

#[test]
fn cells_far_away() {
    check_many("far", true, |random, _| random.between(1e3, 1e4));
}

#[test]
fn cells_near_the_eye() {
    check_many("near", true, |random, size| random.between(0.01, 6.0) * size);
}
