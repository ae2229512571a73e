//! Cell values averaged onto points.

use super::survey;
use super::unstructured::Unstructured;
use super::{check_layout, structured};
use crate::{Cells, Dataset};

/// The mean of a cell array over the cells around each point.
///
/// - `values`: one entry a cell of the dataset; missing ones do not count
///
/// One entry a point of the dataset. Cells that [`decompose`](crate::decompose()) does not cut (flat, hidden, malformed)
/// and values that are not finite do not take part; a point with no other cell gets NaN. Each cell counts once, whatever
/// its size. A dataset whose layout is inconsistent gives NaN everywhere.
pub fn cell_data_to_points(dataset: &Dataset, values: &[f64]) -> Vec<f64> {
    let point_count = dataset.points.len();
    if check_layout(dataset).is_err() {
        return vec![f64::NAN; point_count];
    }
    let mut means = vec![0.0; point_count];
    let mut counts = vec![0_u32; point_count];
    let mut add = |point: usize, value: f64| {
        // A running mean: a sum could overflow where the values are near the largest float.
        counts[point] += 1;
        let share = 1.0 / f64::from(counts[point]);
        means[point] = means[point] * (1.0 - share) + value * share;
    };
    let value_of = |cell: usize| values.get(cell).copied().filter(|value| value.is_finite());
    match &dataset.cells {
        Cells::Unstructured(cells) => {
            let cells = Unstructured::new(cells);
            let taken = survey::Survey::unstructured(&cells, &dataset.points).taken;
            for cell in (0..cells.len()).filter(|&cell| taken[cell]) {
                let Some(value) = value_of(cell) else { continue };
                let view = cells.view(cell);
                if view.faces.is_empty() {
                    distinct(view.points.to_vec()).for_each(|point| add(point, value));
                } else {
                    distinct(view.faces.concat()).for_each(|point| add(point, value));
                }
            }
        }
        Cells::Structured(blocks) => {
            let taken = survey::Survey::structured(blocks, &dataset.points).taken;
            let mut first_cell = 0;
            for block in blocks {
                structured::for_cells(block, 0..structured::row_count(block), |cell, [i, j, k]| {
                    if let (true, Some(value)) = (taken[first_cell + cell], value_of(first_cell + cell)) {
                        structured::corners(block, i, j, k).into_iter().for_each(|point| add(point, value));
                    }
                });
                first_cell += block.cell_count();
            }
        }
    }
    for (mean, _) in means.iter_mut().zip(&counts).filter(|(_, count)| **count == 0) {
        *mean = f64::NAN;
    }
    means
}

/// Each point of a cell once: collapsed cells name some twice.
fn distinct(mut points: Vec<u32>) -> impl Iterator<Item = usize> {
    points.sort_unstable();
    points.dedup();
    points.into_iter().map(|point| point as usize)
}
