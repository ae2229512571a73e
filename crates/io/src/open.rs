//! From a path to a dataset: reads the file and finds its reader.

use std::path::Path;

use crate::opened::{FIRST, read_beginning};
use crate::read::printable;
use crate::{
    IoError, Loaded, MeshReader, RawVolume, ReadOptions, Source, exodus::EXODUS, foreign, gmsh::GMSH, nrrd::NRRD,
    openfoam::OPENFOAM, plot3d::PLOT3D, raw::RAW, vtk, vtkhdf::VTKHDF,
};

/// All readers, in the order in which they are asked whether they recognize a file.
///
/// VTKHDF is asked before Exodus, which takes any file of HDF5; PLOT3D is last: its files begin with nothing that tells them apart, so that it judges by whether all sizes fit.
pub fn readers() -> &'static [&'static dyn MeshReader] {
    static READERS: [&dyn MeshReader; 19] = [
        &vtk::VTU,
        &vtk::VTI,
        &vtk::VTR,
        &vtk::VTS,
        &vtk::PVTU,
        &vtk::PVTI,
        &vtk::PVTR,
        &vtk::PVTS,
        &vtk::PVD,
        &vtk::SERIES,
        &vtk::BLOCKS,
        &vtk::LEGACY,
        &VTKHDF,
        &EXODUS,
        &GMSH,
        &NRRD,
        &OPENFOAM,
        &RAW,
        &PLOT3D,
    ];
    &READERS
}

/// Reads a mesh of any known format, found by its content first and by its extension where the content does not tell.
///
/// `options` say what the file does not: PLOT3D's q file, which time step, size and type of a raw volume, which is taken for one whatever its
/// content. So is a file whose name says them and which is as long as that. Any other file whose content is of another format than
/// its extension says is read by its content, with a warning.
///
/// # Errors
/// [`IoError::Read`] when the system does not give the file, [`IoError::Unsupported`] when no reader takes it (the message
/// lists those there are), [`IoError::Invalid`] when it is broken, [`IoError::Interrupted`] when the progress of the options says so.
pub fn read_mesh(path: &Path, options: &ReadOptions) -> Result<Loaded, IoError> {
    open(path, options, true)
}

/// Reads a mesh that another file names, of any format but those that name meshes themselves: such files could name each other without end.
///
/// - `options`: of the file that names it, of which only the progress counts
pub(crate) fn read_part(path: &Path, options: &ReadOptions) -> Result<Loaded, IoError> {
    open(path, &ReadOptions { progress: options.progress.clone(), ..ReadOptions::default() }, false)
}

fn open(path: &Path, options: &ReadOptions, may_name_meshes: bool) -> Result<Loaded, IoError> {
    let source = |bytes: Vec<u8>| Source { path: path.to_owned(), bytes, options: options.clone() };
    let by_path = readers().iter().copied().find(|reader| reader.takes(path));
    if let Some(reader) = by_path {
        let source = source(Vec::new());
        return finished(&source, reader, reader.read(&source)?);
    }
    let is_raw = options.raw.is_some() || RawVolume::of_name(path, file_length(path)).is_some();
    let mut appended = vtk::AppendedSearch::default();
    let (bytes, file) = read_beginning(path, options, FIRST, |bytes| !is_raw && appended.is_found(bytes))?;
    let mut source = source(bytes);
    if is_raw {
        return finished(&source, &RAW, RAW.read(&source)?);
    }
    let extension = source.extension();
    let expected = reader_of_extension(&extension);
    let recognized = readers().iter().copied().find(|reader| reader.recognizes(&source.bytes));
    let reader = match (recognized, expected) {
        (Some(reader), _) => reader,
        (None, expected) => match foreign::refuse_by_content(path, &source.bytes, readers()) {
            Some(refusal) => return Err(refusal),
            None => expected.ok_or_else(|| foreign::refuse_by_extension(path, readers()))?,
        },
    };
    if reader.names_meshes() && !may_name_meshes {
        return Err(source.unsupported(
            format!("a file that names meshes ({}) inside another", reader.name()),
            "name the meshes themselves in the outer file, or read the inner one by itself",
        ));
    }

    let in_pieces = if source.bytes.len() < file.length() { reader.read_open(&source, &file)? } else { None };
    let loaded = match in_pieces {
        Some(loaded) => loaded,
        None => {
            file.read_rest(&mut source.bytes)?;
            reader.read(&source)?
        }
    };
    let mut loaded = finished(&source, reader, loaded)?;
    let named_otherwise =
        expected.is_some_and(|other| other.name() != reader.name()) || foreign::is_foreign_extension(&extension);
    // Extensions that two readers share say nothing against either.
    if named_otherwise && !reader.extensions().contains(&extension.as_str()) {
        loaded.warnings.push(format!(
            "the file is named .{extension} but its content is {}; it was read by its content",
            reader.name()
        ));
    }
    Ok(loaded)
}

