//! Fans against `tetrascope_classify::project`.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use tetrascope_classify::{FanVertex, Tests, by_planes};
use tetrascope_shaders::layout::NEGATIVE_BIT;
use tetrascope_shaders::{Constant, Program};

use super::scene::{Random, SIZE, Scene, Uploaded, random_cell};
use crate::Gpu;
use crate::kernel::Kernel;
use crate::testing::{checked, contents, gpu};

/// What the vertices of all fans carry: twelve times two vectors a cell; and the records.
fn vertices(gpu: &Gpu, scene: &Scene) -> (Vec<[[f32; 4]; 24]>, Vec<[u32; 4]>) {
    checked(gpu, || {
        let constants = [("NEAR_SHARE", Constant::F32(1e-2))];
        let fans = Program::compose("triangles/fans.wgsl", &[], &constants).unwrap();
        let check = Program::compose("test/triangles_vertices.wgsl", &[], &constants).unwrap();
        let (fans, check) = (Kernel::new(gpu, &fans, "fans_of_block"), Kernel::new(gpu, &check, "vertices_of_fans"));
        let uploaded = Uploaded::new(gpu, scene);
        let count = scene.cells.len();
        let records = gpu.storage("fans", 16 * count as u64);
        let arguments = gpu.storage("arguments", 16);
        let found = gpu.storage("found", 24 * 16 * count as u64);
        let block = gpu.uniform_of("block", &[0, count as u32, 0, 0]);
        let mut resources = uploaded.named();
        resources.push(("drawn", uploaded.drawn.as_entire_binding()));
        resources.push(("block", block.as_entire_binding()));
        resources.push(("fans", records.as_entire_binding()));
        resources.push(("arguments", arguments.as_entire_binding()));
        resources.push(("found", found.as_entire_binding()));
        let mut encoder = gpu.encoder("test");
        let groups = (count as u32).div_ceil(256);
        fans.run_alone(&mut encoder, &fans.bind(gpu, &resources), groups);
        check.run_alone(&mut encoder, &check.bind(gpu, &resources), groups);
        let flat: Vec<[f32; 4]> = contents(gpu, encoder, &found, 24 * count);
        let told: Vec<u32> = contents(gpu, gpu.encoder("test"), &arguments, 4);
        assert_eq!(told, [12, count as u32, 0, 0]);
        let records = contents(gpu, gpu.encoder("test"), &records, count);
        (flat.chunks_exact(24).map(|chunk| chunk.try_into().unwrap()).collect(), records)
    })
}

fn check_fans(scene: &Scene, what: &str) {
    let Some(gpu) = gpu() else { return };
    let (vertices, records) = vertices(&gpu, scene);
    let mut worst = [0.0_f64; 3];
    let mut same = 0;
    for ((cell, vertices), record) in scene.cells.iter().zip(&vertices).zip(&records) {
        let (projected, order) = scene.project(*cell);
        let (corners, scalars) = scene.corners(*cell);
        let triangles = record[0] >> 18 & 7;
        let Some(thick) = projected.thick else {
            assert!(triangles == 0 || triangles == 7, "{what}: a fan of no area");
            continue;
        };
        assert!(triangles != 7, "{what}: a fan was expected of {corners:?}");
        let largest = projected.volumes.a.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
        if projected.volumes.six_volume <= 1e-6 * largest * 0.1 {
            continue;
        }
        let is_clear = projected.volumes.a.iter().all(|a| *a == 0.0 || a.abs() > 1e-5 * largest);
        let class = by_planes(Tests::from_code((record[0] & 127) as usize).signs()).class;
        if is_clear {
            assert_eq!(class, projected.class, "{what}: {corners:?}");
            let pair = |i: usize, j: usize| (i.min(j), i.max(j));
            let expected: BTreeSet<_> = projected
                .fan
                .triangles()
                .map(|[_, i, j]| {
                    let (FanVertex::Corner(i), FanVertex::Corner(j)) = (i, j) else { panic!("no corner") };
                    pair(order[i], order[j])
                })
                .collect();
            let ring = |place: u32| (record[0] >> (8 + 2 * place) & 3) as usize;
            let found: BTreeSet<_> = (0..triangles).map(|t| pair(ring(t), ring(t + 1))).collect();
            assert_eq!(found, expected, "{what}: {corners:?}");
            same += 1;
        }
        // The thick vertex comes first.
        let [nearness, difference, front, back] = vertices[0].map(f64::from);
        let [_, _, depth, reference] = vertices[1].map(f64::from);
        let (over_front, over_back, length) = if scene.is_perspective {
            let (enter, leave) = (1.0 + nearness, 1.0 + nearness - difference);
            let stretch = thick.ray.length() / thick.ray.z;
            (front / enter, back / leave, depth * difference / (enter * leave) * stretch)
        } else {
            (front, back, difference)
        };
        let range = scalars.iter().fold(0.0_f64, |m, s| m.max((s - scalars[0]).abs()));
        let size = corners.iter().fold(0.0_f64, |m, p| m.max(p.distance(corners[0])));
        // Where the signs differ, the chord may have moved along a short edge; its length and the scalars have not.
        if is_clear {
            worst[0] = worst[0].max((over_front + reference - thick.scalar_front).abs() / range);
            worst[1] = worst[1].max((over_back + reference - thick.scalar_back).abs() / range);
        }
        worst[2] = worst[2].max((length - thick.chord_length).abs() / size);
        // Corners project where they are.
        for number in 0..3 * triangles as usize {
            if number % 3 == 0 {
                continue;
            }
            let corner = (record[0] >> (8 + 2 * (number / 3 + number % 3 - 1)) & 3) as usize;
            let p = corners[corner] - scene.eye;
            let over = if scene.is_perspective { p.truncate() / p.z } else { p.truncate() } / scene.pixel;
            let [x, y, ..] = vertices[2 * number + 1].map(f64::from);
            let frame = scene.frame();
            let center = |pixel: i32| f64::from(pixel) + 0.5 - f64::from(SIZE) / 2.0;
            let expected = over - DVec2::new(center(frame.columns[0]), center(frame.rows[0]));
            let distance = DVec2::new(x, y).distance(expected);
            assert!(distance < 1e-5 * (10.0 + expected.length()), "{what}: {x} {y} is not {expected}");
            assert!(vertices[2 * number][1] == 0.0);
        }
    }
    println!(
        "{what}: scalars {:e} {:e}, length {:e}, {same} clear of {}",
        worst[0],
        worst[1],
        worst[2],
        vertices.len()
    );
    assert!(same > vertices.len() / 4, "{what}");
    assert!(worst.iter().all(|w| *w < 2e-5), "{what}: {worst:?}");
}

