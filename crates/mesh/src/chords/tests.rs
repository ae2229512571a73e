//! Mean chords with known answers, and against the segments of random rays.

use glam::DVec3;

use super::*;

use crate::{CellId, Dataset, decompose, rings_sample};

fn mesh_of(dataset: &Dataset) -> TetMesh {
    decompose(dataset).expect("the sample is good").mesh
}

/// A regular tetrahedron of edge `e` has the volume `e^3 / (6 sqrt 2)` and the surface `sqrt 3 e^2`.
#[test]
fn regular_tetrahedron() {
    for scale in [1e-9, 1e-3, 1.0, 7.0, 1e9, 1e120] {
        let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
        let corners = corners.map(|corner| DVec3::from(corner) * scale);
        let mesh = TetMesh::from_tetrahedra(&corners, &[[0, 1, 2, 3]]).unwrap().mesh;
        let found = chord_lengths(&mesh).unwrap();
        let edge = 8.0_f64.sqrt() * scale;
        // Some ten roundings of coordinates that are rounded themselves.
        assert!((found.longest / edge - 1.0).abs() < 1e-14, "{found:?} at {scale}");
        let mean = edge * 4.0 / (6.0 * 6.0_f64.sqrt());
        assert!((found.mean / mean - 1.0).abs() < 1e-14, "{found:?} at {scale}, expected {mean}");
    }
}

/// The mean is that over all segments, in which large cells have many: not the mean of the cells' means.
#[test]
fn cells_count_by_their_surface() {
    let large = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let small = large.map(|p| p * 0.25 + DVec3::splat(2.0));
    let points = [large, small].concat();
    let both = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3], [4, 5, 6, 7]]).unwrap().mesh;
    let one = TetMesh::from_tetrahedra(&points, &[[0, 1, 2, 3]]).unwrap().mesh;
    let ratio = chord_lengths(&both).unwrap().mean / chord_lengths(&one).unwrap().mean;
    let expected = (1.0 + 0.25_f64.powi(3)) / (1.0 + 0.25_f64.powi(2));
    assert!((ratio - expected).abs() < 1e-14, "{ratio}, expected {expected}");
}

#[test]
fn lengths_follow_the_scale() {
    let unit = chord_lengths(&mesh_of(&rings_sample(5))).unwrap();
    for scale in [1e-9, 1e9, 1e200] {
        let mut dataset = rings_sample(5);
        dataset.points.iter_mut().for_each(|point| *point *= scale);
        let found = chord_lengths(&mesh_of(&dataset)).unwrap();
        assert!((found.mean / scale / unit.mean - 1.0).abs() < 1e-13, "{found:?} at {scale}");
        assert!((found.longest / scale / unit.longest - 1.0).abs() < 1e-13, "{found:?} at {scale}");
    }
}

#[test]
fn nothing_to_meet() {
    let mesh = mesh_of(&rings_sample(1)).retain(|_| false);
    assert_eq!(chord_lengths(&mesh), None);
}

/// Evenly spread lines: through a random point of a disk about the origin, across a random direction.
#[test]
fn random_rays_have_this_mean() {
    // The sample reaches to (1.18, 1.18, 0) and (1, 1, 1).
    const RADIUS: f64 = 1.8;
    const LINES: usize = 6000;
    let mesh = mesh_of(&rings_sample(3));
    let expected = chord_lengths(&mesh).unwrap();
    let mut random = Random(1);
    // Per line the number of segments and their length: segments of one line are not independent, lines are.
    let mut lines = Vec::with_capacity(LINES);
    for _ in 0..LINES {
        let direction = random.direction();
        let (right, up) = direction.any_orthonormal_pair();
        let (radius, angle) = (RADIUS * random.unit().sqrt(), std::f64::consts::TAU * random.unit());
        let origin = right * (radius * angle.cos()) + up * (radius * angle.sin());
        let chords = (0..mesh.tetrahedra().len()).filter_map(|cell| {
            let corners = mesh.corners(CellId(cell as u32)).map(|p| mesh.frame().to_world(p));
            chord(corners, origin, direction)
        });
        let (mut count, mut length) = (0.0, 0.0);
        for chord in chords {
            assert!(chord <= expected.longest * (1.0 + 1e-12), "{chord} is longer than {}", expected.longest);
            (count, length) = (count + 1.0, length + chord);
        }
        lines.push((count, length));
    }
    let segments: f64 = lines.iter().map(|line| line.0).sum();
    let mean = lines.iter().map(|line| line.1).sum::<f64>() / segments;
    // Standard error of a ratio of sums: the deviations of each line from the ratio.
    let variance: f64 = lines.iter().map(|(count, length)| (length - count * expected.mean).powi(2)).sum();
    let standard_error = variance.sqrt() / segments;
    assert!(standard_error < 0.01 * expected.mean, "too few lines to tell: {standard_error}");
    let deviation = (mean - expected.mean) / standard_error;
    assert!(deviation.abs() < 4.0, "{mean} of {segments} segments, expected {}: {deviation} errors", expected.mean);
}

/// Length of a line in a cell of positive volume.
fn chord([a, b, c, d]: [DVec3; 4], origin: DVec3, direction: DVec3) -> Option<f64> {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    // The normals point out of the cell.
    for [p, q, r] in [[b, c, d], [a, d, c], [a, b, d], [a, c, b]] {
        let normal = (q - p).cross(r - p);
        let (room, speed) = (normal.dot(p - origin), normal.dot(direction));
        let at = room / speed;
        if speed > 0.0 { leave = leave.min(at) } else { enter = enter.max(at) }
    }
    (leave > enter).then_some(leave - enter)
}

/// Random numbers (splitmix64), the same in every run.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly over the sphere.
    fn direction(&mut self) -> DVec3 {
        let (z, angle) = (2.0 * self.unit() - 1.0, std::f64::consts::TAU * self.unit());
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z)
    }
}
