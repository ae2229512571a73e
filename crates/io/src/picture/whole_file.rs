//! Files that appear whole or not at all.

use std::{
    fs, io,
    io::Write,
    path::{Path, PathBuf},
};

use crate::IoError;

/// Writes a file under a temporary name in the target's folder and renames it once it is complete.
///
/// A file that was there before is replaced in one step. The new one has the permissions of any new file (the system's
/// mask applies). A symbolic link is followed. Should anything fail, the temporary file is removed and what was at `path`
/// stays as it was.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    try_write(path, |file| file.write_all(bytes))
        .map_err(|error| IoError::Write { path: path.to_owned(), problem: error.to_string() })
}

/// Writes a file that is complete in memory: a table, a page. It appears whole or not at all, and replaces one that was there.
///
/// # Errors
/// [`IoError::Write`]; what was at `path` is as it was then.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    write_whole(path, bytes)
}

/// Makes a folder, and those that it lies in, where they are not there yet.
///
/// # Errors
/// [`IoError::Write`].
pub fn make_folder(path: &Path) -> Result<(), IoError> {
    fs::create_dir_all(path)
        .map_err(|error| IoError::Write { path: path.to_owned(), problem: format!("the folder was not made: {error}") })
}

/// [`write_whole`] with the writing left to the caller.
pub(super) fn try_write(path: &Path, write: impl FnOnce(&mut fs::File) -> io::Result<()>) -> io::Result<()> {
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
    let mut file = builder.tempfile_in(folder)?;
    write(file.as_file_mut())?;
    // Some file systems report a full disk only here.
    file.as_file().sync_all()?;
    file.persist(target).map_err(|error| error.error)?;
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
