//! Structured blocks: five tetrahedra a hexahedron, in a checkerboard.

use rayon::prelude::*;

use super::sink::{Part, Sink, Winding};
use crate::StructuredBlock;
use crate::orientation::Space;

/// Where i + j + k is even: the central tetrahedron joins the corners (0,0,0) (1,1,0) (1,0,1) (0,1,1), then one at
/// each of the other corners. Corners are numbered i + 2 j + 4 k.
const EVEN: [[usize; 4]; 5] = [[0, 3, 6, 5], [1, 0, 5, 3], [2, 0, 3, 6], [4, 0, 6, 5], [7, 3, 5, 6]];
/// Where it is odd: the central tetrahedron joins (1,0,0) (0,1,0) (0,0,1) (1,1,1).
const ODD: [[usize; 4]; 5] = [[1, 2, 4, 7], [0, 1, 2, 4], [3, 1, 7, 2], [5, 1, 4, 7], [6, 2, 7, 4]];

/// Rows of cells that one task cuts.
const ROWS_PER_TASK: usize = 256;

/// Point indices of a cell's corners, numbered i + 2 j + 4 k.
pub(super) fn corners(block: &StructuredBlock, i: usize, j: usize, k: usize) -> [usize; 8] {
    let [ni, nj, _] = block.dims;
    let first = block.first_point + i + ni * (j + nj * k);
    let layer = first + ni * nj;
    [first, first + 1, first + ni, first + ni + 1, layer, layer + 1, layer + ni, layer + ni + 1]
}

/// Calls `each(cell within the block, i, j, k)` for the cells of some rows; row r has j + k (nj - 1) = r.
pub(super) fn for_cells(
    block: &StructuredBlock,
    rows: std::ops::Range<usize>,
    mut each: impl FnMut(usize, [usize; 3]),
) {
    let [cells_i, cells_j, _] = block.dims.map(|n| n.saturating_sub(1));
    for row in rows {
        for i in 0..cells_i {
            each(row * cells_i + i, [i, row % cells_j, row / cells_j]);
        }
    }
}

/// Number of rows of cells.
pub(super) fn row_count(block: &StructuredBlock) -> usize {
    if block.dims[0] < 2 { 0 } else { block.dims[1].saturating_sub(1) * block.dims[2].saturating_sub(1) }
}

/// Runs of rows, in order, for tasks.
pub(super) fn row_runs(block: &StructuredBlock) -> Vec<std::ops::Range<usize>> {
    let rows = row_count(block);
    (0..rows).step_by(ROWS_PER_TASK).map(|start| start..(start + ROWS_PER_TASK).min(rows)).collect()
}

/// Cuts the taken cells of one block, whose first cell has the index `first_cell`.
pub(super) fn cut(block: &StructuredBlock, first_cell: usize, taken: &[bool], space: &Space<'_>) -> Vec<Part> {
    let cut_rows = |rows| {
        let mut sink = Sink::new(space);
        for_cells(block, rows, |cell, [i, j, k]| {
            let cell = first_cell + cell;
            if !taken[cell] {
                return;
            }
            let corners = corners(block, i, j, k);
            let pattern = if (i + j + k) % 2 == 0 { &EVEN } else { &ODD };
            for places in pattern {
                sink.push(places.map(|place| corners[place] as u32));
            }
            sink.end_group(cell as u32, Winding::Fixed);
        });
        sink.into_part()
    };
    row_runs(block).into_par_iter().map(cut_rows).collect()
}
