//! Runs of points or cells that two boxes of a grid share.

use super::super::tuples::Run;

/// A box within a larger grid.
#[derive(Clone, Copy, Debug)]
pub(in crate::vtk) struct Place {
    /// The grid's length along i, j and k.
    pub(in crate::vtk) dims: [usize; 3],
    /// Where the box begins in it.
    pub(in crate::vtk) at: [usize; 3],
}

/// What a box takes in each of two grids: runs along i of `(from, to, length)`.
pub(in crate::vtk) fn runs(length: [usize; 3], from: Place, to: Place) -> Vec<Run> {
    let index = |place: &Place, j: usize, k: usize| {
        place.at[0] + place.dims[0] * (place.at[1] + j + place.dims[1] * (place.at[2] + k))
    };
    let mut all = Vec::with_capacity(length[1] * length[2]);
    for k in 0..length[2] {
        all.extend((0..length[1]).map(|j| (index(&from, j, k), index(&to, j, k), length[0])));
    }
    all
}

/// The parts of runs whose `from` is taken.
pub(in crate::vtk) fn taken_runs(runs: &[Run], is_taken: impl Fn(usize) -> bool) -> Vec<Run> {
    let mut all: Vec<Run> = Vec::new();
    for &(from, to, length) in runs {
        let mut open = false;
        for step in 0..length {
            let taken = is_taken(from + step);
            match all.last_mut() {
                Some(last) if open && taken => last.2 += 1,
                _ if taken => all.push((from + step, to + step, 1)),
                _ => {}
            }
            open = taken;
        }
    }
    all
}

/// The smallest box that holds all cells that are taken: where it begins, and its length; nothing where none is.
pub(in crate::vtk) fn box_of(dims: [usize; 3], is_taken: impl Fn(usize) -> bool) -> Option<([usize; 3], [usize; 3])> {
    let (mut low, mut end) = ([usize::MAX; 3], [0; 3]);
    let mut cell = 0;
    for k in 0..dims[2] {
        for j in 0..dims[1] {
            for i in 0..dims[0] {
                if is_taken(cell) {
                    for (axis, place) in [i, j, k].into_iter().enumerate() {
                        low[axis] = low[axis].min(place);
                        end[axis] = end[axis].max(place + 1);
                    }
                }
                cell += 1;
            }
        }
    }
    (end[0] > 0).then(|| (low, [0, 1, 2].map(|axis| end[axis] - low[axis])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_a_box() {
        let from = Place { dims: [2, 2, 1], at: [0; 3] };
        let to = Place { dims: [4, 3, 2], at: [1, 1, 1] };
        let all = runs([2, 2, 1], from, to);
        assert_eq!(all, [(0, 17, 2), (2, 21, 2)]);
        assert_eq!(taken_runs(&all, |from| from != 1), [(0, 17, 1), (2, 21, 2)]);
        assert_eq!(taken_runs(&[(0, 0, 3)], |from| from != 1), [(0, 0, 1), (2, 2, 1)]);
        assert_eq!(box_of([3, 2, 2], |cell| cell == 4 || cell == 11), Some(([1, 1, 0], [2, 1, 2])));
        assert_eq!(box_of([3, 2, 2], |_| false), None);
    }
}
