//! Hard cases of meshes: what is flat, doubled, torn or does not fit.

use std::sync::Arc;

use glam::DVec3;
use tetrascope::{Camera, Projection};

use super::case::{Group, HardCase, HardScene, Limits, Truth, scene_of, volume_of};
use super::judge::LIGHT_LIMITS;
use crate::chords::{boundary, world};
use crate::meshes::{Random, Tets, grid};

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, text, scenes| HardCase { name, group: Group::Mesh, text, scenes };
    vec![
        case(
            "coplanar-sheet",
            "A plate of 2,000 cells, all of whose upper faces lie in one plane: seen from aslant, with the eye in the plane, and by \
             parallel rays along it. Faces in the plane of the eye are lines on the screen and have no order; a division by their \
             area is 0 / 0. Here a ray that runs in a face is moved aside by next to nothing, the same in every cell, so that one \
             cell has it.",
            coplanar_sheet,
        ),
        case(
            "cells-without-volume",
            "Flat cells between good ones: four points in a plane, on a line, two points that are one. They divide by their volume, \
             and stop orders that go from neighbor to neighbor; VTK's ray caster ends with signal 11. Here they are left out before \
             drawing, kept for the adjacency, counted, and said.",
            cells_without_volume,
        ),
        case(
            "hanging-nodes",
            "Two blocks side by side, one in cells of half the size: points of the one lie in the middle of edges and faces of the \
             other, and no face in the middle has a neighbor. Orders that go from neighbor to neighbor fall apart there into two \
             parts. Here that is noticed, and an order that crosses gaps is taken.",
            hanging_nodes,
        ),
        case(
            "overlapping-cells",
            "Two blocks that lie in each other. A ray is in two cells at once; no order of cells, and no composition of segments, \
             is right. All renderers take segments by their middles, so that they agree where those are apart, and the user is told \
             that the mesh overlaps itself and where.",
            overlapping_cells,
        ),
        case(
            "duplicated-cells",
            "Every third cell is there twice. The volume is twice as dense there, and which of two equal cells is in front cannot \
             be told; as they are equal, it need not. The user is told.",
            duplicated_cells,
        ),
        case(
            "cracks",
            "Cells that share no points, moved by up to 1e-9 of the mesh: gaps and overlaps of that width between all. Programs \
             that find neighbors by point numbers see a boundary in every face, and orders by neighbors have nothing to go by. Here \
             pixels are sorted where nothing else is sure; the gaps cost what they are wide.",
            cracks,
        ),
    ]
}

const COLOR: &[[f64; 4]] = &[[0.0, 0.1, 0.3, 0.9], [0.5, 0.9, 0.9, 0.2], [1.0, 0.9, 0.1, 0.1]];
const EXTINCTION: &[[f64; 2]] = &[[0.0, 0.5], [0.4, 3.0], [0.6, 0.2], [1.0, 4.0]];

/// A smooth field from 0 to 1.
fn field(p: DVec3) -> f64 {
    0.5 + 0.25 * (3.1 * p.x + 0.4).sin() + 0.25 * (2.3 * p.y - 1.7 * p.z).cos()
}

/// Cells of grids, as they can be changed.
fn grid_tets(cells: [usize; 3], origin: DVec3, size: f64) -> Tets {
    let mesh = grid(cells, origin, size).mesh;
    let points: Vec<DVec3> = (0..mesh.positions().len() as u32).map(|p| world(&mesh, p)).collect();
    let scalars = points.iter().map(|&p| field(p)).collect();
    Tets { cells: mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect(), points, scalars }
}

fn camera(eye: [f64; 3], target: [f64; 3], fov_y: f64) -> Camera {
    let (eye, target) = (DVec3::from(eye), DVec3::from(target));
    Camera { eye, target, up: DVec3::new(0.02, 0.03, 1.0), projection: Projection::Perspective { fov_y } }
}

fn scene(place: &str, tets: &Tets, camera: &Camera, truth: Option<Truth>) -> HardScene {
    let volume = volume_of(&tets.points, &tets.cells, &tets.scalars);
    let scene = scene_of(camera, [48, 45], COLOR, EXTINCTION);
    match truth {
        Some(truth) => HardScene::new(place, volume, scene, truth),
        None => HardScene::partition(place, volume, scene),
    }
}

/// A plate of 2,000 cells whose upper and lower faces lie in two planes: from aslant, with the eye in such a plane, and parallel to it.
fn coplanar_sheet() -> Vec<HardScene> {
    let tets = grid_tets([20, 20, 1], DVec3::new(-1.0, -1.0, 0.0), 0.1);
    let parallel = Camera {
        eye: DVec3::new(-4.0, 0.31, 0.05),
        target: DVec3::new(0.0, 0.0, 0.05),
        up: DVec3::Z,
        projection: Projection::Orthographic { height: 0.3 },
    };
    vec![
        scene("from aslant", &tets, &camera([1.2, -2.2, 1.4], [0.0, 0.0, 0.05], 0.7), None),
        scene("the eye in the plane", &tets, &camera([3.0, 0.23, 0.1], [0.0, 0.0, 0.1], 0.3), None),
        HardScene {
            // Rays within the plate are fifteen times as long as it is thick, and cells at the eye are huge on the screen.
            within: Limits::of_two(LIGHT_LIMITS.cpu, 5e-5),
            ..scene(
                "the eye in the plane, within the plate",
                &tets,
                &camera([0.13, 0.23, 0.1], [-1.0, 0.1, 0.05], 1.2),
                None,
            )
        },
        scene("rays along the plane", &tets, &parallel, None),
    ]
}

