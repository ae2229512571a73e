//! What of a case is read: the whole of it or what its processors wrote, and which regions.

use std::path::{Path, PathBuf};

use super::{
    NO_MESH,
    case::{self, Located, TimeFolder},
    collated::Blocks,
    mesh::is_mesh_folder,
    part::PartFolders,
};
use crate::{IoError, Source};

/// What of a case is read.
pub(super) struct Chosen {
    pub(super) parts: Vec<PartFolders>,
    pub(super) times: Vec<TimeFolder>,
    /// For the format's name.
    pub(super) description: String,
    /// Whether there are several regions.
    pub(super) by_region: bool,
}

/// Chooses the whole case, unless what the processors have reaches further in time.
pub(super) fn choose(
    source: &Source,
    located: &Located,
    blocks: &mut Blocks,
    warnings: &mut Vec<String>,
) -> Result<Chosen, IoError> {
    let root = &located.root;
    let region = located.region.as_deref();
    let (processors, collated) = processors(root, warnings);
    let first = processors.first().map(PathBuf::as_path);
    let whole = mesh_regions(root, region);
    let split = first.map(|folder| mesh_regions(folder, region)).unwrap_or_default();
    let whole_times = case::time_folders(root);
    let split_times = first.map(case::time_folders).unwrap_or_default();
    let last = |times: &[TimeFolder]| times.last().map_or(f64::NEG_INFINITY, |folder| folder.time);

    let use_split = !split.is_empty() && (whole.is_empty() || last(&split_times) > last(&whole_times));
    if use_split && !whole.is_empty() && !whole_times.is_empty() {
        warnings.push("the processors have later times than the whole case; what they wrote is read".to_owned());
    }
    let (folders, regions, times) = match use_split {
        true => (processors, split, split_times),
        false => (vec![root.clone()], whole, whole_times),
    };
    if regions.is_empty() {
        let (place, problem) = match region {
            Some(region) => (format!("constant/{region}/polyMesh"), "there is no mesh of this region"),
            None => ("constant/polyMesh".to_owned(), "the case has no mesh: points, faces and owner are not there"),
        };
        return Err(source.invalid(place, problem, NO_MESH));
    }
    let others = case::regions(folders.first().unwrap_or(root));
    if let (true, Some(other)) = (regions == [None], others.first()) {
        warnings.push(format!("the regions {} are not read; name constant/{other} to read one", others.join(", ")));
    }

    let mut parts = Vec::new();
    let mut words = match &regions[..] {
        [None] => Vec::new(),
        [Some(region)] => vec![format!("region {region}")],
        several => vec![format!("{} regions", several.len())],
    };
    let by_region = regions.len() > 1;
    let mut processor_count = 0;
    for (region_number, region) in (0..).zip(regions) {
        processor_count = 0;
        for folder in &folders {
            let mesh = folder.join("constant").join(region.as_deref().unwrap_or_default()).join("polyMesh");
            let in_blocks = use_split && collated;
            let count = if in_blocks { blocks.count(&mesh.join("points"))? } else { 1 };
            processor_count += count;
            parts.extend((0..count).map(|block| PartFolders {
                root: folder.clone(),
                region: region.clone(),
                region_number,
                decomposed: use_split,
                block: in_blocks.then_some(block),
            }));
        }
    }
    if use_split {
        words.push(format!("decomposed into {processor_count}"));
    }
    let description = if words.is_empty() { "one mesh".to_owned() } else { words.join(", ") };
    Ok(Chosen { parts, times, description, by_region })
}

/// The folders that processors wrote, and whether they wrote into them together.
fn processors(root: &Path, warnings: &mut Vec<String>) -> (Vec<PathBuf>, bool) {
    let alone = case::processor_folders(root);
    if !alone.is_empty() {
        return (alone, false);
    }
    let together = case::collated_folders(root);
    let count = together.first().map(|(count, _)| *count);
    let other = together.iter().find(|(other, _)| Some(*other) != count);
    if let (Some(count), Some((other, _))) = (count, other) {
        warnings.push(format!("what {other} processors wrote is left out; what {count} of them wrote is taken"));
    }
    (together.into_iter().filter(|(other, _)| Some(*other) == count).map(|(_, folder)| folder).collect(), true)
}

/// The meshes that a folder has: the one without a name, that of the region asked for, or those of all regions.
fn mesh_regions(folder: &Path, wanted: Option<&str>) -> Vec<Option<String>> {
    let plain = is_mesh_folder(&folder.join("constant/polyMesh"));
    let regions = case::regions(folder);
    match wanted {
        Some(wanted) => regions.into_iter().filter(|region| region == wanted).map(Some).collect(),
        None if plain => vec![None],
        None => regions.into_iter().map(Some).collect(),
    }
}
