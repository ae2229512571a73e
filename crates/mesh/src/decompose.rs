//! Cells of any kind become tetrahedra, by one fixed rule.

mod added;
mod as_dataset;
mod cell_data;
mod counts;
mod layout;
mod linear;
mod quadratic;
mod sink;
mod structured;
mod survey;
mod unstructured;

#[cfg(test)]
mod hostile_tests;
#[cfg(test)]
mod tests;

pub use added::AddedPoint;
pub use cell_data::cell_data_to_points;
pub use counts::DecompositionCounts;
pub use layout::check_layout;

use rayon::prelude::*;

use crate::orientation::Space;
use crate::{Cells, Dataset, Frame, MeshError, TetMesh};
use added::Added;
use sink::Part;
use survey::Survey;
use unstructured::Unstructured;

/// The most tetrahedra: a tetrahedron and one of its corners fit in 32 bits together, with one value left for "none".
pub(crate) const MOST_TETRAHEDRA: usize = (1 << 30) - 1;
/// The most points, added ones included.
const MOST_POINTS: usize = u32::MAX as usize;

/// A dataset cut into tetrahedra.
#[derive(Clone, Debug)]
pub struct Decomposition {
    /// The tetrahedra. Its points are the dataset's in their order, followed by the added ones.
    pub mesh: TetMesh,
    /// Points that the dataset does not have; the first has the index of the dataset's number of points.
    pub added_points: Vec<AddedPoint>,
    /// What was found and left out.
    pub counts: DecompositionCounts,
}

impl Decomposition {
    /// Extends a point array of the dataset by values at the added points: the weighted means of their parents.
    ///
    /// `values` has one entry a point of the dataset; entries beyond are dropped, and missing ones are NaN.
    pub fn point_scalars(&self, values: &[f64]) -> Vec<f64> {
        let dataset_points = self.mesh.positions().len() - self.added_points.len();
        let mut scalars = Vec::with_capacity(self.mesh.positions().len());
        scalars.extend_from_slice(&values[..values.len().min(dataset_points)]);
        scalars.resize(dataset_points, f64::NAN);
        scalars.extend(self.added_points.iter().map(|point| point.scalar(values)));
        scalars
    }
}

