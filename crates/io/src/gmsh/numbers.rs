//! The numbers of a section, as words or as bytes behind one face.

use std::str::FromStr;

use super::REWRITE;
use super::sections::{Form, Section, Version};
use crate::bytes::{ByteOrder, Number};
use crate::{IoError, Source};

/// Walks through a section.
pub(super) struct Numbers<'a> {
    source: &'a Source,
    pub(super) section: Section<'a>,
    pub(super) position: usize,
}

impl<'a> Numbers<'a> {
    /// From a place in the section's body on.
    pub(super) fn new(source: &'a Source, section: Section<'a>, position: usize) -> Self {
        Self { source, section, position }
    }

    /// A number of 32 bits, or a word.
    pub(super) fn int(&mut self, what: &str) -> Result<i64, IoError> {
        match self.section.form {
            Form::Text => self.word(what),
            Form::Binary { order, .. } => Ok(self.fixed::<i32>(order, what)?.into()),
        }
    }

    /// A count, or a tag of version 4: as long as the header says, or a word.
    pub(super) fn size(&mut self, what: &str) -> Result<u64, IoError> {
        match self.section.form {
            Form::Text => self.word(what),
            Form::Binary { order, size_bytes: 4 } => Ok(self.fixed::<u32>(order, what)?.into()),
            Form::Binary { order, .. } => self.fixed::<u64>(order, what),
        }
    }

    /// The number of a node or an element: a tag in version 4.1, of 32 bits before.
    pub(super) fn tag(&mut self, what: &str) -> Result<i64, IoError> {
        if self.section.version != Version::V41 {
            return self.int(what);
        }
        let tag = self.size(what)?;
        i64::try_from(tag).map_err(|_| self.invalid(format!("{what} is {tag}, more than can be counted")))
    }

    /// A coordinate or value.
    pub(super) fn real(&mut self, what: &str) -> Result<f64, IoError> {
        match self.section.form {
            Form::Text => {
                let word = self.next_word().unwrap_or_default();
                real_of(word).ok_or_else(|| self.no_number(word, what))
            }
            Form::Binary { order, .. } => self.fixed(order, what),
        }
    }

    /// A number that is a word even in binary files.
    pub(super) fn word<T: FromStr>(&mut self, what: &str) -> Result<T, IoError> {
        let word = self.next_word().unwrap_or_default();
        str::from_utf8(word).ok().and_then(|word| word.parse().ok()).ok_or_else(|| self.no_number(word, what))
    }

    /// A [`word`](Self::word) that is a coordinate or a time.
    pub(super) fn real_word(&mut self, what: &str) -> Result<f64, IoError> {
        let word = self.next_word().unwrap_or_default();
        real_of(word).ok_or_else(|| self.no_number(word, what))
    }

    /// Passes over the end of a line, before which only blanks may stand. Bytes begin right behind it.
    pub(super) fn end_line(&mut self) {
        while let Some(&byte) = self.rest().first().filter(|byte| byte.is_ascii_whitespace()) {
            self.position += 1;
            if byte == b'\n' {
                break;
            }
        }
    }

    /// The rest of the line, which is passed over with its end.
    pub(super) fn line(&mut self) -> String {
        let rest = self.rest();
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        self.position += (length + 1).min(rest.len());
        String::from_utf8_lossy(rest.get(..length).unwrap_or_default()).trim().to_owned()
    }

    /// Whether nothing but white space is left.
    pub(super) fn is_at_end(&self) -> bool {
        self.rest().iter().all(u8::is_ascii_whitespace)
    }

    /// All that was not read yet.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.section.body.get(self.position..).unwrap_or_default()
    }

    /// An error at this place: a line of a text file, a byte of a binary one.
    pub(super) fn invalid(&self, problem: impl Into<String>) -> IoError {
        let at = self.section.start.saturating_add(self.position).min(self.source.bytes.len());
        let title = self.section.title();
        let place = match self.section.form {
            Form::Binary { .. } => format!("section {title}, byte {at}"),
            Form::Text => {
                let before = self.source.bytes.get(..at).unwrap_or_default();
                format!("section {title}, line {}", 1 + memchr::memchr_iter(b'\n', before).count())
            }
        };
        self.source.invalid(place, problem, REWRITE)
    }

    fn next_word(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = rest.get(start..)?;
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.position += start + length;
        rest.get(..length)
    }

    fn no_number(&self, word: &[u8], what: &str) -> IoError {
        if word.is_empty() {
            return self.invalid(format!("the section ends where {what} belongs"));
        }
        let word: String = String::from_utf8_lossy(word).chars().take(40).collect();
        self.invalid(format!("\"{word}\" stands where {what} belongs"))
    }

    fn fixed<T: Number>(&mut self, order: ByteOrder, what: &str) -> Result<T, IoError> {
        match T::from_bytes(self.rest(), order) {
            Some(value) => {
                self.position += T::SIZE;
                Ok(value)
            }
            None => Err(self.invalid(format!("the section ends where {what} belongs"))),
        }
    }
}

/// A number as C, or Fortran with its D for the exponent, writes it.
fn real_of(word: &[u8]) -> Option<f64> {
    let word = str::from_utf8(word).ok()?;
    word.parse().ok().or_else(|| word.replace(['d', 'D'], "e").parse().ok())
}
