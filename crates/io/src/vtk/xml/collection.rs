//! Files that name whole meshes: ParaView's collections (`.pvd`) and file series (`.series`), with the time of each, and VTK's
//! multi-block datasets (`.vtm`).

use std::collections::HashSet;

use super::super::DAMAGED;
use super::super::join::join;
use super::file::without_mark;
use super::list::{Named, each_once, names};
use super::{distinct, root_type};
use crate::open::read_part;
use crate::{IoError, Loaded, MeshReader, Source};

/// Reads ParaView's collections.
pub(crate) struct PvdReader;

/// Reads ParaView's file series (`.vtu.series`, `.vtk.series`, ...), lists in JSON.
pub(crate) struct SeriesReader;

#[derive(serde::Deserialize)]
struct Series {
    files: Vec<SeriesFile>,
}

#[derive(serde::Deserialize)]
struct SeriesFile {
    name: String,
    time: f64,
}

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
        let loaded = read_timed(source, timed)?;
        let times = if knows_time { loaded.times } else { Vec::new() };
        let format = format!("{} of {} time steps, {}", self.name(), times.len().max(1), loaded.format);
        Ok(Loaded { times, format, ..loaded })
    }
}

impl MeshReader for SeriesReader {
    fn name(&self) -> &'static str {
        "ParaView file series"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["series"]
    }

    fn recognizes(&self, bytes: &[u8]) -> bool {
        const KEY: &[u8] = b"\"file-series-version\"";
        const LOOKED_AT: usize = 4096;
        let bytes = without_mark(bytes);
        let head = &bytes[..bytes.len().min(LOOKED_AT)];
        head.trim_ascii_start().starts_with(b"{") && head.windows(KEY.len()).any(|window| window == KEY)
    }

    fn names_meshes(&self) -> bool {
        true
    }

    fn read(&self, source: &Source) -> Result<Loaded, IoError> {
        let series: Series = serde_json::from_slice(without_mark(&source.bytes)).map_err(|error| {
            let place = format!("line {}, column {}", error.line(), error.column());
            source.invalid(place, format!("it is no file series: {error}"), DAMAGED)
        })?;
        let timed: Vec<(f64, Named)> =
            series.files.into_iter().map(|file| (file.time, Named::plain(file.name))).collect();
        if let Some((time, _)) = timed.iter().find(|(time, _)| !time.is_finite()) {
            return Err(source.invalid("files", format!("the time {time} is not finite"), DAMAGED));
        }
        if timed.is_empty() {
            return Err(source.invalid("files", "no file is named", DAMAGED));
        }
        let loaded = read_timed(source, timed)?;
        let format = format!("{} of {} time steps, {}", self.name(), loaded.times.len(), loaded.format);
        Ok(Loaded { format, ..loaded })
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

/// Reads the meshes of the step that is wanted. Steps are counted in the order of time.
fn read_timed(source: &Source, timed: Vec<(f64, Named)>) -> Result<Loaded, IoError> {
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
    let has_part = |named: &Named| named.more.last().is_some_and(Option::is_some);
    if parts.iter().any(|named| has_part(named) && !places.insert(named.more.clone())) {
        warnings.push(format!("several files are listed as one part at the time {chosen}; all are read"));
    }
    let loaded = read_parts(source, parts, warnings)?;
    Ok(Loaded { times, step, ..loaded })
}

/// Reads meshes and puts them one behind the other. What is of a kind that is not read, as surfaces are, is left out where something else is there.
fn read_parts(source: &Source, named: Vec<Named>, mut warnings: Vec<String>) -> Result<Loaded, IoError> {
    let named = each_once(source, named, &mut warnings)?;
    let mut parts = Vec::with_capacity(named.len());
    let (mut formats, mut refused) = (Vec::new(), None);
    for one in &named {
        let path = one.path(source)?;
        match read_part(&path, &source.options) {
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
