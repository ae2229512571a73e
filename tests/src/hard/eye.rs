//! Hard cases of the eye: on and in the mesh, angles of view from narrow to wide, and the way to a parallel view.

use glam::DVec3;
use tetrascope::{Camera, Projection, SceneFile, Volume};

use super::case::{Group, HardCase, HardScene, Limits};
use super::judge::LIGHT_LIMITS;
use super::views::{lively, look, volume};
use crate::chords::boundary_faces;
use crate::meshes::Tets;

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, text, scenes| HardCase { name, group: Group::Eye, text, scenes };
    vec![
        case(
            "eye-in-the-plane-of-a-face",
            "The eye lies on a face of the mesh, inside or on the boundary, or beside it in its plane: the face's signed volume is \
             zero but for rounding, and rays run in the face. Neither cell of it may then be drawn, or both. Here a ray that runs \
             in a face belongs to the one cell that it would enter if moved a little to the right and, by far less, down; both \
             cells decide from the same bits. Cells near the eye are drawn in f64 on the CPU, in integers on a GPU.",
            in_the_plane_of_a_face,
        ),
        case(
            "eye-on-an-edge",
            "The eye lies on an edge, and looks into the mesh or along the edge. All cells about the edge contain the eye and none \
             of them has a silhouette; a fan of triangles on the screen does not exist for them. The planes of their faces do: each \
             ray begins at a depth of 0 and ends at the first face that it leaves through. Along the edge exactly one of the cells \
             has the ray.",
            on_an_edge,
        ),
        case(
            "eye-on-a-vertex",
            "The eye lies on a vertex: three faces of every cell about it pass through the eye, and their projections are lines \
             through everything. Here no corner is projected where the eye is near: nearness, the inverse of depth, would be \
             infinite, so that such cells are clipped ray by ray instead.",
            on_a_vertex,
        ),
        case(
            "eye-in-a-cell",
            "The eye is inside a cell, in its middle or a thousandth from a corner. No entry of the table is meant for that cell: \
             all its faces face away, and the picture is missing it in programs that skip what they cannot classify. It is a class \
             of its own here, and its rays begin at the eye.",
            in_a_cell,
        ),
        case(
            "eye-near-a-face",
            "The eye is 1e-7 of the mesh's size before or behind a face, inside and on the boundary. Depths of one cell go from \
             1e-7 to 1, and with f32 positions the eye lands on the wrong side. Here the side is decided in f64 on the CPU; on a \
             GPU the mesh's coordinates are integers of 2^-29 of its size, so that 1e-7 is fifty steps, and rays of cells that near \
             are tried against their corners in integers.",
            near_a_face,
        ),
        case(
            "cells-across-the-plane-of-the-eye",
            "Cells have corners before and behind the eye, and some exactly at a depth of zero: dividing by depth turns what is \
             behind inside out. A near plane cuts a slice away. Here nothing is cut away: such cells are bounded by the picture and \
             clipped by their faces ray by ray, at depths from 0 on. Parallel rays begin in the plane of the eye as well, and what \
             lies behind it is not seen.",
            across_the_plane_of_the_eye,
        ),
        case(
            "angle-of-one-degree",
            "An angle of one degree, from 175 sizes away and from inside. Rays are nearly parallel, and depths differ in their last \
             digits: in f32 a difference of two depths at a distance of 175 loses two digits more than at 1. Here depths within a \
             cell are relative to a point in that cell.",
            angle_of_one_degree,
        ),
        case(
            "angle-of-170-degrees",
            "An angle of 170 degrees, from inside and from outside: slopes reach 11, chords are up to 11 times as long as their \
             depth, and many cells lie across the plane of the eye. What is linear along the screen in a parallel view is not here: \
             interpolated lengths are off by as much as they vary. Chords follow from nearness, which is linear on the screen at \
             any angle, and from the length of each pixel's own ray.",
            angle_of_170_degrees,
        ),
        case(
            "parallel-as-the-limit-of-perspective",
            "The eye moves away from 10 to 1e8 while the angle of view shrinks: the pictures must become the parallel one. Two \
             programs for two projections often meet at different pixels, and distances of 1e8 leave no digits to f32 depths. The \
             mean difference from the parallel picture is 0.25 to 0.27 divided by the distance in all four ways up to 1e6, and from \
             1e7 on what rounding leaves, 5e-9 in the reference and 2e-8 to 4e-8 in f32.",
            parallel_as_the_limit,
        ),
    ]
}

