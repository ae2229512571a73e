//! OpenFOAM's cases: a folder with a mesh of polyhedra in `constant/polyMesh` and fields in folders named by their time.
//!
//! A case is opened by its folder, by the empty `.foam` file in it, or by any file of its mesh. Its cells are known by their faces
//! alone: [`shapes`] tells the linear kinds, all others stay polyhedra. Fields stay where the files have them, in cells or at points;
//! faces of the boundary and fields on faces are left out. What processors wrote, and regions, are parts that [`join`] puts together.
//!
//! Source: the OpenFOAM User Guide, "Mesh files", and files that OpenFOAM wrote.

mod case;
mod choice;
mod collated;
mod entries;
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
mod field_tests;
#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod part_tests;
#[cfg(test)]
mod test_support;
#[cfg(test)]
mod tests;

use std::{collections::HashSet, path::Path};

use self::{choice::choose, collated::Blocks, fields::Budget, file::Header, join::Joined, part::Part};
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
        let mut blocks = Blocks::new(&source.options);
        let chosen = choose(source, &located, &mut blocks, &mut warnings)?;
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
            joined.add(Part::read(folders, &chosen.times, step, &mut blocks, &mut budget, &mut warnings)?);
        }
        let binary = if joined.is_binary() { "binary" } else { "text" };
        let mut format = format!("OpenFOAM case, {binary}, {}", chosen.description);
        if let Some(folder) = chosen.times.get(step) {
            format = format!("{format}, {} time steps, time {}", times.len(), folder.name);
        }
        let dataset = joined.finish(source, chosen.by_region, &mut budget, &mut warnings)?;
        // Parts have much in common, fields on faces for instance.
        let mut said = HashSet::new();
        warnings.retain(|warning| said.insert(warning.clone()));
        Ok(Loaded { dataset, format, warnings, times, step })
    }
}
