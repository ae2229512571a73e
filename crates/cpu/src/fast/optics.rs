//! What a transfer function makes of the cells: which are invisible, and which pieces of it each one sees.

use rayon::prelude::*;
use tetrascope_integrate::{OpticalModel, Piece, TransferFunction};
use tetrascope_mesh::{CellId, VertexId};

/// A transfer function and what it makes of every cell; view independent.
#[derive(Debug)]
pub(crate) struct Optics {
    transfer: TransferFunction,
    pub(crate) model: OpticalModel,
    /// One entry a cell.
    pieces: Vec<CellPieces>,
    /// The cells that add something to the picture, ascending.
    visible: Vec<CellId>,
}

/// The pieces of the transfer function that a cell's range of scalars meets: `first .. first + count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CellPieces {
    pub(crate) first: u32,
    pub(crate) count: u32,
}

/// A piece as one cell sees it: in f32, over scalars relative to the cell's reference, cut to the cell's range, and with
/// lengths in the cell's unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalPiece {
    /// Lowest and highest scalar.
    pub(crate) start: f32,
    pub(crate) end: f32,
    /// Extinction at `start`, and its slope.
    pub(crate) extinction: [f32; 2],
    /// Color at `start`, and its slope.
    pub(crate) color: [[f32; 3]; 2],
}

impl Optics {
    pub(crate) fn new(
        transfer: &TransferFunction,
        model: OpticalModel,
        tetrahedra: &[[VertexId; 4]],
        scalars: &[f64],
    ) -> Self {
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
            (model.needs_extinction() && transfer.max_extinction(low, high) > 0.0)
                || (!model.is_dark_without_extinction() && transfer.max_emission(low, high) > 0.0)
        };
        let visible = (0..tetrahedra.len() as u32)
            .into_par_iter()
            .filter(|&cell| is_visible(&tetrahedra[cell as usize]))
            .map(CellId)
            .collect();
        Self { transfer: transfer.clone(), model, pieces, visible }
    }

    /// Whether these are the optics of that transfer function.
    pub(crate) fn is_for(&self, transfer: &TransferFunction, model: OpticalModel) -> bool {
        self.model == model && self.transfer == *transfer
    }

    pub(crate) fn visible(&self) -> &[CellId] {
        &self.visible
    }

    pub(crate) fn pieces_of(&self, cell: CellId) -> CellPieces {
        self.pieces[cell.index()]
    }

    pub(crate) fn transfer(&self) -> &TransferFunction {
        &self.transfer
    }

    /// The pieces that a cell meets, ascending, as it sees them.
    ///
    /// - `reference`: the scalar from which the cell counts
    /// - `range`: its lowest and highest scalar, counted from there
    /// - `length`: world length of the cell's unit of length
    pub(crate) fn localize(
        &self,
        pieces: CellPieces,
        reference: f64,
        range: [f32; 2],
        length: f64,
        local: &mut Vec<LocalPiece>,
    ) {
        local.clear();
        let first = pieces.first as usize;
        let all = &self.transfer.pieces()[first..first + pieces.count as usize];
        let color_factor = if self.model.color_is_per_length() { length } else { 1.0 };
        for (index, piece) in all.iter().enumerate() {
            // The first and the last reach the ends of the range, so that rounding leaves no scalar without a piece.
            let start = if index == 0 { f64::from(range[0]) } else { piece.start - reference };
            let end = if index + 1 == all.len() { f64::from(range[1]) } else { piece.end - reference };
            local.push(local_piece(piece, reference, [start, end], length, color_factor));
        }
    }
}

fn local_piece(piece: &Piece, reference: f64, [start, end]: [f64; 2], length: f64, color_factor: f64) -> LocalPiece {
    let width = piece.end - piece.start;
    let slope = |[low, high]: [f64; 2]| if width.is_finite() { (high - low) / width } else { 0.0 };
    let extinction = piece.extinction_at(start + reference);
    let color = piece.color_at(start + reference);
    let color_slope: [f64; 3] = std::array::from_fn(|c| slope([piece.color[0][c], piece.color[1][c]]));
    LocalPiece {
        start: start as f32,
        end: end as f32,
        extinction: [finite(extinction * length), finite(slope(piece.extinction) * length)],
        color: [color.map(|c| finite(c * color_factor)), color_slope.map(|c| finite(c * color_factor))],
    }
}

/// To f32 without becoming infinite: times zero, infinity would be NaN.
fn finite(x: f64) -> f32 {
    x.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}
