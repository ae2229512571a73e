//! The sections of a file, and how each of them is written.

use memchr::memmem;

use super::REWRITE;
use crate::bytes::{ByteOrder, Number};
use crate::{IoError, Source};

/// A version of the format whose layout differs from the others'.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    /// `$NOD` and `$ELM`, without a header.
    V1,
    /// 2.0 to 2.2.
    V2,
    /// 4.0: every node beside its coordinates.
    V40,
    /// 4.1: the numbers of a block's nodes before all their coordinates.
    V41,
}

/// How the numbers of a section are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// As words.
    Text,
    /// As bytes; counts and tags of version 4 take `size_bytes`.
    Binary { order: ByteOrder, size_bytes: usize },
}

/// What stands between `$Name` and `$EndName`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section<'a> {
    /// The name without its `$`.
    pub(super) name: &'a [u8],
    /// Where the body begins, in bytes from the start of the file.
    pub(super) start: usize,
    /// All bytes up to the end mark.
    pub(super) body: &'a [u8],
    pub(super) version: Version,
    pub(super) form: Form,
}

impl Section<'_> {
    /// The name as it stands in the file, for messages.
    pub(super) fn title(&self) -> String {
        format!("${}", String::from_utf8_lossy(self.name))
    }
}

/// All sections of a file but its headers, in its order. Text outside of sections is passed over, as Gmsh does.
///
/// A header (`$MeshFormat`) may come again: Gmsh puts whole files behind one another when it appends a view.
///
/// # Errors
/// [`IoError::Invalid`] where a section has no end or a header is damaged, [`IoError::Unsupported`] for other versions.
pub(super) fn sections(source: &Source) -> Result<Vec<Section<'_>>, IoError> {
    let bytes = source.bytes.as_slice();
    let mut found = Vec::new();
    let mut position = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    let (mut version, mut form) = (Version::V1, Form::Text);
    while let Some(rest) = bytes.get(position..).filter(|rest| !rest.is_empty()) {
        let line_length = memchr::memchr(b'\n', rest).map_or(rest.len(), |end| end + 1);
        let line = rest.get(..line_length).unwrap_or_default().trim_ascii();
        position += line_length;
        let Some(name) = line.strip_prefix(b"$") else { continue };
        if name.get(..3).is_some_and(|start| start.eq_ignore_ascii_case(b"End")) {
            continue;
        }
        let (start, body_rest) = (position, bytes.get(position..).unwrap_or_default());
        // Version 1 has its marks in capitals.
        let mark = [if name == b"NOD" || name == b"ELM" { &b"$END"[..] } else { b"$End" }, name].concat();
        let Some(length) = memmem::find(body_rest, &mark) else {
            let title = String::from_utf8_lossy(name);
            return Err(source.invalid(
                format!("section ${title}, byte {start}"),
                format!("the file ends before $End{title}"),
                REWRITE,
            ));
        };
        let body = body_rest.get(..length).unwrap_or_default();
        position += length + mark.len();
        if name == b"MeshFormat" {
            (version, form) = header(source, body, start)?;
        } else {
            found.push(Section { name, start, body, version, form });
        }
    }
    Ok(found)
}

/// Version and form, from a header: the version, 0 or 1 for text or binary, the size of a number, and of a binary file the number 1.
fn header(source: &Source, body: &[u8], start: usize) -> Result<(Version, Form), IoError> {
    let invalid = |problem: String| source.invalid(format!("section $MeshFormat, byte {start}"), problem, REWRITE);
    let end = memchr::memchr(b'\n', body).unwrap_or(body.len());
    let (line, rest) = (body.get(..end).unwrap_or_default(), body.get(end + 1..).unwrap_or_default());
    let line = String::from_utf8_lossy(line);
    let mut words = line.split_ascii_whitespace();
    let (number, kind, size) = (words.next(), words.next(), words.next());
    let tenths = number.and_then(|word| word.parse::<f64>().ok()).map(|number| (number * 10.0).round());
    let version = match tenths {
        Some(20.0..=22.0) => Version::V2,
        Some(40.0) => Version::V40,
        Some(41.0) => Version::V41,
        Some(_) => {
            return Err(source.unsupported(
                format!("version {} of Gmsh's format", number.unwrap_or_default()),
                "open it in Gmsh and save it as version 4.1 or 2.2",
            ));
        }
        None => return Err(invalid(format!("\"{}\" begins with no version", line.trim()))),
    };
    if kind == Some("0") {
        return Ok((version, Form::Text));
    }
    if kind != Some("1") {
        return Err(invalid(format!("\"{}\" says neither text (0) nor binary (1)", line.trim())));
    }
    // The size is that of a tag in 4.1 and of a coordinate in the versions before, whose counts take 8 bytes.
    let size_bytes = match (version, size) {
        (_, Some("8")) => 8,
        (Version::V41, Some("4")) => 4,
        _ => return Err(invalid(format!("numbers of {} bytes are not known", size.unwrap_or("no")))),
    };
    let one = |order| i32::from_bytes(rest, order) == Some(1);
    match [ByteOrder::Little, ByteOrder::Big].into_iter().find(|&order| one(order)) {
        Some(order) => Ok((version, Form::Binary { order, size_bytes })),
        None => Err(invalid("the number 1 that tells the order of bytes is not there".to_owned())),
    }
}
