//! Files that name whole meshes: ParaView's collections (`.pvd`), with the time of each, and VTK's multi-block datasets (`.vtm`).

use std::collections::HashSet;

use super::super::DAMAGED;
use super::super::join::join;
use super::list::{Named, each_once, names};
use super::{distinct, root_type};
use crate::open::read_part;
use crate::{IoError, Loaded, MeshReader, Source};

/// Reads ParaView's collections.
pub(crate) struct PvdReader;

/// Reads multi-block datasets and their kin.
pub(crate) struct BlocksReader;

const PVD_TYPES: &[&str] = &["Collection"];
const BLOCKS_TYPES: &[&str] = &["vtkMultiBlockDataSet", "vtkPartitionedDataSetCollection", "vtkPartitionedDataSet"];

impl MeshReader for PvdReader {
    fn name(&self) -> &'static str {
        "ParaView collection"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["pvd"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        root_type(bytes).is_some_and(|found| PVD_TYPES.contains(&found))
    }

    fn names_meshes(&self) -> bool {
        true
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let named = names(source, PVD_TYPES, "DataSet", "file", &["timestep", "group", "part"])?;
        let mut timed = Vec::with_capacity(named.len());
        let mut knows_time = false;
        for one in named {
            let time = match one.more.first().and_then(Option::as_deref) {
                None => 0.0,
                Some(text) => {
                    knows_time = true;
                    text.trim().parse().ok().filter(|time: &f64| time.is_finite()).ok_or_else(|| {
                        let problem = format!("the attribute `timestep` is \"{text}\", not a finite number");
                        source.invalid(one.place(source), problem, DAMAGED)
                    })?
                }
            };
            timed.push((time, one));
        }
        let mut warnings = Vec::new();
        if !timed.is_sorted_by(|a, b| a.0 <= b.0) {
            warnings.push("the times do not rise in the file; they are counted in the order of time".to_owned());
        }
        let mut times: Vec<f64> = timed.iter().map(|(time, _)| *time).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let step = source.step(&times)?;
        let chosen = times.get(step).copied().unwrap_or_default();
        let parts: Vec<Named> = timed.into_iter().filter(|(time, _)| *time == chosen).map(|(_, named)| named).collect();
        let mut places = HashSet::new();
        if parts.iter().any(|part| part.more.iter().any(Option::is_some) && !places.insert(part.more.clone())) {
            warnings.push(format!("several files are listed as one part at the time {chosen}; all are read"));
        }
        let loaded = read_parts(source, parts, warnings)?;
        if !knows_time {
            times.clear();
        }
        let format = format!("{} of {} time steps, {}", self.name(), times.len().max(1), loaded.format);
        Ok(Loaded { times, step, format, ..loaded })
    }
}

impl MeshReader for BlocksReader {
    fn name(&self) -> &'static str {
        "VTK multi-block dataset"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["vtm", "vtmb", "vtpc", "vtpd"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        root_type(bytes).is_some_and(|found| BLOCKS_TYPES.contains(&found))
    }

    fn names_meshes(&self) -> bool {
        true
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let named = names(source, BLOCKS_TYPES, "DataSet", "file", &[])?;
        let loaded = read_parts(source, named, Vec::new())?;
        let format = format!("{}, {}", self.name(), loaded.format);
        Ok(Loaded { format, ..loaded })
    }
}

/// Reads meshes and puts them one behind the other. What is of a kind that is not read, as surfaces are, is left out where something else is there.
fn read_parts(source: &Source, named: Vec<Named>, mut warnings: Vec<String>) -> Result<Loaded, IoError> {
    let named = each_once(source, named, &mut warnings)?;
    let mut parts = Vec::with_capacity(named.len());
    let (mut formats, mut refused) = (Vec::new(), None);
    for one in &named {
        let path = one.path(source)?;
        match read_part(&path) {
            Ok(loaded) => {
                warnings.extend(loaded.warnings);
                formats.push(loaded.format);
                parts.push(loaded.dataset);
            }
            Err(error @ IoError::Unsupported { .. }) => {
                warnings.push(format!("`{}` is left out: {error}", one.file));
                refused.get_or_insert(error);
            }
            Err(error) => return Err(error),
        }
    }
    if let (true, Some(error)) = (parts.is_empty(), refused) {
        return Err(error);
    }
    let count = parts.len();
    formats.dedup();
    let dataset = join(parts, &mut warnings)
        .map_err(|problem| source.invalid("the parts together", problem, "read a part by itself"))?;
    let plural = if count == 1 { "part" } else { "parts" };
    let format = format!("{count} {plural}: {}", formats.join("; "));
    Ok(Loaded::without_time(dataset, format, distinct(warnings)))
}
