//! The reader of VTK's legacy files, versions 1.0 to 5.1, text and binary.
//!
//! Source: The VTK Textbook's chapter on file formats ("Simple Legacy Formats"), and for what it does not say (field
//! arrays of text, `METADATA`, the cells of 5.1, percent-encoded names) the files that VTK itself writes.

mod attributes;
mod cells;
mod grid;
mod lexer;
mod structured;

#[cfg(test)]
pub(in crate::vtk) mod grid_tests;
#[cfg(test)]
pub(in crate::vtk) mod tests;

use super::grids::dims_of;
use super::xml::Kind;
use lexer::Lexer;

use crate::{IoError, Loaded, MeshReader, Source};

/// Reads `.vtk` files that hold an unstructured grid or a grid of another kind.
pub(crate) struct LegacyVtk;

const MAGIC: &[u8] = b"# vtk DataFile";

impl MeshReader for LegacyVtk {
    fn name(&self) -> &'static str {
        "VTK legacy"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtk"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        start_of(bytes).is_some()
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let Some(start) = start_of(&source.bytes) else {
            return Err(source.invalid(
                "line 1",
                if source.bytes.is_empty() { "the file is empty" } else { "it does not start with \"# vtk DataFile\"" },
                "name a legacy VTK file, or give the file the extension of its format",
            ));
        };
        let mut lexer = Lexer::new(source, start);
        let (version, kind) = header(&mut lexer)?;
        let loaded = grid::read(lexer, kind)?;
        let encoding = if loaded.is_binary { "binary" } else { "ASCII" };
        let kind = match kind {
            Kind::Unstructured => "",
            Kind::Image => ", structured points",
            Kind::Rectilinear => ", rectilinear grid",
            Kind::Structured => ", structured grid",
        };
        let format = format!("VTK legacy {version}, {encoding}{kind}{}", dims_of(&loaded.dataset));
        Ok(Loaded::without_time(loaded.dataset, format, loaded.warnings))
    }
}

/// Where the file proper begins, behind a byte-order mark and blank lines.
fn start_of(bytes: &[u8]) -> Option<usize> {
    let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let head = rest.get(..MAGIC.len())?;
    head.eq_ignore_ascii_case(MAGIC).then(|| bytes.len() - rest.len())
}

/// Reads the four lines at the top, up to the kind of dataset, and gives the version and the kind.
fn header(lexer: &mut Lexer<'_>) -> Result<(String, Kind), IoError> {
    let first = lexer.line();
    let version = String::from_utf8_lossy(first).split_ascii_whitespace().last().unwrap_or_default().to_owned();
    let version: String = version.chars().take(20).collect();
    // The title may be anything, an empty line too.
    lexer.line();
    match lexer.keyword("ASCII or BINARY")?.as_str() {
        "ASCII" => lexer.is_binary = false,
        "BINARY" => lexer.is_binary = true,
        other => return Err(lexer.invalid(format!("\"{other}\" stands where ASCII or BINARY belongs"))),
    }
    let word = lexer.keyword("DATASET")?;
    if word != "DATASET" {
        return Err(lexer.invalid(format!("\"{word}\" stands where DATASET belongs")));
    }
    let kind = match lexer.keyword("the kind of dataset")?.as_str() {
        "UNSTRUCTURED_GRID" => Kind::Unstructured,
        "STRUCTURED_POINTS" => Kind::Image,
        "RECTILINEAR_GRID" => Kind::Rectilinear,
        "STRUCTURED_GRID" => Kind::Structured,
        other => {
            return Err(lexer.source.unsupported(
                format!("a legacy VTK dataset of the kind {other}"),
                "convert it to an unstructured grid with ParaView (Append Datasets, then Save Data as .vtu)",
            ));
        }
    };
    lexer.line();
    Ok((version, kind))
}
