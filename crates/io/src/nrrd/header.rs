//! The lines of a header: fields by their names, and where the data begins.

use std::collections::BTreeMap;

use crate::{IoError, Source};

/// Fields of a header, and what follows it in the file.
#[derive(Debug)]
pub(super) struct Header<'a> {
    /// The digits behind NRRD: 1 to 6 so far.
    pub(super) version: u32,
    /// Each field's line and what it says, by the name that [`FIELDS`] has first.
    fields: BTreeMap<&'static str, Field>,
    /// Names of data files, one a line, behind `data file: LIST`.
    pub(super) list: Vec<String>,
    /// What comes after the empty line that ends the header; nothing where the file ends with the header.
    pub(super) data: Option<&'a [u8]>,
    /// Lines that are no field of the format and no key with a value: how many, and the first of them.
    pub(super) unknown: Option<(usize, String)>,
}

/// What a field says.
#[derive(Debug)]
pub(super) struct Field {
    /// Its line, counted from 1.
    pub(super) line: usize,
    /// What stands behind the colon, without white space around it.
    pub(super) text: String,
}

/// All fields of the format with the other ways to write them.
const FIELDS: &[&[&str]] = &[
    &["dimension"],
    &["type"],
    &["sizes"],
    &["encoding"],
    &["endian"],
    &["data file", "datafile"],
    &["line skip", "lineskip"],
    &["byte skip", "byteskip"],
    &["kinds"],
    &["centers", "centerings"],
    &["spacings"],
    &["axis mins", "axismins"],
    &["axis maxs", "axismaxs"],
    &["space"],
    &["space dimension", "spacedimension"],
    &["space directions", "spacedirections"],
    &["space origin", "spaceorigin"],
    &["measurement frame", "measurementframe"],
    &["old min", "oldmin"],
    &["old max", "oldmax"],
    // The rest says nothing that a picture needs.
    &["block size", "blocksize"],
    &["content"],
    &["labels"],
    &["max"],
    &["min"],
    &["number"],
    &["sample units", "sampleunits"],
    &["space units", "spaceunits"],
    &["thicknesses"],
    &["units"],
];

/// Axes that a file may have.
const MOST_AXES: usize = 16;

pub(super) const MEND: &str = "mend the header, or write the volume again";

impl<'a> Header<'a> {
    /// Whether bytes begin as a header does.
    pub(super) fn begins(bytes: &[u8]) -> bool {
        bytes.starts_with(b"NRRD000") || bytes.starts_with(b"NRRD00.01")
    }

    /// Takes a header apart. The work is that of its lines alone: the first line that is none of a header ends it.
    pub(super) fn parse(source: &'a Source) -> Result<Self, IoError> {
        let version = version(&source.bytes)
            .map_err(|found| source.invalid("line 1", format!("`{found}` is not NRRD and four digits"), MEND))?;
        let mut lines = Lines { rest: &source.bytes, number: 0 };
        lines.next();
        let mut header = Self { version, fields: BTreeMap::new(), list: Vec::new(), data: None, unknown: None };
        while let Some(line) = lines.next() {
            let number = lines.number;
            let text = line.trim_end();
            if text.is_empty() {
                header.data = Some(lines.rest);
                break;
            }
            if text.starts_with('#') {
                continue;
            }
            if header.lists_files() {
                header.list.push(text.to_owned());
                continue;
            }
            let Some((name, value)) = text.split_once(':') else {
                let found: String = text.chars().take(60).collect();
                return Err(source.invalid(
                    format!("line {number}"),
                    format!("`{found}` is neither a field nor a comment, and no empty line before it ends the header"),
                    MEND,
                ));
            };
            header.add(source, number, name, value)?;
        }
        Ok(header)
    }

    /// Whether the last line said that names follow.
    fn lists_files(&self) -> bool {
        self.fields.get("data file").is_some_and(|field| field.text.split_whitespace().next() == Some("LIST"))
    }

    fn add(&mut self, source: &Source, line: usize, name: &str, value: &str) -> Result<(), IoError> {
        // `key:=value` is for whoever knows the key.
        if value.starts_with('=') {
            return Ok(());
        }
        let lower = name.trim().to_ascii_lowercase();
        let Some(canonical) =
            FIELDS.iter().find(|names| names.contains(&lower.as_str())).and_then(|names| names.first())
        else {
            if !value.contains(":=") {
                self.unknown.get_or_insert_with(|| (0, name.chars().take(60).collect())).0 += 1;
            }
            return Ok(());
        };
        let field = Field { line, text: value.trim().to_owned() };
        if let Some(first) = self.fields.insert(canonical, field) {
            let problem = format!("the field `{canonical}` stands in line {} already", first.line);
            return Err(source.invalid(format!("line {line}"), problem, MEND));
        }
        Ok(())
    }

