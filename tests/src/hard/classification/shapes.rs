//! Cells of hardly any volume, of none, and inside out.

use std::sync::Arc;

use glam::DVec3;
use tetrascope::{Camera, Projection};

use super::super::case::{Beyond, HardScene, Truth, volume_of};
use super::super::views::{Pieces, down, lively, look, oriented, volume};
use super::{RANGE, SPREAD, upright};
use crate::meshes::{Random, Tets};

/// A block in which cells are split at points of these shares of their corners.
fn thin_in_a_block(shares: [f64; 4], seed: u64) -> HardScene {
    let mut tets = Tets::block(2, seed);
    let mut random = Random::new(seed);
    for _ in 0..20 {
        let cell = tets.cells[(random.unit() * tets.cells.len() as f64) as usize];
        // What was split is left alone: thin ones of thin ones have no volume that coordinates resolve.
        if !cell.iter().any(|&corner| corner as usize >= 27) {
            tets.split(&cell, &shares);
        }
    }
    let range = tets.range();
    let camera = look(DVec3::new(3.0, 2.5, 4.0), DVec3::new(0.1, 0.0, 0.0), DVec3::Y, 34.0);
    HardScene::partition("in a block", volume(&tets), lively(&camera, [64, 60], [range.0, range.1], 1.0))
}

/// One cell alone, with nothing beside that would make up for what it gets wrong. `length`: of an optical depth of about one.
pub(super) fn alone(place: &str, corners: &[DVec3; 4], camera: &Camera, length: f64) -> HardScene {
    let mut cell = Pieces::default();
    cell.add(corners, &[oriented(corners, [0, 1, 2, 3])], &SPREAD[..4]);
    let scene = HardScene::partition(place, cell.volume(), lively(camera, [40, 39], RANGE, length));
    HardScene { beyond: Some(LATTICE), ..scene }
}

/// Coordinates on a GPU are integers: a step is 2^-29 of about the mesh's size. What is 1e-8 of the mesh thick is a few steps thick, and by as
/// much as a share of itself it is drawn too thick or too thin where it stands alone, up to all of it. Beside neighbors, who share its corners, nothing shows.
const LATTICE: Beyond = Beyond::gpu("thinner than 1e-7 of the mesh", 1.0);

/// A parallel view across z from the side, y into the picture, as high as wide.
fn from_the_side(target: DVec3, height: f64) -> Camera {
    Camera { eye: target - 5.0 * DVec3::Y, target, up: DVec3::Z, projection: Projection::Orthographic { height } }
}

/// Height over edge of the thin cells.
const THIN: f64 = 1e-8;

pub(super) fn slivers() -> Vec<HardScene> {
    // Four corners near a circle, crosswise up and down.
    let corners = [[1., 0., THIN], [0., 1., -THIN], [-1., 0.1, THIN], [-0.1, -1., -THIN]].map(DVec3::from);
    let mut scenes = vec![
        thin_in_a_block([0.5 - THIN, 0.5 - THIN, THIN, THIN], 7100),
        alone("alone", &corners, &down(DVec3::ZERO, 2.5), THIN),
        alone("alone, along it", &corners, &from_the_side(DVec3::new(-0.02, 0.0, 0.0), 2.5 * THIN), 1.0),
    ];
    let (points, cells) = upright(DVec3::ZERO, |y| y + 2.0 * THIN);
    let mut pair = Pieces::default();
    pair.add(&points, &cells, &SPREAD[..6]);
    for (place, camera) in [
        ("between good cells, edge-on", down(DVec3::ZERO, 2.7)),
        ("between good cells, from aside", look(DVec3::new(1.5, 4.0, 3.0), DVec3::ZERO, DVec3::Z, 30.0)),
    ] {
        scenes.push(HardScene::partition(place, pair.volume(), lively(&camera, [33, 33], RANGE, 1.0)));
    }
    scenes
}