/// Flat cells between good ones: four points in a plane, on a line, and two that are one. They are left out, and said.
fn cells_without_volume() -> Vec<HardScene> {
    let mut tets = grid_tets([3, 3, 3], DVec3::splat(-1.0), 2.0 / 3.0);
    let outline = boundary(&tets.mesh());
    for cell in tets.cells.clone().chunks(7).map(|cells| cells[0]) {
        // A face and the middle of one of its edges; an edge and two points on it; a point twice.
        let [a, b, c, _] = cell;
        let middle = |tets: &mut Tets, share: f64| {
            tets.points.push(tets.points[a as usize].lerp(tets.points[b as usize], share));
            tets.scalars.push(0.5);
            tets.points.len() as u32 - 1
        };
        let [half, third] = [middle(&mut tets, 0.5), middle(&mut tets, 0.25)];
        tets.cells.extend([[a, b, c, half], [a, b, half, third], [a, b, c, a]]);
    }
    [camera([2.2, -3.1, 1.9], [0.0; 3], 0.75), camera([0.0, -4.0, 0.0], [0.0; 3], 0.6)]
        .into_iter()
        .zip(["from aslant", "down an axis"])
        .map(|(camera, place)| {
            let mut hard = scene(place, &tets, &camera, Some(Truth::Outline(outline.clone())));
            hard.says = Some("no volume");
            hard
        })
        .collect()
}

/// Two boxes side by side, one in cells of half the size: faces in the middle do not match, and its points lie on edges and faces of the other.
fn hanging_nodes() -> Vec<HardScene> {
    let coarse = grid_tets([2, 2, 2], DVec3::new(-1.0, -0.5, -0.5), 0.5);
    let mut tets = grid_tets([4, 4, 4], DVec3::new(0.0, -0.5, -0.5), 0.25);
    let first = tets.points.len() as u32;
    let whole = grid_tets([4, 2, 2], DVec3::new(-1.0, -0.5, -0.5), 0.5).mesh();
    tets.points.extend(&coarse.points);
    tets.scalars.extend(&coarse.scalars);
    tets.cells.extend(coarse.cells.iter().map(|cell| cell.map(|p| p + first)));
    // The points in the middle that both have are one.
    for coarse_point in first..tets.points.len() as u32 {
        let at = tets.points[coarse_point as usize];
        if let Some(fine) = tets.points[..first as usize].iter().position(|p| *p == at) {
            tets.cells.iter_mut().flatten().filter(|p| **p == coarse_point).for_each(|p| *p = fine as u32);
        }
    }
    let outline = Truth::Outline(boundary(&whole));
    vec![
        scene("from aslant", &tets, &camera([1.6, -2.4, 1.5], [0.0; 3], 0.8), Some(outline.clone())),
        scene("through the middle", &tets, &camera([3.0, 0.3, 0.2], [0.0; 3], 0.4), Some(outline.clone())),
        scene("the eye in the middle's plane", &tets, &camera([0.0, -2.6, 0.4], [0.0; 3], 0.8), Some(outline)),
    ]
}

/// Two blocks that lie in each other. Opacity is that of both; which color is in front has no answer.
fn overlapping_cells() -> Vec<HardScene> {
    let mut tets = grid_tets([2, 2, 2], DVec3::splat(-1.0), 0.7);
    let other = grid_tets([2, 2, 2], DVec3::new(-0.33, -0.41, -0.27), 0.6);
    let first = tets.points.len() as u32;
    tets.points.extend(&other.points);
    tets.scalars.extend(&other.scalars);
    tets.cells.extend(other.cells.iter().map(|cell| cell.map(|p| p + first)));
    let mut hard = scene("two blocks", &tets, &camera([2.2, -3.1, 1.9], [0.0; 3], 0.75), Some(Truth::Reference));
    hard.says = Some("overlaps itself");
    vec![hard]
}

/// Cells that are there twice.
fn duplicated_cells() -> Vec<HardScene> {
    let mut tets = grid_tets([2, 2, 2], DVec3::splat(-0.8), 0.8);
    let repeated: Vec<[u32; 4]> = tets.cells.iter().step_by(3).copied().collect();
    tets.cells.extend(repeated);
    let mut hard =
        scene("every third cell twice", &tets, &camera([2.0, -2.9, 1.6], [0.0; 3], 0.7), Some(Truth::Reference));
    hard.says = Some("overlaps itself");
    vec![hard]
}

/// Cells that share no points, each moved by a little: gaps and overlaps of that width between all.
fn cracks() -> Vec<HardScene> {
    let whole = grid_tets([3, 3, 3], DVec3::splat(-1.0), 2.0 / 3.0);
    let outline = Arc::new(boundary(&whole.mesh()));
    let torn = |place: &str, width: f64| {
        let mut random = Random::new(77);
        let mut tets = Tets::default();
        for cell in &whole.cells {
            let aside = random.point() * width;
            let first = tets.points.len() as u32;
            tets.points.extend(cell.map(|p| whole.points[p as usize] + aside));
            tets.scalars.extend(cell.map(|p| whole.scalars[p as usize]));
            tets.cells.push([first, first + 1, first + 2, first + 3]);
        }
        let truth = Truth::Outline(outline.as_ref().clone());
        scene(place, &tets, &camera([2.2, -3.1, 1.9], [0.0; 3], 0.75), Some(truth))
    };
    vec![
        torn("points of its own for each cell", 0.0),
        torn("cells moved by 1e-12", 1e-12),
        torn("cells moved by 1e-9", 1e-9),
    ]
}
