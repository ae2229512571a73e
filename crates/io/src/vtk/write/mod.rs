//! Writes a mesh as VTK's XML file of an unstructured grid, every number to the last bit.

mod cells;
mod file;
mod numbers;

use std::path::Path;

use tetrascope_mesh::{ArrayValues, DataArray, Dataset, check_layout};

use crate::IoError;
use crate::budget::Budget;
use crate::picture::write_by;
use cells::{Layout, gathered};
use file::{Element, Section};
use numbers::Numbers;

/// How the numbers of a `.vtu` file are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum VtuEncoding {
    /// As bytes behind the elements, in the order of this machine: the fastest, and what ParaView writes. Sizes have 64 bits.
    #[default]
    Raw,
    /// The same, compressed by zlib.
    Zlib,
    /// As text inside the elements, the shortest that gives the number again. VTK does not read NaN and infinities from it.
    Text,
}

/// What a `.vtu` file is written with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VtuOptions {
    /// How numbers are written.
    pub encoding: VtuEncoding,
    /// The time that the mesh is of (`TimeValue`), if that is known and finite.
    pub time: Option<f64>,
}

/// What was written to a `.vtu` file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WrittenVtu {
    /// Points, used or not.
    pub points: usize,
    /// Cells, without those that were left out.
    pub cells: usize,
    /// The file's length.
    pub bytes: u64,
    /// How the file differs in form from the mesh that was given: a grid's cells that name their points.
    pub notes: Vec<String>,
    /// What was left out or is not what it was, one sentence each.
    pub warnings: Vec<String>,
}

/// Writes a mesh with all its arrays to a `.vtu` file that [`read_mesh`](crate::read_mesh) and VTK read back to the last bit: [`write_vtu_with`] with bytes that are not
/// compressed and without a time.
///
/// # Errors
/// As [`write_vtu_with`].
pub fn write_vtu(path: &Path, dataset: &Dataset) -> Result<WrittenVtu, IoError> {
    write_vtu_with(path, dataset, &VtuOptions::default())
}

/// Writes a mesh with all its arrays to a `.vtu` file. The file appears whole or not at all.
///
/// Points are written in 32 bits where that loses nothing, else in 64; indices in 32 bits where they fit. Cells of structured blocks become
/// hexahedra. Polyhedra are written as all versions of VTK read them (version 1.0 of the format). Left out, and told of, are cells that
/// are hidden, flat cells of which nobody knows the kind, and arrays whose length is not the mesh's.
///
/// # Errors
/// [`IoError::Write`], also for a dataset whose cells do not keep what their type promises.
pub fn write_vtu_with(path: &Path, dataset: &Dataset, options: &VtuOptions) -> Result<WrittenVtu, IoError> {
    check_layout(dataset).map_err(|error| IoError::Write {
        path: path.to_owned(),
        problem: error.to_string(),
        remedy: "give cells whose offsets, point indices and faces fit together",
    })?;
    let mut said = WrittenVtu { points: dataset.points.len(), ..WrittenVtu::default() };
    let layout = Layout::of(dataset, &mut said);
    said.cells = layout.cells.kinds.len();
    let sections = sections(dataset, &layout, &mut said);
    if options.encoding == VtuEncoding::Text {
        warn_of_non_finite(dataset, &mut said.warnings);
    }
    let grid = file::Grid { points: said.points, cells: said.cells, time: options.time, sections };
    let mut numbers = 0;
    write_by(path, |file| {
        [said.bytes, numbers] = grid.write(file, options.encoding)?;
        Ok(())
    })?;
    if numbers > Budget::of_length(said.bytes) {
        said.warnings.push(format!(
            "{numbers} numbers were compressed to {} bytes, which is refused here as too few when it is read again: write them raw",
            said.bytes
        ));
    }
    Ok(said)
}

/// All arrays in the order of the file. `said` hears of those that do not fit.
fn sections<'a>(dataset: &'a Dataset, layout: &'a Layout<'a>, said: &mut WrittenVtu) -> [Section<'a>; 4] {
    let element = |name, array: &DataArray, numbers| Element { name, components: array.components, numbers };
    let mut point_data = Vec::new();
    for array in &dataset.point_arrays {
        if let Some(name) = name_of("point", array, dataset.points.len(), &mut said.warnings) {
            point_data.push(element(name, array, Numbers::of(&array.values)));
        }
    }
    let mut cell_data = Vec::new();
    for array in &dataset.cell_arrays {
        if let Some(name) = name_of("cell", array, layout.all, &mut said.warnings) {
            let numbers = match &layout.kept {
                None => Numbers::of(&array.values),
                Some(kept) => Numbers::made(array.values.type_name(), || gathered(array, kept)),
            };
            cell_data.push(element(name, array, numbers));
        }
    }
    let points = Element { name: "Points".to_owned(), components: 3, numbers: Numbers::of_points(&dataset.points) };
    [
        Section { tag: "PointData", elements: point_data },
        Section { tag: "CellData", elements: cell_data },
        Section { tag: "Points", elements: vec![points] },
        Section { tag: "Cells", elements: layout.elements(dataset.points.len()) },
    ]
}

/// The name that an array is written under; a warning where it is another one, and nothing where the array does not fit.
fn name_of(owner: &str, array: &DataArray, tuples: usize, warnings: &mut Vec<String>) -> Option<String> {
    // XML has no way to write most of them, and readers make spaces of the others.
    let name = array.name.replace(char::is_control, "_");
    if array.components == 0 || Some(array.values.len()) != tuples.checked_mul(array.components) {
        let (numbers, components) = (array.values.len(), array.components);
        warnings.push(format!(
            "the {owner} array `{name}` is left out: it has {numbers} numbers for {tuples} {owner}s of {components} components"
        ));
        return None;
    }
    if name != array.name {
        warnings.push(format!("the name of a {owner} array has control characters; it is written as `{name}`"));
    }
    Some(name)
}

fn warn_of_non_finite(dataset: &Dataset, warnings: &mut Vec<String>) {
    let is_odd = |values: &ArrayValues| match values {
        ArrayValues::F32(numbers) => numbers.iter().any(|x| !x.is_finite()),
        ArrayValues::F64(numbers) => numbers.iter().any(|x| !x.is_finite()),
        _ => false,
    };
    let arrays = dataset.point_arrays.iter().chain(&dataset.cell_arrays).filter(|array| is_odd(&array.values));
    let points = dataset.points.iter().any(|point| !point.is_finite()).then(|| "the coordinates".to_owned());
    let odd: Vec<String> = points.into_iter().chain(arrays.map(|array| format!("`{}`", array.name))).collect();
    if !odd.is_empty() {
        warnings.push(format!(
            "there are NaN or infinities in {}; as text they are read back here, but not by VTK: write them raw or compressed",
            odd.join(", ")
        ));
    }
}

#[cfg(test)]
mod tests;