/// A bent block with places in it.
struct Block {
    tets: Tets,
    /// A point inside, and a cell's other corners about it.
    inner: [DVec3; 4],
    /// A face of the boundary, its normal outwards.
    outer: [DVec3; 3],
}

impl Block {
    fn new(seed: u64) -> Self {
        let tets = Tets::block(2, seed);
        let mesh = tets.mesh();
        let faces = boundary_faces(&mesh);
        let is_outer = |p: u32| faces.iter().any(|face| face.contains(&p));
        let inner = tets
            .cells
            .iter()
            .find_map(|cell| {
                let first = cell.iter().position(|&p| !is_outer(p))?;
                let mut cell = *cell;
                cell.swap(0, first);
                Some(cell.map(|p| tets.points[p as usize]))
            })
            .expect("the block has an inner point");
        let outer = faces[faces.len() / 2].map(|p| tets.points[p as usize]);
        Self { tets, inner, outer }
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.outer;
        (b - a).cross(c - a).normalize()
    }

    fn scene(&self, place: impl Into<String>, camera: &Camera, size: [u32; 2]) -> HardScene {
        let range = self.tets.range();
        HardScene::partition(place, volume(&self.tets), lively(camera, size, [range.0, range.1], 1.0))
    }

    /// From a place, towards the middle of the block's other side.
    fn inward(&self, name: &str, eye: DVec3) -> HardScene {
        let into = if eye.length() > 0.3 { -eye } else { DVec3::new(0.5, -0.8, -0.4) };
        self.scene(format!("{name}, into the mesh"), &look(eye, eye + into, UP, 100.0), [48, 46])
    }

    /// From a place, along a direction that runs in what the eye is on: the ray of the middle pixel does too.
    fn along(&self, name: &str, eye: DVec3, along: DVec3) -> HardScene {
        self.scene(format!("{name}, along it"), &look(eye, eye + along, UP, 70.0), [33, 31])
    }

    /// The same where that is the outline, in which a ray shows all or nothing: no ray runs in it.
    fn beside(&self, name: &str, eye: DVec3, along: DVec3) -> HardScene {
        self.scene(format!("{name}, along it"), &look(eye, eye + along, UP, 70.0), [34, 30])
    }
}

const UP: DVec3 = DVec3::new(0.3, 1.0, 0.2);

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

fn in_the_plane_of_a_face() -> Vec<HardScene> {
    let block = Block::new(7800);
    let [a, b, c, _] = block.inner;
    let [p, q, r] = block.outer;
    let beside = a + 1.75 * (b - a) + 1.5 * (c - a);
    let far = p + 2.5 * (p - q) + 1.5 * (p - r);
    let camera = look(far, mean(&[p, q, r]), block.normal(), 24.0);
    vec![
        block.inward("on an inner face", mean(&[a, b, c])),
        // The middle ray leaves the face through an edge: before it the ray is a cell's that is drawn in f64, behind it rounding in f32 may give it
        // to a cell on the face's other side, and no order of whole cells says which of the two is in front. With `order = "per-pixel"` it is right.
        HardScene {
            within: Limits::of_two(5e-4, LIGHT_LIMITS.compute),
            ..block.along("on an inner face", mean(&[a, b, c]), b - a)
        },
        block.beside("on the boundary", mean(&[p, q, r]), q - p),
        block.along("beside an inner face", beside, a - beside),
        block.scene("in the plane of a boundary face, outside", &camera, [48, 34]),
    ]
}

fn on_an_edge() -> Vec<HardScene> {
    let block = Block::new(7810);
    let [a, b, ..] = block.inner;
    let [p, q, _] = block.outer;
    vec![
        block.inward("an inner edge", mean(&[a, b])),
        block.along("an inner edge", mean(&[a, b]), b - a),
        block.beside("an edge of the boundary", mean(&[p, q]), q - p),
    ]
}

fn on_a_vertex() -> Vec<HardScene> {
    let block = Block::new(7820);
    let [a, b, ..] = block.inner;
    let [p, ..] = block.outer;
    vec![
        block.inward("an inner vertex", a),
        block.along("an inner vertex", a, b - a),
        block.inward("a vertex of the boundary", p),
    ]
}

fn in_a_cell() -> Vec<HardScene> {
    let block = Block::new(7830);
    let [a, b, ..] = block.inner;
    let middle = mean(&block.inner);
    vec![block.inward("in the middle", middle), block.along("in a corner", a + 1e-3 * (middle - a), b - a)]
}