fn random_scene(eye: DVec3, pixel: f64, is_perspective: bool, size: f64) -> Scene {
    let mut random = Random(3);
    let mut scene = Scene::new(eye, pixel, is_perspective);
    for _ in 0..600 {
        let center = DVec3::new(random.within(-0.5, 0.5), random.within(-0.5, 0.5), random.within(-0.5, 0.5));
        let (corners, scalars) = random_cell(&mut random, center, size);
        scene.add(corners, scalars);
    }
    scene
}

#[test]
fn fans_of_random_cells() {
    check_fans(&random_scene(DVec3::new(0.1, -0.2, -3.0), 0.01, true, 0.2), "near");
    check_fans(&random_scene(DVec3::new(3.0, -2.0, -3000.0), 1e-5, true, 0.2), "far");
    check_fans(&random_scene(DVec3::new(0.1, -0.2, -1.5), 0.01, true, 1e-4), "small");
    check_fans(&random_scene(DVec3::new(0.1, -0.2, -3.0), 0.02, false, 0.2), "orthographic");
}

#[test]
fn fans_of_degenerate_cells() {
    // Corners on few places of a grid, seen along an axis or from a place of the grid: classes 3 and 4, and cells without area.
    for (eye, is_perspective) in [(DVec3::new(0.0, 0.0, -1.0), false), (DVec3::new(0.0, 0.0, -1.0), true)] {
        let mut random = Random(11);
        let mut scene = Scene::new(eye, 0.05, is_perspective);
        let place = |random: &mut Random| (random.within(-1.0, 2.0).floor()) * 0.25;
        while scene.cells.len() < 600 {
            let corners = [0; 4].map(|_| DVec3::new(place(&mut random), place(&mut random), place(&mut random)));
            scene.add(corners, [0; 4].map(|_| random.within(-0.5, 0.5)));
        }
        check_fans(&scene, "grid");
        // The same, but for a step of the lattice.
        for point in &mut scene.points {
            for coordinate in &mut point[..3] {
                *coordinate += random.within(-1.4, 1.4).round() as i32;
            }
        }
        let cells = std::mem::take(&mut scene.cells);
        for cell in cells {
            let (corners, scalars) = scene.corners(cell);
            let mut one = Scene::new(eye, 0.05, is_perspective);
            one.add(corners, scalars);
            scene.cells.push([cell[0], cell[1], cell[2], (cell[3] & !NEGATIVE_BIT) | (one.cells[0][3] & NEGATIVE_BIT)]);
        }
        let Some(gpu) = gpu() else { return };
        // Classes may differ here and thin cells are nothing but rounding; all numbers are finite and within the cell.
        for (cell, found) in scene.cells.iter().zip(vertices(&gpu, &scene).0) {
            let (corners, _) = scene.corners(*cell);
            let size = corners.iter().fold(0.0_f64, |m, p| m.max(p.distance(corners[0])));
            for vector in found.chunks_exact(2) {
                assert!(vector[0].iter().all(|x| x.is_finite()) && f64::from(vector[0][1]) <= 4.0 * size, "{vector:?}");
            }
        }
    }
}
