//! Hard cases of order: cells that hide one another in a ring, and cells that hardly do not.

use glam::DVec3;
use tetrascope::{Camera, Projection};

use super::case::{Group, HardCase, HardScene, scene_of, volume_of};

/// The cases of this group.
pub(super) fn cases() -> Vec<HardCase> {
    let case = |name, text, scenes| HardCase { name, group: Group::Order, text, scenes };
    vec![
        case(
            "cycles",
            "Three needles, each over the next: no order of whole cells is right. Textbook orders hang, or draw what they come to. \
             Here rings are found, and their cells are cut or the pixels that they cover are sorted.",
            cycles,
        ),
        case(
            "nearly-cyclic",
            "The same needles with their ends turned up less and less, until they lie side by side, touch, and lie the other way \
             round: by 1e-3 to 1e-12 of their size. Whether there is a ring is a question of the last digit. Here signs that decide \
             on it are exact.",
            nearly_cyclic,
        ),
    ]
}

/// Three needles, each over the next: no order of whole cells is right.
fn cycles() -> Vec<HardScene> {
    vec![ring("a ring of three", 0.3)]
}

/// The same needles turned up at their ends by less and less, until they lie side by side, and down.
fn nearly_cyclic() -> Vec<HardScene> {
    let scene = |rise: f64| ring(&format!("ends {rise:e} above the next"), rise);
    [1e-3, 1e-6, 1e-9, 1e-12, 0.0, -1e-12, -1e-9, -1e-6].map(scene).into()
}

/// Three needles around a triangle; `rise` is how far each one's end lies above the next one's start.
fn ring(place: &str, rise: f64) -> HardScene {
    let (mut points, mut tetrahedra) = (Vec::new(), Vec::new());
    for i in 0..3_u32 {
        let turn = glam::DQuat::from_rotation_z(f64::from(i) * std::f64::consts::TAU / 3.0);
        let first = points.len() as u32;
        let corners = [[-1.2, -0.6, -rise], [-1.2, -0.4, -rise], [1.2, -0.5, rise - 0.1], [1.2, -0.5, rise + 0.1]];
        points.extend(corners.map(|p| turn * DVec3::from(p)));
        tetrahedra.push([0, 1, 2, 3].map(|corner| first + corner));
    }
    let scalars: Vec<f64> = (0..12).map(|i| f64::from(i / 4)).collect();
    let camera = Camera {
        eye: DVec3::new(0.0, 0.0, 5.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_y: 0.6 },
    };
    let color = [[0.0, 1.0, 0.1, 0.1], [1.0, 0.1, 1.0, 0.1], [2.0, 0.1, 0.1, 1.0]];
    let scene = scene_of(&camera, [65, 61], &color, &[[0.0, 8.0]]);
    let mut hard = HardScene::partition(place, volume_of(&points, &tetrahedra, &scalars), scene);
    // A needle is twenty times as long as thick, and its planes are known to f32 relative to its length.
    hard.chord_within.cpu = 3e-5;
    hard
}
