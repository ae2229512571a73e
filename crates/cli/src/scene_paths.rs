//! Scene files on disk: reading one, and writing one whose paths still lead to the mesh.

use std::path::{Component, Path, PathBuf};

use tetrascope::{SceneFile, is_builtin};

use crate::Failure;

/// Whether a path names a scene file, by its extension.
pub(crate) fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml") || e.eq_ignore_ascii_case("json"))
}

/// Reads a scene file.
pub(crate) fn read(path: &Path) -> Result<SceneFile, Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| Failure::Input(format!("{}: cannot be read: {e}; check the path", path.display())))?;
    SceneFile::parse(&text, path).map_err(|e| Failure::Input(e.to_string()))
}

/// The folder that a scene file's paths are relative to.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// Writes a scene whose paths are relative to `base_dir`, so that they lead to the same files from its new place.
pub(crate) fn write(scene: &SceneFile, base_dir: &Path, path: &Path) -> Result<(), Failure> {
    let cannot = |problem: String| Failure::Input(format!("{}: cannot be written: {problem}", path.display()));
    let mut moved = scene.clone();
    let mesh = &mut moved.mesh;
    for file in std::iter::once(&mut mesh.path).chain(&mut mesh.solution).filter(|file| !is_builtin(file)) {
        *file = seen_from(folder_of(path), &base_dir.join(&*file)).map_err(|e| cannot(e.to_string()))?;
    }
    let is_json = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let text = if is_json { moved.to_json() } else { moved.to_toml() }.map_err(|e| cannot(e.to_string()))?;
    // Beside the target and then renamed, so that a scene that was there is not lost half-way.
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.tmp", std::process::id()));
    let temporary = path.with_file_name(name);
    let written = std::fs::write(&temporary, text).and_then(|()| std::fs::rename(&temporary, path));
    written.map_err(|e| {
        // It may not be there; the first problem is the one to tell.
        let _ = std::fs::remove_file(&temporary);
        cannot(e.to_string())
    })
}

/// The way from a folder to a file: relative if they have more than the root in common.
fn seen_from(folder: &Path, file: &Path) -> std::io::Result<PathBuf> {
    let (folder, file) = (folder.canonicalize()?, file.canonicalize()?);
    let common = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    // Another drive, or nothing but the root: a chain of ".." would be longer and break as soon as either moves.
    if common < 2 {
        return Ok(file);
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    Ok(up.chain(file.components().skip(common)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_to_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        std::fs::create_dir_all(root.join("a/b")).unwrap();
        std::fs::create_dir_all(root.join("c")).unwrap();
        std::fs::write(root.join("c/mesh.vtu"), "").unwrap();
        let way = |from: &str| seen_from(&root.join(from), &root.join("a/../c/mesh.vtu")).unwrap();
        assert_eq!(way("c"), Path::new("mesh.vtu"));
        assert_eq!(way("a/b"), Path::new("../../c/mesh.vtu"));
        assert_eq!(way("."), Path::new("c/mesh.vtu"));
    }
}
