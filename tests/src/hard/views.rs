//! What the scenes of classification, eye and pixels share: their optics, and views straight down.

use glam::DVec3;
use tetrascope::{Camera, Projection, SceneFile, Volume};

use super::case::{scene_of, volume_of};
use crate::meshes::Tets;

/// Colors over the range of the field.
const COLORS: [[f64; 4]; 6] = [
    [0.0, 0.05, 0.15, 0.9],
    [0.25, 0.0, 0.8, 0.9],
    [0.45, 0.1, 0.9, 0.15],
    [0.6, 1.0, 0.9, 0.1],
    [0.8, 1.0, 0.25, 0.05],
    [1.0, 0.8, 0.0, 0.6],
];
/// Optical depths of a length of one unit over the range of the field: a slope, a peak, a step.
const DEPTHS: [[f64; 2]; 7] = [[0.0, 2.0], [0.3, 0.4], [0.45, 3.0], [0.55, 0.4], [0.7, 0.4], [0.7, 1.6], [1.0, 2.4]];

/// A scene with a peak and a step in its extinction and six colors.
///
/// - `range`: of the field
/// - `length`: world length of an optical depth of about one
pub(super) fn lively(camera: &Camera, size: [u32; 2], range: [f64; 2], length: f64) -> SceneFile {
    let at = |share: f64| range[0] + (range[1] - range[0]) * share;
    let color = COLORS.map(|[s, r, g, b]| [at(s), r, g, b]);
    let extinction = DEPTHS.map(|[s, depth]| [at(s), depth / length]);
    scene_of(camera, size, &color, &extinction)
}

/// A parallel view straight down z on `target`, y up.
pub(super) fn down(target: DVec3, height: f64) -> Camera {
    Camera { eye: target + 8.0 * DVec3::Z, target, up: DVec3::Y, projection: Projection::Orthographic { height } }
}

/// A view straight down z from `eye`, y up, in which `height` is seen at a depth of 1.
pub(super) fn down_from(eye: DVec3, height: f64) -> Camera {
    let projection = Projection::Perspective { fov_y: 2.0 * (height / 2.0).atan() };
    Camera { eye, target: eye - DVec3::Z, up: DVec3::Y, projection }
}

/// A view in perspective.
pub(super) fn look(eye: DVec3, target: DVec3, up: DVec3, degrees: f64) -> Camera {
    Camera { eye, target, up, projection: Projection::Perspective { fov_y: degrees.to_radians() } }
}

/// A mesh of tetrahedra that grows piece by piece, none of which share points.
#[derive(Default)]
pub(super) struct Pieces {
    pub(super) points: Vec<DVec3>,
    pub(super) tetrahedra: Vec<[u32; 4]>,
    pub(super) scalars: Vec<f64>,
}

impl Pieces {
    /// Adds tetrahedra over points of their own, oriented as they are.
    pub(super) fn add(&mut self, points: &[DVec3], tetrahedra: &[[u32; 4]], scalars: &[f64]) {
        let first = self.points.len() as u32;
        self.points.extend(points);
        self.tetrahedra.extend(tetrahedra.iter().map(|cell| cell.map(|corner| corner + first)));
        self.scalars.extend(scalars);
    }

    pub(super) fn volume(&self) -> Volume {
        volume_of(&self.points, &self.tetrahedra, &self.scalars)
    }
}

/// The volume of tetrahedra with their field.
pub(super) fn volume(tets: &Tets) -> Volume {
    volume_of(&tets.points, &tets.cells, &tets.scalars)
}

/// Positively oriented: the last two corners are swapped where they are not.
pub(super) fn oriented(points: &[DVec3], mut cell: [u32; 4]) -> [u32; 4] {
    let [a, b, c, d] = cell.map(|corner| points[corner as usize]);
    if (b - a).cross(c - a).dot(d - a) < 0.0 {
        cell.swap(2, 3);
    }
    cell
}

/// A float so many units in the last place away; as many of 32 bits with `is_single`, if it is one.
pub(super) fn nudged(value: f64, ulps: i32, is_single: bool) -> f64 {
    if is_single {
        f64::from(f32::from_bits((value as f32).to_bits().wrapping_add_signed(ulps)))
    } else {
        f64::from_bits(value.to_bits().wrapping_add_signed(i64::from(ulps)))
    }
}

/// How far beside: on either side.
pub(super) const ULPS: [i32; 10] = [-1000, -100, -10, -2, -1, 1, 2, 10, 100, 1000];
