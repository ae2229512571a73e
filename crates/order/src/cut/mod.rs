//! Cells that hide one another in a ring are cut until they do not.
//!
//! Of a ring all pairs of cells are compared: one is in front of the other if a ray meets both and a plane between them has the
//! eye on its side. Where these relations still make a ring, a plane through a face of one of its cells divides the space: what
//! lies on the eye's side of it comes first, and cells on both sides become two pieces. Each side is sorted by itself in the same way.
//!
//! Two pieces of different cells lie as their cells do, so that no pair is compared twice but for whether a ray still meets
//! both. It ends, since a cell lies on one side of each of its faces: once all faces have been used, nothing is left on both sides. In
//! general few are used: one for three bars that lie on one another in a ring.
//!
//! **Accuracy.** The relations of whole cells are exact. Pieces have corners in f64: what sticks out of a plane by less
//! than [`ROUNDING`] of the coordinates is not cut off, and pieces that overlap on the screen by less count as beside each other. Nothing is lost:
//! the pieces of a cell make up the cell.
//!
//! Source: [Kraus 2001] for taking each strongly connected part of the relations by itself; the planes and their choice are those of a
//! binary space partition.

mod body;
mod components;
mod relation;
mod sort;

use std::ops::Range;

use rayon::prelude::*;
use tetrascope_mesh::CellId;
use tetrascope_view::Viewpoint;

use crate::{Cells, Order, Piece};
use body::Body;

/// Width, in parts of the largest coordinate, under which nothing is cut off and no overlap is seen: some hundred times the rounding of
/// the few operations that make a corner of a piece, and far less than a picture shows.
const ROUNDING: f64 = 1e-13;

/// Cells of a ring that are compared pair by pair. More take seconds.
const MEMBERS: usize = 4096;

impl Order {
    /// Cuts cells that hide one another in a ring, so that the ring is gone.
    ///
    /// - `cells`, `viewpoint`: those that the order was made for
    ///
    /// Every ring in [`Self::cycles`] is taken with what stands between its first and its last drawn cell. Its cells come out in an
    /// order that is right for all rays, whole where they can be, else as pieces, with an entry in [`Self::pieces`] each. `cycles` of the result has
    /// only what is left: rings of more than 4096 cells or of too many pieces, and rings with cells that penetrate each other. They stay as they were.
    ///
    /// Relations are exact for whole cells; see [`Piece`] for what pieces have in common. Time and memory are bounded for each ring:
    /// about a second. Deterministic, for any number of threads. An order that has pieces already is given back as it is.
    ///
    /// Source: [Kraus 2001].
    #[must_use]
    pub fn cut_cycles(self, cells: Cells<'_>, viewpoint: Viewpoint) -> Self {
        if self.cycles.is_empty() || !self.pieces.is_empty() {
            return self;
        }
        let runs = runs(&self, cells.tetrahedra.len());
        let sorted: Vec<Option<Vec<Body>>> =
            runs.par_iter().map(|run| sort::sort(cells, viewpoint, &self.front_to_back[run.places.clone()])).collect();

        let mut cut = Self {
            front_to_back: Vec::with_capacity(self.front_to_back.len()),
            ..Self::whole(Vec::new(), self.guarantee)
        };
        let mut next = 0;
        for (run, sorted) in runs.iter().zip(sorted) {
            cut.front_to_back.extend(&self.front_to_back[next..run.places.start]);
            next = run.places.end;
            let members = &self.front_to_back[run.places.clone()];
            let Some(bodies) = sorted else {
                cut.front_to_back.extend(members);
                cut.cycles.extend(run.rings.iter().map(|&ring| self.cycles[ring].clone()));
                continue;
            };
            for body in bodies {
                if !body.planes.is_empty() {
                    cut.pieces.push(Piece { place: cut.front_to_back.len() as u32, planes: body.planes });
                }
                cut.front_to_back.push(members[body.member]);
            }
        }
        cut.front_to_back.extend(&self.front_to_back[next..]);
        cut.cycles.sort_unstable();
        cut
    }
}

/// Places in an order from the first to the last drawn cell of one ring, or of several that stand within one another.
struct Run {
    places: Range<usize>,
    /// Numbers in [`Order::cycles`].
    rings: Vec<usize>,
}

/// The places of all rings with two drawn cells or more, ascending.
fn runs(order: &Order, cell_count: usize) -> Vec<Run> {
    const NONE: u32 = u32::MAX;
    let mut ring_of = vec![NONE; cell_count];
    for (number, ring) in order.cycles.iter().enumerate() {
        for cell in ring {
            ring_of[cell.index()] = number as u32;
        }
    }
    let mut found: Vec<Option<Range<usize>>> = vec![None; order.cycles.len()];
    for (place, cell) in order.front_to_back.iter().enumerate() {
        let ring = ring_of[cell.index()];
        if ring != NONE {
            found[ring as usize].get_or_insert(place..place).end = place + 1;
        }
    }
    let mut found: Vec<(usize, Range<usize>)> =
        found.into_iter().enumerate().filter_map(|(ring, places)| Some((ring, places?))).collect();
    found.retain(|(_, places)| places.len() > 1);
    found.sort_unstable_by_key(|(_, places)| places.start);
    let mut runs: Vec<Run> = Vec::new();
    for (ring, places) in found {
        match runs.last_mut() {
            Some(run) if places.start < run.places.end => {
                run.places.end = run.places.end.max(places.end);
                run.rings.push(ring);
            }
            _ => runs.push(Run { places, rings: vec![ring] }),
        }
    }
    runs
}

/// A cell's corners.
fn corners(cells: Cells<'_>, cell: CellId) -> [glam::DVec3; 4] {
    cells.tetrahedra[cell.index()].map(|v| cells.positions[v.index()])
}

#[cfg(test)]
mod tests;
