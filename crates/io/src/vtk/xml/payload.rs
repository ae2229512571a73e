//! The numbers of one array, from text, from inline base64 or from the appended section.
//!
//! Layout, as VTK's XML writer produces it. Without compression: one word with the number of bytes, then the bytes. With
//! compression: words for the number of blocks, their uncompressed size, the last one's if it is partial (else 0), and each
//! one's compressed size; then the blocks. In base64 the header of a compressed array is encoded apart from its blocks.

use std::borrow::Cow;

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use tetrascope_mesh::ArrayValues;

use super::super::DAMAGED;
use super::super::scalars::{ByteOrder, ScalarType};
use super::attributes::line;
use super::compression::Decompressor;
use super::file::{Appended, ArrayElement, XmlFile, without_mark};
use crate::{IoError, Source};

/// Writers differ in whether they pad the end, and in the bits that fill the last character.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

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
    let invalid = |problem: String| source.invalid(place(source, array, label), problem, DAMAGED);
    let bytes = match array.format.to_ascii_lowercase().as_str() {
        "ascii" => {
            let mut words = array.text.iter().flat_map(|text| text.split_ascii_whitespace());
            return scalar.parse_words(&mut words, usize::MAX).map_err(|bad| {
                invalid(format!("value {} is \"{}\", which is no {}", bad.index, bad.word, array.type_name))
            });
        }
        "binary" => {
            let text: String = array.text.iter().flat_map(|text| text.split_ascii_whitespace()).collect();
            if text.is_empty() {
                return Ok(scalar.decode_bytes(&[], file.byte_order));
            }
            read_bytes(Encoded::Base64(text.as_bytes()), file, scalar).map(Cow::into_owned).map_err(invalid)?
        }
        "appended" => {
            let appended = file.appended.ok_or_else(|| invalid("there is no appended data in the file".to_owned()))?;
            let offset = array.offset.as_deref().unwrap_or_default();
            let start: usize = offset
                .trim()
                .parse()
                .map_err(|_| invalid(format!("its offset is \"{}\", not a number of bytes", offset.trim())))?;
            let (Appended::Raw(section) | Appended::Base64(section)) = appended;
            let rest = section.get(start..).ok_or_else(|| {
                invalid(format!("its offset is {start}, but only {} bytes of appended data are there", section.len()))
            })?;
            let encoded = match appended {
                Appended::Raw(_) => Encoded::Raw(rest),
                Appended::Base64(_) => Encoded::Base64(rest),
            };
            let bytes = read_bytes(encoded, file, scalar).map_err(invalid)?;
            return whole_numbers(&bytes, scalar, file.byte_order).map_err(invalid);
        }
        other => {
            let other: String = other.chars().take(40).collect();
            return Err(invalid(format!("its format is \"{other}\", where ascii, binary and appended are known")));
        }
    };
    whole_numbers(&bytes, scalar, file.byte_order).map_err(invalid)
}

/// Where an array stands, for messages.
pub(super) fn place(source: &Source, array: &ArrayElement<'_>, label: &str) -> String {
    format!("{} ({label})", line(without_mark(&source.bytes), array.position))
}

fn whole_numbers(bytes: &[u8], scalar: ScalarType, order: ByteOrder) -> Result<ArrayValues, String> {
    if !bytes.len().is_multiple_of(scalar.size()) {
        return Err(format!("it has {} bytes, which is no multiple of the {} of a value", bytes.len(), scalar.size()));
    }
    Ok(scalar.decode_bytes(bytes, order))
}

/// Bytes still in their encoding; what was taken is gone.
#[derive(Clone, Copy)]
enum Encoded<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

