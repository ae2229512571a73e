//! The section of appended data, which is found by its bytes as it is no XML.

use super::super::DAMAGED;
use super::attributes::Attributes;
use super::file::Appended;
use crate::IoError;

/// Finds the section by its bytes: it begins behind the first underscore behind the tag, with only white space between.
pub(super) fn find_appended<'a>(attributes: &Attributes<'_, 'a>, end_of_tag: usize) -> Result<Appended<'a>, IoError> {
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
