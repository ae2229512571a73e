//! The XML around the arrays: which pieces there are, which arrays each has, and where their numbers stand.
//!
//! Elements are pulled one after another and nothing recurses, so depth costs one byte a level. Entities other than the
//! five predefined ones and character references are never expanded.

use std::cell::Cell;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::super::DAMAGED;
use super::super::scalars::ByteOrder;
use super::compression::Compressor;
use crate::{IoError, Source};

/// The file as a list of arrays that are not decoded yet.
#[derive(Debug)]
pub(super) struct VtuFile<'a> {
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
    /// How many numbers may still be decoded; see [`NUMBERS_PER_BYTE`].
    numbers_left: Cell<usize>,
}

/// Numbers that all arrays of a file together may come to, a byte of the file. Without compression a byte is one number at most, as text or
/// as bytes; what is more is compressed, or is named by several arrays at one offset. The real meshes of the tests, whose indices and coordinates differ,
/// stay below 1. Without the bound, 100 kB of arrays that share an offset, or of zeros that were compressed, are gigabytes.
const NUMBERS_PER_BYTE: usize = 16;

/// Numbers that are decoded whatever the file's length is: 8 MiB of the widest type.
const NUMBERS_ALWAYS: usize = 1 << 20;

/// One `Piece` element.
#[derive(Debug, Default)]
pub(super) struct Piece<'a> {
    /// What the file declares; only ever compared with, never reserved.
    pub(super) point_count: u64,
    pub(super) cell_count: u64,
    pub(super) point_data: Vec<ArrayElement<'a>>,
    pub(super) cell_data: Vec<ArrayElement<'a>>,
    pub(super) points: Vec<ArrayElement<'a>>,
    pub(super) cells: Vec<ArrayElement<'a>>,
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
    /// The text directly inside, in pieces where comments or other elements stand between.
    pub(super) text: Vec<std::borrow::Cow<'a, str>>,
    /// The line on which the element starts is counted from this byte when there is something to say.
    pub(super) position: usize,
}

/// The appended section: everything behind the underscore, up to the file's end or the closing tag.
#[derive(Clone, Copy, Debug)]
pub(super) enum Appended<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

/// What an open element is; all that matters for knowing where an array belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Open {
    Root,
    Grid,
    Piece,
    PointData,
    CellData,
    Points,
    Cells,
    Array,
    Other,
}

impl VtuFile<'_> {
    /// Takes so many numbers from what the file may come to. The error says what the limit is, for the caller to add the place.
    pub(super) fn spend(&self, numbers: usize) -> Result<(), String> {
        let left = self.numbers_left.get().checked_sub(numbers).ok_or_else(|| {
            format!(
                "with its {numbers} numbers the arrays come to more than {NUMBERS_PER_BYTE} numbers a byte of the file \
                 (and to more than {NUMBERS_ALWAYS}), which is the limit; if the file is whole, save it without compression"
            )
        })?;
        self.numbers_left.set(left);
        Ok(())
    }
}