impl<'a> Encoded<'a> {
    /// The next `count` bytes, which in base64 were encoded together: they end with a whole group of four characters.
    fn take(&mut self, count: usize) -> Result<Cow<'a, [u8]>, String> {
        match self {
            Self::Raw(rest) => {
                let (taken, left) = rest.split_at_checked(count).ok_or_else(|| too_short(count, rest.len()))?;
                *rest = left;
                Ok(Cow::Borrowed(taken))
            }
            Self::Base64(rest) => {
                // More bytes than characters cannot be there, and below that the sum does not overflow.
                if count > rest.len() {
                    return Err(too_short(count, rest.len() / 4 * 3));
                }
                let characters = count.div_ceil(3) * 4;
                let (taken, left) = rest.split_at(characters.min(rest.len()));
                let mut bytes = BASE64.decode(taken).map_err(|e| format!("its base64 is damaged ({e})"))?;
                if bytes.len() < count {
                    return Err(too_short(count, bytes.len()));
                }
                bytes.truncate(count);
                *rest = left;
                Ok(Cow::Owned(bytes))
            }
        }
    }

    /// Whether the next `count` bytes were encoded apart from what follows: their last group is padded just so.
    fn is_apart(&self, count: usize) -> bool {
        match self {
            Self::Raw(_) => true,
            Self::Base64(rest) => {
                let padding = (3 - count % 3) % 3;
                let end = count.div_ceil(3) * 4;
                padding > 0 && rest.get(end - padding) == Some(&b'=')
            }
        }
    }
}

fn too_short(needed: usize, there: usize) -> String {
    format!("{needed} bytes are declared, but only {there} are left in the file")
}

/// The array's bytes in the file's byte order, without header and compression.
fn read_bytes<'a>(mut encoded: Encoded<'a>, file: &XmlFile<'_>, scalar: ScalarType) -> Result<Cow<'a, [u8]>, String> {
    let size = file.header_size;
    let word = |bytes: &[u8]| -> Result<usize, String> {
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
        usize::try_from(value).map_err(|_| format!("its header says {value}"))
    };
    let mut ahead = encoded;
    let first = word(&ahead.take(size)?)?;
    let Some(compressor) = file.compressor else {
        if encoded.is_apart(size) {
            encoded.take(size)?;
            let bytes = encoded.take(first)?;
            return file.budget.spend(first / scalar.size(), scalar.size()).map(|()| bytes);
        }
        let total = first.checked_add(size).ok_or_else(|| format!("{first} bytes are declared"))?;
        let mut bytes = encoded.take(total)?.into_owned();
        file.budget.spend(first / scalar.size(), scalar.size())?;
        bytes.drain(..size);
        return Ok(Cow::Owned(bytes));
    };
    let block_count = first;
    if block_count == 0 {
        return Ok(Cow::Borrowed(&[]));
    }
    let header_size = block_count
        .checked_add(3)
        .and_then(|words| words.checked_mul(size))
        .ok_or_else(|| format!("{block_count} compressed blocks are declared"))?;
    // Taking the header proves that its words are there, and so bounds the number of blocks by the file's size.
    let header = encoded.take(header_size).map_err(|e| format!("{block_count} compressed blocks: {e}"))?;
    let mut words = header.chunks_exact(size).map(word).skip(1);
    let mut next = || words.next().unwrap_or_else(|| Err("its header is too short".to_owned()));
    let (block_size, last_size) = (next()?, next()?);
    let stored: Vec<usize> = words.collect::<Result<_, _>>()?;
    let total = stored
        .iter()
        .try_fold(0_usize, |sum, &n| sum.checked_add(n))
        .ok_or("the sizes of its compressed blocks overflow")?;
    let blocks = encoded.take(total)?;
    let declared_of = |number: usize| if number + 1 == stored.len() && last_size != 0 { last_size } else { block_size };
    let inflated = (stored.len() - 1).saturating_mul(block_size).saturating_add(declared_of(stored.len() - 1));
    file.budget.spend(inflated / scalar.size(), scalar.size())?;
    let mut decompressor = Decompressor::new(compressor);
    let mut out = Vec::new();
    let mut at = 0;
    for (number, &length) in stored.iter().enumerate() {
        decompressor
            .decompress(&blocks[at..at + length], declared_of(number), &mut out)
            .map_err(|e| format!("compressed block {number} of {block_count}: {e}"))?;
        at += length;
    }
    Ok(Cow::Owned(out))
}