/// Cuts all cells of a dataset into tetrahedra.
///
/// - Structured blocks: five tetrahedra a hexahedron, in a checkerboard. Where i + j + k of the cell within its block
///   is even, the central one joins the corners (0,0,0) (1,1,0) (1,0,1) (0,1,1), where odd the other four.
/// - Linear cells of unstructured grids: each face is cut through its corner of smallest point index, and the cell is
///   the cone from its own smallest point index over the faces that do not touch it. A hexahedron or voxel gives six,
///   a wedge three, a pyramid two, a pentagonal prism nine, a hexagonal prism twelve.
/// - Quadratic cells: cut along their mid-edge points into linear cells, which follow the rule above. A tetrahedron
///   gives eight: four at its corners, and its inner octahedron coned from the mid-edge point of smallest index. A
///   hexahedron falls into eight hexahedra, a wedge into eight wedges (four where it is linear between its triangles),
///   a pyramid into six pyramids and four tetrahedra. Centers of quadrilateral faces, and of hexahedra, that the kind
///   does not have are added by the serendipity shape functions; both neighbors of a face use the same added point.
/// - Polyhedra: from the mean of their points, which is added, over their faces, each cut into the triangles that
///   meet in its point of smallest index.
///
/// So cells that share the points of a face share the triangles of that face, whatever the order of cells and points.
/// The rule of structured and that of unstructured cells do not agree with each other.
///
/// Orientation is decided exactly. A tetrahedron that is flat in the coordinates of the file, or so nearly flat
/// that the local frame cannot hold it, is left out; one of negative volume has two points exchanged. Both
/// are counted, as are cells that are not cut at all: see [`DecompositionCounts`]. The frame is fitted to the points
/// of the cells that are cut.
///
/// The order of tetrahedra is that of the cells, and the result does not depend on the number of threads.
///
/// # Errors
///
/// [`MeshError::NoPoints`], [`MeshError::NoCells`], [`MeshError::NoSolidCell`] and [`MeshError::NoVolume`] where nothing
/// is left to draw, [`MeshError::TooLarge`] beyond 2³² - 1 points or 2³⁰ - 1 tetrahedra, and
/// [`MeshError::Inconsistent`] where the layout of the cells breaks its own rules.
pub fn decompose(dataset: &Dataset) -> Result<Decomposition, MeshError> {
    check_layout(dataset)?;
    if dataset.points.is_empty() {
        return Err(MeshError::NoPoints);
    }
    let unstructured = match &dataset.cells {
        Cells::Unstructured(cells) => Some(Unstructured::new(cells)),
        Cells::Structured(_) => None,
    };
    let survey = survey(dataset, unstructured.as_ref());
    if survey.taken.is_empty() {
        return Err(MeshError::NoCells { points: dataset.points.len() });
    }
    if !survey.taken.contains(&true) {
        return Err(MeshError::NoSolidCell { cells: survey.taken.len(), left_out: survey.counts.left_out_words() });
    }

    let added = match &unstructured {
        Some(cells) => {
            let taken = (0..cells.len()).filter(|&cell| survey.taken[cell]);
            Added::collect(dataset.points.len(), taken.map(|cell| (cell as u32, cells.view(cell))))
        }
        None => Added::default(),
    };
    let point_count = dataset.points.len() + added.points.len();
    if point_count > MOST_POINTS {
        return Err(MeshError::TooLarge { what: "points", count: point_count, limit: MOST_POINTS });
    }

    let frame = Frame::fitting(survey.lowest, survey.highest);
    let mut positions = Vec::with_capacity(point_count);
    dataset.points.par_iter().map(|&point| frame.to_local(point)).collect_into_vec(&mut positions);
    let centers: Vec<_> = added.points.iter().map(|point| point.position(&positions)).collect();
    positions.extend(centers);

    let space = Space { world: &dataset.points, local: &positions, scale: frame.scale };
    let parts = match (&dataset.cells, &unstructured) {
        (Cells::Structured(blocks), _) => {
            let mut parts = Vec::new();
            let mut first_cell = 0;
            for block in blocks {
                parts.extend(structured::cut(block, first_cell, &survey.taken, &space));
                first_cell += block.cell_count();
            }
            parts
        }
        (_, Some(cells)) => cells.cut(&survey.taken, &added, &space),
        (_, None) => Vec::new(),
    };
    assemble(parts, frame, positions, added.points, survey.counts)
}

/// The first look at the cells of either layout.
fn survey(dataset: &Dataset, unstructured: Option<&Unstructured<'_>>) -> Survey {
    match (&dataset.cells, unstructured) {
        (Cells::Structured(blocks), _) => Survey::structured(blocks, &dataset.points),
        (_, Some(cells)) => Survey::unstructured(cells, &dataset.points),
        (_, None) => Survey::default(),
    }
}

/// Joins what the tasks have cut, in order.
fn assemble(
    parts: Vec<Part>,
    frame: Frame,
    positions: Vec<glam::DVec3>,
    added_points: Vec<AddedPoint>,
    mut counts: DecompositionCounts,
) -> Result<Decomposition, MeshError> {
    let kept = parts.iter().map(|part| part.tetrahedra.len()).sum();
    if kept > MOST_TETRAHEDRA {
        return Err(MeshError::TooLarge { what: "tetrahedra", count: kept, limit: MOST_TETRAHEDRA });
    }
    let mut tetrahedra = Vec::with_capacity(kept);
    let mut source_cells = Vec::with_capacity(kept);
    for part in parts {
        tetrahedra.extend_from_slice(&part.tetrahedra);
        source_cells.extend_from_slice(&part.source_cells);
        counts.tetrahedra += part.seen;
        counts.no_volume += part.no_volume;
        counts.inverted += part.inverted;
    }
    if tetrahedra.is_empty() {
        return Err(MeshError::NoVolume { tetrahedra: counts.tetrahedra });
    }
    Ok(Decomposition {
        mesh: TetMesh { frame, positions, tetrahedra, source_cells, originals: Vec::new() },
        added_points,
        counts,
    })
}
