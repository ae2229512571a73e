//! The numbers of one array, from text, from inline base64 or from the appended section.
//!
//! Layout, as VTK's XML writer produces it. Without compression: one word with the number of bytes, then the bytes. With
//! compression: words for the number of blocks, their uncompressed size, the last one's if it is partial (else 0), and each
//! one's compressed size; then the blocks. In base64 the header of a compressed array is encoded apart from its blocks.
//!
//! Numbers are turned into what they are for as they are decoded, so that no array is in memory twice.

use std::borrow::Cow;

use tetrascope_mesh::ArrayValues;

use super::super::DAMAGED;
use super::super::numbers::Scalar;
use super::super::scalars::{ByteOrder, ScalarType, for_type, with_type};
use super::attributes::line;
use super::body::{Blocks, Body};
use super::encoded::{Encoded, Problem, Stored, too_short};
use super::file::{Appended, ArrayElement, XmlFile, without_mark};
use super::text;
use crate::{IoError, Source};

/// The type that an array's `type` attribute names; nothing for text and bit arrays and for unknown names.
pub(super) fn scalar_type(name: &str) -> Option<ScalarType> {
    Some(match name {
        "Int8" => ScalarType::I8,
        "UInt8" => ScalarType::U8,
        "Int16" => ScalarType::I16,
        "UInt16" => ScalarType::U16,
        "Int32" => ScalarType::I32,
        "UInt32" => ScalarType::U32,
        "Int64" | "vtkIdType" => ScalarType::I64,
        "UInt64" => ScalarType::U64,
        "Float32" => ScalarType::F32,
        "Float64" => ScalarType::F64,
        _ => return None,
    })
}

/// An array that is wanted.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'w> {
    pub(super) source: &'w Source,
    pub(super) file: &'w XmlFile<'w>,
    pub(super) array: &'w ArrayElement<'w>,
    pub(super) scalar: ScalarType,
    /// What to call it in messages.
    pub(super) label: &'w str,
}

/// Reads an array's numbers.
///
/// - `label`: what to call the array in messages
///
/// # Errors
/// With the array's name and line: bad words, bad base64, sizes beyond the file, damaged or oversized blocks.
pub(super) fn decode(
    source: &Source,
    file: &XmlFile<'_>,
    array: &ArrayElement<'_>,
    scalar: ScalarType,
    label: &str,
) -> Result<ArrayValues, IoError> {
    let wanted = Wanted { source, file, array, scalar, label };
    Ok(for_type!(scalar, T => {
        let mut numbers = Vec::new();
        wanted.turn::<T, T>(&mut numbers, T::default(), Some)?;
        numbers
    }))
}

impl Wanted<'_> {
    /// Reads whole numbers as they are used for indices and turns them into something, behind what is in `made` already; false as soon as
    /// one could not be, as no floating-point number can, and then without the rest.
    ///
    /// # Errors
    /// As of [`decode`].
    pub(super) fn turn_indices<T: Copy + Send>(
        &self,
        made: &mut Vec<T>,
        blank: T,
        turn: impl Fn(i64) -> Option<T> + Sync,
    ) -> Result<bool, IoError> {
        with_type!(self.scalar, S => self.turn::<S, T>(made, blank, |number| number.to_index().and_then(&turn)))
    }

    /// Reads numbers of any type as f64.
    ///
    /// # Errors
    /// As of [`decode`].
    pub(super) fn decode_f64(&self) -> Result<Vec<f64>, IoError> {
        let mut numbers = Vec::new();
        with_type!(self.scalar, S => self.turn::<S, f64>(&mut numbers, 0.0, |number| Some(number.to_f64())))?;
        Ok(numbers)
    }

    fn turn<S: Scalar, T: Copy + Send>(
        &self,
        made: &mut Vec<T>,
        blank: T,
        turn: impl Fn(S) -> Option<T> + Sync,
    ) -> Result<bool, IoError> {
        let Self { source, file, array, scalar, label } = *self;
        let invalid = |problem: String| source.invalid(place(source, array, label), problem, DAMAGED);
        let body = match array.format.to_ascii_lowercase().as_str() {
            "ascii" => {
                return text::turn(&array.text, file, made, turn)?.map_err(|bad| {
                    invalid(format!("value {} is \"{}\", which is no {}", bad.index, bad.word, array.type_name))
                });
            }
            "binary" => {
                let text = text::without_white_space(&array.text);
                if text.is_empty() {
                    return Ok(true);
                }
                return self.turn_bytes(open(Encoded::Base64(text.as_bytes()), file, scalar), made, blank, turn);
            }
            "appended" => {
                let appended =
                    file.appended.ok_or_else(|| invalid("there is no appended data in the file".to_owned()))?;
                let offset = array.offset.as_deref().unwrap_or_default();
                let start: usize = offset
                    .trim()
                    .parse()
                    .map_err(|_| invalid(format!("its offset is \"{}\", not a number of bytes", offset.trim())))?;
                let encoded = appended.from(start).ok_or_else(|| {
                    let there = appended.length();
                    invalid(format!("its offset is {start}, but only {there} bytes of appended data are there"))
                })?;
                open(encoded, file, scalar)
            }
            other => {
                let other: String = other.chars().take(40).collect();
                return Err(invalid(format!("its format is \"{other}\", where ascii, binary and appended are known")));
            }
        };
        self.turn_bytes(body, made, blank, turn)
    }

    fn turn_bytes<S: Scalar, T: Copy + Send>(
        &self,
        body: Result<Body<'_>, Problem>,
        made: &mut Vec<T>,
        blank: T,
        turn: impl Fn(S) -> Option<T> + Sync,
    ) -> Result<bool, IoError> {
        let Self { source, file, array, scalar, label } = *self;
        let (size, order) = (scalar.size(), file.byte_order);
        let done = body.and_then(|body| {
            let length = body.length();
            if !length.is_multiple_of(size) {
                return Err(format!("it has {length} bytes, which is no multiple of the {size} of a value").into());
            }
            body.turn(file, size, made, blank, &|bytes: &[u8], made: &mut [T]| S::turn_bytes(bytes, order, made, &turn))
        });
        done.map_err(|problem| match problem {
            Problem::Words(words) => source.invalid(place(source, array, label), words, DAMAGED),
            Problem::Failed(error) => error,
        })
    }
}

