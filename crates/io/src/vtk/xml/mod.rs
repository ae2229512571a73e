//! The readers of VTK's XML files: unstructured grids, image data, rectilinear and structured grids, one file or several.
//!
//! A file is read in three steps that know little of each other: `elements` lists the arrays with their attributes and
//! undecoded text, `payload` turns one array's text or appended bytes into numbers (`body` piece by piece, `text` word by word), `unstructured` or `structured` puts the arrays of all
//! pieces together into a dataset. `parallel` and `collection` do so for files that name others.

mod appended;
mod arrays;
mod attributes;
mod body;
mod collection;
mod compression;
mod declared;
mod elements;
mod encoded;
mod faces;
mod file;
mod list;
mod parallel;
mod payload;
mod regular;
mod steps;
mod structured;
mod text;
mod unstructured;
mod xz;

#[cfg(test)]
pub(in crate::vtk) mod grid_tests;
#[cfg(test)]
mod large_tests;
#[cfg(test)]
mod named_tests;
#[cfg(test)]
pub(in crate::vtk) mod tests;

pub(crate) use appended::AppendedSearch;
pub(crate) use collection::{BlocksReader, PvdReader, SeriesReader};
pub(crate) use parallel::ParallelReader;

use std::collections::HashSet;

use super::DAMAGED;
use super::grids::budget::{Budget, Limit};
use super::grids::{GRID_LIMIT, dims_of, merge};
use crate::{IoError, Loaded, MeshReader, OpenFile, Source};
use file::{Appended, XmlFile};

/// The kinds of dataset that one file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Unstructured,
    Image,
    Rectilinear,
    Structured,
}

impl Kind {
    /// Its name in files.
    fn type_name(self) -> &'static str {
        match self {
            Self::Unstructured => "UnstructuredGrid",
            Self::Image => "ImageData",
            Self::Rectilinear => "RectilinearGrid",
            Self::Structured => "StructuredGrid",
        }
    }

    /// Its name for users.
    fn label(self) -> &'static str {
        match self {
            Self::Unstructured => "VTK XML unstructured grid",
            Self::Image => "VTK XML image data",
            Self::Rectilinear => "VTK XML rectilinear grid",
            Self::Structured => "VTK XML structured grid",
        }
    }

    /// What the arrays of a file may come to. Real meshes, whose indices and coordinates differ, stay below one number a byte.
    fn limit(self) -> Limit {
        match self {
            Self::Unstructured | Self::Structured => Limit::NumbersAByte(16),
            Self::Image | Self::Rectilinear => GRID_LIMIT,
        }
    }
}

/// Types of files that other readers take.
const NOT_UNSTRUCTURED: &[&str] = &[
    "ImageData",
    "RectilinearGrid",
    "StructuredGrid",
    "PUnstructuredGrid",
    "PImageData",
    "PRectilinearGrid",
    "PStructuredGrid",
    "Collection",
    "vtkMultiBlockDataSet",
    "vtkPartitionedDataSetCollection",
    "vtkPartitionedDataSet",
];

/// Reads files of one kind, of any encoding that VTK writes.
pub(crate) struct XmlReader {
    pub(super) kind: Kind,
}

impl MeshReader for XmlReader {
    fn name(&self) -> &'static str {
        self.kind.label()
    }

    fn extensions(&self) -> &'static [&'static str] {
        match self.kind {
            Kind::Unstructured => &["vtu"],
            Kind::Image => &["vti"],
            Kind::Rectilinear => &["vtr"],
            Kind::Structured => &["vts"],
        }
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        let is_other = |found: &str| NOT_UNSTRUCTURED.contains(&found);
        root_type(bytes).is_some_and(|found| match self.kind {
            // What is none of these kinds is refused by its own name.
            Kind::Unstructured => !is_other(found),
            kind => found == kind.type_name(),
        })
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let budget = Budget::new(self.kind.limit());
        self.assemble(source, &elements::parse(source, None, self.kind, &budget)?)
    }

    fn read_open(&self, beginning: &Source, file: &OpenFile) -> Result<Option<Loaded>, IoError> {
        if !elements::is_enough(beginning, file, self.kind) {
            return Ok(None);
        }
        let budget = Budget::new(self.kind.limit());
        self.assemble(beginning, &elements::parse(beginning, Some(file), self.kind, &budget)?).map(Some)
    }
}

