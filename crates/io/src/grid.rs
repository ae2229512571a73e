//! Grids of points at equal distances: what images and volumes are.

use glam::DVec3;
use tetrascope_mesh::{Cells, Dataset, StructuredBlock};

/// A grid of points at equal distances along three directions, which need not be at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RegularGrid {
    /// Number of points along i, j and k; each at least 1.
    pub(crate) dims: [usize; 3],
    /// World coordinates of the first point.
    pub(crate) origin: DVec3,
    /// From a point to the next along i, j and k; world length.
    pub(crate) steps: [DVec3; 3],
}

/// Points that a mesh can have: their numbers have 32 bits, of which one is never a point's.
const MOST_POINTS: usize = u32::MAX as usize - 1;

/// Why dims make no grid: in words, with the limit.
pub(crate) fn check_dims(dims: [usize; 3]) -> Result<usize, String> {
    let [i, j, k] = dims;
    if dims.contains(&0) {
        return Err(format!("{i} x {j} x {k} points are no grid: each must be at least 1"));
    }
    i.checked_mul(j)
        .and_then(|ij| ij.checked_mul(k))
        .filter(|&points| points <= MOST_POINTS)
        .ok_or_else(|| format!("{i} x {j} x {k} points are more than the {MOST_POINTS} that a mesh can have"))
}

impl RegularGrid {
    /// The grid as a dataset without arrays, i fastest. What its points take is the caller's to have seen in the file: one number a point at least.
    pub(crate) fn dataset(&self) -> Dataset {
        let [i_count, j_count, k_count] = self.dims;
        let [i_step, j_step, k_step] = self.steps;
        let mut points = Vec::with_capacity(i_count * j_count * k_count);
        for k in 0..k_count {
            for j in 0..j_count {
                let row = self.origin + k_step * k as f64 + j_step * j as f64;
                points.extend((0..i_count).map(|i| row + i_step * i as f64));
            }
        }
        let block = StructuredBlock { dims: self.dims, first_point: 0, hidden_points: Vec::new() };
        Dataset { points, cells: Cells::Structured(vec![block]), ..Dataset::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_come_with_i_fastest() {
        let steps = [DVec3::new(1.0, 0.0, 0.5), DVec3::Y * 2.0, DVec3::Z * -3.0];
        let grid = RegularGrid { dims: [3, 2, 2], origin: DVec3::splat(10.0), steps };
        let dataset = grid.dataset();
        assert_eq!(dataset.points.len(), 12);
        assert_eq!(dataset.points[1], DVec3::new(11.0, 10.0, 10.5));
        assert_eq!(dataset.points[3], DVec3::new(10.0, 12.0, 10.0));
        assert_eq!(dataset.points[11], DVec3::new(12.0, 12.0, 8.0));
    }

    #[test]
    fn dims_that_are_none() {
        assert_eq!(check_dims([4, 3, 2]), Ok(24));
        assert!(check_dims([4, 0, 2]).is_err());
        assert!(check_dims([1 << 20, 1 << 20, 1]).is_err());
        assert!(check_dims([usize::MAX, 2, 1]).is_err());
    }
}
