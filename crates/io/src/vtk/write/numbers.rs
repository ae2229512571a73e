//! Numbers on their way to a file: as bytes in parts of a limited size, or as text.

use std::borrow::Cow;
use std::io::{self, Write};

use glam::DVec3;
use tetrascope_mesh::ArrayValues;

/// The numbers of an element, which may be made only when they are written, so that no two of them are in memory at a time.
pub(super) struct Numbers<'a> {
    pub(super) type_name: &'static str,
    make: Box<dyn Fn() -> Cow<'a, ArrayValues> + 'a>,
}

impl<'a> Numbers<'a> {
    /// Those of an array.
    pub(super) fn of(values: &'a ArrayValues) -> Self {
        Self { type_name: values.type_name(), make: Box::new(|| Cow::Borrowed(values)) }
    }

    /// Those that a function gives, which are of that type.
    pub(super) fn made(type_name: &'static str, make: impl Fn() -> ArrayValues + 'a) -> Self {
        Self { type_name, make: Box::new(move || Cow::Owned(make())) }
    }

    /// Coordinates, in 32 bits where these hold every one of them.
    pub(super) fn of_points(points: &'a [DVec3]) -> Self {
        let numbers = move || points.iter().flat_map(DVec3::to_array);
        // The bits are compared: the quiet NaN of 64 bits may have more of them than one of 32 can keep.
        if numbers().all(|x| f64::from(x as f32).to_bits() == x.to_bits()) {
            let single = move || ArrayValues::F32(numbers().map(|x| x as f32).collect());
            Self::made("Float32", single)
        } else {
            Self::made("Float64", move || ArrayValues::F64(numbers().collect()))
        }
    }

    /// Indices, in 32 bits if `limit`, which none of them is above, fits.
    pub(super) fn of_indices<I: Iterator<Item = i64>>(limit: usize, indices: impl Fn() -> I + 'a) -> Self {
        if i32::try_from(limit).is_ok() {
            // None is above the limit.
            let short = move || ArrayValues::I32(indices().map(|index| index as i32).collect());
            Self::made("Int32", short)
        } else {
            Self::made("Int64", move || ArrayValues::I64(indices().collect()))
        }
    }

    pub(super) fn values(&self) -> Cow<'a, ArrayValues> {
        (self.make)()
    }
}

/// Bytes that a number takes.
pub(super) fn size(values: &ArrayValues) -> usize {
    match values {
        ArrayValues::I8(_) | ArrayValues::U8(_) => 1,
        ArrayValues::I16(_) | ArrayValues::U16(_) => 2,
        ArrayValues::I32(_) | ArrayValues::U32(_) | ArrayValues::F32(_) => 4,
        ArrayValues::I64(_) | ArrayValues::U64(_) | ArrayValues::F64(_) => 8,
    }
}

/// Gives all numbers as bytes in the order of this machine, in parts of `part` bytes, a multiple of 8, and a shorter last one.
pub(super) fn for_parts(
    values: &ArrayValues,
    part: usize,
    mut take: impl FnMut(&[u8]) -> io::Result<()>,
) -> io::Result<()> {
    let mut bytes = Vec::new();
    let in_part = (part / size(values)).max(1);
    macro_rules! all {
        ($($kind:ident),*) => {
            match values {
                $(ArrayValues::$kind(numbers) => {
                    for run in numbers.chunks(in_part) {
                        bytes.clear();
                        bytes.extend(run.iter().flat_map(|x| x.to_ne_bytes()));
                        take(&bytes)?;
                    }
                })*
            }
        };
    }
    all!(I8, U8, I16, U16, I32, U32, I64, U64, F32, F64);
    Ok(())
}

/// Numbers a line of text.
const LINE: usize = 12;

/// Writes all numbers as text: the shortest that gives the same number again.
pub(super) fn write_text(values: &ArrayValues, out: &mut impl Write) -> io::Result<()> {
    macro_rules! all {
        ($form:literal: $($kind:ident),*; $float_form:literal: $($float:ident),*) => {
            match values {
                $(ArrayValues::$kind(numbers) => {
                    for (index, x) in numbers.iter().enumerate() {
                        write!(out, $form, between(index), x)?;
                    }
                })*
                $(ArrayValues::$float(numbers) => {
                    for (index, x) in numbers.iter().enumerate() {
                        write!(out, $float_form, between(index), x)?;
                    }
                })*
            }
        };
    }
    all!("{}{}": I8, U8, I16, U16, I32, U32, I64, U64; "{}{:?}": F32, F64);
    Ok(())
}

fn between(index: usize) -> &'static str {
    match index {
        0 => "",
        index if index % LINE == 0 => "\n",
        _ => " ",
    }
}
