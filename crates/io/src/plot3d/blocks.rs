//! The numbers of a file whose layout is known.

use tetrascope_mesh::ArrayValues;

use super::{
    layout::{Encoding, Layout},
    measure::{Content, Fit},
    records::{RecordError, Records},
};
use crate::bytes::Number;

/// The two float types of files.
pub(super) trait Real: Number + Into<f64> {
    /// Rounds to the type.
    fn from_f64(value: f64) -> Self;

    /// The values as a mesh's array.
    fn array(values: Vec<Self>) -> ArrayValues;
}

impl Real for f32 {
    fn from_f64(value: f64) -> Self {
        value as Self
    }

    fn array(values: Vec<Self>) -> ArrayValues {
        ArrayValues::F32(values)
    }
}

impl Real for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn array(values: Vec<Self>) -> ArrayValues {
        ArrayValues::F64(values)
    }
}

/// One grid's part of a file.
#[derive(Clone, Debug)]
pub(super) struct Block<T> {
    /// Of a solution: Mach number, angle of attack in degrees, Reynolds number, time. Empty for a grid.
    pub(super) reference: Vec<T>,
    /// One quantity after another, each with one value a point, i fastest.
    pub(super) values: Vec<T>,
    /// One value a point, or empty where the file has none.
    pub(super) iblank: Vec<i32>,
}

/// Reads all grids' parts; `T` is the float type of the layout (f64 for text).
///
/// The layout has been measured, so that nothing is missing; should it be, that is an error and no panic.
pub(super) fn read<T: Real>(content: &Content<'_>, fit: &Fit) -> Result<Vec<Block<T>>, RecordError> {
    let layout = fit.layout;
    match (content, layout.encoding) {
        (Content::Text(values), _) => read_text(values, fit),
        (Content::Binary(bytes), Encoding::Binary { order, marks, .. }) => {
            read_binary(Records::new(bytes, order, marks), fit)
        }
        (Content::Binary(_), Encoding::Text) => Err(RecordError::too_short(0, 1, 0)),
    }
}

fn read_binary<T: Real>(mut records: Records<'_>, fit: &Fit) -> Result<Vec<Block<T>>, RecordError> {
    let layout = fit.layout;
    if layout.multi {
        records.integers(1)?;
    }
    records.integers(fit.dims.len() * layout.axes)?;
    fit.points()
        .map(|points| {
            let reference = match layout.floats_per_block() {
                0 => Vec::new(),
                floats => records.record((floats * T::SIZE) as u64)?.many(floats)?,
            };
            let size = u64::try_from(layout.points_record(points as u128)).unwrap_or(u64::MAX);
            let mut record = records.record(size)?;
            let values = record.many(points * layout.floats_per_point())?;
            let iblank = if layout.iblank { record.many(points)? } else { Vec::new() };
            Ok(Block { reference, values, iblank })
        })
        .collect()
}

fn read_text<T: Real>(values: &[f64], fit: &Fit) -> Result<Vec<Block<T>>, RecordError> {
    let layout = fit.layout;
    let mut next = 0;
    let mut take = |count: usize| {
        let taken = values[next..].get(..count).ok_or(RecordError::too_short(next, count, values.len()))?;
        next += count;
        Ok::<_, RecordError>(taken)
    };
    take(header_length(layout, fit.dims.len()))?;
    let convert = |values: &[f64]| values.iter().map(|&v| T::from_f64(v)).collect();
    fit.points()
        .map(|points| {
            let reference = convert(take(layout.floats_per_block())?);
            let values = convert(take(points * layout.floats_per_point())?);
            // Out of range values saturate and keep their sign, and only 0 has a meaning.
            let flag = |&v: &f64| if v.abs() > 0.0 && v.abs() < 1.0 { 1 } else { v as i32 };
            let iblank = if layout.iblank { take(points)?.iter().map(flag).collect() } else { Vec::new() };
            Ok(Block { reference, values, iblank })
        })
        .collect()
}

fn header_length(layout: Layout, grids: usize) -> usize {
    usize::from(layout.multi) + grids * layout.axes
}
