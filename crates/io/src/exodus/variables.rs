//! The values of nodes and elements at one time step.

use std::collections::BTreeMap;

use tetrascope_mesh::{ArrayValues, DataArray};

use super::DAMAGED;
use super::blocks::Block;
use super::netcdf::Netcdf;
use super::numbered::{numbered, numbered_pairs};
use super::vectors::join;
use crate::IoError;
use crate::vtk::named::NamedArrays;
use crate::vtk::scalars::to_indices;

/// The times of all steps, in the file's order.
pub(super) fn times(file: &Netcdf<'_>) -> Result<Vec<f64>, IoError> {
    match file.shape("time_whole") {
        Some(_) => Ok(file.numbers("time_whole", &[])?.to_f64()),
        None => Ok(Vec::new()),
    }
}

/// The arrays of points: the variables of nodes at a step, then the numberings of nodes that have a name.
pub(super) fn node_arrays(
    file: &Netcdf<'_>,
    points: usize,
    step: Option<u64>,
    warnings: &mut Vec<String>,
) -> Result<Vec<DataArray>, IoError> {
    let mut arrays = NamedArrays::default();
    if let Some(step) = step {
        // Files of Exodus 2 have all variables in one, files since then one for each.
        let together = file.shape("vals_nod_var").filter(|shape| shape.len() == 3);
        let (numbers, in_one) = match together {
            Some(shape) => ((1..=file.texts("name_nod_var")?.len() as u64).filter(|&n| n <= shape[1]).collect(), true),
            None => (numbered(file, "vals_nod_var"), false),
        };
        let names = names(file, "name_nod_var", "node variable ", &numbers)?;
        for array in join(&names, |_, _| true) {
            let mut components = Vec::with_capacity(array.variables.len());
            for &number in &numbers[array.variables] {
                let values = if in_one {
                    file.numbers("vals_nod_var", &[step, number - 1])?
                } else {
                    file.numbers(&format!("vals_nod_var{number}"), &[step])?
                };
                components.push(of_length(file, &array.name, values, points)?);
            }
            let count = components.len();
            arrays.add("point", &array.name, count, interleaved(components), warnings);
        }
    }
    add_maps(file, ("nmap_names", "node_map", "point"), points, &mut arrays, warnings)?;
    Ok(arrays.into_arrays())
}

/// The arrays of cells: the variables of elements at a step, with NaN where a block does not have them; the numberings of elements that have a
/// name; and, where there are several blocks, the ID of each cell's block.
pub(super) fn element_arrays(
    file: &Netcdf<'_>,
    blocks: &[Block],
    step: Option<u64>,
    warnings: &mut Vec<String>,
) -> Result<Vec<DataArray>, IoError> {
    let cells = blocks.last().map_or(0, |block| block.cells.end);
    let mut arrays = NamedArrays::default();
    if let Some(step) = step {
        let mut blocks_of: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
        for (variable, block) in numbered_pairs(file, "vals_elem_var", "eb") {
            blocks_of.entry(variable).or_default().push(block);
        }
        let numbers: Vec<u64> = blocks_of.keys().copied().collect();
        let names = names(file, "name_elem_var", "element variable ", &numbers)?;
        let has: Vec<&Vec<u64>> = blocks_of.values().collect();
        let by_number: BTreeMap<u64, &Block> = blocks.iter().map(|block| (block.number, block)).collect();
        for array in join(&names, |a, b| has.get(a) == has.get(b)) {
            let mut components = Vec::with_capacity(array.variables.len());
            for index in array.variables {
                let place = || format!("element variable `{}`", array.name);
                file.budget().take(file.source, place(), cells as u64)?;
                let mut values = Whole::default();
                let mut at = 0;
                for (block, &number) in has[index].iter().filter_map(|number| Some((*by_number.get(number)?, number))) {
                    let variable = format!("vals_elem_var{}eb{number}", numbers[index]);
                    let own = of_length(file, &array.name, file.numbers(&variable, &[step])?, block.cells.len())?;
                    values.missing(block.cells.start - at);
                    values.append(own);
                    at = block.cells.end;
                }
                values.missing(cells - at);
                let is_partial = values.has_missing;
                components.push(values.values);
                if is_partial && components.len() == 1 {
                    warnings.push(format!(
                        "the cell array `{}` is not there for all element blocks; it is NaN in the others",
                        array.name
                    ));
                }
            }
            let count = components.len();
            arrays.add("cell", &array.name, count, interleaved(components), warnings);
        }
    }
    add_maps(file, ("emap_names", "elem_map", "cell"), cells, &mut arrays, warnings)?;
    if blocks.len() > 1 {
        let ids = blocks.iter().flat_map(|block| block.cells.clone().map(|_| block.id));
        arrays.add("cell", "ObjectId", 1, ArrayValues::I64(ids.collect()), warnings);
    }
    Ok(arrays.into_arrays())
}