pub(super) fn needles() -> Vec<HardScene> {
    let corners = [[-1., 0., 0.], [1., THIN, 0.], [1., -0.5 * THIN, THIN], [1., -0.5 * THIN, -THIN]].map(DVec3::from);
    // Along its axis from the point, as near as it is thin.
    let axis = Camera {
        eye: DVec3::new(-5.0, 0.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Orthographic { height: 2.5 * THIN },
    };
    vec![
        thin_in_a_block([THIN, THIN, 0.4, 0.6 - 2.0 * THIN], 7200),
        alone("alone, along its axis", &corners, &axis, 1.0),
        alone("alone, across it", &corners, &from_the_side(DVec3::new(0.98, 0.0, 0.0), 2.5 * THIN), THIN),
    ]
}

pub(super) fn caps() -> Vec<HardScene> {
    let corners = [[-1., -0.6, 0.], [1., -0.7, 0.], [0.1, 1., 0.], [0.05, -0.1, THIN]].map(DVec3::from);
    vec![
        thin_in_a_block([THIN, 0.3, 0.3, 0.4 - THIN], 7300),
        alone("alone", &corners, &down(DVec3::ZERO, 2.5), THIN),
        alone("alone, along it", &corners, &from_the_side(DVec3::new(0.03, 0.0, 0.0), 2.5 * THIN), 1.0),
    ]
}

pub(super) fn coincident_points() -> Vec<HardScene> {
    let tets = Tets::block(3, 7400);
    let middle = |cell: &[u32; 4]| cell.iter().map(|&p| tets.points[p as usize].x).sum::<f64>() / 4.0;
    let is_left: Vec<bool> = tets.cells.iter().map(|cell| middle(cell) < 0.1).collect();
    let left = || tets.cells.iter().zip(&is_left).filter(|(_, is_left)| **is_left);
    let mut other = vec![None; tets.points.len()];
    let (mut points, mut scalars) = (tets.points.clone(), tets.scalars.clone());
    let mut used_left = vec![false; points.len()];
    for (cell, _) in left() {
        cell.iter().for_each(|&p| used_left[p as usize] = true);
    }
    let mut cells = Vec::new();
    for (cell, is_left) in tets.cells.iter().zip(&is_left) {
        if *is_left {
            cells.push(oriented(&tets.points, *cell));
            continue;
        }
        let moved = cell.map(|p| {
            if !used_left[p as usize] {
                return p;
            }
            *other[p as usize].get_or_insert_with(|| {
                points.push(tets.points[p as usize]);
                scalars.push(tets.scalars[p as usize]);
                points.len() as u32 - 1
            })
        });
        cells.push(oriented(&points, moved));
    }
    // Three flat cells on every face of the cut: a prism between a triangle and itself.
    let mut flat = Vec::new();
    for (cell, _) in left() {
        let shared: Vec<u32> = cell.iter().copied().filter(|&p| other[p as usize].is_some()).collect();
        if let [a, b, c] = shared[..] {
            let [d, e, f] = [a, b, c].map(|p| other[p as usize].unwrap_or(p));
            flat.extend([[a, b, c, d], [b, c, d, e], [c, d, e, f]]);
        }
    }
    cells.extend(flat);
    let range = tets.range();
    let camera = look(DVec3::new(2.0, 2.5, 4.5), DVec3::new(0.1, 0.0, 0.0), DVec3::Y, 34.0);
    let inside = look(DVec3::new(0.1, 0.05, 0.0), DVec3::new(0.2, 1.0, 0.3), DVec3::Z, 90.0);
    [("from outside", camera), ("from inside", inside)]
        .map(|(place, camera)| {
            let made = volume_of(&points, &cells, &scalars);
            let scene = lively(&camera, [56, 54], [range.0, range.1], 1.0);
            HardScene { says: Some("have no volume"), ..HardScene::partition(place, made, scene) }
        })
        .to_vec()
}

pub(super) fn inverted_cells() -> Vec<HardScene> {
    let mut tets = Tets::block(3, 7500);
    tets.cells = tets.cells.iter().map(|&cell| oriented(&tets.points, cell)).collect();
    let range = tets.range();
    let camera = look(DVec3::new(-2.5, 2.0, 4.0), DVec3::new(0.1, 0.0, 0.0), DVec3::Y, 36.0);
    let scene = lively(&camera, [56, 54], [range.0, range.1], 1.0);
    let upright = Arc::new(volume(&tets));
    [("every second", 2), ("all", 1), ("none", usize::MAX)]
        .map(|(place, step)| {
            let mut turned = tets.clone();
            turned.cells.iter_mut().step_by(step).for_each(|cell| cell.swap(0, 1));
            if step == usize::MAX {
                turned.cells[0].swap(0, 1);
            }
            let outline = crate::chords::boundary(&upright.decomposition.mesh);
            let scene = HardScene::new(place, volume(&turned), scene.clone(), Truth::Outline(outline));
            HardScene { says: (step != usize::MAX).then_some("were inverted and are turned round"), ..scene }
        })
        .to_vec()
}
