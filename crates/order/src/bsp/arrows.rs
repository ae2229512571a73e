//! Which cells come before which across empty space, seen from one viewpoint.

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use super::flat::{Flat, overlap_surely};
use super::overlap::{Seen, is_before, overlap};
use super::split::Plane;
use super::tiles::{Rectangle, Sheets, Tiles};
use super::{BoundaryFragment, BspTree};
use crate::signs::eye_side;

/// What became of the arrows of one view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ArrowReport {
    /// Boundary faces that a ray may leave a cell through, with something behind them.
    pub exits: usize,
    /// Boundary faces that a ray may enter a cell through, with something in front of them.
    pub entries: usize,
    /// Pairs of an exit and an entry that were compared.
    pub compared: usize,
    /// Arrows given: pairs of cells, each once.
    pub arrows: usize,
    /// Whether all pairs were compared. If not, relations are missing.
    pub is_complete: bool,
}

/// Pairs that tiles may offer per boundary face, and in any case. Meshes in use offer tens; only long thin triangles
/// all across each other come near, of which some ten thousand take some seconds a view. Beyond, relations are missing, and the order
/// says so.
const CANDIDATES_PER_FACE: usize = 200;
const CANDIDATES: usize = 1 << 22;

/// Faces that one task puts on sheets.
const FACES_PER_TASK: usize = 1 << 11;

/// The ranks of a face's fragments, in the order of the tree.
#[derive(Clone, Copy)]
struct Ranks {
    first: u32,
    last: u32,
}

/// A face seen through one sheet.
#[derive(Clone, Copy)]
struct Sighting {
    face: u32,
    ranks: Ranks,
    rectangle: Rectangle,
    flat: Flat,
}

/// What all comparisons of one view need.
#[derive(Clone, Copy)]
struct Look<'a> {
    viewpoint: Viewpoint,
    /// For every face the side of it that the eye is on.
    eye_sides: &'a [i8],
    /// Of a coordinate on a sheet.
    rounding: f64,
}

impl BspTree {
    /// Visits the fragments of all boundary faces that are not seen edge-on: if a fragment hides part of another, it
    /// comes first. Where a cell and another touch in one plane, the fragment that looks away from the eye comes first.
    ///
    /// That holds but for widths of about 1e-13 of the coordinates at the edges of fragments that were split, and for
    /// what [`TreeReport::unordered`](super::TreeReport::unordered) counts.
    pub fn front_to_back(&self, viewpoint: Viewpoint, visit: &mut dyn FnMut(BoundaryFragment)) {
        let eye_sides = self.eye_sides(viewpoint);
        self.walk(viewpoint, &eye_sides, |faces, in_one_plane| {
            let fragment = |&face: &u32| {
                let faces_eye = eye_sides[face as usize] != self.faces[face as usize].cell_side;
                (eye_sides[face as usize] != 0)
                    .then_some(BoundaryFragment { cell: self.faces[face as usize].cell, faces_eye })
            };
            let (exits, entries): (Vec<_>, Vec<_>) =
                faces.iter().filter_map(fragment).partition(|fragment| in_one_plane && !fragment.faces_eye);
            exits.into_iter().chain(entries).for_each(&mut *visit);
        });
    }

    /// Gives the arrows that cross empty space: `sink(a, b)` where a ray leaves cell `a` through a boundary face and
    /// later enters cell `b` through another.
    ///
    /// Every arrow is exact: there is such a ray. None is missing if the report says complete, but for overlaps
    /// narrower than 1e-12 of the coordinates, at the edges of faces that the tree splits. Each comes once, ascending.
    /// The same for any number of threads. See the module for what they are worth.
    pub fn arrows(&self, viewpoint: Viewpoint, sink: &mut dyn FnMut(CellId, CellId)) -> ArrowReport {
        let eye_sides = self.eye_sides(viewpoint);
        let ranks = self.ranks(viewpoint, &eye_sides);
        let (exits, mut entries) = self.with_partners(&eye_sides, &ranks);
        let mut report =
            ArrowReport { exits: exits.len(), entries: entries.len(), is_complete: true, ..ArrowReport::default() };
        if exits.is_empty() || entries.is_empty() {
            return report;
        }
        // Far entries first: in a tile everything after the first that is in front of an exit is in front of it too.
        entries.sort_by_key(|&face| std::cmp::Reverse(ranks[face as usize].last));
        let sheets = Sheets::new(viewpoint, self.largest);
        let exits = self.sightings(&sheets, &ranks, &eye_sides, &exits);
        let entries = self.sightings(&sheets, &ranks, &eye_sides, &entries);
        let view = Look { viewpoint, eye_sides: &eye_sides, rounding: sheets.rounding() };

        let mut arrows: Vec<(CellId, CellId)> = Vec::new();
        let mut sheets_used = 0;
        let mut offered = 0;
        let most = CANDIDATES + CANDIDATES_PER_FACE * self.faces.len();
        for (exits, entries) in exits.iter().zip(&entries) {
            if exits.is_empty() || entries.is_empty() {
                continue;
            }
            let ranked: Vec<_> = entries.iter().map(|entry| (entry.rectangle, entry.ranks.last)).collect();
            let tiles = Tiles::new(&ranked);
            let counts: Vec<usize> = exits.par_iter().map(|exit| tiles.candidates(&exit.rectangle)).collect();
            let affordable = counts
                .iter()
                .take_while(|&&count| {
                    offered += count;
                    offered <= most
                })
                .count();
            report.is_complete &= affordable == exits.len();
            let (compared, found) = exits[..affordable]
                .par_iter()
                .fold(
                    || (0, Vec::new()),
                    |(mut compared, mut found), exit| {
                        tiles.meeting(&exit.rectangle, exit.ranks.first, |member| {
                            let entry = &entries[member as usize];
                            compared += 1;
                            if self.is_arrow(&view, exit, entry) {
                                let cell = |face: u32| self.faces[face as usize].cell;
                                found.push((cell(exit.face), cell(entry.face)));
                            }
                        });
                        (compared, found)
                    },
                )
                .reduce(
                    || (0, Vec::new()),
                    |mut left, mut right| {
                        left.1.append(&mut right.1);
                        (left.0 + right.0, left.1)
                    },
                );
            report.compared += compared;
            sheets_used += 1;
            if arrows.is_empty() {
                arrows = found;
            } else {
                arrows.extend(found);
            }
        }
        if sheets_used > 1 {
            arrows.par_sort_unstable();
        } else {
            // Faces come by their cells, so that only what begins at one cell is out of order.
            arrows.par_chunk_by_mut(|a, b| a.0 == b.0).for_each(<[_]>::sort_unstable);
        }
        arrows.dedup();
        report.arrows = arrows.len();
        arrows.into_iter().for_each(|(front, back)| sink(front, back));
        report
    }

