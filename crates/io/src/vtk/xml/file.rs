//! A file as a list of arrays that are not decoded yet.

use super::super::grids::Lattice;
use super::super::grids::budget::Budget;
use super::super::grids::extent::Extent;
use super::super::scalars::ByteOrder;
use super::Kind;
use super::compression::Compressor;
use crate::progress::Meter;
use crate::{IoError, OpenFile};

/// All that stands around the arrays, and these undecoded.
#[derive(Debug)]
pub(super) struct XmlFile<'a> {
    /// The kind of dataset that it holds.
    pub(super) kind: Kind,
    /// The format's version as the file states it.
    pub(super) version: String,
    /// The order of bytes in all numbers and headers.
    pub(super) byte_order: ByteOrder,
    /// Bytes of a word in the header of an array: 4 or 8.
    pub(super) header_size: usize,
    /// How binary arrays are compressed.
    pub(super) compressor: Option<Compressor>,
    /// At least one.
    pub(super) pieces: Vec<Piece<'a>>,
    /// The section behind the XML that arrays of the format `appended` point into.
    pub(super) appended: Option<Appended<'a>>,
    /// What the arrays may come to.
    pub(super) budget: &'a Budget,
    /// Counts what was decoded of a file that is in memory; one that is not counts what is read.
    pub(super) meter: Meter,
    /// Where image data lie.
    pub(super) lattice: Lattice,
    /// Arrays of the whole file.
    pub(super) field_data: Vec<ArrayElement<'a>>,
    /// The times of the steps of a file that holds several.
    pub(super) times: Vec<f64>,
    /// The step whose arrays are listed.
    pub(super) step: usize,
}

impl XmlFile<'_> {
    /// Reports so many more bytes as decoded.
    pub(super) fn advance(&self, bytes: usize) -> Result<(), IoError> {
        match self.appended {
            Some(Appended::Open { .. }) => Ok(()),
            _ => self.meter.advance(bytes),
        }
    }

    /// Reports that all is decoded.
    pub(super) fn finish(&self) -> Result<(), IoError> {
        match self.appended {
            Some(Appended::Open { file, .. }) => file.meter().finish(),
            _ => self.meter.finish(),
        }
    }
}

/// One `Piece` element.
#[derive(Debug, Default)]
pub(super) struct Piece<'a> {
    /// What the file declares; only ever compared with, never reserved.
    pub(super) point_count: u64,
    pub(super) cell_count: u64,
    /// Which points of a grid it has; nothing in unstructured grids.
    pub(super) extent: Option<Extent>,
    pub(super) point_data: Vec<ArrayElement<'a>>,
    pub(super) cell_data: Vec<ArrayElement<'a>>,
    pub(super) points: Vec<ArrayElement<'a>>,
    pub(super) cells: Vec<ArrayElement<'a>>,
    pub(super) coordinates: Vec<ArrayElement<'a>>,
}

impl<'a> Piece<'a> {
    /// All arrays but indices.
    pub(super) fn arrays(&self) -> impl Iterator<Item = &ArrayElement<'a>> {
        self.points.iter().chain(&self.coordinates).chain(&self.point_data).chain(&self.cell_data)
    }
}

/// One `DataArray` (or `Array`) element.
#[derive(Debug)]
pub(super) struct ArrayElement<'a> {
    pub(super) name: String,
    pub(super) type_name: String,
    /// Nothing where the attribute is absent.
    pub(super) components: Option<String>,
    pub(super) format: String,
    pub(super) offset: Option<String>,
    /// Nothing in files of one step.
    pub(super) listed: Option<Listed>,
    /// The text directly inside, in pieces where comments or other elements stand between.
    pub(super) text: Vec<std::borrow::Cow<'a, str>>,
    /// The line on which the element starts is counted from this byte when there is something to say.
    pub(super) position: usize,
}

/// For which step an array is listed, in files of several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Listed {
    /// The last one up to that which is read.
    In(usize),
    /// Later ones alone.
    Later,
}

/// The appended section: everything behind the underscore, up to the file's end or the closing tag.
#[derive(Clone, Copy, Debug)]
pub(super) enum Appended<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
    /// Raw bytes that are not in memory, from byte `start` of the file on.
    Open {
        file: &'a OpenFile,
        start: usize,
    },
}

/// The bytes without a byte-order mark of UTF-8.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
