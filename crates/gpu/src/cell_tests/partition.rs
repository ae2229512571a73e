//! Cells that fill a cube: what a ray has in them is what it has in the cube, whatever it runs through.

use glam::DVec3;
use tetrascope_mesh::TetMesh;
use tetrascope_view::View;

use super::twin::{Found, Twin};
use super::{Random, stage, view};
use crate::lattice::{Lattice, decompress};
use crate::testing::gpu;
use crate::view::{Part, frame_of};

/// Cubes a side.
const SIDE: usize = 4;
const SIZE: [u32; 2] = [64, 48];

/// A cube of side 1 about the origin, cut into tetrahedra; points inside are moved by up to so many sides of the small cubes.
fn cube(random: &mut Random, jitter: f64) -> Lattice {
    let at = |x: usize, y: usize, z: usize| ((z * (SIDE + 1) + y) * (SIDE + 1) + x) as u32;
    let mut points = Vec::new();
    for z in 0..=SIDE {
        for y in 0..=SIDE {
            for x in 0..=SIDE {
                let place = DVec3::new(x as f64, y as f64, z as f64) / SIDE as f64 - 0.5;
                let is_inside = [x, y, z].iter().all(|&i| i > 0 && i < SIDE);
                let moved = if is_inside { random.vector() * jitter / SIDE as f64 } else { DVec3::ZERO };
                points.push(place + moved);
            }
        }
    }
    let mut cells = Vec::new();
    for (x, y, z) in (0..SIDE).flat_map(|z| (0..SIDE).flat_map(move |y| (0..SIDE).map(move |x| (x, y, z)))) {
        // Along the diagonal, one for each order of the axes: faces of neighbors agree.
        for axes in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut place = [x, y, z];
            let mut cell = [at(x, y, z); 4];
            for (corner, axis) in axes.into_iter().enumerate() {
                place[axis] += 1;
                cell[corner + 1] = at(place[0], place[1], place[2]);
            }
            cells.push(cell);
        }
    }
    let mesh = TetMesh::from_tetrahedra(&points, &cells).unwrap().mesh;
    let scalars: Vec<f64> = points.iter().map(|_| random.between(0.0, 5.0)).collect();
    let lattice = Lattice::new(&mesh, &scalars);
    for (cell, range) in lattice.cells.iter().zip(&lattice.ranges) {
        let [low, high] = decompress(*range);
        let scalars = crate::lattice::bare(cell).map(|v| lattice.vertices[v as usize][3]);
        assert!(scalars.iter().all(|s| low <= *s && *s <= high));
        assert!(scalars.iter().any(|s| s - low < 1 << 14) && scalars.iter().any(|s| high - s < 1 << 14));
    }
    assert_eq!(lattice.collapsed, 0);
    lattice
}

/// Length of a ray in the cube; `None` where the cube's surface is too near to tell.
fn length_in_cube(twin: &Twin, view: &View, pixel: [i32; 2]) -> Option<f64> {
    let ray = view.ray(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
    let length = |moved: DVec3| {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis] + moved[axis], ray.direction[axis]);
            if direction.abs() < 1e-14 {
                if origin.abs() > 0.5 {
                    return 0.0;
                }
                continue;
            }
            let ends = [-0.5, 0.5].map(|side| (side - origin) / direction);
            enter = enter.max(ends[0].min(ends[1]));
            leave = leave.min(ends[0].max(ends[1]));
        }
        (leave - enter).max(0.0) * ray.direction.length()
    };
    let beside = 10.0 * twin.rounding;
    let exact = length(DVec3::ZERO);
    let is_clear = [view.right, view.up, view.right + view.up, view.right - view.up]
        .iter()
        .all(|&way| [-beside, beside].iter().all(|&by| (length(way * by) - exact).abs() < 3e-6));
    is_clear.then_some(exact)
}

fn check_cube(name: &str, lattice: &Lattice, view: &View) {
    let Some(gpu) = gpu() else { return };
    let part = Part { origin: [0, 0], extent: SIZE };
    let count = lattice.cells.len();
    let frame = frame_of(view, part, 0.0, count as u32, lattice.vertices.len() as u32);
    let points = stage::project(&gpu, &frame, &lattice.vertices);
    let twin = Twin::new(view, &frame);
    let pixels: Vec<[i32; 2]> = (0..SIZE[1] as i32).flat_map(|y| (0..SIZE[0] as i32).map(move |x| [x, y])).collect();
    let asked: Vec<[i32; 4]> =
        pixels.iter().flat_map(|&[x, y]| (0..count as i32).map(move |cell| [cell, x, y, 0])).collect();
    let told = stage::sample(&gpu, &frame, &points, &lattice.cells, &asked);
    let (mut met, mut skipped, mut by_corners, mut worst) = (0, 0, 0, 0.0_f64);
    for (pixel, told) in pixels.iter().zip(told.chunks(count)) {
        let sum: f64 = told.iter().filter(|told| told.covered).map(|told| f64::from(told.length)).sum();
        let Some(exact) = length_in_cube(&twin, view, *pixel) else {
            skipped += 1;
            continue;
        };
        met += usize::from(exact > 0.0);
        by_corners += told.iter().filter(|told| told.covered && told.entry_count == 0).count();
        let error = (sum - exact).abs();
        worst = worst.max(error);
        if error > 1e-5 {
            for (told, cell) in told.iter().zip(&lattice.cells) {
                let found: Option<Found> = twin.span(&points, *cell, *pixel);
                if told.covered || found.is_some() {
                    println!("{cell:?} {told:?} {found:?}");
                }
            }
            panic!("{name}: {pixel:?} has {sum} of {exact}");
        }
    }
    println!("{name}: {met} rays, {by_corners} samples by corners, {skipped} at the surface; worst {worst:.1e}");
    assert!(met > 100, "{name}");
}

