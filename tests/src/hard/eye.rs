//! Hard cases of the eye: on and in the mesh, angles of view from narrow to wide, and the way to a parallel view.

use glam::DVec3;
use tetrascope::{Camera, Projection, SceneFile, Volume};

use super::case::{Group, HardCase, HardScene};
use super::views::{lively, look, volume};
use crate::chords::boundary_faces;
use crate::meshes::Tets;

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, scenes| HardCase { name, group: Group::Eye, scenes };
    vec![
        case("eye-in-the-plane-of-a-face", in_the_plane_of_a_face),
        case("eye-on-an-edge", on_an_edge),
        case("eye-on-a-vertex", on_a_vertex),
        case("eye-in-a-cell", in_a_cell),
        case("eye-near-a-face", near_a_face),
        case("cells-across-the-plane-of-the-eye", across_the_plane_of_the_eye),
        case("angle-of-one-degree", angle_of_one_degree),
        case("angle-of-170-degrees", angle_of_170_degrees),
        case("parallel-as-the-limit-of-perspective", parallel_as_the_limit),
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

    /// From a place, towards the middle of the block's other side, and along a direction.
    fn from(&self, name: &str, eye: DVec3, along: DVec3) -> Vec<HardScene> {
        let into = if eye.length() > 0.3 { -eye } else { DVec3::new(0.5, -0.8, -0.4) };
        let up = DVec3::new(0.3, 1.0, 0.2);
        vec![
            self.scene(format!("{name}, into the mesh"), &look(eye, eye + into, up, 100.0), [48, 46]),
            self.scene(format!("{name}, along it"), &look(eye, eye + along, up, 70.0), [33, 31]),
        ]
    }
}

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

/// Beside the face, so that it is seen edge-on; on it; on the boundary.
fn in_the_plane_of_a_face() -> Vec<HardScene> {
    let block = Block::new(7800);
    let [a, b, c, _] = block.inner;
    let mut scenes = block.from("on an inner face", mean(&[a, b, c]), b - a);
    let [p, q, r] = block.outer;
    scenes.extend(block.from("on the boundary", mean(&[p, q, r]), q - p));
    // In the planes of faces far outside of the mesh: a block whose coordinates are of few digits, seen along its inner faces.
    let beside = a + 1.75 * (b - a) + 1.5 * (c - a);
    scenes.extend(block.from("in the plane of an inner face, beside it", beside, a - beside));
    let far = p + 2.5 * (p - q) + 1.5 * (p - r);
    let camera = look(far, mean(&[p, q, r]), block.normal(), 24.0);
    scenes.push(block.scene("in the plane of a boundary face, outside", &camera, [48, 33]));
    scenes
}

fn on_an_edge() -> Vec<HardScene> {
    let block = Block::new(7810);
    let [a, b, ..] = block.inner;
    let mut scenes = block.from("an inner edge", mean(&[a, b]), b - a);
    let [p, q, _] = block.outer;
    scenes.extend(block.from("an edge of the boundary", mean(&[p, q]), q - p));
    scenes
}

fn on_a_vertex() -> Vec<HardScene> {
    let block = Block::new(7820);
    let [a, b, ..] = block.inner;
    let mut scenes = block.from("an inner vertex", a, b - a);
    let [p, q, _] = block.outer;
    scenes.extend(block.from("a vertex of the boundary", p, q - p));
    scenes
}

fn in_a_cell() -> Vec<HardScene> {
    let block = Block::new(7830);
    let [a, b, ..] = block.inner;
    let mut scenes = block.from("in the middle", mean(&block.inner), b - a);
    scenes.extend(block.from("in a corner", a + 1e-3 * (mean(&block.inner) - a), b - a));
    scenes
}

/// 1e-7 of about the mesh's size from a face, on either side.
fn near_a_face() -> Vec<HardScene> {
    let block = Block::new(7840);
    let [a, b, c, _] = block.inner;
    let normal = (b - a).cross(c - a).normalize();
    let [p, q, r] = block.outer;
    let mut scenes = Vec::new();
    for (side, away) in [("before", 1e-7), ("behind", -1e-7)] {
        scenes.extend(block.from(&format!("{side} an inner face"), mean(&[a, b, c]) + away * normal, b - a));
        scenes.extend(block.from(&format!("{side} the boundary"), mean(&[p, q, r]) + away * block.normal(), q - p));
    }
    scenes
}

/// Most cells have corners both before and behind the eye.
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

/// Two hundred sizes away, and onto a detail from near.
fn angle_of_one_degree() -> Vec<HardScene> {
    let block = Block::new(7860);
    let towards = DVec3::new(0.5, 0.4, 1.0).normalize();
    let detail = block.outer[0];
    vec![
        block.scene("from far", &look(towards * 175.0, DVec3::ZERO, DVec3::Y, 1.0), [56, 54]),
        block.scene("from near", &look(towards * 4.0, detail, DVec3::Y, 1.0), [41, 41]),
        block.scene("from inside", &look(mean(&block.inner), detail, DVec3::X, 1.0), [32, 32]),
    ]
}

fn angle_of_170_degrees() -> Vec<HardScene> {
    let block = Block::new(7870);
    let [a, ..] = block.inner;
    let up = DVec3::new(0.1, 1.0, 0.2);
    let towards = DVec3::new(0.4, 0.3, 1.0).normalize();
    vec![
        block.scene("from inside", &look(mean(&block.inner), DVec3::new(0.2, 0.1, -1.0), up, 170.0), [56, 54]),
        block.scene("from a vertex", &look(a, a + DVec3::new(-0.4, 0.3, 1.0), up, 170.0), [41, 40]),
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
    scenes.into_iter().step_by(2).map(hard).collect()
}
