//! What the elements around the numbers declare by their attributes.

use super::super::DAMAGED;
use super::super::grids::Lattice;
use super::super::grids::extent::Extent;
use super::super::scalars::ByteOrder;
use super::Kind;
use super::attributes::{Attributes, shorten};
use super::compression::Compressor;
use super::file::{ArrayElement, Piece, XmlFile};
use super::steps::last_step;
use crate::IoError;

/// The attributes of the root element.
pub(super) fn read_root(attributes: &Attributes<'_, '_>, kind: Kind, file: &mut XmlFile<'_>) -> Result<(), IoError> {
    let source = attributes.source;
    let found = attributes.get("type")?.unwrap_or_default();
    if found.trim() != kind.type_name() {
        return Err(source.unsupported(
            format!("a VTK file of the type \"{}\"", shorten(&found)),
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

/// The attributes of the element around the pieces; gives the whole box of a grid.
pub(super) fn read_grid(
    attributes: &Attributes<'_, '_>,
    kind: Kind,
    file: &mut XmlFile<'_>,
) -> Result<Option<Extent>, IoError> {
    if let Some(text) = attributes.get("TimeValues")? {
        let times: Result<Vec<f64>, _> = text.split_ascii_whitespace().map(str::parse).collect();
        file.times = times.map_err(|_| {
            let problem = format!("the attribute `TimeValues` is \"{}\", not a list of numbers", shorten(&text));
            attributes.source.invalid(attributes.place(), problem, DAMAGED)
        })?;
        file.step = attributes.source.step(&file.times)?;
    }
    if kind == Kind::Unstructured {
        return Ok(None);
    }
    if kind == Kind::Image {
        let usual = Lattice::default();
        file.lattice = Lattice {
            origin: attributes.numbers("Origin")?.unwrap_or(usual.origin),
            spacing: attributes.numbers("Spacing")?.unwrap_or(usual.spacing),
            direction: attributes.numbers("Direction")?.unwrap_or(usual.direction),
        };
    }
    // It may be larger than any mesh; what counts are the pieces.
    Ok(attributes.extent("WholeExtent").ok().flatten())
}

/// The counts or the extent of a piece.
pub(super) fn read_piece<'a>(
    attributes: &Attributes<'_, '_>,
    kind: Kind,
    whole_extent: Option<Extent>,
) -> Result<Piece<'a>, IoError> {
    if kind == Kind::Unstructured {
        let (point_count, cell_count) = (attributes.count("NumberOfPoints")?, attributes.count("NumberOfCells")?);
        return Ok(Piece { point_count, cell_count, ..Piece::default() });
    }
    let extent = match attributes.extent("Extent")? {
        Some(extent) => extent,
        None => whole_extent.ok_or_else(|| {
            let problem = "it has no attribute `Extent`, and there is no `WholeExtent` that could stand for it";
            attributes.source.invalid(attributes.place(), problem, DAMAGED)
        })?,
    };
    let (point_count, cell_count) = (extent.point_count() as u64, extent.cell_count() as u64);
    Ok(Piece { point_count, cell_count, extent: Some(extent), ..Piece::default() })
}

/// The attributes of an array.
///
/// - `step`: the one that is read
pub(super) fn read_array<'a>(attributes: &Attributes<'_, '_>, step: usize) -> Result<ArrayElement<'a>, IoError> {
    Ok(ArrayElement {
        listed: last_step(attributes, step)?,
        name: attributes.get("Name")?.unwrap_or_default(),
        type_name: attributes.get("type")?.unwrap_or_default().trim().to_owned(),
        components: attributes.get("NumberOfComponents")?,
        format: attributes.get("format")?.unwrap_or_else(|| "ascii".to_owned()).trim().to_owned(),
        offset: attributes.get("offset")?,
        text: Vec::new(),
        position: attributes.start,
    })
}