#[test]
fn chords_add_up_along_axes() {
    let mut random = Random(5);
    let even = cube(&mut random, 0.0);
    // Rays through points and along edges and faces: pixels of a power of two, and of what rounding makes of others.
    for (axis, name) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z"), (-DVec3::Z, "-z")] {
        for (pixel, size) in [(1.0 / 32.0, SIZE), (1.0 / 36.0, [63, 47]), (1.0 / 36.0, [63, 48])] {
            let size = [size[0], size[1]];
            let orthographic = view(axis * 2.0, DVec3::ZERO, false, pixel, size);
            check_cube(
                &format!("orthographic {name} {pixel}"),
                &even,
                &View { width: SIZE[0], height: SIZE[1], ..orthographic },
            );
            let shifted = DVec3::splat(pixel * 0.5) - axis * pixel * 0.5;
            let orthographic = view(axis * 2.0 + shifted, shifted, false, pixel, SIZE);
            check_cube(&format!("orthographic {name} {pixel}, through points"), &even, &orthographic);
            let perspective = view(axis * 2.0 + shifted * 0.0, DVec3::ZERO, true, pixel, SIZE);
            check_cube(&format!("perspective {name} {pixel}"), &even, &perspective);
        }
    }
}

#[test]
fn chords_add_up_from_anywhere() {
    let mut random = Random(6);
    for round in 0..6 {
        let lattice = cube(&mut random, [0.3, 0.0, 0.45][round % 3]);
        let eye = random.direction() * random.between(1.0, 3.0);
        let near = view(eye, DVec3::ZERO, true, 0.03, SIZE);
        check_cube("perspective", &lattice, &near);
        check_cube("orthographic", &lattice, &view(eye, DVec3::ZERO, false, 0.03, SIZE));
        check_cube("far", &lattice, &view(eye * 1e4, DVec3::ZERO, true, 0.03, SIZE));
    }
}

#[test]
fn chords_add_up_from_inside() {
    let mut random = Random(7);
    for round in 0..6 {
        let lattice = cube(&mut random, [0.3, 0.0][round % 2]);
        let eye = random.vector() * 0.45;
        let inside = view(eye, eye + random.direction(), true, [0.03, 0.1][round / 3], SIZE);
        check_cube("inside", &lattice, &inside);
        // On points of the lattice, along axes: the eye lies on corners, edges and faces.
        let eye = (eye * 4.0).round() / 4.0 * if round == 5 { 0.5 } else { 1.0 };
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][round % 3];
        check_cube("inside, on a corner", &lattice, &view(eye, eye + axis, true, 1.0 / 32.0, SIZE));
    }
}

#[test]
fn views_of_any_size_are_finite() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(8);
    let lattice = cube(&mut random, 0.2);
    for distance in [1e-300, 1e-9, 1.0, 1e9, 1e300] {
        for pixel in [1e-300, 1e-12, 1.0, 1e12, 1e300] {
            for is_perspective in [false, true] {
                let straight = View {
                    eye: DVec3::new(0.1, 0.2, -distance),
                    right: DVec3::X,
                    up: -DVec3::Y,
                    forward: DVec3::Z,
                    half_width: 32.0 * pixel,
                    half_height: 24.0 * pixel,
                    is_perspective,
                    width: SIZE[0],
                    height: SIZE[1],
                };
                let part = Part { origin: [0, 0], extent: SIZE };
                let frame = frame_of(&straight, part, 0.0, lattice.cells.len() as u32, lattice.vertices.len() as u32);
                let floats = [frame.eye, frame.rest, frame.slope];
                assert!(floats.as_flattened().iter().all(|x| x.is_finite()), "{frame:?}");
                let points = stage::project(&gpu, &frame, &lattice.vertices);
                let asked: Vec<[i32; 4]> = (0..500)
                    .map(|_| {
                        [random.below(lattice.cells.len()), random.below(64), random.below(48), 0].map(|i| i as i32)
                    })
                    .collect();
                // Finite, which every answer is asked for.
                for told in stage::sample(&gpu, &frame, &points, &lattice.cells, &asked) {
                    assert!(told.length >= 0.0);
                }
            }
        }
    }
}
