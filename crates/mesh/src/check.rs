//! What is wrong with a mesh, in numbers and in sentences.

use glam::DVec3;
use rayon::prelude::*;

use crate::{CellId, Decomposition, DecompositionCounts, FaceAdjacency, TetMesh};

/// What [`check`] finds. Values only; [`MeshReport::findings`] says what they mean.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshReport {
    /// What the decomposition left out and turned round.
    pub decomposition: DecompositionCounts,
    /// Points, added ones included.
    pub points: usize,
    /// Tetrahedra, all of positive volume.
    pub tetrahedra: usize,
    /// Tetrahedra that repeat the four points of an earlier one.
    pub duplicate_tetrahedra: usize,
    /// Points that no tetrahedron uses.
    pub unreferenced_points: usize,
    /// Points with a coordinate that is not finite.
    pub non_finite_points: usize,
    /// Points at exactly the coordinates of a point of smaller index.
    pub coincident_points: usize,
    /// Faces of three or more tetrahedra.
    pub non_manifold_faces: usize,
    /// Faces with both of their tetrahedra on the same side.
    pub folded_faces: usize,
    /// Faces of one tetrahedron alone.
    pub boundary_faces: usize,
    /// Parts of the mesh that no face joins.
    pub connected_parts: usize,
    /// Sum of all volumes, world length cubed; infinite or zero where f64 cannot hold it (sizes beyond about 1e±100).
    pub volume_world: f64,
    /// Lowest and highest world coordinates of points in use; `None` if there is no tetrahedron.
    pub bounds_world: Option<(DVec3, DVec3)>,
}

/// Looks a mesh over.
///
/// `adjacency` must be that of the mesh's tetrahedra. Takes a few tenths of a microsecond a tetrahedron; the
/// result does not depend on the number of threads.
pub fn check(decomposition: &Decomposition, adjacency: &FaceAdjacency) -> MeshReport {
    let mesh = &decomposition.mesh;
    let mut is_used = vec![false; mesh.positions().len()];
    for vertex in mesh.tetrahedra().iter().flatten() {
        is_used[vertex.index()] = true;
    }
    MeshReport {
        decomposition: decomposition.counts.clone(),
        points: mesh.positions().len(),
        tetrahedra: mesh.tetrahedra().len(),
        duplicate_tetrahedra: adjacency.duplicates().len(),
        unreferenced_points: is_used.iter().filter(|used| !**used).count(),
        non_finite_points: mesh.positions().iter().filter(|p| !p.is_finite()).count(),
        coincident_points: coincident_points(mesh.positions()),
        non_manifold_faces: adjacency.non_manifold_faces().len(),
        folded_faces: adjacency.folded_faces().len(),
        boundary_faces: adjacency.boundary_faces().len(),
        connected_parts: connected_parts(adjacency),
        volume_world: volume_world(mesh),
        bounds_world: mesh.bounds_world(),
    }
}

impl MeshReport {
    /// Sentences for people: everything that is not as one would wish, each with what it means for the picture. Empty
    /// if all is well.
    pub fn findings(&self) -> Vec<String> {
        let mut findings = self.decomposition.findings();
        let mut tell = |count: usize, what: &str, meaning: &str| {
            if count > 0 {
                findings.push(format!("{count} {what}; {meaning}"));
            }
        };
        tell(
            self.duplicate_tetrahedra,
            "tetrahedra repeat the points of another",
            "they are drawn twice, so the volume is too dense there",
        );
        tell(
            self.folded_faces,
            "faces have both of their tetrahedra on the same side",
            "the mesh overlaps itself there and no order of cells is right for all views",
        );
        tell(
            self.non_manifold_faces,
            "faces belong to three or more tetrahedra",
            "cells overlap there, and the volume is too dense",
        );
        tell(
            self.coincident_points,
            "points lie exactly where another one lies",
            "cells that meet there by position but not by index count as a boundary: orders that go from neighbor to \
             neighbor do not cross it, and gradients may show a seam; merge the points to join them",
        );
        tell(self.non_finite_points, "points have coordinates that are not finite", "cells at them are left out");
        tell(self.unreferenced_points, "points are used by no tetrahedron", "this changes nothing in the picture");
        tell(
            if self.connected_parts > 1 { self.connected_parts } else { 0 },
            "parts of the mesh are not joined by any face",
            "what lies between them is drawn as empty, and orders by neighbors cannot tell which is in front",
        );
        findings
    }
}

/// Points at the coordinates of an earlier one; those that are not finite do not count.
fn coincident_points(positions: &[DVec3]) -> usize {
    // Adding zero turns -0 into 0; then equal numbers have equal bits.
    let bits = |p: &DVec3| (*p + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut places: Vec<[u64; 3]> = positions.par_iter().filter(|p| p.is_finite()).map(bits).collect();
    places.par_sort_unstable();
    places.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// Number of parts that faces join; non-manifold faces join too.
fn connected_parts(adjacency: &FaceAdjacency) -> usize {
    let mut parents: Vec<u32> = (0..adjacency.table().len() as u32).collect();
    let mut parts = parents.len();
    let mut join = |a: u32, b: u32| {
        let (a, b) = (root(&mut parents, a), root(&mut parents, b));
        if a != b {
            parents[a.max(b) as usize] = a.min(b);
            parts -= 1;
        }
    };
    for (cell, neighbors) in adjacency.table().iter().enumerate() {
        for &neighbor in neighbors.iter().filter(|&&neighbor| neighbor != FaceAdjacency::NONE) {
            if (neighbor as usize) < cell {
                join(cell as u32, neighbor);
            }
        }
    }
    for face in adjacency.non_manifold_faces() {
        face.windows(2).for_each(|pair| join(pair[0].cell.0, pair[1].cell.0));
    }
    parts
}

/// The smallest cell known to be joined to this one; shortens the way for the next question.
fn root(parents: &mut [u32], mut cell: u32) -> u32 {
    while parents[cell as usize] != cell {
        let grandparent = parents[parents[cell as usize] as usize];
        parents[cell as usize] = grandparent;
        cell = grandparent;
    }
    cell
}

fn volume_world(mesh: &TetMesh) -> f64 {
    // Sums of runs of fixed length, so that the rounding does not depend on threads and grows slowly.
    let run_sum = |run: &[u32]| run.iter().map(|&cell| mesh.volume6_local(CellId(cell))).sum::<f64>();
    let cells: Vec<u32> = (0..mesh.tetrahedra().len() as u32).collect();
    let sums: Vec<f64> = cells.par_chunks(1024).map(run_sum).collect();
    let scale = mesh.frame().scale;
    sums.iter().sum::<f64>() / 6.0 * scale * scale * scale
}

#[cfg(test)]
mod tests;
