//! Which tetrahedra meet in a face. Topology alone: no positions.

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::prelude::*;

use crate::decompose::MOST_TETRAHEDRA;
use crate::{CellId, VertexId};

/// One of a tetrahedron's faces: the one opposite a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CellFace {
    /// The tetrahedron.
    pub cell: CellId,
    /// The place of the opposite corner, 0 to 3.
    pub corner: u8,
}

/// Joins tetrahedra face to face.
///
/// Two tetrahedra are neighbors where a face belongs to both and to no third. A face of one tetrahedron is on the
/// boundary; a face of three or more is non-manifold and joins nothing. Memory: 16 bytes a tetrahedron; while it is
/// built, about 32 more.
#[derive(Clone, Debug)]
pub struct FaceAdjacency {
    neighbors: Vec<[u32; 4]>,
    boundary: Vec<CellFace>,
    non_manifold: Vec<Vec<CellFace>>,
    folded: Vec<[CellFace; 2]>,
    duplicates: Vec<[CellId; 2]>,
}

/// Stands in the table for a non-manifold face until the boundary is listed.
const NON_MANIFOLD: u32 = u32::MAX - 1;

/// A face on its way to its twin: three point indices, ascending, and cell * 4 + corner. Ordered by all of them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    middle_and_last: u64,
    first: u32,
    cell_face: u32,
}

impl Entry {
    #[inline]
    fn new(cell_face: u32, tetrahedra: &[[VertexId; 4]]) -> Self {
        let points = face_points(tetrahedra[(cell_face >> 2) as usize], (cell_face & 3) as u8);
        let [first, middle, last] = ascending(points);
        Self { middle_and_last: u64::from(middle) << 32 | u64::from(last), first, cell_face }
    }

    fn key(&self) -> (u64, u32) {
        (self.middle_and_last, self.first)
    }

    fn face(&self) -> CellFace {
        CellFace { cell: CellId(self.cell_face >> 2), corner: (self.cell_face & 3) as u8 }
    }
}

/// What the faces of some buckets tell besides neighbors.
#[derive(Default)]
struct Oddities {
    non_manifold: Vec<Vec<CellFace>>,
    folded: Vec<[CellFace; 2]>,
    duplicates: Vec<[CellId; 2]>,
}

/// Faces that one task sorts, about.
const ENTRIES_PER_TASK: usize = 1 << 16;

impl FaceAdjacency {
    /// In [`FaceAdjacency::table`]: there is no neighbor.
    pub const NONE: u32 = u32::MAX;

    /// Finds all neighbors, in time about proportional to the number of tetrahedra: faces are dealt into buckets by
    /// their smallest point index, and each bucket is sorted.
    ///
    /// The result does not depend on the number of threads. A tetrahedron that names a point twice has faces that name
    /// it twice; they join where they are equal.
    ///
    /// # Panics
    ///
    /// Beyond 2³⁰ - 1 tetrahedra, more than [`decompose`](crate::decompose()) gives.
    pub fn new(tetrahedra: &[[VertexId; 4]]) -> Self {
        assert!(tetrahedra.len() <= MOST_TETRAHEDRA, "{} tetrahedra cannot be numbered", tetrahedra.len());
        let (cell_faces, starts) = buckets(tetrahedra);
        let neighbors: Vec<[AtomicU32; 4]> =
            tetrahedra.par_iter().map(|_| [const { AtomicU32::new(Self::NONE) }; 4]).collect();

        // Every slot of the table is written by the one group that holds its face: the order of tasks cannot matter.
        let link = |from: CellFace, to: u32| {
            neighbors[from.cell.index()][usize::from(from.corner)].store(to, Ordering::Relaxed)
        };
        let oddities: Vec<Oddities> = tasks(&starts)
            .into_par_iter()
            .map(|bounds| {
                let mut oddities = Oddities::default();
                let mut bucket = Vec::new();
                for range in bounds.windows(2) {
                    bucket.clear();
                    let cell_faces = &cell_faces[range[0]..range[1]];
                    bucket.extend(cell_faces.iter().map(|&cell_face| Entry::new(cell_face, tetrahedra)));
                    bucket.sort_unstable();
                    for group in bucket.chunk_by(|a, b| a.key() == b.key()) {
                        match group {
                            [_] => {}
                            [a, b] => {
                                link(a.face(), b.face().cell.0);
                                link(b.face(), a.face().cell.0);
                            }
                            more => more.iter().for_each(|entry| link(entry.face(), NON_MANIFOLD)),
                        }
                        oddities.look_at(group, tetrahedra);
                    }
                }
                oddities
            })
            .collect();

        let mut adjacency = Self {
            neighbors: neighbors.into_iter().map(|slots| slots.map(AtomicU32::into_inner)).collect(),
            boundary: Vec::new(),
            non_manifold: Vec::new(),
            folded: Vec::new(),
            duplicates: Vec::new(),
        };
        for task in oddities {
            adjacency.non_manifold.extend(task.non_manifold);
            adjacency.folded.extend(task.folded);
            adjacency.duplicates.extend(task.duplicates);
        }
        adjacency.non_manifold.sort_unstable();
        adjacency.folded.sort_unstable();
        adjacency.duplicates.sort_unstable();
        adjacency.list_boundary();
        adjacency
    }

