//! Views of chance: far, near, inside, and where rays meet vertices, edges and faces exactly.

use glam::DVec3;
use tetrascope::{CameraSection, ProjectionName};

use super::case::Bounds;
use super::mesh::{Made, pick};
use crate::meshes::Random;

/// Columns and rows: few enough that thousands of scenes are drawn, odd and even.
pub(super) fn size(random: &mut Random) -> (u32, u32) {
    match pick(random, 12) {
        0 => (1 + pick(random, 3) as u32, 1 + pick(random, 3) as u32),
        1 => (97, 65),
        2 => (1 + pick(random, 64) as u32, 1 + pick(random, 48) as u32),
        _ => ([24, 31, 33, 40][pick(random, 4)], [17, 24, 32, 25][pick(random, 4)]),
    }
}

/// A camera with every number given, and where it is.
pub(super) fn view(random: &mut Random, made: &Made, bounds: Bounds) -> (&'static str, CameraSection) {
    let Bounds { center, radius } = bounds;
    let direction = random.point().normalize_or(DVec3::Z);
    let inward = random.unit() < 0.7;
    let corners = {
        let cell = made.tets.cells[pick(random, made.tets.cells.len())];
        cell.map(|v| made.tets.points[v as usize])
    };
    let target = center + random.point() * (0.2 * radius);
    // From a place of the mesh mostly to its middle: outward there is often nothing.
    let from = |eye: DVec3| if inward && eye != center { center } else { eye + direction * radius };
    // The eye, what it looks at, and the angle that shows a part of the mesh.
    let (kind, eye, target, fov) = match pick(random, 16) {
        0..=4 => {
            let distance = random.between(1.5, 6.0);
            ("fit", center + direction * (distance * radius), target, 2.0 * (1.1 / distance).atan())
        }
        5 => {
            let distance = 10.0_f64.powf(random.between(1.0, 4.0));
            ("far", center + direction * (distance * radius), target, 2.0 * (1.1 / distance).atan())
        }
        6 => {
            let angle = random.between(120.0_f64, 175.0).to_radians();
            ("wide", center + direction * (random.between(0.2, 1.0) * radius), target, angle)
        }
        7 => {
            let angle = random.between(0.1_f64, 2.0).to_radians();
            ("narrow", center + direction * (random.between(2.0, 40.0) * radius), target, angle)
        }
        8 => ("near", center + direction * (random.between(0.3, 1.1) * radius), target, 1.2),
        9 => {
            let [a, b, c] = [random.unit(), random.unit(), random.unit()];
            let weights = [a, b, c, random.unit()].map(|w| w + 0.01);
            let eye = corners.iter().zip(weights).map(|(&p, w)| p * w).sum::<DVec3>() / weights.iter().sum::<f64>();
            ("inside a cell", eye, from(eye), random.between(0.6, 2.0))
        }
        10 => ("on a vertex", corners[0], from(corners[0]), random.between(0.6, 2.0)),
        11 => {
            let eye = (corners[0] + corners[1]) * 0.5;
            ("on an edge", eye, from(eye), random.between(0.6, 2.0))
        }
        12 => {
            let eye = (corners[0] + corners[1] + corners[2]) / 3.0;
            ("on a face", eye, from(eye), random.between(0.6, 2.0))
        }
        13 => {
            let along = (corners[1] - corners[0]).normalize_or(direction);
            let eye = corners[0] + along * (random.between(2.0, 4.0) * radius);
            ("in a face's plane", eye, if random.unit() < 0.5 { corners[0] } else { center }, 0.7)
        }
        _ => return along_an_axis(random, made, bounds),
    };
    let up = random.point();
    let mut camera = CameraSection {
        eye: Some(eye.to_array()),
        target: Some(target.to_array()),
        up: Some(up.to_array()),
        fov_y: Some(fov.to_degrees().clamp(1e-3, 179.0)),
        ..Default::default()
    };
    if random.unit() < 0.2 {
        camera.projection = ProjectionName::Orthographic;
        camera.fov_y = None;
        camera.height = Some(match pick(random, 3) {
            0 => 2.1 * radius,
            1 => radius * random.between(0.05, 1.5),
            _ => radius * random.between(1.5, 8.0),
        });
    }
    (kind, camera)
}

/// Straight down an axis; of a grid so that pixel centers lie on lines of the grid.
fn along_an_axis(random: &mut Random, made: &Made, bounds: Bounds) -> (&'static str, CameraSection) {
    let Bounds { center, radius } = bounds;
    let axis = pick(random, 3);
    let sign = if random.unit() < 0.5 { 1.0 } else { -1.0 };
    let mut forward = DVec3::ZERO;
    forward[axis] = sign;
    let mut up = DVec3::ZERO;
    up[(axis + 1 + pick(random, 2)) % 3] = 1.0;
    let mut camera = CameraSection {
        projection: ProjectionName::Orthographic,
        eye: Some((center - forward * (3.0 * radius)).to_array()),
        target: Some(center.to_array()),
        up: Some(up.to_array()),
        height: Some(2.0 * radius),
        ..Default::default()
    };
    if random.unit() < 0.3 {
        camera.projection = ProjectionName::Perspective;
        (camera.height, camera.fov_y) = (None, Some(45.0));
    } else if let Some(cells) = made.grid {
        // A pixel is a power of two of a cell's side, whatever the picture's rows are: the middle of an odd picture is a pixel's center.
        let side = radius / DVec3::from(cells.map(|n| n as f64)).length() * 2.0;
        camera.height = Some(side * f64::from(1_u32 << pick(random, 4)) * 2.0);
    }
    ("down an axis", camera)
}
