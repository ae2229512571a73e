//! The first look at all cells: which take part, where they lie, and why the others do not.

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use super::DecompositionCounts;
use super::structured;
use super::unstructured::{Unstructured, point_count};
use crate::{CellKind, StructuredBlock};

/// What the first look finds.
pub(super) struct Survey {
    /// One flag a cell: whether it is cut.
    pub(super) taken: Vec<bool>,
    /// Bounds in world coordinates of the points of taken cells; the lowest lies above the highest if there is none.
    pub(super) lowest: DVec3,
    pub(super) highest: DVec3,
    pub(super) counts: DecompositionCounts,
}

impl Default for Survey {
    fn default() -> Self {
        Self {
            taken: Vec::new(),
            lowest: DVec3::INFINITY,
            highest: DVec3::NEG_INFINITY,
            counts: DecompositionCounts::default(),
        }
    }
}

impl Survey {
    pub(super) fn unstructured(cells: &Unstructured<'_>, points: &[DVec3]) -> Self {
        let look = |run: std::ops::Range<usize>| {
            let mut survey = Self::default();
            let mut kinds = KindCounter::default();
            for cell in run {
                survey.look_at(cell, cells, points, &mut kinds);
            }
            survey.counts.cells = kinds.finish();
            survey
        };
        Self::merged(cells.runs().into_par_iter().map(look).collect())
    }

    pub(super) fn structured(blocks: &[StructuredBlock], points: &[DVec3]) -> Self {
        let mut parts = Vec::new();
        for block in blocks {
            let look = |rows| {
                let mut survey = Self::default();
                structured::for_cells(block, rows, |_, [i, j, k]| {
                    let corners = structured::corners(block, i, j, k);
                    let is_hidden =
                        |&corner: &usize| block.hidden_points.get(corner - block.first_point).copied().unwrap_or(false);
                    if corners.iter().any(is_hidden) {
                        survey.counts.hidden += 1;
                        survey.taken.push(false);
                    } else {
                        survey.take_if_finite(corners.into_iter(), points);
                    }
                });
                if !survey.taken.is_empty() {
                    survey.counts.cells.insert(CellKind::Hexahedron, survey.taken.len());
                }
                survey
            };
            parts.extend(structured::row_runs(block).into_par_iter().map(look).collect::<Vec<_>>());
        }
        Self::merged(parts)
    }

    fn look_at(&mut self, cell: usize, cells: &Unstructured<'_>, points: &[DVec3], kinds: &mut KindCounter) {
        let view = cells.view(cell);
        kinds.count(view.kind);
        let counts = &mut self.counts;
        let is_malformed = match (view.kind, point_count(view.kind)) {
            (CellKind::Flat | CellKind::FlatOf(_), _) => {
                counts.flat += 1;
                self.taken.push(false);
                return;
            }
            (CellKind::Other(number), _) => {
                *counts.unknown.entry(number).or_default() += 1;
                self.taken.push(false);
                return;
            }
            (_, Some(count)) => view.points.len() < count,
            // A solid has four faces of three corners at least.
            (_, None) => view.faces.len() < 4 || view.faces.iter().any(|face| face.len() < 3),
        };
        if is_malformed {
            counts.malformed += 1;
            counts.first_malformed.get_or_insert(cell);
            self.taken.push(false);
            return;
        }
        let has_surplus = view.faces.is_empty() && cells.all_points(cell).len() > view.points.len();
        let was_taken = if view.faces.is_empty() {
            self.take_if_finite(view.points.iter().map(|&point| point as usize), points)
        } else {
            self.take_if_finite(view.faces.iter().flatten().map(|&point| point as usize), points)
        };
        self.counts.shortened += usize::from(has_surplus && was_taken);
    }

    fn take_if_finite(&mut self, cell: impl Iterator<Item = usize>, points: &[DVec3]) -> bool {
        let (mut lowest, mut highest) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut is_finite = true;
        for point in cell.map(|index| points[index]) {
            is_finite &= point.is_finite();
            lowest = lowest.min(point);
            highest = highest.max(point);
        }
        if is_finite {
            self.lowest = self.lowest.min(lowest);
            self.highest = self.highest.max(highest);
        } else {
            self.counts.non_finite += 1;
        }
        self.taken.push(is_finite);
        is_finite
    }

    fn merged(parts: Vec<Self>) -> Self {
        let mut all = Self::default();
        all.taken.reserve(parts.iter().map(|part| part.taken.len()).sum());
        for part in parts {
            all.taken.extend(part.taken);
            all.lowest = all.lowest.min(part.lowest);
            all.highest = all.highest.max(part.highest);
            all.counts.add(part.counts);
        }
        all
    }
}

/// Counts kinds; neighbors in a file mostly are of one kind, so a run of them costs one look-up.
#[derive(Default)]
struct KindCounter {
    counts: BTreeMap<CellKind, usize>,
    run: Option<(CellKind, usize)>,
}

impl KindCounter {
    fn count(&mut self, kind: CellKind) {
        match &mut self.run {
            Some((current, length)) if *current == kind => *length += 1,
            _ => {
                self.flush();
                self.run = Some((kind, 1));
            }
        }
    }

    fn flush(&mut self) {
        if let Some((kind, length)) = self.run.take() {
            *self.counts.entry(kind).or_default() += length;
        }
    }

    fn finish(mut self) -> BTreeMap<CellKind, usize> {
        self.flush();
        self.counts
    }
}
