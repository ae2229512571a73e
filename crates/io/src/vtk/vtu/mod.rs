//! The reader of VTK's XML unstructured grids.
//!
//! The file is read in three steps that know little of each other: `xml` lists the arrays with their attributes and
//! undecoded text, `payload` turns one array's text or appended bytes into numbers, `pieces` puts the arrays of all pieces
//! together into a dataset.

mod compression;
mod payload;
mod pieces;
mod xml;
mod xz;

#[cfg(test)]
pub(in crate::vtk) mod tests;

use crate::{IoError, Loaded, MeshReader, Source};

/// Reads `.vtu` files of any encoding that VTK writes.
pub(crate) struct VtuReader;

impl MeshReader for VtuReader {
    fn name(&self) -> &'static str {
        "VTK XML unstructured grid"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtu"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        // Comments and declarations may stand before the root, but not many bytes of them.
        const LOOKED_AT: usize = 4096;
        const ROOT: &[u8] = b"<VTKFile";
        let bytes = xml::without_mark(bytes);
        let head = &bytes[..bytes.len().min(LOOKED_AT)];
        head.trim_ascii_start().starts_with(b"<") && head.windows(ROOT.len()).any(|window| window == ROOT)
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let file = xml::parse(source)?;
        pieces::assemble(source, &file)
    }
}
