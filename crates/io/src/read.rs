//! The one trait behind which all readers stand.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use tetrascope_mesh::Dataset;

use crate::{IoError, OpenFile, RawVolume, ReadProgress};

/// What a user says of a mesh file besides its name.
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    /// A second file that goes with it: PLOT3D's solution.
    pub solution: Option<PathBuf>,
    /// Which of its time steps to read.
    pub step: StepChoice,
    /// That it is a raw volume, and of what.
    pub raw: Option<RawVolume>,
    /// Who is told how far it is, and may stop it.
    pub progress: Option<Arc<dyn ReadProgress>>,
}

/// One time step of those that a file has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum StepChoice {
    /// The last one: what a computation came to. First steps are often all zero.
    #[default]
    Last,
    /// By number, from 0.
    Number(usize),
    /// The one whose time is nearest, of two equally near ones the earlier.
    Time(f64),
}

/// A file that was read into memory, to be understood.
#[derive(Debug, Default)]
pub struct Source {
    /// Where it came from; used in messages and to find files beside it.
    pub path: PathBuf,
    /// All its bytes; none of a folder, or of a file that a reader takes [by its path](MeshReader::takes).
    pub bytes: Vec<u8>,
    /// What the user says of it.
    pub options: ReadOptions,
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
    /// The times of all steps that the file has, in its own order; empty where it knows no time.
    pub times: Vec<f64>,
    /// Which of these was read; 0 where there are none.
    pub step: usize,
}

impl Loaded {
    /// Of a file that knows no time.
    pub fn without_time(dataset: Dataset, format: String, warnings: Vec<String>) -> Self {
        Self { dataset, format, warnings, times: Vec::new(), step: 0 }
    }
}

/// Reads one format.
pub trait MeshReader: Sync {
    /// The format's name.
    fn name(&self) -> &'static str;

    /// Extensions that its files usually have, in lower case without the dot.
    fn extensions(&self) -> &'static [&'static str];

    /// Whether a file is surely of this format, judged by its content alone.
    fn recognizes(&self, bytes: &[u8]) -> bool;

    /// Whether a path is surely of this format whatever the file holds: a folder with certain files in it, or a file that is empty by custom.
    fn takes(&self, _path: &Path) -> bool {
        false
    }

    /// Whether its files name others that any reader may read. Such a file is not read where another one names it.
    fn names_meshes(&self) -> bool {
        false
    }

    /// Reads it.
    ///
    /// # Errors
    /// [`IoError`] with the file, the place and a remedy. Never panics, and reserves no memory from declared counts.
    fn read(&self, source: &Source) -> Result<Loaded, IoError>;

    /// Reads it without having all of it in memory: `beginning` has the first bytes of `file`. Nothing where that cannot be done, and
    /// the file is to be [read](Self::read) whole.
    ///
    /// # Errors
    /// As of [`read`](Self::read).
    fn read_open(&self, _beginning: &Source, _file: &OpenFile) -> Result<Option<Loaded>, IoError> {
        Ok(None)
    }
}

impl ReadOptions {
    /// With a second file, or nothing.
    pub fn with_solution(solution: Option<&Path>) -> Self {
        Self { solution: solution.map(Path::to_owned), ..Self::default() }
    }
}

impl StepChoice {
    /// The step that is meant, of those at `times`.
    ///
    /// # Errors
    /// A sentence, where there is no such step; 0 is the only one where there are none.
    pub fn of(self, times: &[f64]) -> Result<usize, String> {
        let count = times.len().max(1);
        match self {
            Self::Last => Ok(count - 1),
            Self::Number(number) if number < count => Ok(number),
            Self::Number(number) => Err(match times {
                [] => format!("there is no step {number}: the file has no time steps"),
                _ => format!("there is no step {number}: the file has {count}, counted from 0"),
            }),
            Self::Time(time) => {
                let distance = |step: &usize| (times[*step] - time).abs();
                let nearest = (0..times.len()).filter(|step| !distance(step).is_nan());
                nearest
                    .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                    .ok_or_else(|| format!("there is no time {time}: the file has no time steps"))
            }
        }
    }
}

impl Source {
    /// The step that the user means, of those at `times`.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where there is none.
    pub fn step(&self, times: &[f64]) -> Result<usize, IoError> {
        let remedy = "choose one with --step or --time; `tetrascope info` lists them";
        self.options.step.of(times).map_err(|problem| self.invalid("time steps", problem, remedy))
    }

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
    fn steps_by_number_and_time() {
        let times = [0.0, 0.5, 2.0];
        assert_eq!(StepChoice::Last.of(&times), Ok(2));
        assert_eq!(StepChoice::Last.of(&[]), Ok(0));
        assert_eq!(StepChoice::Number(1).of(&times), Ok(1));
        assert_eq!(StepChoice::Number(0).of(&[]), Ok(0));
        assert!(StepChoice::Number(3).of(&times).unwrap_err().contains("the file has 3"));
        for (time, step) in [(-1.0, 0), (0.25, 0), (0.26, 1), (9.0, 2)] {
            assert_eq!(StepChoice::Time(time).of(&times), Ok(step), "{time}");
        }
        assert_eq!(StepChoice::Time(1.0).of(&[f64::NAN, 1.5]), Ok(1));
        assert!(StepChoice::Time(f64::NAN).of(&times).is_err() && StepChoice::Time(0.0).of(&[]).is_err());
    }

    #[test]
    fn texts_of_files_can_be_shown() {
        assert_eq!(printable("`\u{1b}[2Jα\n`".to_owned()), "`\u{fffd}[2Jα\u{fffd}`");
        let long = printable("ab".repeat(100_000));
        assert!(long.starts_with("abab") && long.ends_with("abab") && long.chars().count() == LONGEST_TEXT + 5);
    }
}
