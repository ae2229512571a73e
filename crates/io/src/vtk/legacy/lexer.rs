//! Words, lines and numbers of a legacy file.

use tetrascope_mesh::ArrayValues;

use super::super::DAMAGED;
use super::super::scalars::{ByteOrder, ScalarType};
use crate::{IoError, Source};

/// Walks through a file that mixes lines of text with binary blocks.
#[derive(Clone)]
pub(super) struct Lexer<'a> {
    pub(super) source: &'a Source,
    bytes: &'a [u8],
    position: usize,
    pub(super) is_binary: bool,
}

/// A type of numbers as legacy files name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LegacyType {
    /// Packed in binary files, eight to a byte, the first in the highest bit.
    Bit,
    /// VTK's index type. Binary files hold 32 bits of it, whatever the program that wrote them used.
    Id,
    /// All others.
    Plain(ScalarType),
}

impl<'a> Lexer<'a> {
    /// A lexer from a byte on; text until told otherwise.
    pub(super) fn new(source: &'a Source, position: usize) -> Self {
        Self { source, bytes: &source.bytes, position, is_binary: false }
    }

    /// Whether nothing but white space is left. Zero bytes count as such: some writers pad their files with them.
    pub(super) fn is_at_end(&self) -> bool {
        self.bytes[self.position..].iter().all(|&byte| byte == 0 || byte.is_ascii_whitespace())
    }

    /// Whether not even white space is left. Unlike [`is_at_end`](Self::is_at_end) this takes no time, for loops over lines.
    pub(super) fn is_used_up(&self) -> bool {
        self.position >= self.bytes.len()
    }

