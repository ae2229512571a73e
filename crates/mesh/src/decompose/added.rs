//! Points that the file does not have: centers of quadratic faces and hexahedra, and of polyhedra.

use glam::DVec3;

use super::quadratic::{QuadFace, Recipe, recipe};
use super::unstructured::CellView;
use crate::VertexId;

/// A point that was added to cut a cell, as a weighted mean of points of the dataset.
///
/// The same weights place it and give its scalar. They sum to 1; those of a polyhedron's centroid are equal, those of
/// quadratic cells are the serendipity shape functions at the center (corners count negatively), so that a quadratic
/// field has its own value there and one beyond the range of the cell's points is possible.
#[derive(Clone, Debug, PartialEq)]
pub struct AddedPoint {
    /// Points of the dataset and their weights, ascending by point.
    pub parents: Vec<(VertexId, f64)>,
}

impl AddedPoint {
    fn new(mut parents: Vec<(VertexId, f64)>) -> Self {
        parents.sort_by_key(|&(vertex, _)| vertex);
        parents.dedup_by(|later, kept| {
            let is_same = later.0 == kept.0;
            if is_same {
                kept.1 += later.1;
            }
            is_same
        });
        Self { parents }
    }

    pub(crate) fn position(&self, local: &[DVec3]) -> DVec3 {
        self.parents.iter().map(|&(v, weight)| local[v.index()] * weight).sum()
    }

    pub(crate) fn scalar(&self, values: &[f64]) -> f64 {
        self.parents.iter().map(|&(v, weight)| values.get(v.index()).map_or(f64::NAN, |x| x * weight)).sum()
    }
}

/// All added points of a dataset, and how cells find theirs. Face centers come first, ascending by the sorted corners
/// of the face, then the cells' own centers, ascending by cell: nothing depends on the order of work.
#[derive(Default)]
pub(super) struct Added {
    first_index: usize,
    faces: Vec<[u32; 4]>,
    cells: Vec<u32>,
    pub(super) points: Vec<AddedPoint>,
}

impl Added {
    /// Collects the points that these cells need. `first_index` is the dataset's number of points.
    pub(super) fn collect<'a>(first_index: usize, cells: impl Iterator<Item = (u32, CellView<'a>)>) -> Self {
        let mut faces = Vec::new();
        let mut centers = Vec::new();
        for (cell, view) in cells {
            if !view.faces.is_empty() {
                centers.push((cell, centroid(view.faces)));
            } else if let Some(recipe) = recipe(view.kind) {
                for face in recipe.faces.iter().filter(|face| usize::from(face.center) >= recipe.own) {
                    faces.push((key(face, view.points), AddedPoint::new(face_parents(face, view.points, 1.0))));
                }
                if recipe.has_center && recipe.own < recipe.slots {
                    centers.push((cell, hexahedron_center(recipe, view.points)));
                }
            }
        }
        // Stable, so that the first cell with a face decides where neighbors disagree about its mid-edge points.
        faces.sort_by_key(|&(key, _)| key);
        faces.dedup_by_key(|&mut (key, _)| key);
        let (faces, mut points): (Vec<_>, Vec<_>) = faces.into_iter().unzip();
        let (cells, centers): (Vec<_>, Vec<_>) = centers.into_iter().unzip();
        points.extend(centers);
        Self { first_index, faces, cells, points }
    }

    /// Index of the center of a face that [`Added::collect`] has seen.
    pub(super) fn face_center(&self, face: &QuadFace, points: &[u32]) -> u32 {
        let place = self.faces.partition_point(|other| *other < key(face, points));
        (self.first_index + place) as u32
    }

    /// Index of the center of a cell that [`Added::collect`] has seen.
    pub(super) fn cell_center(&self, cell: u32) -> u32 {
        let place = self.cells.partition_point(|&other| other < cell);
        (self.first_index + self.faces.len() + place) as u32
    }
}

fn key(face: &QuadFace, points: &[u32]) -> [u32; 4] {
    let mut corners = face.corners.map(|slot| points[usize::from(slot)]);
    corners.sort_unstable();
    corners
}

/// The eight-node serendipity shape functions at the center: -1/4 at corners, 1/2 amid edges.
fn face_parents(face: &QuadFace, points: &[u32], factor: f64) -> Vec<(VertexId, f64)> {
    let weighted =
        |slots: [u8; 4], weight: f64| slots.map(|slot| (VertexId(points[usize::from(slot)]), weight * factor));
    [weighted(face.corners, -0.25), weighted(face.mids, 0.5)].concat()
}

/// Transfinite interpolation at the center: half of the face centers, less a quarter of the edges', plus an eighth of
/// the corners. With all face centers by [`face_parents`] these are the 20-node serendipity shape functions (-1/4 at
/// corners, 1/4 amid edges); face centers that the cell has are used as they are.
fn hexahedron_center(recipe: &Recipe, points: &[u32]) -> AddedPoint {
    let mut parents = Vec::with_capacity(68);
    for face in recipe.faces {
        match points.get(usize::from(face.center)) {
            Some(&center) => parents.push((VertexId(center), 0.5)),
            None => parents.extend(face_parents(face, points, 0.5)),
        }
    }
    parents.extend(points[..8].iter().map(|&corner| (VertexId(corner), 0.125)));
    parents.extend(points[8..20].iter().map(|&mid| (VertexId(mid), -0.25)));
    AddedPoint::new(parents)
}

/// The mean of a polyhedron's points, each counted once.
fn centroid(faces: &[Vec<u32>]) -> AddedPoint {
    let mut points: Vec<u32> = faces.iter().flatten().copied().collect();
    points.sort_unstable();
    points.dedup();
    let weight = 1.0 / points.len() as f64;
    AddedPoint::new(points.into_iter().map(|point| (VertexId(point), weight)).collect())
}