/// What a reader gives, with what is the same for all.
fn finished(source: &Source, reader: &dyn MeshReader, mut loaded: Loaded) -> Result<Loaded, IoError> {
    loaded.warnings = loaded.warnings.into_iter().map(printable).collect();
    loaded.format = printable(loaded.format);
    if source.options.solution.is_some() && reader.name() != PLOT3D.name() {
        loaded.warnings.push(format!(
            "the solution file was not read: only PLOT3D keeps its arrays in a second file, and this is {}",
            reader.name()
        ));
    }
    // Of a file with steps the reader has chosen one.
    if loaded.times.is_empty() {
        source.step(&[])?;
    }
    Ok(loaded)
}

/// Length of a file in bytes; 0 for what cannot be looked at, which reading will say.
pub fn file_length(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |metadata| metadata.len())
}

/// All bytes of a file that holds no mesh and is small by its nature: a color map, say.
///
/// - `most`: bytes that it may have
///
/// # Errors
/// [`IoError::Read`] when the system does not give the file, [`IoError::Unsupported`] for a folder, a device or one that is too large,
/// [`IoError::Invalid`] for one that is empty.
pub fn read_small_file(path: &Path, most: u64) -> Result<Vec<u8>, IoError> {
    let length = file_length(path);
    if length > most {
        return Err(IoError::Unsupported {
            path: path.to_owned(),
            what: format!("reading {length} bytes where at most {most} are expected"),
            remedy: "check the path; it seems to be another file".to_owned(),
        });
    }
    crate::opened::read_whole(path, &ReadOptions::default())
}

fn reader_of_extension(extension: &str) -> Option<&'static dyn MeshReader> {
    readers().iter().copied().find(|reader| reader.extensions().contains(&extension))
}

/// The file's name alone, for warnings.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::extension;

    fn refusal(name: &str, bytes: &[u8]) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let message = read_mesh(&path, &ReadOptions::default()).unwrap_err().to_string();
        assert!(message.contains(name), "{message}");
        message
    }

    #[test]
    fn extension_of_a_path() {
        assert_eq!(extension(Path::new("a.b/Grid.XYZ")), "xyz");
        assert_eq!(extension(Path::new("a.b/grid")), "");
    }

    #[test]
    fn refusals_name_the_file_and_a_way_out() {
        let png = refusal("picture.vtu", b"\x89PNG\r\n\x1a\n....");
        assert!(png.contains("PNG picture") && png.contains("PLOT3D"), "{png}");
        assert!(refusal("empty.vtu", b"").contains("empty (0 bytes)"));
        assert!(refusal("fluent.msh", b"(0 \"Fluent\")").contains("Fluent"));
        assert!(refusal("unrecognizable.vti", b"what is this").contains("XML"));
        assert!(refusal("notes.txt", b"nothing of the kind").contains(".exo"));
        assert!(refusal("noextension", b"nothing of the kind").contains("no extension"));
    }

    #[test]
    fn missing_files_and_folders() {
        let folder = tempfile::tempdir().unwrap();
        let missing = read_mesh(&folder.path().join("missing.vtu"), &ReadOptions::default()).unwrap_err();
        assert!(matches!(missing, IoError::Read { .. }), "{missing}");
        assert!(missing.to_string().contains("missing.vtu"));
        let is_folder = read_mesh(folder.path(), &ReadOptions::default()).unwrap_err();
        assert!(is_folder.to_string().contains("folder"), "{is_folder}");
    }
}
