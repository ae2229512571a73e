//! Formats that are not read, known well enough to say so and to name a way around.

use std::path::Path;

use crate::{IoError, MeshReader, read::extension};

/// A format that is told apart but not read.
struct Foreign {
    name: &'static str,
    extensions: &'static [&'static str],
    /// What its files begin with, after white space and a byte-order mark; any one of these.
    magic: &'static [&'static [u8]],
    remedy: &'static str,
}

const NOT_A_MESH: &str = "name a file that holds a mesh";
const UNPACK: &str = "unpack it and name the file inside";

const FOREIGN: &[Foreign] = &[
    Foreign {
        name: "a surface (it has no volume)",
        extensions: &["vtp", "stl", "ply", "obj"],
        magic: &[],
        remedy: NOT_A_MESH,
    },
    Foreign { name: "a PNG picture", extensions: &["png"], magic: &[b"\x89PNG\r\n\x1a\n"], remedy: NOT_A_MESH },
    Foreign { name: "a JPEG picture", extensions: &["jpg", "jpeg"], magic: &[b"\xff\xd8\xff"], remedy: NOT_A_MESH },
    Foreign { name: "an OpenEXR picture", extensions: &["exr"], magic: &[b"\x76\x2f\x31\x01"], remedy: NOT_A_MESH },
    Foreign { name: "a gzip archive", extensions: &["gz", "tgz"], magic: &[b"\x1f\x8b"], remedy: UNPACK },
    Foreign { name: "a zip archive", extensions: &["zip"], magic: &[b"PK\x03\x04"], remedy: UNPACK },
    Foreign { name: "a bzip2 archive", extensions: &["bz2"], magic: &[b"BZh"], remedy: UNPACK },
    Foreign { name: "an xz archive", extensions: &["xz"], magic: &[b"\xfd7zXZ\x00"], remedy: UNPACK },
    Foreign { name: "a PDF document", extensions: &["pdf"], magic: &[b"%PDF-"], remedy: NOT_A_MESH },
];

/// The refusal of a file whose content is of a format that is not read, if it is one of those known here.
pub(crate) fn refuse_by_content(path: &Path, bytes: &[u8], readers: &[&dyn MeshReader]) -> Option<IoError> {
    let unmarked = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let content = unmarked.trim_ascii_start();
    let begins = |magic: &&[u8]| unmarked.starts_with(magic) || content.starts_with(magic);
    FOREIGN.iter().find(|foreign| foreign.magic.iter().any(begins)).map(|foreign| foreign.refusal(path, readers))
}

/// The refusal of a file that no reader took, by its extension.
pub(crate) fn refuse_by_extension(path: &Path, readers: &[&dyn MeshReader]) -> IoError {
    let extension = extension(path);
    match FOREIGN.iter().find(|foreign| foreign.extensions.contains(&extension.as_str())) {
        Some(foreign) => foreign.refusal(path, readers),
        None => IoError::Unsupported {
            path: path.to_owned(),
            what: if extension.is_empty() {
                "this content (and there is no extension to go by)".to_owned()
            } else {
                format!("this content, or the extension .{extension},")
            },
            remedy: format!("{}; ParaView or meshio can convert most others to .vtu", formats_read(readers)),
        },
    }
}

/// Whether the extension belongs to a format of this list.
pub(crate) fn is_foreign_extension(extension: &str) -> bool {
    FOREIGN.iter().any(|foreign| foreign.extensions.contains(&extension))
}

impl Foreign {
    fn refusal(&self, path: &Path, readers: &[&dyn MeshReader]) -> IoError {
        IoError::Unsupported {
            path: path.to_owned(),
            what: self.name.to_owned(),
            remedy: format!("{}; {}", self.remedy, formats_read(readers)),
        }
    }
}

/// "the formats read are A (.a, .b) and ...".
fn formats_read(readers: &[&dyn MeshReader]) -> String {
    let each = |reader: &&dyn MeshReader| {
        let extensions: Vec<_> = reader.extensions().iter().map(|e| format!(".{e}")).collect();
        format!("{} ({})", reader.name(), extensions.join(", "))
    };
    format!("the formats read are {}", readers.iter().map(each).collect::<Vec<_>>().join(", "))
}
