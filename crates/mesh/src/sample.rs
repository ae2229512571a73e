//! A mesh to look at when there is no file.

use glam::{DMat3, DVec3};

use crate::{ArrayValues, Cells, DataArray, Dataset, StructuredBlock};

/// The sphere's radius; the box around it reaches from -1 to 1 before it is bent.
const RADIUS: f64 = 0.6;
/// Turn between the middle of the box and its ends, in radians.
const TWIST: f64 = 0.45;
/// How much the sides bulge, relative to their distance from the axis.
const BULGE: f64 = 0.18;
/// The most cells along a side that [`rings_sample`] makes.
const MOST_CELLS: usize = 512;

/// A bent box around a sphere, whose point array `"distance"` is the distance to the sphere's surface: negative inside.
///
/// - `cells_per_side`: hexahedra along each side, 1 to 512; numbers outside are moved to the next of these
///
/// One structured block of (n + 1)³ points about the origin, twisted about z and bulging at its waist, so that its
/// sides are curved and its cells differ. The array is exact at the points, from -0.6 at the center to about 1.1 at the
/// corners; a thin peak of extinction at a value draws a spherical shell, which shows as a ring because rays along its
/// rim stay in it longest, and several peaks draw rings within each other. In the manner of [Röttger 2000], figure 3,
/// where linear interpolation and thin peaks show what an integration method is worth.
pub fn rings_sample(cells_per_side: usize) -> Dataset {
    let cells = cells_per_side.clamp(1, MOST_CELLS);
    let side = cells + 1;
    let at = |n: usize| 2.0 * n as f64 / cells as f64 - 1.0;
    let mut points = Vec::with_capacity(side * side * side);
    for k in 0..side {
        for j in 0..side {
            points.extend((0..side).map(|i| bend(DVec3::new(at(i), at(j), at(k)))));
        }
    }
    let distance = points.iter().map(|point| point.length() - RADIUS).collect();
    Dataset {
        points,
        cells: Cells::Structured(vec![StructuredBlock { dims: [side; 3], first_point: 0, hidden_points: Vec::new() }]),
        point_arrays: vec![DataArray {
            name: "distance".to_owned(),
            components: 1,
            values: ArrayValues::F64(distance),
        }],
        cell_arrays: Vec::new(),
    }
}

/// Bends the box. One to one there: every height is turned and widened as a whole.
fn bend(point: DVec3) -> DVec3 {
    let widened = 1.0 + BULGE * (1.0 - point.z * point.z);
    DMat3::from_rotation_z(TWIST * point.z) * (point * DVec3::new(widened, widened, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decompose;

    #[test]
    fn sample_has_upright_cells_and_the_distance() {
        for cells in [1, 2, 7, 24] {
            let sample = rings_sample(cells);
            let cut = decompose(&sample).expect("the sample is good");
            assert_eq!(cut.counts.tetrahedra, 5 * cells.pow(3));
            assert_eq!(cut.counts.findings(), Vec::<String>::new());
            let distance = sample.point_arrays[0].component(0);
            for (point, found) in sample.points.iter().zip(&distance) {
                assert!((point.length() - RADIUS - found).abs() < 1e-15);
            }
        }
        assert_eq!(rings_sample(0).points.len(), 8);
        let distance = rings_sample(24).point_arrays[0].component(0);
        let lowest = distance.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = distance.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!((lowest + 0.6).abs() < 1e-12 && (1.0..1.3).contains(&highest), "{lowest} to {highest}");
    }
}