/// Numbers of one kind, with NaN where there are none.
struct Whole {
    values: ArrayValues,
    has_missing: bool,
}

impl Default for Whole {
    fn default() -> Self {
        Self { values: ArrayValues::F64(Vec::new()), has_missing: false }
    }
}

impl Whole {
    fn missing(&mut self, count: usize) {
        self.has_missing |= count > 0;
        match &mut self.values {
            ArrayValues::F32(values) => values.extend(std::iter::repeat_n(f32::NAN, count)),
            values => {
                let mut all = std::mem::replace(values, ArrayValues::F64(Vec::new())).to_f64();
                all.extend(std::iter::repeat_n(f64::NAN, count));
                *values = ArrayValues::F64(all);
            }
        }
    }

    fn append(&mut self, more: ArrayValues) {
        match (&mut self.values, more) {
            (ArrayValues::F32(values), ArrayValues::F32(more)) => values.extend(more),
            // The first block, or gaps before it, which are NaN in either type.
            (ArrayValues::F64(values), ArrayValues::F32(more)) if values.iter().all(|x| x.is_nan()) => {
                let gaps = values.iter().map(|_| f32::NAN);
                self.values = ArrayValues::F32(gaps.chain(more).collect());
            }
            (ArrayValues::F64(values), more) => values.extend(more.to_f64()),
            (values, more) => {
                let mut all = std::mem::replace(values, ArrayValues::F64(Vec::new())).to_f64();
                all.extend(more.to_f64());
                *values = ArrayValues::F64(all);
            }
        }
    }
}

/// The names of variables by their numbers.
fn names(file: &Netcdf<'_>, variable: &str, otherwise: &str, numbers: &[u64]) -> Result<Vec<String>, IoError> {
    let texts = file.texts(variable)?;
    let name = |&number: &u64| {
        let text = usize::try_from(number - 1).ok().and_then(|index| texts.get(index));
        text.filter(|text| !text.is_empty()).cloned().unwrap_or_else(|| format!("{otherwise}{number}"))
    };
    Ok(numbers.iter().map(name).collect())
}

/// Numberings of points or cells: names, prefix of the variables, owner.
fn add_maps(
    file: &Netcdf<'_>,
    (names, prefix, owner): (&str, &str, &str),
    count: usize,
    arrays: &mut NamedArrays,
    warnings: &mut Vec<String>,
) -> Result<(), IoError> {
    for (name, number) in file.texts(names)?.iter().zip(1_u64..) {
        let variable = format!("{prefix}{number}");
        if name.is_empty() || file.shape(&variable).is_none() {
            continue;
        }
        let values = of_length(file, name, file.numbers(&variable, &[])?, count)?;
        if to_indices(&values).is_some() {
            arrays.add(owner, name, 1, values, warnings);
        }
    }
    Ok(())
}

fn of_length(file: &Netcdf<'_>, name: &str, values: ArrayValues, count: usize) -> Result<ArrayValues, IoError> {
    if values.len() == count {
        return Ok(values);
    }
    let problem = format!("it has {} values, where {count} were expected", values.len());
    Err(file.source.invalid(format!("variable `{name}`"), problem, DAMAGED))
}

/// Components that stand one behind the other, as tuples.
fn interleaved(mut components: Vec<ArrayValues>) -> ArrayValues {
    if components.len() == 1 {
        return components.swap_remove(0);
    }
    let floats: Option<Vec<&Vec<f32>>> = components
        .iter()
        .map(|component| if let ArrayValues::F32(values) = component { Some(values) } else { None })
        .collect();
    let count = components.iter().map(ArrayValues::len).min().unwrap_or(0);
    if let Some(floats) = floats {
        let tuple = |index: usize| floats.iter().map(move |values| values[index]);
        return ArrayValues::F32((0..count).flat_map(tuple).collect());
    }
    let doubles: Vec<Vec<f64>> = components.iter().map(ArrayValues::to_f64).collect();
    let tuple = |index: usize| doubles.iter().map(move |values| values[index]);
    ArrayValues::F64((0..count).flat_map(tuple).collect())
}
