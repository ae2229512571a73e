//! Unstructured cells: one view of each, and how each kind is cut.

use rayon::prelude::*;

use super::added::Added;
use super::linear::{self, Faces, cut, fan};
use super::quadratic::{MOST_SLOTS, Recipe, recipe};
use super::sink::{Part, Sink, Winding};
use crate::orientation::Space;
use crate::{CellKind, UnstructuredCells};

/// Cells that one task cuts.
const CELLS_PER_TASK: usize = 8192;

/// One cell: its kind, as many points as its kind has, and the faces of a polyhedron.
#[derive(Clone, Copy)]
pub(super) struct CellView<'a> {
    pub(super) kind: CellKind,
    pub(super) points: &'a [u32],
    /// Empty but for polyhedra.
    pub(super) faces: &'a [Vec<u32>],
}

/// The cells with an index of their polyhedra.
pub(super) struct Unstructured<'a> {
    cells: &'a UnstructuredCells,
    /// Which cells are polyhedra, ascending.
    polyhedra: Vec<usize>,
}

impl<'a> Unstructured<'a> {
    pub(super) fn new(cells: &'a UnstructuredCells) -> Self {
        let is_polyhedron = |&cell: &usize| cells.kinds[cell] == CellKind::Polyhedron;
        let polyhedra = if cells.polyhedra.is_empty() {
            Vec::new()
        } else {
            (0..cells.kinds.len()).filter(is_polyhedron).collect()
        };
        Self { cells, polyhedra }
    }

    pub(super) fn len(&self) -> usize {
        self.cells.kinds.len()
    }

    /// All points that the file gives for a cell.
    pub(super) fn all_points(&self, cell: usize) -> &'a [u32] {
        &self.cells.connectivity[self.cells.offsets[cell]..self.cells.offsets[cell + 1]]
    }

    /// A cell with as many points as its kind has, or all if they are fewer.
    #[inline]
    pub(super) fn view(&self, cell: usize) -> CellView<'a> {
        let kind = self.cells.kinds[cell];
        let all = self.all_points(cell);
        let points = point_count(kind).and_then(|count| all.get(..count)).unwrap_or(all);
        let faces = match kind {
            CellKind::Polyhedron => {
                self.polyhedra.binary_search(&cell).map_or(&[][..], |rank| self.cells.polyhedra[rank].as_slice())
            }
            _ => &[],
        };
        CellView { kind, points, faces }
    }

    /// Runs of cells, in order, for tasks.
    pub(super) fn runs(&self) -> Vec<std::ops::Range<usize>> {
        (0..self.len()).step_by(CELLS_PER_TASK).map(|start| start..(start + CELLS_PER_TASK).min(self.len())).collect()
    }

    /// Cuts the taken cells.
    pub(super) fn cut(&self, taken: &[bool], added: &Added, space: &Space<'_>) -> Vec<Part> {
        let cut_run = |run: std::ops::Range<usize>| {
            let mut sink = Sink::new(space);
            for cell in run.filter(|&cell| taken[cell]) {
                cut_cell(cell as u32, &self.view(cell), added, &mut sink);
            }
            sink.into_part()
        };
        self.runs().into_par_iter().map(cut_run).collect()
    }
}

/// Number of points of a kind that has a fixed number.
pub(super) fn point_count(kind: CellKind) -> Option<usize> {
    match kind {
        CellKind::Tetrahedron => Some(4),
        CellKind::Voxel | CellKind::Hexahedron => Some(8),
        CellKind::Wedge => Some(6),
        CellKind::Pyramid => Some(5),
        CellKind::PentagonalPrism => Some(10),
        CellKind::HexagonalPrism => Some(12),
        CellKind::Polyhedron | CellKind::Flat | CellKind::FlatOf(_) | CellKind::Other(_) => None,
        quadratic => recipe(quadratic).map(|recipe| recipe.own),
    }
}

/// Faces of a linear kind, and whether the order of its points fixes its orientation.
///
/// Wedges and prisms come both ways round in files (VTK's own text and its data differ), so they are taken either way.
fn linear_faces(kind: CellKind) -> Option<(Faces, Winding)> {
    match kind {
        CellKind::Voxel => Some((linear::VOXEL, Winding::Fixed)),
        CellKind::Hexahedron => Some((linear::HEXAHEDRON, Winding::Fixed)),
        CellKind::Pyramid => Some((linear::PYRAMID, Winding::Fixed)),
        CellKind::Wedge => Some((linear::WEDGE, Winding::Either)),
        CellKind::PentagonalPrism => Some((linear::PENTAGONAL_PRISM, Winding::Either)),
        CellKind::HexagonalPrism => Some((linear::HEXAGONAL_PRISM, Winding::Either)),
        _ => None,
    }
}

fn cut_cell(cell: u32, view: &CellView<'_>, added: &Added, sink: &mut Sink<'_>) {
    if let (CellKind::Tetrahedron, &[a, b, c, d]) = (view.kind, view.points) {
        sink.push([a, b, c, d]);
        sink.end_group(cell, Winding::Fixed);
    } else if view.kind == CellKind::Polyhedron {
        let apex = added.cell_center(cell);
        for face in view.faces {
            // Faces are turned either way, so only the triangles of one face can disagree.
            fan(face.len(), |place| face[place], |[a, b, c]| sink.push([apex, a, b, c]));
            sink.end_group(cell, Winding::Either);
        }
    } else if let Some((faces, winding)) = linear_faces(view.kind) {
        cut(view.points, faces, |tetrahedron| sink.push(tetrahedron));
        sink.end_group(cell, winding);
    } else if let Some(recipe) = recipe(view.kind) {
        cut_quadratic(cell, recipe, view.points, added, sink);
    }
}

fn cut_quadratic(cell: u32, recipe: &Recipe, points: &[u32], added: &Added, sink: &mut Sink<'_>) {
    let mut slots = [0; MOST_SLOTS];
    slots[..points.len()].copy_from_slice(points);
    for face in recipe.faces.iter().filter(|face| usize::from(face.center) >= recipe.own) {
        slots[usize::from(face.center)] = added.face_center(face, points);
    }
    if recipe.has_center && recipe.own < recipe.slots {
        slots[recipe.slots - 1] = added.cell_center(cell);
    }
    for (faces, places) in recipe.parts {
        let mut corners = [0; linear::MOST_POINTS];
        for (corner, &slot) in corners.iter_mut().zip(*places) {
            *corner = slots[usize::from(slot)];
        }
        cut(&corners[..places.len()], faces, |tetrahedron| sink.push(tetrahedron));
    }
    sink.end_group(cell, recipe.winding);
}