fn near_a_face() -> Vec<HardScene> {
    let block = Block::new(7840);
    let [a, b, c, _] = block.inner;
    let normal = (b - a).cross(c - a).normalize() * 1e-7;
    let [p, q, r] = block.outer;
    let [inner, outer, out] = [mean(&[a, b, c]), mean(&[p, q, r]), block.normal() * 1e-7];
    vec![
        block.inward("before the boundary", outer + out),
        block.beside("behind the boundary", outer - out, q - p),
        block.along("before an inner face", inner - normal, b - a),
        block.inward("behind an inner face", inner + normal),
    ]
}

fn across_the_plane_of_the_eye() -> Vec<HardScene> {
    let block = Block::new(7850);
    let up = DVec3::new(0.1, 1.0, 0.3);
    let mut scenes = Vec::new();
    for (place, eye, target) in [
        ("a wide view from the middle", DVec3::new(0.1, 0.05, 0.02), DVec3::new(1.0, 0.2, -0.3)),
        ("beside the mesh, along its side", DVec3::new(0.3, 0.2, 1.3), DVec3::new(-0.9, 0.1, 1.0)),
    ] {
        scenes.push(block.scene(place, &look(eye, target, up, 130.0), [52, 40]));
    }
    // The plane of the eye through a vertex, parallel to a face: corners at a depth of zero.
    let [p, q, r] = block.outer;
    let [a, ..] = block.inner;
    let camera = look(a, a - block.normal(), q - p, 120.0);
    scenes.push(block.scene("corners in the plane of the eye", &camera, [33, 31]));
    let camera = look(mean(&[p, q, r]), mean(&[p, q, r]) - block.normal(), r - p, 140.0);
    scenes.push(block.scene("a face in the plane of the eye", &camera, [32, 31]));
    // Parallel rays start in the middle of the mesh: what is behind is not seen.
    let forward = DVec3::new(-0.4, 0.2, -1.0);
    let camera = Camera { eye: a, target: a + forward, up, projection: Projection::Orthographic { height: 2.5 } };
    scenes.push(block.scene("parallel rays from the middle", &camera, [40, 40]));
    scenes
}

fn angle_of_one_degree() -> Vec<HardScene> {
    let block = Block::new(7860);
    let towards = DVec3::new(0.5, 0.4, 1.0).normalize();
    let detail = block.outer[0];
    vec![
        block.scene("from far", &look(towards * 175.0, DVec3::ZERO, DVec3::Y, 1.0), [56, 54]),
        block.scene("from inside", &look(mean(&block.inner), detail, DVec3::X, 1.0), [32, 32]),
    ]
}

fn angle_of_170_degrees() -> Vec<HardScene> {
    let block = Block::new(7870);
    let up = DVec3::new(0.1, 1.0, 0.2);
    let towards = DVec3::new(0.4, 0.3, 1.0).normalize();
    vec![
        block.scene("from inside", &look(mean(&block.inner), DVec3::new(0.2, 0.1, -1.0), up, 170.0), [56, 54]),
        block.scene("from outside", &look(towards * 1.5, DVec3::ZERO, up, 170.0), [64, 64]),
    ]
}

/// The mesh and its scenes on the way to a parallel view: the eye's distance with each; the last one is parallel.
pub fn towards_parallel_scenes() -> (Volume, Vec<(f64, SceneFile)>) {
    let towards = DVec3::new(0.5, 0.4, 1.0).normalize();
    let height = 3.0_f64;
    let tets = Tets::block(2, 7880);
    let (low, high) = tets.range();
    let scene = |distance: f64, eye: f64, projection| {
        let camera = Camera { eye: towards * eye, target: DVec3::ZERO, up: DVec3::Y, projection };
        (distance, lively(&camera, [48, 46], [low, high], 1.0))
    };
    let mut scenes: Vec<(f64, SceneFile)> = (1..=8)
        .map(|power| {
            let distance = 10.0_f64.powi(power);
            let fov_y = 2.0 * (height / 2.0).atan2(distance);
            scene(distance, distance, Projection::Perspective { fov_y })
        })
        .collect();
    scenes.push(scene(f64::INFINITY, 10.0, Projection::Orthographic { height }));
    (volume(&tets), scenes)
}

fn parallel_as_the_limit() -> Vec<HardScene> {
    let (_, scenes) = towards_parallel_scenes();
    let hard = |(distance, scene): (f64, SceneFile)| {
        let place = if distance.is_finite() { format!("from {distance:e}") } else { "in parallel".to_owned() };
        HardScene::partition(place, volume(&Tets::block(2, 7880)), scene)
    };
    scenes.into_iter().step_by(4).map(hard).collect()
}
