//! The XML around the arrays: which pieces there are, which arrays each has, and where their numbers stand.
//!
//! Elements are pulled one after another and nothing recurses, so depth costs one byte a level. Entities other than the
//! five predefined ones and character references are never expanded.

use quick_xml::events::Event;
use quick_xml::reader::Reader;

use super::super::DAMAGED;
use super::super::grids::Lattice;
use super::super::grids::budget::Budget;
use super::super::scalars::ByteOrder;
use super::Kind;
use super::appended::find_appended;
use super::attributes::{Attributes, line, shorten};
use super::declared::{read_array, read_grid, read_piece, read_root};
use super::file::{Appended, ArrayElement, Piece, XmlFile, without_mark};
use super::steps::{is_piece_a_step, keep_last_listed};
use crate::progress::{Meter, ReadStage};
use crate::{IoError, OpenFile, Source};

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
    Coordinates,
    FieldData,
    Array,
    Other,
}

/// Lists the arrays of a file of this kind.
///
/// - `opened`: the file, where only its beginning is in memory, and [that is enough](is_enough)
pub(super) fn parse<'a>(
    source: &'a Source,
    opened: Option<&'a OpenFile>,
    kind: Kind,
    budget: &'a Budget,
) -> Result<XmlFile<'a>, IoError> {
    let file = list(source, opened, kind, budget)?;
    budget.grant(opened.map_or(source.bytes.len(), OpenFile::length));
    Ok(file)
}

/// Whether the beginning of a file is all of it that has to be in memory. Where anything is wrong with it, it is not, as that is said of whole files.
pub(super) fn is_enough(beginning: &Source, opened: &OpenFile, kind: Kind) -> bool {
    let budget = Budget::new(kind.limit());
    beginning.bytes.len() < opened.length()
        && list(beginning, Some(opened), kind, &budget)
            .is_ok_and(|file| matches!(file.appended, Some(Appended::Open { .. })))
}

fn list<'a>(
    source: &'a Source,
    opened: Option<&'a OpenFile>,
    kind: Kind,
    budget: &'a Budget,
) -> Result<XmlFile<'a>, IoError> {
    let bytes = without_mark(&source.bytes);
    let mut reader = Reader::from_reader(bytes);
    // An empty element then looks like one with nothing in it.
    reader.config_mut().expand_empty_elements = true;
    let mut file = XmlFile {
        kind,
        version: String::new(),
        byte_order: ByteOrder::Little,
        header_size: 4,
        compressor: None,
        pieces: Vec::new(),
        appended: None,
        budget,
        meter: Meter::new(&source.path, &source.options, ReadStage::Decoding, source.bytes.len() as u64),
        lattice: Lattice::default(),
        field_data: Vec::new(),
        times: Vec::new(),
        step: 0,
    };
    let mut whole_extent = None;
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
                        read_root(&attributes, kind, &mut file)?;
                        Open::Root
                    }
                    (None, name) => {
                        return Err(source.invalid(
                            line(bytes, start),
                            format!("the root element is `{}`, not `VTKFile`", shorten(name)),
                            "name a VTK XML file, or give the file the extension of its format",
                        ));
                    }
                    (Some(Open::Root), name) if name == kind.type_name() => {
                        whole_extent = read_grid(&attributes, kind, &mut file)?;
                        Open::Grid
                    }
                    (Some(Open::Root), "AppendedData") => {
                        file.appended = Some(find_appended(&attributes, opened, position(&reader))?);
                        // The section is not XML: nothing behind this tag may be parsed as such.
                        break;
                    }
                    (Some(Open::Grid), "Piece") => {
                        file.pieces.push(read_piece(&attributes, kind, whole_extent)?);
                        Open::Piece
                    }
                    (Some(Open::Piece), "PointData") => Open::PointData,
                    (Some(Open::Piece), "CellData") => Open::CellData,
                    (Some(Open::Piece), "Points") => Open::Points,
                    (Some(Open::Piece), "Cells") => Open::Cells,
                    (Some(Open::Piece), "Coordinates") => Open::Coordinates,
                    (Some(Open::Root | Open::Grid), "FieldData") => Open::FieldData,
                    (Some(section), "DataArray" | "Array") => {
                        let step = file.step;
                        match arrays_of(&mut file, section) {
                            Some(arrays) => {
                                arrays.push(read_array(&attributes, step)?);
                                Open::Array
                            }
                            None => Open::Other,
                        }
                    }
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
                        "name a VTK XML file, or give the file the extension of its format",
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
    if is_piece_a_step(&file) {
        let step = file.pieces.swap_remove(file.step);
        file.pieces = vec![step];
    } else if !file.times.is_empty() {
        for piece in &mut file.pieces {
            let Piece { point_data, cell_data, points, cells, coordinates, .. } = piece;
            [point_data, cell_data, points, cells, coordinates].into_iter().for_each(keep_last_listed);
        }
    }
    if file.pieces.is_empty() {
        let place = format!("element {}", kind.type_name());
        return Err(source.invalid(place, "it holds no Piece, so there is no mesh", DAMAGED));
    }
    Ok(file)
}

fn position(reader: &Reader<&[u8]>) -> usize {
    usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX)
}

fn arrays_of<'f, 'a>(file: &'f mut XmlFile<'a>, section: Open) -> Option<&'f mut Vec<ArrayElement<'a>>> {
    if section == Open::FieldData {
        return Some(&mut file.field_data);
    }
    let piece = file.pieces.last_mut()?;
    match section {
        Open::PointData => Some(&mut piece.point_data),
        Open::CellData => Some(&mut piece.cell_data),
        Open::Points => Some(&mut piece.points),
        Open::Cells => Some(&mut piece.cells),
        Open::Coordinates => Some(&mut piece.coordinates),
        _ => None,
    }
}

/// The array that text belongs to: only where it stands directly inside, not in the array's information keys.
fn current_array<'f, 'a>(file: &'f mut XmlFile<'a>, open: &[Open]) -> Option<&'f mut ArrayElement<'a>> {
    match open {
        [.., section, Open::Array] => arrays_of(file, *section)?.last_mut(),
        _ => None,
    }
}