    /// Whether a ray leaves through the exit and enters through the entry later.
    fn is_arrow(&self, view: &Look<'_>, exit: &Sighting, entry: &Sighting) -> bool {
        let is_narrow = exit.rectangle.is_whole && entry.rectangle.is_whole;
        let surely = is_narrow.then(|| overlap_surely(&exit.flat, &entry.flat, view.rounding)).flatten();
        if surely == Some(false) {
            return false;
        }
        let seen =
            |face: u32| Seen { points: self.faces[face as usize].points, eye_side: view.eye_sides[face as usize] };
        let (front, back) = (seen(exit.face), seen(entry.face));
        // Faces that were never split were put on the sides of planes without rounding: their ranks decide.
        let is_ranked = self.is_whole[exit.face as usize] && self.is_whole[entry.face as usize];
        (surely == Some(true) || overlap(view.viewpoint, &front, &back, is_narrow))
            && (is_ranked || is_before(view.viewpoint, &front, &back))
    }

    /// For every face the side of it that the eye is on.
    fn eye_sides(&self, viewpoint: Viewpoint) -> Vec<i8> {
        self.faces.par_iter().with_min_len(1 << 10).map(|face| eye_side(face.points, viewpoint)).collect()
    }

    fn walk(&self, viewpoint: Viewpoint, eye_sides: &[i8], visit: impl FnMut(&[u32], bool)) {
        let eye_side = |plane: Plane| match plane {
            Plane::Face(face) => eye_sides[face as usize],
            Plane::Axis { .. } => plane.eye_side(&self.faces, viewpoint),
        };
        self.tree.walk(eye_side, visit);
    }

    fn ranks(&self, viewpoint: Viewpoint, eye_sides: &[i8]) -> Vec<Ranks> {
        let mut ranks = vec![Ranks { first: u32::MAX, last: 0 }; self.faces.len()];
        let mut next = 0;
        self.walk(viewpoint, eye_sides, |faces, in_one_plane| {
            for &face in faces {
                // In one plane exits come first; without an order all have the same ranks.
                let is_entry = eye_sides[face as usize] != self.faces[face as usize].cell_side;
                let rank = next + u32::from(in_one_plane && is_entry);
                let ranks = &mut ranks[face as usize];
                ranks.first = ranks.first.min(rank);
                ranks.last = ranks.last.max(rank);
            }
            next += 2;
        });
        ranks
    }

    /// Faces that look away from the eye and are not behind all that look at it, and the other way round.
    fn with_partners(&self, eye_sides: &[i8], ranks: &[Ranks]) -> (Vec<u32>, Vec<u32>) {
        let is_exit = |face: u32| eye_sides[face as usize] == self.faces[face as usize].cell_side;
        let seen = (0..self.faces.len() as u32).filter(|&face| eye_sides[face as usize] != 0);
        let (mut exits, mut entries): (Vec<u32>, Vec<u32>) = seen.partition(|&face| is_exit(face));
        let last_entry = entries.iter().map(|&face| ranks[face as usize].last).max();
        let first_exit = exits.iter().map(|&face| ranks[face as usize].first).min();
        exits.retain(|&face| Some(ranks[face as usize].first) <= last_entry);
        entries.retain(|&face| first_exit.is_some_and(|first| first <= ranks[face as usize].last));
        (exits, entries)
    }

    /// Where faces are seen, by sheets, in the order of `faces`.
    fn sightings(&self, sheets: &Sheets, ranks: &[Ranks], eye_sides: &[i8], faces: &[u32]) -> Vec<Vec<Sighting>> {
        let parts: Vec<Vec<Vec<Sighting>>> = faces
            .par_chunks(FACES_PER_TASK)
            .map(|faces| {
                let mut sightings = vec![Vec::new(); 6];
                for &face in faces {
                    let (own, ranks, eye_side) =
                        (&self.faces[face as usize], ranks[face as usize], eye_sides[face as usize]);
                    sheets.project(&own.points, |rectangle, corners| {
                        let turn = if Sheets::is_mirror(rectangle.sheet) { -eye_side } else { eye_side };
                        let flat = Flat::new(corners, own.numbers, turn);
                        sightings[usize::from(rectangle.sheet)].push(Sighting { face, ranks, rectangle, flat });
                    });
                }
                sightings
            })
            .collect();
        (0..6).map(|sheet| parts.iter().flat_map(|part| &part[sheet]).copied().collect()).collect()
    }
}