    /// The rest of the line without its end, which is passed over; "\r\n" ends a line too.
    pub(super) fn line(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.position..];
        let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.position += (length + 1).min(rest.len());
        rest[..length].strip_suffix(b"\r").unwrap_or(&rest[..length])
    }

    /// The next word, or nothing at the end. What is not UTF-8 comes as nothing too, as no keyword or number does so.
    pub(super) fn word(&mut self) -> Option<&'a str> {
        let rest = &self.bytes[self.position..];
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        self.position += start + length;
        std::str::from_utf8(&rest[start..start + length]).ok()
    }

    /// The next word in upper case; `wanted` says what it should be, for the error at the file's end.
    pub(super) fn keyword(&mut self, wanted: &str) -> Result<String, IoError> {
        match self.word() {
            Some(word) => Ok(word.chars().take(40).collect::<String>().to_ascii_uppercase()),
            None => Err(self.invalid(format!("the file ends where {wanted} belongs, or holds what is no text there"))),
        }
    }

    /// Whether the next word is this one, in capitals or not; it is passed over if so.
    pub(super) fn accept(&mut self, keyword: &str) -> bool {
        let mut ahead = self.clone();
        let is_next = ahead.word().is_some_and(|word| word.eq_ignore_ascii_case(keyword));
        if is_next {
            self.position = ahead.position;
        }
        is_next
    }

    /// A name, with its percent-encoded bytes decoded.
    pub(super) fn name(&mut self) -> Result<String, IoError> {
        let rest = &self.bytes[self.position..];
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace());
        let Some(start) = start else { return Err(self.invalid("the file ends where a name belongs")) };
        let length = rest[start..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - start);
        self.position += start + length;
        Ok(decode_name(&rest[start..start + length]))
    }

    /// A count or size.
    pub(super) fn count(&mut self, what: &str) -> Result<usize, IoError> {
        let word = self.word().unwrap_or_default();
        word.parse().map_err(|_| {
            let word: String = word.chars().take(40).collect();
            self.invalid(format!("{what} is \"{word}\", not a count"))
        })
    }

    /// The name of a type. Nothing for types whose values are no numbers.
    pub(super) fn scalar_type(&mut self) -> Result<Option<LegacyType>, IoError> {
        let name = self.keyword("a type")?;
        Ok(Some(match name.as_str() {
            "BIT" => LegacyType::Bit,
            "CHAR" | "SIGNED_CHAR" | "VTKTYPEINT8" => LegacyType::Plain(ScalarType::I8),
            "UNSIGNED_CHAR" | "VTKTYPEUINT8" => LegacyType::Plain(ScalarType::U8),
            "SHORT" | "VTKTYPEINT16" => LegacyType::Plain(ScalarType::I16),
            "UNSIGNED_SHORT" | "VTKTYPEUINT16" => LegacyType::Plain(ScalarType::U16),
            "INT" | "VTKTYPEINT32" => LegacyType::Plain(ScalarType::I32),
            "UNSIGNED_INT" | "VTKTYPEUINT32" => LegacyType::Plain(ScalarType::U32),
            // The format does not say how long a `long` is; all systems but Windows write eight bytes.
            "LONG" | "LONG_LONG" | "VTKTYPEINT64" => LegacyType::Plain(ScalarType::I64),
            "UNSIGNED_LONG" | "UNSIGNED_LONG_LONG" | "VTKTYPEUINT64" => LegacyType::Plain(ScalarType::U64),
            "VTKIDTYPE" => LegacyType::Id,
            "FLOAT" => LegacyType::Plain(ScalarType::F32),
            "DOUBLE" => LegacyType::Plain(ScalarType::F64),
            "STRING" | "UTF8_STRING" => return Ok(None),
            _ => return Err(self.invalid(format!("the type \"{}\" is not known", name.to_ascii_lowercase()))),
        }))
    }

    /// Reads a block of numbers that starts on the next line. In binary files all bytes must be there before any memory
    /// is taken; in text it is taken as the words come.
    pub(super) fn numbers(&mut self, kind: LegacyType, count: usize, what: &str) -> Result<ArrayValues, IoError> {
        if !self.is_binary {
            let scalar = match kind {
                LegacyType::Bit => ScalarType::U8,
                LegacyType::Id => ScalarType::I64,
                LegacyType::Plain(scalar) => scalar,
            };
            let values = scalar.parse_words(&mut std::iter::from_fn(|| self.word()), count).map_err(|bad| {
                self.invalid(format!(
                    "value {} of {what} is \"{}\", which is no number of its type",
                    bad.index, bad.word
                ))
            })?;
            if values.len() < count {
                let problem = format!("{what}: the file ends after {} of {count} values", values.len());
                return Err(self.invalid(problem));
            }
            return Ok(values);
        }
        match kind {
            LegacyType::Bit => {
                let packed = self.block(Some(count.div_ceil(8)), what)?;
                Ok(ArrayValues::U8((0..count).map(|i| packed[i / 8] >> (7 - i % 8) & 1).collect()))
            }
            LegacyType::Id => {
                let bytes = self.block(count.checked_mul(4), what)?;
                Ok(ArrayValues::I64(
                    bytes.as_chunks::<4>().0.iter().map(|&chunk| i32::from_be_bytes(chunk).into()).collect(),
                ))
            }
            LegacyType::Plain(scalar) => {
                let bytes = self.block(count.checked_mul(scalar.size()), what)?;
                Ok(scalar.decode_bytes(bytes, ByteOrder::Big))
            }
        }
    }

    /// The next bytes of a binary file; nothing as length stands for one that overflows.
    pub(super) fn block(&mut self, length: Option<usize>, what: &str) -> Result<&'a [u8], IoError> {
        let rest = &self.bytes[self.position..];
        let Some((block, _)) = length.and_then(|length| rest.split_at_checked(length)) else {
            let needed = length.map_or_else(|| "more bytes than can be counted".to_owned(), |n| format!("{n} bytes"));
            return Err(self.invalid(format!("{what} declares {needed}, but only {} are left", rest.len())));
        };
        self.position += block.len();
        Ok(block)
    }

    /// An error at this place: a line of a text file, a byte of a binary one.
    pub(super) fn invalid(&self, problem: impl Into<String>) -> IoError {
        let place = if self.is_binary {
            format!("byte {}", self.position)
        } else {
            let before = &self.bytes[..self.position.min(self.bytes.len())];
            format!("line {}", 1 + before.iter().filter(|&&byte| byte == b'\n').count())
        };
        self.source.invalid(place, problem, DAMAGED)
    }
}

/// Replaces `%20` and the like by the bytes that they stand for; a percent sign that starts no such code stays.
fn decode_name(encoded: &[u8]) -> String {
    let mut decoded = Vec::with_capacity(encoded.len());
    let mut rest = encoded;
    while let Some((&first, behind)) = rest.split_first() {
        let code = match rest {
            [b'%', high, low, ..] => hex_digit(*high).zip(hex_digit(*low)),
            _ => None,
        };
        match code {
            Some((high, low)) => {
                decoded.push(high << 4 | low);
                rest = &rest[3..];
            }
            None => {
                decoded.push(first);
                rest = behind;
            }
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}

fn hex_digit(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).and_then(|value| u8::try_from(value).ok())
}
