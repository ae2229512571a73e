//! Classification against its twin in f64.

use glam::DVec3;
use tetrascope_classify::{FanVertex, Projected, ProjectionClass, Viewpoint, project};
use tetrascope_shaders::layout::{LATTICE_STEP, NEGATIVE_BIT};

use super::twin::{Twin, corners};
use super::{Random, stage, view};
use crate::testing::gpu;
use crate::view::{Part, frame_of};

const SIZE: [u32; 2] = [400, 300];

/// Cells on a coarse lattice, many of them degenerate or seen edge-on, and some that were moved a little.
fn cells(random: &mut Random, count: usize) -> (Vec<[i32; 4]>, Vec<[u32; 4]>) {
    let (mut vertices, mut cells) = (Vec::new(), Vec::new());
    for index in 0..count {
        let size = [0.25, 0.01, 1e-3][index % 3];
        let moved = [0.0, 1e-8, 1e-6, 1.0][index / 3 % 4];
        let middle = random.vector() * 0.5;
        let corners = [0; 4].map(|_| {
            let place = DVec3::from([0; 3].map(|_| random.below(3) as f64 - 1.0)) + random.vector() * moved;
            let place = (middle + place * size).to_array();
            [place[0], place[1], place[2], random.between(-0.99, 0.99)].map(|x| (x / LATTICE_STEP).round() as i32)
        });
        let place = corners.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
        let volume = (place[1] - place[0]).cross(place[2] - place[0]).dot(place[3] - place[0]);
        let first = vertices.len() as u32;
        vertices.extend(corners);
        cells.push([first, first + 1, first + 2, (first + 3) | if volume < 0.0 { NEGATIVE_BIT } else { 0 }]);
    }
    (vertices, cells)
}

const CLASSES: [ProjectionClass; 8] = [
    ProjectionClass::Degenerate,
    ProjectionClass::OneA,
    ProjectionClass::OneB,
    ProjectionClass::Two,
    ProjectionClass::ThreeA,
    ProjectionClass::ThreeB,
    ProjectionClass::Four,
    ProjectionClass::EyeInside,
];

/// Triangles of a ring or a fan about its center, each with its lowest corner first.
fn triangles(ring: &[usize]) -> Vec<[usize; 2]> {
    let mut found: Vec<[usize; 2]> = ring.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    found.sort_unstable();
    found
}

#[test]
fn cells_are_classified_as_in_f64() {
    let Some(gpu) = gpu() else { return };
    let mut random = Random(3);
    let (mut compared, mut other, mut worst) = (0, 0, [0.0_f64; 3]);
    for round in 0..12 {
        let (vertices, cells) = cells(&mut random, 600);
        let is_perspective = round % 2 == 0;
        let way = if round % 4 < 2 { DVec3::Z } else { random.direction() };
        let eye = -way * [2.0, 30.0, 0.3][round / 4];
        let view = view(eye, DVec3::ZERO, is_perspective, 0.01, SIZE);
        let frame = frame_of(&view, Part { origin: [0; 2], extent: SIZE }, 0.0, 600, 2400);
        let twin = Twin::new(&view, &frame);
        let points = stage::project(&gpu, &frame, &vertices);
        for (cell, told) in cells.iter().zip(stage::classify(&gpu, &frame, &points, &cells)) {
            // The twin wants a positive volume.
            let order = if cell[3] & NEGATIVE_BIT == 0 { [0, 1, 2, 3] } else { [0, 1, 3, 2] };
            let corner = corners(&points, *cell);
            let vertices = crate::lattice::bare(cell);
            let eye = twin.eye;
            let viewpoint = if is_perspective { Viewpoint::Eye(eye) } else { Viewpoint::Direction(DVec3::Z) };
            let scalar = |i: usize| f64::from(points[vertices[i] as usize][3]) * LATTICE_STEP;
            let exact = project(&order.map(|i| corner[i]), &order.map(scalar), order, viewpoint);
            let size = (0..4)
                .flat_map(|i| (0..i).map(move |j| (i, j)))
                .map(|(i, j)| corner[i].distance(corner[j]))
                .fold(0.0, f64::max);
            // Three products of lengths, and the distance of the eye.
            let reach = if is_perspective { (corner[0] - eye).length() + size } else { 1.0 };
            let rounding = 3e-7 * size * size * reach + 1e-30;
            for (place, volume) in order.iter().zip(exact.volumes.a) {
                let error = (f64::from(told.volumes[*place]) - volume).abs();
                assert!(error <= rounding, "{error} {rounding} {told:?} {exact:?}");
            }
            let is_clear = exact.volumes.a.iter().all(|a| *a == 0.0 || a.abs() > rounding)
                && exact.volumes.six_volume > 1e-6 * size.powi(3);
            check_class(&told, &exact, order, is_clear, &mut other);
            let (Some(thick), true) = (exact.thick, is_clear && told.class == class_number(exact.class)) else {
                continue;
            };
            compared += 1;
            // What rounding takes from the smaller sum.
            let least = exact.volumes.sum_plus().min(exact.volumes.sum_minus());
            let relative = rounding / least + 1e-6 * size.powi(3) / exact.volumes.six_volume;
            let first = scalar(0);
            let errors = [
                (f64::from(told.length) - thick.chord_length).abs() / size / relative,
                (f64::from(told.scalars[0]) + first - thick.scalar_front).abs() / (relative * 2.0 + 1e-7),
                (f64::from(told.scalars[1]) + first - thick.scalar_back).abs() / (relative * 2.0 + 1e-7),
            ];
            for (worst, error) in worst.iter_mut().zip(errors) {
                *worst = worst.max(error);
            }
            assert!(errors.iter().all(|&error| error <= 1.0), "{errors:?} {told:?} {exact:?}");
            let near = thick.near - eye;
            if !is_perspective || near.z > size {
                let unit = if is_perspective { near.z } else { 1.0 };
                let place = near.truncate() / unit;
                for axis in 0..2 {
                    let screen = f64::from(told.screen[axis]) * f64::from(frame.slope[2 + axis]);
                    let tolerance = relative * size / unit + 1e-6 * (1.0 + place[axis].abs());
                    assert!((screen - place[axis]).abs() <= tolerance, "{screen} {place} {told:?} {exact:?}");
                }
            }
        }
    }
    println!("{compared} cells compared, {other} of another class; worst over tolerance: {worst:.2?}");
    assert!(compared > 2000);
}

fn class_number(class: ProjectionClass) -> usize {
    CLASSES.iter().position(|&known| known == class).unwrap()
}

fn check_class(told: &stage::ToldClass, exact: &Projected, order: [usize; 4], is_clear: bool, other: &mut usize) {
    let is_same = CLASSES[told.class] == exact.class;
    if !is_same {
        *other += 1;
        assert!(!is_clear, "{told:?} {exact:?}");
        return;
    }
    if exact.thick.is_none() || !is_clear {
        return;
    }
    let ring: Vec<usize> = exact
        .fan
        .as_slice()
        .iter()
        .filter_map(|vertex| match vertex {
            FanVertex::Corner(corner) => Some(order[*corner]),
            FanVertex::Thick => None,
        })
        .collect();
    assert_eq!(triangles(&told.ring), triangles(&ring), "{told:?} {exact:?}");
    let corner = exact.thick.and_then(|thick| thick.corner).map_or(4, |corner| order[corner]);
    // Of the two that coincide in class 4, and of any other class, the same.
    assert_eq!(told.corner, corner);
}
