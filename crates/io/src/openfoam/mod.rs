//! OpenFOAM's cases: a folder with a mesh of polyhedra in `constant/polyMesh` and fields in folders named by their time.
//!
//! A case is opened by its folder, by the empty `.foam` file in it, or by any file of its mesh. Cells are faces there; those of
//! the linear kinds are told by their faces, all others stay polyhedra. Cells, faces of the boundary and fields on faces are not made points' values:
//! arrays are those of the time folder, in cells and at points as they are there.
//!
//! Source: the OpenFOAM User Guide, "Mesh description" and "Basic input/output file format", and files that OpenFOAM wrote.

mod case;
mod fields;
mod file;
mod join;
mod lists;
mod mesh;
mod part;
mod patches;
mod shapes;
mod shared_points;
mod words;

#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod test_support;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use self::{
    case::{Located, TimeFolder},
    fields::Budget,
    file::Header,
    join::Joined,
    part::{Part, PartFolders},
};
use crate::{IoError, Loaded, MeshReader, Source, StepChoice};

/// The reader of OpenFOAM's cases.
pub(crate) static OPENFOAM: OpenFoam = OpenFoam;

/// See [`OPENFOAM`].
#[derive(Debug)]
pub(crate) struct OpenFoam;

/// What to advise where a path leads to no mesh.
const NO_MESH: &str = "name the folder of a case whose mesh is made (blockMesh, snappyHexMesh, or an import)";

impl MeshReader for OpenFoam {
    fn name(&self) -> &'static str {
        "OpenFOAM"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &case::MARKS
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        Header::parse(bytes).is_some()
    }

    fn takes(&self, path: &Path) -> bool {
        case::is_taken(path)
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let located = case::locate(&source.path).ok_or_else(|| {
            source.invalid(
                "the folder",
                "there is no OpenFOAM case that this belongs to: no constant/polyMesh, no processor0",
                NO_MESH,
            )
        })?;
        let mut warnings = Vec::new();
        let chosen = choose(source, &located, &mut warnings)?;
        let times: Vec<f64> = chosen.times.iter().map(|folder| folder.time).collect();
        let step = match (&located.time, source.options.step) {
            // The path itself says which step, if nothing else does.
            (Some(name), StepChoice::Last) => chosen.times.iter().position(|folder| folder.name == *name),
            _ => None,
        };
        let step = step.map_or_else(|| source.step(&times), Ok)?;

        let mut budget = Budget::default();
        let mut joined = Joined::default();
        for folders in &chosen.parts {
            joined.add(Part::read(folders, &chosen.times, step, &mut budget, &mut warnings)?);
        }
        let binary = if joined.is_binary() { "binary" } else { "text" };
        let mut format = format!("OpenFOAM case, {binary}, {}", chosen.description);
        if let Some(folder) = chosen.times.get(step) {
            format = format!("{format}, {} time steps, time {}", times.len(), folder.name);
        }
        let dataset = joined.finish(source, chosen.by_region, &mut budget, &mut warnings)?;
        Ok(Loaded { dataset, format, warnings, times, step })
    }
}

/// What of a case is read.
struct Chosen {
    parts: Vec<PartFolders>,
    times: Vec<TimeFolder>,
    description: String,
    /// Whether the parts are regions, rather than what processors have of one mesh.
    by_region: bool,
}

/// Whether the case as a whole is read or what its processors wrote, and which regions.
fn choose(source: &Source, located: &Located, warnings: &mut Vec<String>) -> Result<Chosen, IoError> {
    let root = &located.root;
    let processors = case::processor_folders(root);
    let first = processors.first().map(PathBuf::as_path);
    let has_mesh = |folder: &Path| mesh_regions(folder, located.region.as_deref());
    let whole = has_mesh(root);
    let split = first.map(has_mesh).unwrap_or_default();
    let whole_times = case::time_folders(root);
    let split_times = first.map(case::time_folders).unwrap_or_default();
    let last = |times: &[TimeFolder]| times.last().map_or(f64::NEG_INFINITY, |folder| folder.time);

    if let (Some(name), true) = (case::collated_folder(root), processors.is_empty()) {
        if whole.is_empty() {
            return Err(source.unsupported(
                format!("a decomposed case whose processors write into one folder, `{name}`,"),
                "run reconstructPar, or decompose with -fileHandler uncollated",
            ));
        }
        warnings.push(format!(
            "`{name}` is not read: processors have written into it together; reconstructPar joins what it holds"
        ));
    }
    let use_split = !split.is_empty() && (whole.is_empty() || last(&split_times) > last(&whole_times));
    let (folders, regions, times) = match use_split {
        true => (processors.clone(), split, split_times),
        false => (vec![root.clone()], whole, whole_times),
    };
    if regions.is_empty() {
        let (place, problem) = match &located.region {
            Some(region) => (format!("constant/{region}/polyMesh"), "there is no mesh of this region".to_owned()),
            None => (
                "constant/polyMesh".to_owned(),
                "the case has no mesh: points, faces and owner are not there".to_owned(),
            ),
        };
        return Err(source.invalid(place, problem, NO_MESH));
    }
    if use_split && !case::time_folders(root).is_empty() && !mesh_regions(root, located.region.as_deref()).is_empty() {
        warnings.push("the processors have later times than the whole case; what they wrote is read".to_owned());
    }

    let mut description = match &regions[..] {
        [None] => String::new(),
        [Some(region)] => format!("region {region}"),
        several => format!("{} regions", several.len()),
    };
    let others = case::regions(folders.first().unwrap_or(root));
    if regions == [None] && !others.is_empty() {
        warnings.push(format!(
            "the regions {} are not read; name constant/{} to read one",
            others.join(", "),
            others[0]
        ));
    }
    if use_split {
        let parts = format!("decomposed into {}", folders.len());
        description = if description.is_empty() { parts } else { format!("{description}, {parts}") };
    }
    if description.is_empty() {
        "one mesh".clone_into(&mut description);
    }
    let by_region = regions.len() > 1;
    let part = |(region_number, region): (i32, Option<String>)| {
        folders.iter().map(move |root| PartFolders { root: root.clone(), region: region.clone(), region_number })
    };
    let parts = (0..).zip(regions).flat_map(part).collect();
    Ok(Chosen { parts, times, description, by_region })
}

/// The meshes that a folder has: the one without a name, that of the region asked for, or those of all regions.
fn mesh_regions(folder: &Path, wanted: Option<&str>) -> Vec<Option<String>> {
    let plain = mesh::is_mesh_folder(&folder.join("constant/polyMesh"));
    let regions = case::regions(folder);
    match wanted {
        Some(wanted) => regions.into_iter().filter(|region| region == wanted).map(Some).collect(),
        None if plain => vec![None],
        None => regions.into_iter().map(Some).collect(),
    }
}