    /// The tetrahedron on the other side of the face opposite a corner (0 to 3).
    ///
    /// # Panics
    ///
    /// If there is no such tetrahedron or corner.
    #[inline]
    pub fn neighbor(&self, cell: CellId, corner: usize) -> Option<CellId> {
        let neighbor = self.neighbors[cell.index()][corner];
        (neighbor != Self::NONE).then_some(CellId(neighbor))
    }

    /// For every tetrahedron the neighbor opposite each of its corners, or [`FaceAdjacency::NONE`].
    pub fn table(&self) -> &[[u32; 4]] {
        &self.neighbors
    }

    /// Faces of one tetrahedron alone, ascending.
    pub fn boundary_faces(&self) -> &[CellFace] {
        &self.boundary
    }

    /// Faces of three or more tetrahedra, each as those have it.
    pub fn non_manifold_faces(&self) -> &[Vec<CellFace>] {
        &self.non_manifold
    }

    /// Faces whose two tetrahedra lie on the same side of it, if both have a positive volume: the mesh overlaps itself.
    /// Told from the order of their points alone. They still count as neighbors.
    pub fn folded_faces(&self) -> &[[CellFace; 2]] {
        &self.folded
    }

    /// Tetrahedra with the same four points: each after the first, together with the first.
    pub fn duplicates(&self) -> &[[CellId; 2]] {
        &self.duplicates
    }

    fn list_boundary(&mut self) {
        for (cell, slots) in self.neighbors.iter_mut().enumerate() {
            for (corner, slot) in slots.iter_mut().enumerate() {
                if *slot == Self::NONE {
                    self.boundary.push(CellFace { cell: CellId(cell as u32), corner: corner as u8 });
                } else if *slot == NON_MANIFOLD {
                    *slot = Self::NONE;
                }
            }
        }
    }
}

impl Oddities {
    /// Looks at all tetrahedra of one face.
    fn look_at(&mut self, group: &[Entry], tetrahedra: &[[VertexId; 4]]) {
        if group.len() < 2 {
            return;
        }
        let opposite = |entry: &Entry| tetrahedra[entry.face().cell.index()][usize::from(entry.face().corner)];
        // Equal tetrahedra meet in all four faces; they are told at the one of their three smallest points.
        let is_top = |entry: &Entry| opposite(entry).0 > entry.middle_and_last as u32;
        let mut tops: Vec<_> = match group {
            // Nearly all groups: no memory is asked for.
            [a, b] if opposite(a) != opposite(b) => Vec::new(),
            all => all.iter().filter(|entry| is_top(entry)).map(|entry| (opposite(entry), entry.face().cell)).collect(),
        };
        tops.sort_unstable();
        for same in tops.chunk_by(|a, b| a.0 == b.0) {
            self.duplicates.extend(same[1..].iter().map(|&(_, cell)| [same[0].1, cell]));
        }
        match group {
            [a, b] => {
                let turns = |entry: &Entry| is_odd(tetrahedra[entry.face().cell.index()], entry.face().corner);
                if turns(a) == turns(b) {
                    self.folded.push([a.face(), b.face()]);
                }
            }
            more => self.non_manifold.push(more.iter().map(Entry::face).collect()),
        }
    }
}

