//! The attributes of an element of XML, and places in words.

#[cfg(test)]
use std::cell::Cell;

use quick_xml::XmlVersion;
use quick_xml::events::BytesStart;

use super::super::DAMAGED;
use super::super::grids::extent::Extent;
use crate::{IoError, Source};

#[cfg(test)]
thread_local! {
    /// Bytes that were looked through for the numbers of lines.
    pub(super) static LOOKED_THROUGH: Cell<usize> = const { Cell::new(0) };
}

/// A place in words: the line, counted from 1. It looks through all that is before, so that it is for errors alone.
pub(super) fn line(bytes: &[u8], at: usize) -> String {
    #[cfg(test)]
    LOOKED_THROUGH.set(LOOKED_THROUGH.get() + at);
    let before = &bytes[..at.min(bytes.len())];
    format!("line {}", 1 + before.iter().filter(|&&byte| byte == b'\n').count())
}

/// The beginning of a text of a file, of a length that fits a message.
pub(super) fn shorten(text: &str) -> String {
    text.chars().take(40).collect()
}

/// The attributes of one element, with what is needed to complain about them.
pub(super) struct Attributes<'e, 'a> {
    pub(super) source: &'a Source,
    pub(super) bytes: &'a [u8],
    pub(super) start: usize,
    pub(super) element: &'e BytesStart<'a>,
}

impl Attributes<'_, '_> {
    /// An attribute's value; of two with this name the first.
    pub(super) fn get(&self, name: &str) -> Result<Option<String>, IoError> {
        let broken = |problem: String| self.source.invalid(self.place(), problem, DAMAGED);
        // Without the check for repeated names, whose time grows with the square of their number; the first one holds.
        for attribute in self.element.attributes().with_checks(false) {
            let attribute = attribute.map_err(|e| broken(format!("broken attribute: {e}")))?;
            if attribute.key.as_ref() == name {
                let value = attribute
                    .normalized_value(XmlVersion::Implicit1_0)
                    .map_err(|e| broken(format!("the attribute `{name}` cannot be read: {e}")))?;
                return Ok(Some(value.into_owned()));
            }
        }
        Ok(None)
    }

    /// A count that must be there.
    pub(super) fn count(&self, name: &str) -> Result<u64, IoError> {
        let text = self.get(name)?.unwrap_or_default();
        text.trim().parse().map_err(|_| {
            let problem = format!("the attribute `{name}` of Piece is \"{}\", not a count", shorten(&text));
            self.source.invalid(self.place(), problem, DAMAGED)
        })
    }

    /// A box of points, if the attribute is there.
    pub(super) fn extent(&self, name: &str) -> Result<Option<Extent>, IoError> {
        let Some(text) = self.get(name)? else { return Ok(None) };
        Extent::parse(&text).map(Some).map_err(|problem| {
            let problem = format!("the attribute `{name}` is \"{}\": {problem}", shorten(&text));
            self.source.invalid(self.place(), problem, DAMAGED)
        })
    }

    /// So many finite numbers, if the attribute is there.
    pub(super) fn numbers<const N: usize>(&self, name: &str) -> Result<Option<[f64; N]>, IoError> {
        let Some(text) = self.get(name)? else { return Ok(None) };
        let words: Result<Vec<f64>, _> = text.split_ascii_whitespace().map(str::parse).collect();
        let numbers: Option<[f64; N]> = words.ok().and_then(|words| words.try_into().ok());
        numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())).map(Some).ok_or_else(|| {
            let problem = format!("the attribute `{name}` is \"{}\", not {N} finite numbers", shorten(&text));
            self.source.invalid(self.place(), problem, DAMAGED)
        })
    }

    /// The line of the element.
    pub(super) fn place(&self) -> String {
        line(self.bytes, self.start)
    }

    /// The refusal of a value that is not among those known.
    pub(super) fn unknown(&self, name: &str, value: &str, known: &str) -> IoError {
        self.source.invalid(
            self.place(),
            format!("the attribute `{name}` is \"{}\", where {known} are known", shorten(value)),
            DAMAGED,
        )
    }
}