impl<'a> Appended<'a> {
    fn length(&self) -> usize {
        match self {
            Self::Raw(section) | Self::Base64(section) => section.len(),
            Self::Open { file, start } => file.length().saturating_sub(*start),
        }
    }

    /// What is behind so many bytes of the section; nothing where there are fewer.
    fn from(&self, offset: usize) -> Option<Encoded<'a>> {
        Some(match *self {
            Self::Raw(section) => Encoded::Raw(section.get(offset..)?),
            Self::Base64(section) => Encoded::Base64(section.get(offset..)?),
            Self::Open { file, start } => {
                let start = start.checked_add(offset).filter(|&start| start <= file.length())?;
                Encoded::Open { file, start, end: file.length() }
            }
        })
    }
}

/// Where an array stands, for messages.
pub(super) fn place(source: &Source, array: &ArrayElement<'_>, label: &str) -> String {
    format!("{} ({label})", line(without_mark(&source.bytes), array.position))
}

/// An array's header, and where its data are.
fn open<'a>(mut encoded: Encoded<'a>, file: &XmlFile<'_>, scalar: ScalarType) -> Result<Body<'a>, Problem> {
    let size = file.header_size;
    let word = |bytes: &[u8]| -> Result<usize, Problem> {
        let mut wide = [0_u8; 8];
        let value = match file.byte_order {
            ByteOrder::Little => {
                wide[..size].copy_from_slice(&bytes[..size]);
                u64::from_le_bytes(wide)
            }
            ByteOrder::Big => {
                wide[8 - size..].copy_from_slice(&bytes[..size]);
                u64::from_be_bytes(wide)
            }
        };
        usize::try_from(value).map_err(|_| Problem::Words(format!("its header says {value}")))
    };
    let mut ahead = encoded.clone();
    let first = word(&ahead.take(size)?)?;
    let Some(compressor) = file.compressor else {
        let before = if encoded.is_apart(size) {
            encoded.take(size)?;
            0
        } else {
            size
        };
        let body = match encoded {
            Encoded::Base64(characters) => {
                // Base64 holds three bytes for four characters.
                let there = characters.len() / 4 * 3 + characters.len() % 4 * 3 / 4;
                let total = first.checked_add(before).filter(|&total| total <= there);
                total.ok_or_else(|| too_short(first, there.saturating_sub(before)))?;
                Body::Base64 { characters, before, length: first }
            }
            mut plain => Body::Plain(plain.take_stored(first)?),
        };
        file.budget.spend(first / scalar.size(), scalar.size())?;
        return Ok(body);
    };
    let block_count = first;
    if block_count == 0 {
        return Ok(Body::Plain(Stored::Memory(Cow::Borrowed(&[]))));
    }
    let header_size = block_count
        .checked_add(3)
        .and_then(|words| words.checked_mul(size))
        .ok_or_else(|| format!("{block_count} compressed blocks are declared"))?;
    // Taking the header proves that its words are there, and so bounds the number of blocks by the file's size.
    let header = encoded.take(header_size).map_err(|problem| match problem {
        Problem::Words(words) => Problem::Words(format!("{block_count} compressed blocks: {words}")),
        failed => failed,
    })?;
    let mut words = header.chunks_exact(size).map(word).skip(1);
    let mut next = || words.next().unwrap_or_else(|| Err("its header is too short".to_owned().into()));
    let (block_size, last_size) = (next()?, next()?);
    let lengths: Vec<usize> = words.collect::<Result<_, _>>()?;
    let total = lengths
        .iter()
        .try_fold(0_usize, |sum, &n| sum.checked_add(n))
        .ok_or_else(|| "the sizes of its compressed blocks overflow".to_owned())?;
    let last_size = if last_size == 0 { block_size } else { last_size };
    let blocks = Blocks { stored: encoded.take_stored(total)?, lengths, size: block_size, last_size, compressor };
    let body = Body::Blocks(blocks);
    file.budget.spend(body.length() / scalar.size(), scalar.size())?;
    Ok(body)
}
