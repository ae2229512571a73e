//! Cells of grids as cells that name their points.

use tetrascope_mesh::{CellKind, StructuredBlock, UnstructuredCells};

/// Adds the cells of a block that are `taken` (cells counted i fastest). One with a hidden corner is of the kind that is not drawn.
pub(in crate::vtk) fn push_hexahedra(
    cells: &mut UnstructuredCells,
    block: &StructuredBlock,
    taken: impl Fn(usize) -> bool,
) {
    let [ni, nj, _] = block.dims;
    let [cells_i, cells_j, cells_k] = block.dims.map(|n| n.saturating_sub(1));
    // In VTK's order: round the lower quadrilateral, then round the upper one.
    let layer = ni * nj;
    let corners = [0, 1, ni + 1, ni, layer, layer + 1, layer + ni + 1, layer + ni];
    for k in 0..cells_k {
        for j in 0..cells_j {
            for i in 0..cells_i {
                let first = i + ni * (j + nj * k);
                let is_hidden = |corner: &usize| block.hidden_points.get(first + corner) == Some(&true);
                if !taken(i + cells_i * (j + cells_j * k)) {
                    continue;
                }
                let index = |corner: usize| u32::try_from(block.first_point + first + corner).unwrap_or(u32::MAX);
                cells.connectivity.extend(corners.map(index));
                cells.offsets.push(cells.connectivity.len());
                cells.kinds.push(if corners.iter().any(is_hidden) { CellKind::Flat } else { CellKind::Hexahedron });
            }
        }
    }
}