impl XmlReader {
    fn assemble(&self, source: &Source, file: &XmlFile<'_>) -> Result<Loaded, IoError> {
        let mut warnings = Vec::new();
        let dataset = match self.kind {
            Kind::Unstructured => unstructured::assemble(source, file, &mut warnings)?,
            _ => {
                let pieces = structured::read_pieces(source, file, &mut warnings)?;
                merge::assemble(pieces, &mut warnings)
                    .map_err(|problem| source.invalid("the pieces of the grid", problem, DAMAGED))?
            }
        };
        let format = describe(file) + &dims_of(&dataset);
        let (times, step) = times(source, file);
        file.finish()?;
        Ok(Loaded { dataset, format, warnings: distinct(warnings), times, step })
    }
}

/// Whether a root of this type has all of its data in one file.
fn is_one_file(found: &str) -> bool {
    [Kind::Unstructured, Kind::Image, Kind::Rectilinear, Kind::Structured].iter().any(|kind| found == kind.type_name())
}

/// The `type` of the root element, if this is a VTK XML file at all. An attribute that is missing or broken counts as an empty one.
fn root_type(bytes: &[u8]) -> Option<&str> {
    // Comments and declarations may stand before the root, but not many bytes of them.
    const LOOKED_AT: usize = 4096;
    const ROOT: &[u8] = b"<VTKFile";
    let bytes = file::without_mark(bytes);
    let head = &bytes[..bytes.len().min(LOOKED_AT)];
    if !head.trim_ascii_start().starts_with(b"<") {
        return None;
    }
    let start = head.windows(ROOT.len()).position(|window| window == ROOT)? + ROOT.len();
    let tag = head[start..].split(|&byte| byte == b'>').next().unwrap_or_default();
    Some(attribute(std::str::from_utf8(tag).unwrap_or_default(), "type").unwrap_or_default())
}

/// The value of an attribute in the text of a tag.
fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    tag.match_indices(name).find_map(|(at, _)| {
        let starts = tag[..at].ends_with(|c: char| c.is_ascii_whitespace());
        let value = tag[at + name.len()..].trim_start().strip_prefix('=')?.trim_start();
        let quote = value.chars().next().filter(|quote| starts && ['"', '\''].contains(quote))?;
        value[1..].split(quote).next().map(str::trim)
    })
}

/// Every piece repeats what is odd about the names.
fn distinct(mut warnings: Vec<String>) -> Vec<String> {
    let mut said = HashSet::new();
    warnings.retain(|warning: &String| said.insert(warning.clone()));
    warnings
}

/// The times of a file, and which of them was read: several, or the one that programs write beside the pieces.
fn times(source: &Source, file: &XmlFile<'_>) -> (Vec<f64>, usize) {
    if !file.times.is_empty() {
        return (file.times.clone(), file.step);
    }
    let time = || {
        let array = file.field_data.iter().find(|array| array.name == "TimeValue")?;
        let scalar = payload::scalar_type(&array.type_name)?;
        let values = payload::decode(source, file, array, scalar, "TimeValue").ok()?;
        match values.to_f64()[..] {
            [time] if time.is_finite() => Some(time),
            _ => None,
        }
    };
    (time().into_iter().collect(), 0)
}

fn describe(file: &XmlFile<'_>) -> String {
    let order = match file.byte_order {
        super::scalars::ByteOrder::Little => "little-endian",
        super::scalars::ByteOrder::Big => "big-endian",
    };
    let mut formats = file.pieces.iter().flat_map(file::Piece::arrays).map(|array| array.format.as_str());
    let mut text = format!("{} {}", file.kind.label(), file.version);
    match (formats.next(), file.appended) {
        (Some("ascii") | None, _) => text += ", ASCII",
        (Some("appended"), Some(Appended::Raw(_) | Appended::Open { .. })) => text += ", appended raw",
        (Some("appended"), _) => text += ", appended base64",
        _ => text += ", inline base64",
    }
    if let (Some(compressor), false) = (file.compressor, text.ends_with("ASCII")) {
        text = text + ", " + compressor.label();
    }
    if !text.ends_with("ASCII") {
        text = text + ", " + order;
    }
    text
}
