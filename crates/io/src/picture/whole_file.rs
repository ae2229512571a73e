//! Files that appear whole or not at all.

use std::{
    fs, io,
    io::Write,
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

use tempfile::NamedTempFile;

use crate::IoError;

/// Writes a file under a temporary name in the target's folder and renames it once it is complete.
///
/// A file that was there before is replaced in one step. The new one has the permissions of any new file (the system's
/// mask applies). A symbolic link is followed. Should anything fail, the temporary file is removed and what was at `path`
/// stays as it was.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    try_write(path, |file| file.write_all(bytes)).map_err(|error| not_written(path, &error))
}

/// [`write_whole`] for what is not in memory at once.
pub(crate) fn write_by(path: &Path, write: impl FnOnce(&mut fs::File) -> io::Result<()>) -> Result<(), IoError> {
    try_write(path, write).map_err(|error| not_written(path, &error))
}

/// Writes a file that is complete in memory: a table, a page. It appears whole or not at all, and replaces one that was there.
///
/// # Errors
/// [`IoError::Write`]; what was at `path` is as it was then.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    write_whole(path, bytes)
}

/// Writes files that belong together: all of them are complete under temporary names before the first takes its place.
///
/// # Errors
/// [`IoError::Write`]. All that was there is as it was then, unless the system refuses one of the renamings after it has done others.
pub fn write_files<'a>(files: impl IntoIterator<Item = (&'a Path, &'a [u8])>) -> Result<(), IoError> {
    let mut pending = Vec::new();
    for (path, bytes) in files {
        let made = PendingFile::make(path, |file| file.write_all(bytes)).map_err(|error| not_written(path, &error))?;
        pending.push(made);
    }
    put_in_place(pending).map_err(|(path, error)| not_written(&path, &error))
}

/// Whether a file could be written here: a temporary one is made beside it and removed. For whoever works long before there is something to
/// write.
///
/// # Errors
/// [`IoError::Write`] where the folder takes no file, or something else than a file is at `path`.
pub fn check_writable(path: &Path) -> Result<(), IoError> {
    PendingFile::empty(path).map(drop).map_err(|error| not_written(path, &error))
}

/// Makes a folder, and those that it lies in, where they are not there yet.
///
/// # Errors
/// [`IoError::Write`].
pub fn make_folder(path: &Path) -> Result<(), IoError> {
    fs::create_dir_all(path).map_err(|error| IoError::Write {
        path: path.to_owned(),
        problem: format!("the folder was not made: {error}"),
        remedy: remedy_of(&error),
    })
}

/// Ends all writing of this process, for a program that was told to end: temporary files are removed, and no file takes its place from now
/// on. Whoever writes one gets [`IoError::Write`].
///
/// A file that is being put in its place at this moment is waited for.
pub fn end_writing() {
    let mut pending = pending();
    pending.is_ended = true;
    for path in pending.paths.drain(..) {
        // Of what is not there nothing is left.
        let _ = fs::remove_file(path);
    }
}

/// [`write_whole`] with the writing left to the caller.
pub(super) fn try_write(path: &Path, write: impl FnOnce(&mut fs::File) -> io::Result<()>) -> io::Result<()> {
    put_in_place(vec![PendingFile::make(path, write)?]).map_err(|(_, error)| error)
}

fn not_written(path: &Path, error: &io::Error) -> IoError {
    IoError::Write { path: path.to_owned(), problem: error.to_string(), remedy: remedy_of(error) }
}

fn remedy_of(error: &io::Error) -> &'static str {
    if error.get_ref().is_some_and(|inner| inner.is::<Ended>()) {
        return "run it again";
    }
    match error.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free some space there, or name another folder"
        }
        _ => "check the folder and its permissions, or name another",
    }
}

/// Refuses what takes more memory than the system gives, before an encoder asks for it piece by piece.
pub(super) fn ask_for_memory(path: &Path, bytes: u64) -> Result<(), IoError> {
    let asked = usize::try_from(bytes).ok().and_then(|bytes| Vec::<u8>::new().try_reserve_exact(bytes).ok());
    asked.ok_or_else(|| IoError::Memory { path: path.to_owned(), bytes })
}

/// Why nothing is written after [`end_writing`].
#[derive(Debug, thiserror::Error)]
#[error("the program was told to end")]
struct Ended;

/// What [`end_writing`] has to know; held while files come and go, so that it misses none.
struct Pending {
    paths: Vec<PathBuf>,
    is_ended: bool,
}

impl Pending {
    fn refuse_if_ended(&self) -> io::Result<()> {
        if self.is_ended { Err(io::Error::other(Ended)) } else { Ok(()) }
    }
}

static PENDING: Mutex<Pending> = Mutex::new(Pending { paths: Vec::new(), is_ended: false });

fn pending() -> MutexGuard<'static, Pending> {
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A complete file under a temporary name. Dropped it is removed.
struct PendingFile {
    file: NamedTempFile,
    target: PathBuf,
    listed: Listed,
}

/// A temporary file's place in [`PENDING`].
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        pending().paths.retain(|path| *path != self.0);
    }
}

impl PendingFile {
    fn make(path: &Path, write: impl FnOnce(&mut fs::File) -> io::Result<()>) -> io::Result<Self> {
        let mut pending = Self::empty(path)?;
        write(pending.file.as_file_mut())?;
        // Some file systems report a full disk only here.
        pending.file.as_file().sync_all()?;
        Ok(pending)
    }

    fn empty(path: &Path) -> io::Result<Self> {
        let target = target_of(path)?;
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".tetrascope-").suffix(".part");
        // A temporary file is private by default; 0o666 less the mask is what `File::create` gives.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut pending = pending();
        pending.refuse_if_ended()?;
        let file = builder.tempfile_in(folder)?;
        let listed = Listed(file.path().to_owned());
        pending.paths.push(listed.0.clone());
        Ok(Self { file, target, listed })
    }
}

/// Renames complete files; on failure with the target that it failed at.
fn put_in_place(files: Vec<PendingFile>) -> Result<(), (PathBuf, io::Error)> {
    // Their places in the list are given up under the same lock, and so after it is given back.
    let (_listed, files): (Vec<_>, Vec<_>) =
        files.into_iter().map(|PendingFile { file, target, listed }| (listed, (file, target))).unzip();
    let pending = pending();
    for (file, target) in files {
        if let Err(error) = pending.refuse_if_ended() {
            return Err((target, error));
        }
        file.persist(&target).map_err(|error| (target, error.error))?;
    }
    Ok(())
}

/// The path that is to be replaced: where a symbolic link leads, and never a folder or a device.
fn target_of(path: &Path) -> io::Result<PathBuf> {
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_file() => fs::canonicalize(path),
        Ok(_) => Err(io::Error::other("there is something that is not a regular file")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            if path.file_name().is_none() {
                Err(error)
            } else {
                Ok(path.to_owned())
            }
        }
        Err(error) => Err(error),
    }
}
