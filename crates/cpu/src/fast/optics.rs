//! What a transfer function makes of the cells: which are invisible, and which pieces of it each one sees.

use rayon::prelude::*;
use tetrascope_integrate::{Isosurfaces, OpticalModel, Piece, TransferFunction};
use tetrascope_mesh::{CellId, VertexId};
use tetrascope_scene::{Sharpness, Shown};

use super::cell::{CellPieces, LocalPiece};
use super::record::CellRecord;

/// A transfer function and what it makes of every cell; view independent.
#[derive(Debug)]
pub(crate) struct Optics {
    /// As the plan has it.
    source: TransferFunction,
    /// What is to be seen in which cells.
    shown: Shown,
    pub(crate) model: OpticalModel,
    /// How fast the transfer function changes.
    sharpness: Sharpness,
    /// The pieces of the transfer function, as lines.
    lines: Vec<Line>,
    /// One entry a cell.
    pieces: Vec<CellPieces>,
    /// The cells that add something to the picture, ascending.
    visible: Vec<CellId>,
    /// For every cell whether it is one of these.
    is_shown: Vec<bool>,
}

/// A piece as lines through an anchor, f64.
#[derive(Clone, Copy, Debug)]
struct Line {
    start: f64,
    end: f64,
    anchor: f64,
    /// Extinction at the anchor, and its slope.
    extinction: [f64; 2],
    /// Color at the anchor, and its slope.
    color: [[f64; 3]; 2],
}

impl Line {
    fn new(piece: &Piece) -> Self {
        let width = piece.end - piece.start;
        let slope = |[low, high]: [f64; 2]| if width.is_finite() { (high - low) / width } else { 0.0 };
        // Beyond the ends the function is constant, and any anchor will do.
        let anchor = if piece.start.is_finite() { piece.start } else { 0.0 };
        let [low, high] = piece.color;
        Self {
            start: piece.start,
            end: piece.end,
            anchor,
            extinction: [piece.extinction[0], slope(piece.extinction)],
            color: [low, [0, 1, 2].map(|c| slope([low[c], high[c]]))],
        }
    }

    /// As a cell sees it from `start` to `end`, scalars that count from `reference`.
    #[inline(always)]
    fn localize(&self, reference: f64, [start, end]: [f64; 2], length: f64, color_factor: f64) -> LocalPiece {
        let distance = (start + reference) - self.anchor;
        let value = |at: f64, slope: f64, factor: f64| finite((at + slope * distance).max(0.0) * factor);
        let [at, slope] = self.color;
        LocalPiece {
            start: start as f32,
            end: end as f32,
            extinction: [value(self.extinction[0], self.extinction[1], length), finite(self.extinction[1] * length)],
            color: [[0, 1, 2].map(|c| value(at[c], slope[c], color_factor)), slope.map(|s| finite(s * color_factor))],
        }
    }
}

impl Optics {
    /// - `surfaces`: those that are to be seen, in the renderer's unit
    /// - `base`, `factor`: scalars of the plan less the first, times the second, are in the renderer's unit
    /// - `scalars`: one a point, in that unit
    pub(crate) fn new(
        source: &TransferFunction,
        (base, factor): (f64, f64),
        model: OpticalModel,
        surfaces: &Isosurfaces,
        tetrahedra: &[[VertexId; 4]],
        scalars: &[f64],
    ) -> Self {
        let shown = Shown::new(source.with_scalars_from(base).with_scalars_scaled(factor), model, surfaces.clone());
        let transfer = shown.transfer();
        let range = |cell: &[VertexId; 4]| {
            let values = cell.map(|v| scalars[v.index()]);
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &s| (low.min(s), high.max(s)))
        };
        let pieces = tetrahedra
            .par_iter()
            .map(|cell| {
                let (low, high) = range(cell);
                let pieces = transfer.pieces_between(low, high);
                CellPieces { first: pieces.start as u32, count: pieces.len() as u32 }
            })
            .collect();
        let is_visible = |cell: &[VertexId; 4]| {
            let (low, high) = range(cell);
            shown.shows(low, high)
        };
        let is_shown: Vec<bool> = tetrahedra.par_iter().map(is_visible).collect();
        let visible =
            (0..tetrahedra.len() as u32).into_par_iter().filter(|&cell| is_shown[cell as usize]).map(CellId).collect();
        let lines = transfer.pieces().iter().map(Line::new).collect();
        let sharpness = Sharpness::new(shown.transfer(), model);
        Self { source: source.clone(), shown, model, sharpness, lines, pieces, visible, is_shown }
    }

    /// Whether these are the optics of that transfer function, and of surfaces of these values.
    pub(crate) fn is_for(&self, transfer: &TransferFunction, model: OpticalModel, surfaces: &Isosurfaces) -> bool {
        let values = |surfaces: &Isosurfaces| surfaces.as_slice().iter().map(|s| s.value).collect::<Vec<_>>();
        self.model == model && self.source == *transfer && values(self.shown.surfaces()) == values(surfaces)
    }

    /// For every cell whether it adds something to the picture.
    pub(crate) fn is_shown(&self) -> &[bool] {
        &self.is_shown
    }

    pub(crate) fn sharpness(&self) -> &Sharpness {
        &self.sharpness
    }

    pub(crate) fn visible(&self) -> &[CellId] {
        &self.visible
    }

    pub(crate) fn pieces_of(&self, cell: CellId) -> CellPieces {
        self.pieces[cell.index()]
    }

    pub(crate) fn transfer(&self) -> &TransferFunction {
        self.shown.transfer()
    }

    /// The pieces that a cell meets, ascending, as it sees them.
    #[inline(always)]
    pub(crate) fn localize(&self, record: &CellRecord, local: &mut Vec<LocalPiece>) {
        let &CellRecord { pieces, scalar_reference: reference, scalar_range: range, length, .. } = record;
        local.clear();
        let first = pieces.first as usize;
        let all = &self.lines[first..first + pieces.count as usize];
        let color_factor = if self.model.color_is_per_length() { length } else { 1.0 };
        for (index, line) in all.iter().enumerate() {
            // The first and the last reach the ends of the range, so that rounding leaves no scalar without a piece.
            let start = if index == 0 { f64::from(range[0]) } else { line.start - reference };
            let end = if index + 1 == all.len() { f64::from(range[1]) } else { line.end - reference };
            local.push(line.localize(reference, [start, end], length, color_factor));
        }
    }
}

/// An extinction of more than this is opaque however short a chord is; brighter light than this has no picture.
const MOST: f64 = 1e30;

/// To f32, so far from infinite that sums and products with scalars and lengths are finite too: times zero, infinity would be NaN.
#[inline(always)]
fn finite(x: f64) -> f32 {
    x.clamp(-MOST, MOST) as f32
}
