//! What a ray has inside of a cell, in f64: half-spaces that clip it.

use glam::DVec3;
use tetrascope_shaders::layout::{Frame, LATTICE_STEP, NEGATIVE_BIT};
use tetrascope_view::View;

/// A view as the twin sees it: its eye from the base, in f64.
pub(super) struct Twin {
    /// From the base, local units.
    pub(super) eye: DVec3,
    slope: [f64; 2],
    size: [u32; 2],
    is_perspective: bool,
    /// What integers take from places across, local units.
    pub(super) rounding: f64,
}

/// What the twin finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// From the base, local units.
    pub(super) depth: [f64; 2],
    /// From the first corner's.
    pub(super) scalar: [f64; 2],
    pub(super) length: f64,
    /// How far depths may be off, if the ray is `rounding` and 2e-6 of the cell's size beside its place.
    pub(super) tolerance: f64,
    /// Likewise scalars.
    pub(super) scalar_tolerance: f64,
}

/// A point as the stage `project` makes it: the same integers.
pub(super) fn project(frame: &Frame, vertex: [i32; 4]) -> [i32; 4] {
    let along = |axis: [i32; 4]| {
        let sum: i128 = (0..3).map(|i| i128::from(axis[i]) * i128::from(vertex[i])).sum();
        i32::try_from((sum + (1 << 29)) >> 30).unwrap().wrapping_sub(axis[3])
    };
    [along(frame.right), along(frame.down), along(frame.forward), vertex[3]]
}

impl Twin {
    pub(super) fn new(view: &View, frame: &Frame) -> Self {
        let base = DVec3::new(frame.right[3].into(), frame.down[3].into(), frame.forward[3].into()) * LATTICE_STEP;
        let eye = DVec3::new(view.right.dot(view.eye), -view.up.dot(view.eye), view.forward.dot(view.eye));
        Self {
            eye: eye - base,
            slope: [2.0 * view.half_width / f64::from(view.width), 2.0 * view.half_height / f64::from(view.height)],
            size: [view.width, view.height],
            is_perspective: view.is_perspective,
            rounding: 3.0 * LATTICE_STEP * f64::from(frame.tangent[3]).exp2(),
        }
    }

    /// Origin and direction of a pixel's ray; the direction has unit depth.
    pub(super) fn ray(&self, pixel: [i32; 2]) -> (DVec3, DVec3) {
        let across = [0, 1].map(|i| (f64::from(pixel[i]) + 0.5 - 0.5 * f64::from(self.size[i])) * self.slope[i]);
        if self.is_perspective {
            (self.eye, DVec3::new(across[0], across[1], 1.0))
        } else {
            (self.eye + DVec3::new(across[0], across[1], 0.0), DVec3::Z)
        }
    }

    /// The pixel whose ray is next to a point, which lies in front of the eye.
    pub(super) fn pixel(&self, point: DVec3) -> [i32; 2] {
        let from = point - self.eye;
        let unit = if self.is_perspective { from.z } else { 1.0 };
        [0, 1].map(|i| (from[i] / unit / self.slope[i] + 0.5 * f64::from(self.size[i]) - 0.5).round() as i32)
    }

    /// How near the ray passes by an edge of a cell, at its depth; local units.
    pub(super) fn nearest_edge(&self, points: &[[i32; 4]], cell: [u32; 4], pixel: [i32; 2]) -> f64 {
        let (origin, direction) = self.ray(pixel);
        let beside = corners(points, cell).map(|p| {
            let along = origin + direction * (p.z - origin.z);
            (p - along).truncate()
        });
        let mut nearest = f64::INFINITY;
        for i in 0..4 {
            for j in 0..i {
                let edge = beside[i] - beside[j];
                let share = (-beside[j].dot(edge) / edge.length_squared().max(1e-300)).clamp(0.0, 1.0);
                nearest = nearest.min((beside[j] + edge * share).length());
            }
        }
        nearest
    }

    pub(super) fn span(&self, points: &[[i32; 4]], cell: [u32; 4], pixel: [i32; 2]) -> Option<Found> {
        let corner = corners(points, cell);
        let [a, b, c, d] = corner;
        let sign = if cell[3] & NEGATIVE_BIT == 0 { 1.0 } else { -1.0 };
        let normal = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p);
        let faces = [(b, normal(b, c, d)), (a, -normal(a, c, d)), (a, normal(a, b, d)), (a, -normal(a, b, c))]
            .map(|(p, n)| (p, n * sign));
        let six_volume = -(b - a).dot(faces[1].1);
        let scalars = scalars(points, cell);
        let mut gradient = DVec3::ZERO;
        for i in 1..4 {
            gradient -= faces[i].1 * (scalars[i] / six_volume);
        }
        if six_volume <= 0.0 {
            return None;
        }
        let longest = (0..4).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| corner[i].distance(corner[j]));
        let size = longest.fold(0.0, f64::max);
        let (origin, direction) = self.ray(pixel);
        // Parameters are depths from a corner: those from a far eye would lose digits.
        let start = origin + direction * (a.z - origin.z);
        let (mut enter, mut leave) = (self.eye.z - a.z, f64::INFINITY);
        let [mut enter_slope, mut leave_slope] = [0.0; 2];
        for (point, normal) in faces {
            let (room, speed) = (normal.dot(point - start), normal.dot(direction));
            let depth = room / speed;
            let slope = normal.length() / speed.abs();
            if speed > 0.0 && depth < leave {
                (leave, leave_slope) = (depth, slope);
            } else if speed < 0.0 && depth > enter {
                (enter, enter_slope) = (depth, slope);
            } else if speed == 0.0 && room < 0.0 {
                return None;
            }
        }
        if enter >= leave || enter.is_nan() || leave.is_nan() {
            return None;
        }
        let [low, high] = scalars.iter().fold([0.0; 2], |[low, high], &s| [f64::min(low, s), f64::max(high, s)]);
        let scalar = [enter, leave].map(|t| gradient.dot(start + direction * t - a).clamp(low, high));
        let beside = self.rounding + 2e-6 * size;
        let steepest = 1.0 + f64::max(enter_slope, leave_slope);
        Some(Found {
            depth: [enter, leave].map(|t| a.z + t),
            scalar,
            length: (leave - enter) * direction.length(),
            tolerance: beside * steepest,
            scalar_tolerance: gradient.length() * beside * steepest + 2e-6 * (high - low) + 2.0 * LATTICE_STEP,
        })
    }
}

pub(super) fn corners(points: &[[i32; 4]], cell: [u32; 4]) -> [DVec3; 4] {
    crate::lattice::bare(&cell).map(|v| {
        let [x, y, z, _] = points[v as usize];
        DVec3::new(x.into(), y.into(), z.into()) * LATTICE_STEP
    })
}

/// From the first corner's.
fn scalars(points: &[[i32; 4]], cell: [u32; 4]) -> [f64; 4] {
    let scalars = crate::lattice::bare(&cell).map(|v| f64::from(points[v as usize][3]) * LATTICE_STEP);
    scalars.map(|s| s - scalars[0])
}