/// The bytes without a byte-order mark of UTF-8.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Lists the arrays of a file.
pub(super) fn parse(source: &Source) -> Result<VtuFile<'_>, IoError> {
    let bytes = without_mark(&source.bytes);
    let mut reader = Reader::from_reader(bytes);
    // An empty element then looks like one with nothing in it.
    reader.config_mut().expand_empty_elements = true;
    let mut file = VtuFile {
        version: String::new(),
        byte_order: ByteOrder::Little,
        header_size: 4,
        compressor: None,
        pieces: Vec::new(),
        appended: None,
        numbers_left: Cell::new(bytes.len().saturating_mul(NUMBERS_PER_BYTE).max(NUMBERS_ALWAYS)),
    };
    let mut open: Vec<Open> = Vec::new();
    let mut root_seen = false;
    loop {
        let start = position(&reader);
        let event = reader.read_event().map_err(|e| {
            let at = usize::try_from(reader.error_position()).unwrap_or(start);
            source.invalid(line(bytes, at), format!("not well-formed XML: {e}"), DAMAGED)
        })?;
        match event {
            Event::Start(element) => {
                let attributes = Attributes { source, bytes, start, element: &element };
                let parent = open.last().copied();
                let this = match (parent, element.name().as_ref()) {
                    (None, "VTKFile") if !root_seen => {
                        root_seen = true;
                        read_root(&attributes, &mut file)?;
                        Open::Root
                    }
                    (None, name) => {
                        return Err(source.invalid(
                            line(bytes, start),
                            format!("the root element is `{}`, not `VTKFile`", shorten(name)),
                            "name a VTU file, or give the file the extension of its format",
                        ));
                    }
                    (Some(Open::Root), "UnstructuredGrid") => Open::Grid,
                    (Some(Open::Root), "AppendedData") => {
                        file.appended = Some(read_appended(&attributes, position(&reader))?);
                        // The section is not XML: nothing behind this tag may be parsed as such.
                        break;
                    }
                    (Some(Open::Grid), "Piece") => {
                        file.pieces.push(Piece {
                            point_count: attributes.count("NumberOfPoints")?,
                            cell_count: attributes.count("NumberOfCells")?,
                            ..Piece::default()
                        });
                        Open::Piece
                    }
                    (Some(Open::Piece), "PointData") => Open::PointData,
                    (Some(Open::Piece), "CellData") => Open::CellData,
                    (Some(Open::Piece), "Points") => Open::Points,
                    (Some(Open::Piece), "Cells") => Open::Cells,
                    (Some(section), "DataArray" | "Array") => match arrays_of(&mut file, section) {
                        Some(arrays) => {
                            arrays.push(read_array(&attributes)?);
                            Open::Array
                        }
                        None => Open::Other,
                    },
                    _ => Open::Other,
                };
                open.push(this);
            }
            Event::End(_) => {
                open.pop();
            }
            Event::Text(text) => {
                if let Some(array) = current_array(&mut file, &open) {
                    array.text.push(text.into_inner());
                }
            }
            Event::CData(text) => {
                if let Some(array) = current_array(&mut file, &open) {
                    array.text.push(text.into_inner());
                }
            }
            Event::GeneralRef(entity) if current_array(&mut file, &open).is_some() => {
                return Err(source.invalid(
                    line(bytes, start),
                    format!("the entity `&{};` stands among numbers; entities are not expanded", shorten(&entity)),
                    "write the numbers themselves",
                ));
            }
            Event::Eof => {
                if !root_seen {
                    return Err(source.invalid(
                        "start of the file",
                        if bytes.is_empty() { "the file is empty" } else { "there is no XML element `VTKFile`" },
                        "name a VTU file, or give the file the extension of its format",
                    ));
                }
                if !open.is_empty() {
                    return Err(source.invalid("end of the file", "the file ends inside an XML element", DAMAGED));
                }
                break;
            }
            _ => {}
        }
    }
    if file.pieces.is_empty() {
        return Err(source.invalid("element UnstructuredGrid", "it holds no Piece, so there is no mesh", DAMAGED));
    }
    Ok(file)
}

fn position(reader: &Reader<&[u8]>) -> usize {
    usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX)
}

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

fn shorten(text: &str) -> String {
    text.chars().take(40).collect()
}

fn arrays_of<'f, 'a>(file: &'f mut VtuFile<'a>, section: Open) -> Option<&'f mut Vec<ArrayElement<'a>>> {
    let piece = file.pieces.last_mut()?;
    match section {
        Open::PointData => Some(&mut piece.point_data),
        Open::CellData => Some(&mut piece.cell_data),
        Open::Points => Some(&mut piece.points),
        Open::Cells => Some(&mut piece.cells),
        _ => None,
    }
}

/// The array that text belongs to: only where it stands directly inside, not in the array's information keys.
fn current_array<'f, 'a>(file: &'f mut VtuFile<'a>, open: &[Open]) -> Option<&'f mut ArrayElement<'a>> {
    match open {
        [.., section, Open::Array] => arrays_of(file, *section)?.last_mut(),
        _ => None,
    }
}

/// The attributes of one element, with what is needed to complain about them.
struct Attributes<'e, 'a> {
    source: &'a Source,
    bytes: &'a [u8],
    start: usize,
    element: &'e BytesStart<'a>,
}

