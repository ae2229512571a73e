//! The folders of a case: where it begins, its time steps, its regions and the parts that processors wrote.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{file::existing, mesh::is_mesh_folder};

/// What a path says of a case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Located {
    /// The folder with `constant` and `system` in it.
    pub(super) root: PathBuf,
    /// The region that the path lies in, of a case of several meshes.
    pub(super) region: Option<String>,
    /// The time folder that the path is or lies in.
    pub(super) time: Option<String>,
}

/// A time folder.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TimeFolder {
    pub(super) name: String,
    pub(super) time: f64,
}

/// Extensions of the empty files by which other programs open a case.
pub(super) const MARKS: [&str; 2] = ["foam", "openfoam"];

/// How deep below its case a file can lie that stands for it: `constant/region/polyMesh/points`.
const DEEPEST: usize = 4;

/// The case that a path is, marks, or lies in.
pub(super) fn locate(path: &Path) -> Option<Located> {
    let whole = |root: PathBuf| Located { root, region: None, time: None };
    if path.is_dir() {
        return if is_case(path) { Some(whole(path.to_owned())) } else { inside(path) };
    }
    let parent = match path.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new("."),
        Some(parent) => parent,
        None => return None,
    };
    if is_mark(path) {
        let stem = path.file_stem()?.to_string_lossy();
        // `case{region}.foam` is how a mark names one region.
        let region = stem.split_once('{').and_then(|(_, rest)| rest.strip_suffix('}')).map(str::to_owned);
        return is_case(parent).then(|| Located { region, ..whole(parent.to_owned()) });
    }
    if path.is_file() { inside(parent) } else { None }
}

/// Whether a path is the empty file that stands for a case.
pub(super) fn is_mark(path: &Path) -> bool {
    MARKS.contains(&crate::read::extension(path).as_str())
}

/// Whether a path is surely a case's, by where it lies: its folder, its mark, or a file of its mesh or times that has no name of another format.
pub(super) fn is_taken(path: &Path) -> bool {
    if is_mark(path) {
        return path.is_file();
    }
    if path.is_dir() {
        return locate(path).is_some();
    }
    let in_mesh = path.parent().and_then(Path::file_name).is_some_and(|name| name == "polyMesh");
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let is_control = name == "controlDict";
    let packed = name.strip_suffix(".gz").is_some_and(|name| !name.contains('.'));
    (in_mesh || is_control || packed) && locate(path).is_some()
}

/// The case that a folder lies in, if it is one of those that a case has.
fn inside(folder: &Path) -> Option<Located> {
    let folder = folder.canonicalize().ok()?;
    let root = folder.ancestors().skip(1).take(DEEPEST).find(|ancestor| is_case(ancestor))?;
    let below = folder.strip_prefix(root).ok()?;
    let mut names = below.iter().map(|name| name.to_string_lossy().into_owned());
    let first = names.next()?;
    let time = time_of(&first).map(|_| first.clone());
    if first != "constant" && first != "system" && time.is_none() {
        return None;
    }
    let region = names.next().filter(|name| name != "polyMesh" && is_region(root, name));
    Some(Located { root: root.to_owned(), region, time })
}

/// Whether a folder is a case, made or only prepared.
fn is_case(folder: &Path) -> bool {
    folder.join("constant/polyMesh").is_dir()
        || folder.join("system/controlDict").is_file()
        || folder.join("processor0").is_dir()
        || !collated_folders(folder).is_empty()
        || !regions(folder).is_empty()
}

fn is_region(root: &Path, name: &str) -> bool {
    let collated = collated_folders(root).into_iter().map(|(_, folder)| folder);
    let mut roots = [root.to_owned(), root.join("processor0")].into_iter().chain(collated);
    roots.any(|root| root.join("constant").join(name).join("polyMesh").is_dir())
}

/// Names of the regions whose meshes a folder has, sorted.
pub(super) fn regions(root: &Path) -> Vec<String> {
    names_in(&root.join("constant"))
        .into_iter()
        .filter(|name| is_mesh_folder(&root.join("constant").join(name).join("polyMesh")))
        .collect()
}

/// The folders that the processors of a parallel run wrote, in their order.
pub(super) fn processor_folders(root: &Path) -> Vec<PathBuf> {
    let number = |name: &str| name.strip_prefix("processor").and_then(|number| number.parse::<u32>().ok());
    let mut found: Vec<(u32, String)> =
        names_in(root).into_iter().filter_map(|name| number(&name).map(|number| (number, name))).collect();
    found.sort();
    found.into_iter().map(|(_, name)| root.join(name)).filter(|folder| folder.is_dir()).collect()
}

/// The folders whose files several processors have written together, by the number of processors and the first of those in them:
/// `processors4`, or `processors4_0-1` and `processors4_2-3`.
pub(super) fn collated_folders(root: &Path) -> Vec<(u32, PathBuf)> {
    let numbers = |name: &str| {
        let name = name.strip_prefix("processors")?;
        let (count, first) = match name.split_once('_') {
            Some((count, range)) => (count, range.split_once('-')?.0.parse::<u32>().ok()?),
            None => (name, 0),
        };
        Some((count.parse::<u32>().ok()?, first))
    };
    let mut found: Vec<_> =
        names_in(root).into_iter().filter_map(|name| Some((numbers(&name)?, root.join(name)))).collect();
    found.sort();
    found.into_iter().filter(|(_, folder)| folder.is_dir()).map(|((count, _), folder)| (count, folder)).collect()
}

/// The time folders of a case, by time.
pub(super) fn time_folders(root: &Path) -> Vec<TimeFolder> {
    let folder = |name: String| Some(TimeFolder { time: time_of(&name)?, name });
    let mut times: Vec<TimeFolder> =
        names_in(root).into_iter().filter_map(folder).filter(|folder| root.join(&folder.name).is_dir()).collect();
    times.sort_by(|a, b| a.time.total_cmp(&b.time));
    times
}

/// The time that a folder's name says. Rust reads `inf` and `nan` as numbers, which no program writes as a time.
fn time_of(name: &str) -> Option<f64> {
    name.parse().ok().filter(|time: &f64| time.is_finite())
}

/// The last of the first `steps` time folders in which the mesh has this file anew, else `constant`.
pub(super) fn instance_of(root: &Path, times: &[TimeFolder], below: &Path, name: &str) -> PathBuf {
    let changed = |folder: &&TimeFolder| existing(&root.join(&folder.name).join(below).join(name)).is_some();
    let instance = times.iter().rev().find(changed).map_or("constant", |folder| folder.name.as_str());
    root.join(instance).join(below)
}

/// Names in a folder, sorted; none where it cannot be looked at.
pub(super) fn names_in(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<String> = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    names
}
