//! The ways in which PLOT3D files are written, and what a file must hold in each.
//!
//! Nothing in a file says how it was written; [Walatka 1990] describes the formats. [`all_layouts`] lists
//! every way that is read here.

use std::fmt;

use crate::bytes::ByteOrder;

/// Which of the two files of a data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Coordinates, perhaps with iblank ("xyz file").
    Grid,
    /// Four reference values and five conserved quantities ("q file").
    Solution,
}

/// Width of the floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Precision {
    Single,
    Double,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Decimal numbers between white space.
    Text,
    /// Machine numbers; integers have 32 bits.
    Binary {
        order: ByteOrder,
        /// Whether each Fortran record stands between two 32-bit counts of its bytes.
        marks: bool,
        precision: Precision,
    },
}

/// One way of writing a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) kind: Kind,
    pub(super) encoding: Encoding,
    /// Whether the number of grids comes first.
    pub(super) multi: bool,
    /// Whether each grid's coordinates are followed by one integer a point. Never in a solution.
    pub(super) iblank: bool,
    /// 3, or 2 for the planar files that are told apart but not read.
    pub(super) axes: usize,
}

/// Every layout of a kind of file, text or binary, with 3 or 2 axes.
pub(super) fn all_layouts(kind: Kind, text: bool, axes: usize) -> Vec<Layout> {
    let mut encodings = vec![Encoding::Text];
    if !text {
        encodings.clear();
        for order in [ByteOrder::Big, ByteOrder::Little] {
            for marks in [false, true] {
                for precision in [Precision::Single, Precision::Double] {
                    encodings.push(Encoding::Binary { order, marks, precision });
                }
            }
        }
    }
    let iblanks: &[bool] = if kind == Kind::Grid { &[false, true] } else { &[false] };
    let mut layouts = Vec::new();
    for encoding in encodings {
        for multi in [false, true] {
            layouts.extend(iblanks.iter().map(|&iblank| Layout { kind, encoding, multi, iblank, axes }));
        }
    }
    layouts
}

impl Layout {
    /// Floats a point: coordinates, or density, momentum and energy.
    pub(super) fn floats_per_point(&self) -> usize {
        match self.kind {
            Kind::Grid => self.axes,
            Kind::Solution => self.axes + 2,
        }
    }

    /// Floats before those of the points: Mach number, angle of attack, Reynolds number and time of a solution.
    pub(super) fn floats_per_block(&self) -> usize {
        match self.kind {
            Kind::Grid => 0,
            Kind::Solution => 4,
        }
    }

    /// Bytes a float; 1 for text, where sizes are counted in numbers.
    pub(super) fn float_size(&self) -> usize {
        match self.encoding {
            Encoding::Text => 1,
            Encoding::Binary { precision: Precision::Single, .. } => 4,
            Encoding::Binary { precision: Precision::Double, .. } => 8,
        }
    }

    /// Bytes an integer; 1 for text.
    pub(super) fn integer_size(&self) -> usize {
        if self.encoding == Encoding::Text { 1 } else { 4 }
    }

    /// Bytes (of text: numbers) of the record with one grid's points.
    pub(super) fn points_record(&self, points: u128) -> u128 {
        let iblank = if self.iblank { self.integer_size() } else { 0 };
        points * (self.floats_per_point() * self.float_size() + iblank) as u128
    }

    /// Bytes (of text: numbers) of the whole file, without padding.
    pub(super) fn file_size(&self, points: impl ExactSizeIterator<Item = u128>) -> u128 {
        let blocks = points.len() as u128;
        let marks = if matches!(self.encoding, Encoding::Binary { marks: true, .. }) { 8 } else { 0 };
        let count = if self.multi { self.integer_size() as u128 + marks } else { 0 };
        let dims = blocks * (self.axes * self.integer_size()) as u128 + marks;
        let reference = match self.floats_per_block() {
            0 => 0,
            floats => (floats * self.float_size()) as u128 + marks,
        };
        count + dims + points.map(|n| reference + self.points_record(n) + marks).sum::<u128>()
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.encoding {
            Encoding::Text => f.write_str("text")?,
            Encoding::Binary { order, marks, precision } => {
                let bits = if precision == Precision::Single { 32 } else { 64 };
                let marks = if marks { "with record marks" } else { "no record marks" };
                write!(f, "binary, {order}, {bits}-bit, {marks}")?;
            }
        }
        f.write_str(if self.multi { ", multi-grid" } else { ", single-grid" })?;
        if self.kind == Kind::Grid {
            f.write_str(if self.iblank { ", with iblank" } else { ", no iblank" })?;
        }
        if self.axes == 2 { f.write_str(", 2-D") } else { Ok(()) }
    }
}

/// "40x32x32", and "8x12x12 + 8x12x12" for several grids.
pub(super) fn dims_text<T: fmt::Display>(dims: &[Vec<T>]) -> String {
    const SHOWN: usize = 8;
    let one = |dims: &Vec<T>| dims.iter().map(T::to_string).collect::<Vec<_>>().join("x");
    let mut text = dims.iter().take(SHOWN).map(one).collect::<Vec<_>>().join(" + ");
    if dims.len() > SHOWN {
        text += &format!(" + {} more", dims.len() - SHOWN);
    }
    text
}
