//! Boxes of points on a grid, by the numbers of their first and last points.

use crate::grid::check_dims;

/// Largest number of a point along one direction, either sign: far beyond any grid, and small enough for sums and differences.
const LARGEST: i64 = 1 << 40;

/// A box of points of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::vtk) struct Extent {
    /// Numbers of the first point along i, j and k.
    pub(in crate::vtk) low: [i64; 3],
    /// Number of points along each; 0 along any where the box is empty.
    pub(in crate::vtk) dims: [usize; 3],
}

impl Extent {
    /// From first and last numbers along i, j and k, in a text. The error says what is wrong with it.
    pub(in crate::vtk) fn parse(text: &str) -> Result<Self, String> {
        let words: Result<Vec<i64>, _> = text.split_ascii_whitespace().map(str::parse).collect();
        let numbers: [i64; 6] =
            words.ok().and_then(|words| words.try_into().ok()).ok_or("it is not six whole numbers")?;
        if let Some(large) = numbers.into_iter().find(|number| number.abs() > LARGEST) {
            return Err(format!("{large} is beyond all grids"));
        }
        let [i0, i1, j0, j1, k0, k1] = numbers;
        let count = |first: i64, last: i64| usize::try_from(last - first + 1).unwrap_or(0);
        let dims = [count(i0, i1), count(j0, j1), count(k0, k1)];
        if !dims.contains(&0) {
            check_dims(dims)?;
        }
        Ok(Self { low: [i0, j0, k0], dims })
    }

    /// From numbers of points, counted from 0. The error says why they make no grid.
    pub(in crate::vtk) fn of_dims(dims: [usize; 3]) -> Result<Self, String> {
        if !dims.contains(&0) {
            check_dims(dims)?;
        }
        Ok(Self { low: [0; 3], dims })
    }

    /// Whether it has no point.
    pub(in crate::vtk) fn is_empty(&self) -> bool {
        self.dims.contains(&0)
    }

    /// Number of points.
    pub(in crate::vtk) fn point_count(&self) -> usize {
        self.dims.iter().product()
    }

    /// The numbers of cells along i, j and k. A direction with one point has one layer of flat cells.
    pub(in crate::vtk) fn cell_dims(&self) -> [usize; 3] {
        if self.is_empty() { [0; 3] } else { self.dims.map(|n| (n - 1).max(1)) }
    }

    /// Number of cells, flat ones included.
    pub(in crate::vtk) fn cell_count(&self) -> usize {
        self.cell_dims().iter().product()
    }

    /// Whether its cells have no volume.
    pub(in crate::vtk) fn is_flat(&self) -> bool {
        self.dims.contains(&1)
    }

    /// The smallest box that holds all of these; nothing where it has more points than a mesh can have.
    pub(in crate::vtk) fn around(boxes: impl Iterator<Item = Self>) -> Option<Self> {
        let ends = |e: &Self| [0, 1, 2].map(|axis| e.low[axis] + e.dims[axis] as i64);
        let (low, end) = boxes.filter(|one| !one.is_empty()).fold(([i64::MAX; 3], [i64::MIN; 3]), |(low, end), one| {
            let others = ends(&one);
            ([0, 1, 2].map(|axis| low[axis].min(one.low[axis])), [0, 1, 2].map(|axis| end[axis].max(others[axis])))
        });
        let mut dims = [0; 3];
        for axis in 0..3 {
            dims[axis] = usize::try_from(end[axis].checked_sub(low[axis])?).ok()?;
        }
        check_dims(dims).ok()?;
        Some(Self { low, dims })
    }

    /// Where this box begins in a larger one that holds it.
    pub(in crate::vtk) fn within(&self, larger: &Self) -> [usize; 3] {
        [0, 1, 2].map(|axis| usize::try_from(self.low[axis] - larger.low[axis]).unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_from_text() {
        let one = Extent::parse(" -2 3 0 1\n5 5").unwrap();
        assert_eq!((one.low, one.dims), ([-2, 0, 5], [6, 2, 1]));
        assert_eq!((one.point_count(), one.cell_count(), one.is_flat()), (12, 5, true));
        assert!(Extent::parse("0 -1 0 -1 0 -1").unwrap().is_empty());
        for broken in ["", "0 1 0 1 0", "0 1 0 1 0 x", "0 4000000000 0 1 0 1", "0 9223372036854775807 0 1 0 1"] {
            assert!(Extent::parse(broken).is_err(), "{broken}");
        }
    }

    #[test]
    fn boxes_around_boxes() {
        let boxes = ["0 3 0 1 0 1", "3 5 -1 1 0 1", "0 -1 0 -1 0 -1"].map(|text| Extent::parse(text).unwrap());
        let all = Extent::around(boxes.into_iter()).unwrap();
        assert_eq!((all.low, all.dims), ([0, -1, 0], [6, 3, 2]));
        assert_eq!(boxes[1].within(&all), [3, 0, 0]);
        let far = ["0 1 0 1 0 1", "1000000 1000001 1000000 1000001 0 1"].map(|text| Extent::parse(text).unwrap());
        assert_eq!(Extent::around(far.into_iter()), None);
        assert_eq!(Extent::around(boxes[2..].iter().copied()), None);
    }
}