    /// A field, where the header has it.
    pub(super) fn field(&self, name: &str) -> Option<&Field> {
        self.fields.get(name)
    }

    /// A field's text in lower case, where the header has it.
    pub(super) fn lower(&self, name: &str) -> Option<String> {
        self.field(name).map(|field| field.text.to_ascii_lowercase())
    }

    /// A field that every file must have.
    pub(super) fn needed(&self, source: &Source, name: &str) -> Result<&Field, IoError> {
        self.field(name).ok_or_else(|| source.invalid("the header", format!("it has no field `{name}`"), MEND))
    }

    /// Number of samples along every axis, the fastest first; one to sixteen numbers above 0.
    pub(super) fn sizes(&self, source: &Source) -> Result<Vec<usize>, IoError> {
        let dimension = self.needed(source, "dimension")?;
        let axes = dimension.text.parse().ok().filter(|axes| (1..=MOST_AXES).contains(axes)).ok_or_else(|| {
            dimension.invalid(source, format!("`{}` is no number of axes from 1 to {MOST_AXES}", dimension.text))
        })?;
        let sizes = self.needed(source, "sizes")?;
        let number = |word: &str| {
            word.parse::<usize>().ok().filter(|&size| size > 0).ok_or_else(|| {
                sizes.invalid(source, format!("`{word}` is no number of samples: a number of at least 1 is"))
            })
        };
        let counts: Vec<usize> = sizes.text.split_whitespace().map(number).collect::<Result<_, _>>()?;
        if counts.len() != axes {
            return Err(sizes.invalid(source, format!("{} sizes are given for {axes} axes", counts.len())));
        }
        Ok(counts)
    }

    /// The words of a field with one word an axis; `None` where the header does not have it.
    pub(super) fn words(&self, source: &Source, name: &str, axes: usize) -> Result<Option<Vec<String>>, IoError> {
        let Some(field) = self.field(name) else { return Ok(None) };
        let words: Vec<String> = field.text.split_whitespace().map(str::to_owned).collect();
        if words.len() != axes {
            return Err(field.invalid(source, format!("{} words stand in `{name}` of {axes} axes", words.len())));
        }
        Ok(Some(words))
    }

    /// The numbers of a field with one an axis, NaN where one is not known; `None` where the header does not have it.
    pub(super) fn numbers(&self, source: &Source, name: &str, axes: usize) -> Result<Option<Vec<f64>>, IoError> {
        let Some(words) = self.words(source, name, axes)? else { return Ok(None) };
        let number = |word: &String| {
            word.parse().map_err(|_| match self.field(name) {
                Some(field) => field.invalid(source, format!("`{word}` in `{name}` is no number")),
                None => source.invalid("the header", format!("`{word}` in `{name}` is no number"), MEND),
            })
        };
        words.iter().map(number).collect::<Result<_, _>>().map(Some)
    }

    /// A whole number, 0 where the header does not have the field.
    pub(super) fn integer(&self, source: &Source, name: &str) -> Result<i64, IoError> {
        match self.field(name) {
            None => Ok(0),
            Some(field) => field
                .text
                .parse()
                .map_err(|_| field.invalid(source, format!("`{}` in `{name}` is no whole number", field.text))),
        }
    }
}

impl Field {
    /// An error at this field's line.
    pub(super) fn invalid(&self, source: &Source, problem: impl Into<String>) -> IoError {
        source.invalid(format!("line {}", self.line), problem, MEND)
    }
}

/// The digits that a file begins with, or the text that stands there instead.
fn version(bytes: &[u8]) -> Result<u32, String> {
    let beginning = bytes.get(..20).unwrap_or(bytes).split(|&byte| byte == b'\n').next().unwrap_or_default();
    let magic = String::from_utf8_lossy(beginning).trim_end().to_owned();
    match magic.strip_prefix("NRRD") {
        Some("00.01") => Ok(1),
        Some(digits) if digits.len() == 4 => digits.parse().map_err(|_| magic),
        _ => Err(magic),
    }
}

/// Lines of text in front of bytes that are none.
struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl Lines<'_> {
    /// The next line without its end; bytes that are no UTF-8 are replaced.
    fn next(&mut self) -> Option<String> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let end = self.rest.iter().position(|&byte| byte == b'\n');
        let (line, rest) = match end {
            Some(end) => (self.rest.get(..end)?, self.rest.get(end + 1..)?),
            None => (self.rest, &[][..]),
        };
        self.rest = rest;
        Some(String::from_utf8_lossy(line).into_owned())
    }
}
