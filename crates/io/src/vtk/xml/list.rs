//! Files that name others: which, and where those lie.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use quick_xml::events::Event;
use quick_xml::reader::Reader;

use super::super::DAMAGED;
use super::appended::AppendedSearch;
use super::attributes::{Attributes, line, shorten};
use super::file::without_mark;
use crate::opened::{FIRST, read_beginning};
use crate::{IoError, OpenFile, Source};

/// What to do where a file that another one names is not there.
const TOGETHER: &str = "keep the files together, in the folders in which they were written";

/// An element that names a file.
#[derive(Debug)]
pub(super) struct Named {
    /// The name as it stands there.
    pub(super) file: String,
    /// Attributes that were asked for, where they are there.
    pub(super) more: Vec<Option<String>>,
    /// The byte at which the element starts.
    position: usize,
}

/// All elements of one name that name a file, at any depth, in a file of one of these types.
///
/// - `attribute`: the one that holds the name; an element without it names none
/// - `more`: other attributes that are wanted
pub(super) fn names(
    source: &Source,
    types: &[&str],
    element_name: &str,
    attribute: &str,
    more: &[&str],
) -> Result<Vec<Named>, IoError> {
    let bytes = without_mark(&source.bytes);
    let mut reader = Reader::from_reader(bytes);
    reader.config_mut().expand_empty_elements = true;
    let position = |reader: &Reader<&[u8]>| usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
    let (mut depth, mut root_seen) = (0_usize, false);
    let mut all = Vec::new();
    loop {
        let start = position(&reader);
        let event = reader.read_event().map_err(|e| {
            let at = usize::try_from(reader.error_position()).unwrap_or(start);
            source.invalid(line(bytes, at), format!("not well-formed XML: {e}"), DAMAGED)
        })?;
        match event {
            Event::Start(element) => {
                let attributes = Attributes { source, bytes, start, element: &element };
                if depth == 0 {
                    let found = attributes.get("type")?.unwrap_or_default();
                    if root_seen || element.name().as_ref() != "VTKFile" || !types.contains(&found.trim()) {
                        return Err(source.invalid(
                            attributes.place(),
                            format!("there is no root element `VTKFile` of the type {}", types.join(" or ")),
                            "give the file the extension of its format",
                        ));
                    }
                    root_seen = true;
                } else if element.name().as_ref() == element_name
                    && let Some(file) = attributes.get(attribute)?
                {
                    let more = more.iter().map(|name| attributes.get(name)).collect::<Result<_, _>>()?;
                    all.push(Named { file: file.trim().to_owned(), more, position: start });
                }
                depth += 1;
            }
            Event::End(_) => depth = depth.saturating_sub(1),
            Event::Eof if depth > 0 || !root_seen => {
                let problem = if root_seen { "the file ends inside an XML element" } else { "there is no XML element" };
                return Err(source.invalid("end of the file", problem, DAMAGED));
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if all.is_empty() {
        let problem = format!("no element `{element_name}` names a file in its attribute `{attribute}`");
        return Err(source.invalid("the whole file", problem, DAMAGED));
    }
    Ok(all)
}

impl Named {
    /// Named by something else than an element.
    pub(super) fn plain(file: String) -> Self {
        Self { file, more: Vec::new(), position: 0 }
    }

    /// Where the name stands.
    pub(super) fn place(&self, source: &Source) -> String {
        line(without_mark(&source.bytes), self.position)
    }

    /// The path of the file: relative names count from the folder of the file that names it.
    ///
    /// # Errors
    /// Addresses of the network, and files that are not there.
    pub(super) fn path(&self, source: &Source) -> Result<PathBuf, IoError> {
        let name = &self.file;
        if name.contains("://") {
            let problem = format!("it names `{}`, and files are not fetched from a network", shorten(name));
            return Err(source.invalid(self.place(source), problem, "name files of this machine"));
        }
        let folder = source.path.parent().unwrap_or_else(|| Path::new(""));
        let path = folder.join(name);
        if !path.exists() && name.contains('\\') {
            // As Windows writes them.
            let turned = folder.join(name.replace('\\', "/"));
            if turned.exists() {
                return Ok(turned);
            }
        }
        match std::fs::metadata(&path) {
            Ok(metadata) if metadata.is_file() => Ok(path),
            found => {
                let why = found.map_or_else(|error| error.to_string(), |_| "it is no regular file".to_owned());
                let problem = format!("it names `{}`, which cannot be read: {why}", shorten(name));
                Err(source.invalid(self.place(source), problem, TOGETHER))
            }
        }
    }

    /// The beginning of the file, to be understood with the same options, and the file.
    pub(super) fn open(&self, source: &Source) -> Result<(Source, OpenFile), IoError> {
        let path = self.path(source)?;
        let mut appended = AppendedSearch::default();
        let (bytes, file) = read_beginning(&path, &source.options, FIRST, |bytes| appended.is_found(bytes))?;
        Ok((Source { bytes, path, options: source.options.clone() }, file))
    }
}

/// Leaves out what names a file that was named before: no mesh is there twice, and a few bytes could stand for any number of files.
pub(super) fn each_once(source: &Source, named: Vec<Named>, warnings: &mut Vec<String>) -> Result<Vec<Named>, IoError> {
    let mut seen = HashSet::new();
    let mut once = Vec::new();
    for one in named {
        let path = one.path(source)?;
        if seen.insert(path.canonicalize().unwrap_or(path)) {
            once.push(one);
        } else {
            warnings.push(format!("`{}` is named more than once; it is read once", one.file));
        }
    }
    Ok(once)
}
