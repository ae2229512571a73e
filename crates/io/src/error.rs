//! What goes wrong with files: what, where, and what to do.

use std::path::PathBuf;

/// Why a file was not read or written. Every message names the file, the place in it and a remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The operating system did not give the file.
    #[error("{}: cannot be read: {source}; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The file breaks the rules of its format, or ends too early.
    #[error("{}: {place}: {problem}; {remedy}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// Where in it: a line, a byte offset, an array's name, a cell's number.
        place: String,
        /// What is wrong there, with the number found and its limit.
        problem: String,
        /// What the user can do.
        remedy: String,
    },
    /// The file may be fine but is of a kind that is not read here.
    #[error("{}: {what} is not supported; {remedy}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// The format or feature.
        what: String,
        /// What the user can do.
        remedy: String,
    },
    /// Reading was given up, as [`ReadProgress::is_stopped`](crate::ReadProgress::is_stopped) said.
    #[error("{}: reading it was interrupted; start again to read it", path.display())]
    Interrupted {
        /// The file.
        path: PathBuf,
    },
    /// A file was not written; nothing is left in its place.
    #[error("{}: cannot be written: {problem}; {remedy}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the operating system or the encoder says.
        problem: String,
        /// What the user can do.
        remedy: &'static str,
    },
    /// The memory that a file takes on its way out is not there; nothing was written.
    #[error(
        "{}: cannot be written: that takes {} MiB, more memory than the system gives; ask for a smaller picture (image.width and \
         image.height), or free some memory",
        path.display(),
        .bytes.div_ceil(1 << 20)
    )]
    Memory {
        /// The file.
        path: PathBuf,
        /// Bytes at least.
        bytes: u64,
    },
}
