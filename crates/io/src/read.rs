//! The one trait behind which all readers stand.

use std::path::{Path, PathBuf};

use tetrascope_mesh::Dataset;

use crate::IoError;

/// A file that was read into memory, to be understood.
#[derive(Debug)]
pub struct Source {
    /// Where it came from; used in messages and to find files beside it.
    pub path: PathBuf,
    /// All its bytes.
    pub bytes: Vec<u8>,
    /// A second file that the user named to go with it (PLOT3D's solution).
    pub solution: Option<PathBuf>,
}

/// What a reader gives.
#[derive(Debug)]
pub struct Loaded {
    /// The mesh and its arrays.
    pub dataset: Dataset,
    /// The format as a user would call it, with what was found out: "PLOT3D, big-endian, 32-bit, no record marks".
    pub format: String,
    /// What was odd and how it was treated, one sentence each.
    pub warnings: Vec<String>,
}

/// Reads one format.
pub trait MeshReader: Sync {
    /// The format's name.
    fn name(&self) -> &'static str;

    /// Extensions that its files usually have, in lower case without the dot.
    fn extensions(&self) -> &'static [&'static str];

    /// Whether a file is surely of this format, judged by its content alone.
    fn recognizes(&self, bytes: &[u8]) -> bool;

    /// Reads it.
    ///
    /// # Errors
    /// [`IoError`] with the file, the place and a remedy. Never panics, and reserves no memory from declared counts.
    fn read(&self, source: &Source) -> Result<Loaded, IoError>;
}

impl Source {
    /// An [`IoError::Invalid`] about this file.
    pub fn invalid(&self, place: impl Into<String>, problem: impl Into<String>, remedy: impl Into<String>) -> IoError {
        IoError::Invalid {
            path: self.path.clone(),
            place: printable(place.into()),
            problem: printable(problem.into()),
            remedy: remedy.into(),
        }
    }

    /// An [`IoError::Unsupported`] about this file.
    pub fn unsupported(&self, what: impl Into<String>, remedy: impl Into<String>) -> IoError {
        IoError::Unsupported { path: self.path.clone(), what: printable(what.into()), remedy: remedy.into() }
    }

    /// The file's extension in lower case, or nothing.
    pub fn extension(&self) -> String {
        extension(&self.path)
    }
}

pub(crate) fn extension(path: &Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Longest part of a message, in characters: words and names of a file are repeated in it, and may be as long as the file.
const LONGEST_TEXT: usize = 800;

/// A text that has words of a file in it, as it may be shown: control characters, which can make a terminal do anything, give way to
/// U+FFFD, and of a long text the middle is left out.
pub(crate) fn printable(text: String) -> String {
    let mut text = text;
    if text.contains(char::is_control) {
        text = text.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect();
    }
    let length = text.chars().count();
    if length > LONGEST_TEXT {
        let start: String = text.chars().take(LONGEST_TEXT / 2).collect();
        let end: String = text.chars().skip(length - LONGEST_TEXT / 2).collect();
        text = format!("{start} ... {end}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_files_can_be_shown() {
        assert_eq!(printable("`\u{1b}[2Jα\n`".to_owned()), "`\u{fffd}[2Jα\u{fffd}`");
        let long = printable("ab".repeat(100_000));
        assert!(long.starts_with("abab") && long.ends_with("abab") && long.chars().count() == LONGEST_TEXT + 5);
    }
}