impl Attributes<'_, '_> {
    fn get(&self, name: &str) -> Result<Option<String>, IoError> {
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

    fn count(&self, name: &str) -> Result<u64, IoError> {
        let text = self.get(name)?.unwrap_or_default();
        text.trim().parse().map_err(|_| {
            let problem = format!("the attribute `{name}` of Piece is \"{}\", not a count", shorten(&text));
            self.source.invalid(self.place(), problem, DAMAGED)
        })
    }

    fn place(&self) -> String {
        line(self.bytes, self.start)
    }

    fn unknown(&self, name: &str, value: &str, known: &str) -> IoError {
        self.source.invalid(
            self.place(),
            format!("the attribute `{name}` is \"{}\", where {known} are known", shorten(value)),
            DAMAGED,
        )
    }
}

fn read_root(attributes: &Attributes<'_, '_>, file: &mut VtuFile<'_>) -> Result<(), IoError> {
    let source = attributes.source;
    let kind = attributes.get("type")?.unwrap_or_default();
    if kind.starts_with("PUnstructuredGrid") {
        return Err(source.unsupported(
            "a parallel file (PUnstructuredGrid), which only names other files,",
            "open one of its .vtu files, or merge them into one with ParaView (Merge Blocks, then Save Data)",
        ));
    }
    if kind != "UnstructuredGrid" {
        return Err(source.unsupported(
            format!("a VTK file of the type \"{}\"", shorten(&kind)),
            "convert it to an unstructured grid with ParaView (Append Datasets, then Save Data as .vtu)",
        ));
    }
    file.version = shorten(&attributes.get("version")?.unwrap_or_else(|| "without version".to_owned()));
    file.byte_order = match attributes.get("byte_order")?.as_deref().map(str::trim) {
        None | Some("LittleEndian") => ByteOrder::Little,
        Some("BigEndian") => ByteOrder::Big,
        Some(other) => return Err(attributes.unknown("byte_order", other, "LittleEndian and BigEndian")),
    };
    // Without the attribute the words are of 32 bits, whatever the version says.
    file.header_size = match attributes.get("header_type")?.as_deref().map(str::trim) {
        None | Some("UInt32") => 4,
        Some("UInt64") => 8,
        Some(other) => return Err(attributes.unknown("header_type", other, "UInt32 and UInt64")),
    };
    file.compressor = match attributes.get("compressor")?.as_deref().map(str::trim) {
        None | Some("") => None,
        Some(name) => Some(Compressor::named(name).ok_or_else(|| {
            source.unsupported(
                format!("the compressor \"{}\"", shorten(name)),
                "save it with the compressor vtkZLibDataCompressor, or without one",
            )
        })?),
    };
    Ok(())
}

fn read_array<'a>(attributes: &Attributes<'_, '_>) -> Result<ArrayElement<'a>, IoError> {
    Ok(ArrayElement {
        name: attributes.get("Name")?.unwrap_or_default(),
        type_name: attributes.get("type")?.unwrap_or_default().trim().to_owned(),
        components: attributes.get("NumberOfComponents")?,
        format: attributes.get("format")?.unwrap_or_else(|| "ascii".to_owned()).trim().to_owned(),
        offset: attributes.get("offset")?,
        text: Vec::new(),
        position: attributes.start,
    })
}

/// Finds the section by its bytes: it begins behind the first underscore behind the tag, with only white space between.
fn read_appended<'a>(attributes: &Attributes<'_, 'a>, end_of_tag: usize) -> Result<Appended<'a>, IoError> {
    let rest = attributes.bytes.get(end_of_tag..).unwrap_or_default().trim_ascii_start();
    let Some(section) = rest.strip_prefix(b"_") else {
        let problem = "the appended data does not start with an underscore";
        return Err(attributes.source.invalid(attributes.place(), problem, DAMAGED));
    };
    match attributes.get("encoding")?.as_deref().map(str::trim) {
        Some("raw") => Ok(Appended::Raw(section)),
        None | Some("base64") => {
            let end = section.iter().position(|&byte| byte == b'<').unwrap_or(section.len());
            Ok(Appended::Base64(section[..end].trim_ascii_end()))
        }
        Some(other) => Err(attributes.unknown("encoding", other, "raw and base64")),
    }
}
