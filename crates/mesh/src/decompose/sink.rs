//! Where the cutters put their tetrahedra: turns them round, leaves out the flat ones, and counts.

use crate::VertexId;
use crate::orientation::{Sign, Space};

/// Whether the order of a cell's points says which way round it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Winding {
    /// It does: a negative volume is an inversion.
    Fixed,
    /// Files differ (wedges, prisms, faces of polyhedra): only tetrahedra that disagree with most of their group are
    /// inversions.
    Either,
}

/// Tetrahedra of a run of cells.
#[derive(Default)]
pub(super) struct Part {
    pub(super) tetrahedra: Vec<[VertexId; 4]>,
    pub(super) source_cells: Vec<u32>,
    pub(super) seen: usize,
    pub(super) no_volume: usize,
    pub(super) inverted: usize,
}

/// Collects the tetrahedra of one run of cells.
pub(super) struct Sink<'a> {
    space: &'a Space<'a>,
    group: Vec<([u32; 4], Sign)>,
    part: Part,
}

impl<'a> Sink<'a> {
    pub(super) fn new(space: &'a Space<'a>) -> Self {
        Self { space, group: Vec::new(), part: Part::default() }
    }

    /// Takes one tetrahedron of the group at hand.
    #[inline]
    pub(super) fn push(&mut self, tetrahedron: [u32; 4]) {
        let sign = self.space.sign(tetrahedron);
        self.group.push((tetrahedron, sign));
    }

    /// Ends a group: tetrahedra of one cell (or of one face of a polyhedron) that should all be the same way round.
    pub(super) fn end_group(&mut self, cell: u32, winding: Winding) {
        let upright = match winding {
            Winding::Fixed => Sign::Positive,
            Winding::Either => {
                let count = |sign| self.group.iter().filter(|(_, s)| *s == sign).count();
                if count(Sign::Negative) > count(Sign::Positive) { Sign::Negative } else { Sign::Positive }
            }
        };
        for ([a, b, c, d], sign) in self.group.drain(..) {
            self.part.seen += 1;
            let positive = match sign {
                Sign::Zero => {
                    self.part.no_volume += 1;
                    continue;
                }
                Sign::Positive => [a, b, c, d],
                Sign::Negative => [a, b, d, c],
            };
            self.part.inverted += usize::from(sign != upright);
            self.part.tetrahedra.push(positive.map(VertexId));
            self.part.source_cells.push(cell);
        }
    }

    pub(super) fn into_part(self) -> Part {
        self.part
    }
}