/// The three points of the face opposite a corner.
#[inline]
fn face_points(tetrahedron: [VertexId; 4], corner: u8) -> [u32; 3] {
    let [a, b, c, d] = tetrahedron.map(|v| v.0);
    match corner {
        0 => [b, c, d],
        1 => [a, c, d],
        2 => [a, b, d],
        _ => [a, b, c],
    }
}

/// Whether bringing a tetrahedron's points into the order (opposite corner, face's points ascending) takes an odd
/// number of exchanges. Two positive tetrahedra on different sides of a face differ in this.
fn is_odd(tetrahedron: [VertexId; 4], corner: u8) -> bool {
    let [a, b, c] = face_points(tetrahedron, corner);
    (corner % 2 == 1) ^ (a > b) ^ (a > c) ^ (b > c)
}

#[inline]
fn ascending([a, b, c]: [u32; 3]) -> [u32; 3] {
    let (low, high) = (a.min(b), a.max(b));
    [low.min(c), low.max(high.min(c)), high.max(c)]
}

/// All faces as cell * 4 + corner, dealt into buckets by the smallest point index, and where each bucket starts.
fn buckets(tetrahedra: &[[VertexId; 4]]) -> (Vec<u32>, Vec<usize>) {
    let largest = tetrahedra.par_iter().map(|t| t[0].max(t[1]).max(t[2]).max(t[3]).0).max().unwrap_or(0);
    // As many buckets as faces at most: indices may be sparse, the memory may not follow them.
    let most = (4 * tetrahedra.len()).max(1) as u32;
    let mut shift = 0;
    while largest >> shift >= most {
        shift += 1;
    }
    let bucket_count = (largest >> shift) as usize + 1;
    // The smallest point of the face opposite each corner: the smallest of all, but opposite that one the second.
    let bucket_of = |tetrahedron: &[VertexId; 4]| {
        let [a, b, c, d] = tetrahedron.map(|v| v.0);
        let (ab, cd) = (a.min(b), c.min(d));
        [b.min(cd), a.min(cd), ab.min(d), ab.min(c)].map(|first| (first >> shift) as usize)
    };

    let mut starts = vec![0_usize; bucket_count + 1];
    for tetrahedron in tetrahedra {
        for bucket in bucket_of(tetrahedron) {
            starts[bucket + 1] += 1;
        }
    }
    let mut total = 0;
    for start in &mut starts {
        total += *start;
        *start = total;
    }
    let mut next = starts.clone();
    let mut cell_faces = vec![0; 4 * tetrahedra.len()];
    for (cell, tetrahedron) in tetrahedra.iter().enumerate() {
        for (corner, bucket) in bucket_of(tetrahedron).into_iter().enumerate() {
            cell_faces[next[bucket]] = (cell as u32) << 2 | corner as u32;
            next[bucket] += 1;
        }
    }
    (cell_faces, starts)
}

/// Cuts the buckets into runs of about [`ENTRIES_PER_TASK`] faces; each lists the bounds of its buckets.
fn tasks(starts: &[usize]) -> Vec<&[usize]> {
    let mut tasks = Vec::new();
    let mut bucket = 0;
    while bucket + 1 < starts.len() {
        let past = starts.partition_point(|&start| start < starts[bucket] + ENTRIES_PER_TASK);
        let end = past.clamp(bucket + 1, starts.len() - 1);
        tasks.push(&starts[bucket..=end]);
        bucket = end;
    }
    tasks
}

#[cfg(test)]
mod tests;
