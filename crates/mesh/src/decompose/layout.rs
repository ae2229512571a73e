//! Whether the arrays that lay out the cells agree with each other, so that the rest may index without looking.

use crate::{CellKind, Cells, Dataset, MeshError, StructuredBlock, UnstructuredCells};

/// The most cells, so that 32 bits name one.
const MOST_CELLS: usize = u32::MAX as usize;

/// Refuses a dataset whose layout of cells is not what [`UnstructuredCells`] and [`StructuredBlock`] promise. Arrays are not looked at.
///
/// # Errors
///
/// [`MeshError::Inconsistent`], and [`MeshError::TooLarge`] beyond 2³² - 1 cells.
pub fn check_layout(dataset: &Dataset) -> Result<(), MeshError> {
    let point_count = dataset.points.len();
    let cell_count = match &dataset.cells {
        Cells::Unstructured(cells) => {
            check_unstructured(cells, point_count)?;
            cells.kinds.len()
        }
        Cells::Structured(blocks) => {
            for (index, block) in blocks.iter().enumerate() {
                check_block(index, block, point_count)?;
            }
            blocks.iter().map(StructuredBlock::cell_count).sum()
        }
    };
    if cell_count > MOST_CELLS {
        return Err(MeshError::TooLarge { what: "cells", count: cell_count, limit: MOST_CELLS });
    }
    Ok(())
}

fn ensure(holds: bool, what: &'static str, index: usize, value: usize, limit: usize) -> Result<(), MeshError> {
    if holds { Ok(()) } else { Err(MeshError::Inconsistent { what, index, value, limit }) }
}

fn check_unstructured(cells: &UnstructuredCells, point_count: usize) -> Result<(), MeshError> {
    let UnstructuredCells { kinds, offsets, connectivity, polyhedra } = cells;
    let rows = kinds.len() + 1;
    ensure(offsets.len() == rows, "one offset more than cells", 0, offsets.len(), rows)?;
    ensure(offsets[0] == 0, "the first offset is 0", 0, offsets[0], 0)?;
    for (index, pair) in offsets.windows(2).enumerate() {
        ensure(pair[0] <= pair[1], "offsets never fall", index + 1, pair[1], pair[0])?;
    }
    let end = offsets[rows - 1];
    ensure(end == connectivity.len(), "the last offset ends the connectivity", rows - 1, end, connectivity.len())?;
    check_indices(connectivity.iter(), "point indices are below the number of points", point_count)?;
    let polyhedron_count = kinds.iter().filter(|&&kind| kind == CellKind::Polyhedron).count();
    ensure(polyhedra.len() == polyhedron_count, "faces for each polyhedron", 0, polyhedra.len(), polyhedron_count)?;
    check_indices(polyhedra.iter().flatten().flatten(), "faces of polyhedra name points that exist", point_count)
}

fn check_indices<'a>(
    mut indices: impl Iterator<Item = &'a u32>,
    what: &'static str,
    point_count: usize,
) -> Result<(), MeshError> {
    match indices.by_ref().enumerate().find(|&(_, &point)| point as usize >= point_count) {
        Some((index, &point)) => {
            Err(MeshError::Inconsistent { what, index, value: point as usize, limit: point_count })
        }
        None => Ok(()),
    }
}

fn check_block(index: usize, block: &StructuredBlock, point_count: usize) -> Result<(), MeshError> {
    let smallest = block.dims.iter().copied().min().unwrap_or(0);
    ensure(smallest >= 1, "every block has a point along each direction", index, smallest, 1)?;
    let count = block.dims.iter().try_fold(1_usize, |product, &n| product.checked_mul(n)).unwrap_or(usize::MAX);
    let end = count.saturating_add(block.first_point);
    ensure(end <= point_count, "the points of every block exist", index, end, point_count)?;
    let flags = block.hidden_points.len();
    ensure(flags == 0 || flags == count, "one hidden flag a point or none", index, flags, count)
}
