//! Cells and points that are marked as copies of other pieces' ones, or as hidden.
//!
//! Source: the bits of `vtkDataSetAttributes`' CellGhostTypes and PointGhostTypes, and `vtkGhostLevels`, which VTK wrote before version 7.

use tetrascope_mesh::{Cells, DataArray, Dataset, UnstructuredCells};

use super::super::scalars::to_indices;
use super::super::tuples::kept;

/// A copy of another piece's cell, one that finer cells cover, one that is hidden. Other bits tell of the neighborhood.
const LEFT_OUT_CELL: i64 = 1 | 8 | 32;

/// A point that is hidden, with all its cells. A point that is a copy is as good as any.
const HIDDEN_POINT: i64 = 2;

/// Takes the marks out of the arrays of cells: `true` for those that are left out. Empty where none is.
pub(in crate::vtk) fn left_out_cells(arrays: &mut Vec<DataArray>) -> Vec<bool> {
    let types = take(arrays, "vtkGhostType").map(|marks| marks.iter().map(|mark| mark & LEFT_OUT_CELL != 0).collect());
    let levels = take(arrays, "vtkGhostLevels").map(|levels| levels.iter().map(|&level| level > 0).collect());
    some_of(types.or(levels))
}

/// Takes the marks out of the arrays of points: `true` for those that are hidden. Empty where none is.
pub(in crate::vtk) fn hidden_points(arrays: &mut Vec<DataArray>) -> Vec<bool> {
    take(arrays, "vtkGhostLevels");
    let types = take(arrays, "vtkGhostType");
    some_of(types.map(|marks| marks.iter().map(|mark| mark & HIDDEN_POINT != 0).collect()))
}

fn some_of(flags: Option<Vec<bool>>) -> Vec<bool> {
    flags.filter(|flags| flags.contains(&true)).unwrap_or_default()
}

/// The marks under a name, if they are whole numbers, one a tuple; what else has the name stays.
fn take(arrays: &mut Vec<DataArray>, name: &str) -> Option<Vec<i64>> {
    let at = arrays.iter().position(|array| array.name == name && array.components == 1)?;
    let marks = to_indices(&arrays[at].values)?;
    arrays.remove(at);
    Some(marks)
}

/// Leaves the cells out that are marked, with their values, and says so.
pub(in crate::vtk) fn leave_out_ghosts(dataset: &mut Dataset, warnings: &mut Vec<String>) {
    let left_out = left_out_cells(&mut dataset.cell_arrays);
    let hidden = hidden_points(&mut dataset.point_arrays);
    let Cells::Unstructured(cells) = &mut dataset.cells else { return };
    if left_out.is_empty() && hidden.is_empty() {
        return;
    }
    let is_hidden = |point: &u32| hidden.get(*point as usize) == Some(&true);
    let keep: Vec<bool> = (0..cells.kinds.len())
        .map(|cell| {
            let points = &cells.connectivity[cells.offsets[cell]..cells.offsets[cell + 1]];
            left_out.get(cell) != Some(&true) && !points.iter().any(is_hidden)
        })
        .collect();
    let gone = keep.iter().filter(|keep| !**keep).count();
    if gone == 0 {
        return;
    }
    keep_cells(cells, &keep);
    for array in &mut dataset.cell_arrays {
        array.values = kept(&array.values, array.components, &keep);
    }
    warnings.push(format!("{gone} of {} cells are left out: {WHY}", keep.len()));
}

/// Why cells are left out.
pub(in crate::vtk) const WHY: &str = "they are marked as copies of other pieces' cells, as refined or as hidden";

fn keep_cells(cells: &mut UnstructuredCells, keep: &[bool]) {
    let all = std::mem::take(cells);
    let mut polyhedra = all.polyhedra.into_iter();
    for (cell, (&kind, &keep)) in all.kinds.iter().zip(keep).enumerate() {
        let faces = if kind == tetrascope_mesh::CellKind::Polyhedron { polyhedra.next() } else { None };
        if keep {
            cells.connectivity.extend_from_slice(&all.connectivity[all.offsets[cell]..all.offsets[cell + 1]]);
            cells.offsets.push(cells.connectivity.len());
            cells.kinds.push(kind);
            cells.polyhedra.extend(faces);
        }
    }
}
