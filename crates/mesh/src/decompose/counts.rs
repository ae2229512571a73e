//! What the decomposition found, turned round and left out.

use std::collections::BTreeMap;

use crate::CellKind;

/// How many cells and tetrahedra there were, and what became of them.
///
/// Every cell is either cut or counted once in `flat`, `unknown`, `malformed`, `hidden` or `non_finite`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DecompositionCounts {
    /// Cells of the dataset by kind; those of structured blocks are hexahedra.
    pub cells: BTreeMap<CellKind, usize>,
    /// Tetrahedra that the cells were cut into, before those of no volume were left out.
    pub tetrahedra: usize,
    /// Tetrahedra left out because they have no volume.
    pub no_volume: usize,
    /// Tetrahedra turned round because they were inverted: negative in a cell whose points must come in one order, or
    /// contrary to most of their cell where files use both orders (wedges, prisms, faces of polyhedra).
    pub inverted: usize,
    /// Cells that have no volume by their kind.
    pub flat: usize,
    /// Cells of kinds that are not cut, by VTK's number.
    pub unknown: BTreeMap<u8, usize>,
    /// Cells left out because they have fewer points (polyhedra: faces or corners) than their kind needs.
    pub malformed: usize,
    /// The index of the first of these.
    pub first_malformed: Option<usize>,
    /// Cells that were cut by their first points because they have more than their kind.
    pub shortened: usize,
    /// Cells of structured blocks left out because a corner is hidden.
    pub hidden: usize,
    /// Cells left out because a point of theirs has a coordinate that is not a finite number.
    pub non_finite: usize,
}

impl DecompositionCounts {
    /// Number of cells of the dataset.
    pub fn cell_count(&self) -> usize {
        self.cells.values().sum()
    }

    /// Sentences for people about everything that is not as one would wish, with its effect; empty if all is well.
    pub fn findings(&self) -> Vec<String> {
        let mut findings = Vec::new();
        let mut tell = |count: usize, text: String| {
            if count > 0 {
                findings.push(text);
            }
        };
        tell(
            self.flat,
            format!("{} cells are points, lines or faces; they have no volume and are not drawn", self.flat),
        );
        for (number, count) in &self.unknown {
            tell(
                *count,
                format!("{count} cells are of VTK's type {number}, which is not cut into tetrahedra; not drawn"),
            );
        }
        let place = self.first_malformed.map(|cell| format!(" (the first is cell {cell})")).unwrap_or_default();
        tell(
            self.malformed,
            format!(
                "{} cells have too few points for their kind{place}; they are left out, which leaves holes",
                self.malformed
            ),
        );
        tell(
            self.shortened,
            format!(
                "{} cells have more points than their kind; only their first points, the corners, are used",
                self.shortened
            ),
        );
        tell(self.hidden, format!("{} cells are hidden by the file (blanked points) and not drawn", self.hidden));
        tell(
            self.non_finite,
            format!(
                "{} cells use points whose coordinates are not finite; they are left out, which leaves holes",
                self.non_finite
            ),
        );
        tell(
            self.no_volume,
            format!(
                "{} of {} tetrahedra have no volume; they are left out, which changes nothing in the picture",
                self.no_volume, self.tetrahedra
            ),
        );
        tell(
            self.inverted,
            format!(
                "{} of {} tetrahedra were inverted and are turned round; where only some cells of a mesh are, it overlaps itself there",
                self.inverted, self.tetrahedra
            ),
        );
        findings
    }

    /// Why cells were not cut, in a few words.
    pub(super) fn left_out_words(&self) -> String {
        let unknown = self.unknown.values().sum();
        let reasons = [
            (self.flat, "are points, lines or faces"),
            (unknown, "are of unknown kinds"),
            (self.malformed, "have too few points"),
            (self.hidden, "are hidden"),
            (self.non_finite, "have coordinates that are not finite"),
        ];
        let told = reasons.iter().filter(|(count, _)| *count > 0).map(|(count, reason)| format!("{count} {reason}"));
        told.collect::<Vec<_>>().join(", ")
    }

    /// Adds the counts of later cells.
    pub(super) fn add(&mut self, later: Self) {
        for (kind, count) in later.cells {
            *self.cells.entry(kind).or_default() += count;
        }
        for (number, count) in later.unknown {
            *self.unknown.entry(number).or_default() += count;
        }
        self.first_malformed = self.first_malformed.or(later.first_malformed);
        self.tetrahedra += later.tetrahedra;
        self.no_volume += later.no_volume;
        self.inverted += later.inverted;
        self.flat += later.flat;
        self.malformed += later.malformed;
        self.shortened += later.shortened;
        self.hidden += later.hidden;
        self.non_finite += later.non_finite;
    }
}
