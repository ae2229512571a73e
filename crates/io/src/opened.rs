//! Files on their way into memory: all of them, or the beginning and the rest when it is asked for.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use crate::progress::{Meter, ReadStage};
use crate::{IoError, ReadOptions};

/// Bytes that are read before anything is asked of them.
pub(crate) const FIRST: usize = 1 << 16;

/// Bytes between two reports.
const STEP: usize = 1 << 22;

/// An open file of which the beginning is in memory.
#[derive(Debug)]
pub struct OpenFile {
    path: PathBuf,
    file: File,
    /// Bytes that it has, the beginning included.
    length: usize,
    meter: Meter,
}

/// All bytes of a regular file that is not empty.
///
/// # Errors
/// [`IoError::Read`], [`IoError::Unsupported`] for what is no regular file, [`IoError::Invalid`] where it is empty, [`IoError::Interrupted`].
pub(crate) fn read_whole(path: &Path, options: &ReadOptions) -> Result<Vec<u8>, IoError> {
    let (bytes, _) = read_beginning(path, options, FIRST, |_| false)?;
    Ok(bytes)
}

/// The bytes of a regular file that is not empty, up to where they are enough.
///
/// - `step`: how many bytes to read before `is_enough` is asked for the first time
///
/// # Errors
/// As of [`read_whole`].
pub(crate) fn read_beginning(
    path: &Path,
    options: &ReadOptions,
    step: usize,
    mut is_enough: impl FnMut(&[u8]) -> bool,
) -> Result<(Vec<u8>, OpenFile), IoError> {
    let failed = |source| IoError::Read { path: path.to_owned(), source };
    let metadata = std::fs::metadata(path).map_err(failed)?;
    // A device or a pipe may never end.
    if !metadata.is_file() {
        return Err(IoError::Unsupported {
            path: path.to_owned(),
            what: if metadata.is_dir() { "reading a folder" } else { "reading a device or pipe" }.to_owned(),
            remedy: "name a regular file, or the folder of an OpenFOAM case".to_owned(),
        });
    }
    let mut file = File::open(path).map_err(failed)?;
    let meter = Meter::new(path, options, ReadStage::Reading, metadata.len());
    let length = usize::try_from(metadata.len()).unwrap_or(usize::MAX);
    let mut bytes = Vec::new();
    let mut wanted = step;
    loop {
        let left = length.saturating_sub(bytes.len());
        reserve(&mut bytes, wanted.min(left)).map_err(failed)?;
        let taken = file.by_ref().take(wanted as u64).read_to_end(&mut bytes).map_err(failed)?;
        meter.advance(taken)?;
        if taken < wanted || is_enough(&bytes) {
            break;
        }
        if bytes.len() == step {
            // It was no short look then: the rest fits, and is not moved.
            reserve(&mut bytes, length.saturating_sub(step)).map_err(failed)?;
        }
        wanted = STEP;
    }
    if bytes.is_empty() {
        return Err(IoError::Invalid {
            path: path.to_owned(),
            place: "the whole file".to_owned(),
            problem: "it is empty (0 bytes)".to_owned(),
            remedy: "write it again; the program that made it may have failed".to_owned(),
        });
    }
    // A file of the system's own may say that it is shorter than it is.
    let length = length.max(bytes.len());
    Ok((bytes, OpenFile { path: path.to_owned(), file, length, meter }))
}

fn reserve(bytes: &mut Vec<u8>, more: usize) -> Result<(), std::io::Error> {
    bytes.try_reserve_exact(more).map_err(|_| std::io::ErrorKind::OutOfMemory.into())
}

impl OpenFile {
    /// Bytes that the file has, the beginning included.
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// Counts what is read.
    pub(crate) fn meter(&self) -> &Meter {
        &self.meter
    }

    /// Reads so many bytes from one on, in place of what is in `bytes`. They must be known to be there.
    ///
    /// # Errors
    /// [`IoError::Read`] and [`IoError::Interrupted`].
    pub(crate) fn read_at(&self, start: usize, count: usize, bytes: &mut Vec<u8>) -> Result<(), IoError> {
        let failed = |source| IoError::Read { path: self.path.clone(), source };
        bytes.clear();
        reserve(bytes, count).map_err(failed)?;
        let mut file = &self.file;
        file.seek(SeekFrom::Start(start as u64)).map_err(failed)?;
        let taken = file.take(count as u64).read_to_end(bytes).map_err(failed)?;
        if taken < count {
            // It was longer when it was opened.
            return Err(failed(std::io::ErrorKind::UnexpectedEof.into()));
        }
        self.meter.advance(count)
    }

    /// Reads what is behind the beginning.
    ///
    /// # Errors
    /// [`IoError::Read`] and [`IoError::Interrupted`].
    pub(crate) fn read_rest(&self, beginning: &mut Vec<u8>) -> Result<(), IoError> {
        let failed = |source| IoError::Read { path: self.path.clone(), source };
        let mut file = &self.file;
        file.seek(SeekFrom::Start(beginning.len() as u64)).map_err(failed)?;
        reserve(beginning, self.length.saturating_sub(beginning.len())).map_err(failed)?;
        loop {
            let taken = file.take(STEP as u64).read_to_end(beginning).map_err(failed)?;
            self.meter.advance(taken)?;
            if taken < STEP {
                return Ok(());
            }
        }
    }
}
