//! Where the data of a header lies: behind it, in another file, or in many.

use std::{
    collections::HashSet,
    fs,
    path::{Path, PathBuf},
};

use super::{
    axes::Axes,
    header::{Field, Header, MEND},
    pattern::Pattern,
};
use crate::{IoError, Source};

/// The data of a header, in one part or several that follow each other.
#[derive(Debug)]
pub(super) enum Data<'a> {
    /// Behind the header.
    Attached(&'a [u8]),
    /// In files of their own, which were there.
    Files(Vec<DataFile>),
}

/// One data file.
#[derive(Debug)]
pub(super) struct DataFile {
    /// Its name as the header has it, for messages.
    pub(super) name: String,
    pub(super) path: PathBuf,
    /// Its length in bytes.
    length: u64,
}

impl<'a> Data<'a> {
    /// Finds the data. The files that the header names are there, each a regular one and none of them named twice, so that a header cannot
    /// make much of little; and there are as many as the sizes ask for.
    pub(super) fn find(source: &'a Source, header: &Header<'a>, axes: &Axes) -> Result<Self, IoError> {
        let Some(field) = header.field("data file") else {
            let no_end = "no empty line ends the header, and no field `data file` says where the data is";
            return header.data.map(Self::Attached).ok_or_else(|| source.invalid("the header", no_end, MEND));
        };
        let mut words = field.text.split_whitespace();
        let names: Box<dyn Iterator<Item = String>> = match words.next() {
            Some("LIST") => {
                let dimension = dimension(source, field, words.next(), axes)?;
                check_count(source, field, axes, dimension, header.list.len())?;
                Box::new(header.list.iter().cloned())
            }
            Some(first) if Pattern::is_one(first) => {
                let pattern = Pattern::parse(&field.text).map_err(|problem| field.invalid(source, problem))?;
                let dimension = dimension(source, field, pattern.dimension.as_deref(), axes)?;
                check_count(source, field, axes, dimension, pattern.count())?;
                Box::new(pattern.names())
            }
            Some(_) => Box::new(std::iter::once(field.text.clone())),
            None => return Err(field.invalid(source, "`data file` names no file")),
        };
        let mut seen = HashSet::new();
        names.map(|name| DataFile::find(source, field, name, &mut seen)).collect::<Result<_, _>>().map(Self::Files)
    }

    /// Bytes of all parts together.
    pub(super) fn length(&self) -> usize {
        match self {
            Self::Attached(data) => data.len(),
            Self::Files(files) => {
                let length = files.iter().fold(0_u64, |sum, file| sum.saturating_add(file.length));
                usize::try_from(length).unwrap_or(usize::MAX)
            }
        }
    }

    /// Number of parts, each of which holds as many samples as any other.
    pub(super) fn part_count(&self) -> usize {
        match self {
            Self::Attached(_) => 1,
            Self::Files(files) => files.len().max(1),
        }
    }
}

impl DataFile {
    fn find(source: &Source, field: &Field, name: String, seen: &mut HashSet<PathBuf>) -> Result<Self, IoError> {
        let place = format!("line {}", field.line);
        let remedy = "put the data file where the header says, or correct its name there";
        if name.contains("://") {
            return Err(source.unsupported(format!("data at an address, `{name}`,"), "fetch it, and name the file"));
        }
        let path = source.path.parent().unwrap_or(Path::new("")).join(&name);
        let problem = |what: String| source.invalid(place.as_str(), format!("the data file `{name}` {what}"), remedy);
        let found = fs::metadata(&path).and_then(|metadata| Ok((metadata, fs::canonicalize(&path)?)));
        let (metadata, canonical) = found.map_err(|error| problem(format!("cannot be read: {error}")))?;
        if !metadata.is_file() {
            return Err(problem("is no regular file".to_owned()));
        }
        if !seen.insert(canonical) {
            return Err(problem("is named twice".to_owned()));
        }
        Ok(Self { name, path, length: metadata.len() })
    }
}

/// How many axes a data file has: one less than the whole unless the header says more.
fn dimension(source: &Source, field: &Field, word: Option<&str>, axes: &Axes) -> Result<usize, IoError> {
    let all = axes.sizes.len();
    match word {
        None => Ok(all - 1),
        Some(word) => word.parse().ok().filter(|dimension| (1..=all).contains(dimension)).ok_or_else(|| {
            field.invalid(source, format!("`{word}` is no number of axes of a data file: 1 to {all} are"))
        }),
    }
}

/// There must be a file for every place along the axes that a file does not have; of files with all axes any number that divides the last.
fn check_count(source: &Source, field: &Field, axes: &Axes, dimension: usize, count: usize) -> Result<(), IoError> {
    let slower = axes.sizes.get(dimension..).unwrap_or_default();
    if slower.is_empty() {
        let last = axes.sizes.last().copied().unwrap_or(1);
        return match count {
            1.. if last % count == 0 => Ok(()),
            _ => {
                Err(field
                    .invalid(source, format!("{count} data files cannot share the {last} places of the last axis")))
            }
        };
    }
    let needed: usize = slower.iter().product();
    if count != needed {
        let problem = format!("{count} data files of {dimension} axes are named, and the sizes ask for {needed}");
        return Err(field.invalid(source, problem));
    }
    Ok(())
}
