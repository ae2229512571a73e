//! The section of appended data, which is found by its bytes as it is no XML.

use memchr::memmem;

use super::super::DAMAGED;
use super::attributes::Attributes;
use super::file::Appended;
use super::{is_one_file, root_type};
use crate::{IoError, OpenFile};

/// Finds the section by its bytes: it begins behind the first underscore behind the tag, with only white space between.
///
/// - `open`: the file, where only its beginning is in memory
pub(super) fn find_appended<'a>(
    attributes: &Attributes<'_, 'a>,
    open: Option<&'a OpenFile>,
    end_of_tag: usize,
) -> Result<Appended<'a>, IoError> {
    let rest = attributes.bytes.get(end_of_tag..).unwrap_or_default().trim_ascii_start();
    let Some(section) = rest.strip_prefix(b"_") else {
        let problem = "the appended data does not start with an underscore";
        return Err(attributes.source.invalid(attributes.place(), problem, DAMAGED));
    };
    match (attributes.get("encoding")?.as_deref().map(str::trim), open) {
        (Some("raw"), None) => Ok(Appended::Raw(section)),
        // Both end with the beginning of the file.
        (Some("raw"), Some(file)) => Ok(Appended::Open { file, start: attributes.source.bytes.len() - section.len() }),
        (None | Some("base64"), _) => {
            let end = memchr::memchr(b'<', section).unwrap_or(section.len());
            Ok(Appended::Base64(section[..end].trim_ascii_end()))
        }
        (Some(other), _) => Err(attributes.unknown("encoding", other, "raw and base64")),
    }
}

/// Looks for the section in more and more bytes of a file, of which those behind it need not be in memory.
#[derive(Debug, Default)]
pub(crate) struct AppendedSearch {
    /// Bytes that it does not begin in.
    searched: usize,
}

/// Bytes behind the beginning of the section's tag that are wanted too: its attributes and the underscore.
const TAG: usize = 4096;

impl AppendedSearch {
    /// Whether this is the beginning of a VTK XML file, up to the section.
    pub(crate) fn is_found(&mut self, bytes: &[u8]) -> bool {
        const START: &[u8] = b"<AppendedData";
        if !root_type(bytes).is_some_and(is_one_file) {
            return false;
        }
        let more = bytes.get(self.searched..).unwrap_or_default();
        match memmem::find(more, START) {
            Some(at) => {
                self.searched += at;
                bytes.len() - self.searched > TAG
            }
            None => {
                self.searched = bytes.len().saturating_sub(START.len() - 1).max(self.searched);
                false
            }
        }
    }
}
