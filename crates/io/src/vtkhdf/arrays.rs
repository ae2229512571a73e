//! The arrays of points and cells, and how those of several blocks become one.

use std::collections::HashMap;

use hdf5_reader::group::Group;
use tetrascope_mesh::DataArray;

use super::container::Container;
use crate::IoError;
use crate::vtk::named::NamedArrays;
use crate::vtk::scalars::append;

/// The group of the arrays of points or of cells.
pub(super) fn group_of(owner: &str) -> &'static str {
    if owner == "point" { "PointData" } else { "CellData" }
}

/// All arrays of points or cells of a group, `tuples` rows from where `start` says for each.
///
/// - `owner`: "point" or "cell"
pub(super) fn read_arrays(
    file: &Container<'_>,
    group: &Group,
    owner: &str,
    tuples: u64,
    start: &dyn Fn(&str) -> Result<u64, IoError>,
    warnings: &mut Vec<String>,
) -> Result<Vec<DataArray>, IoError> {
    let mut arrays = NamedArrays::default();
    let Some(group) = file.group(group, group_of(owner)) else { return Ok(Vec::new()) };
    for name in file.datasets(&group)? {
        let shape = file.shape(&group, &name).unwrap_or_default();
        let components = match shape.as_slice() {
            [_] => Some(1),
            [_, components @ ..] => {
                components.iter().try_fold(1_usize, |all, &n| all.checked_mul(usize::try_from(n).ok()?))
            }
            [] => None,
        };
        let Some(components) = components.filter(|&components| components > 0) else {
            warnings.push(format!("the {owner} array `{name}` is left out: it has no components"));
            continue;
        };
        let values = file.rows(&group, &name, start(&name)?, tuples)?;
        arrays.add(owner, &name, components, values, warnings);
    }
    Ok(arrays.into_arrays())
}

/// Arrays of points or of cells over all blocks; what is not in all of them goes.
pub(super) struct Joined {
    owner: &'static str,
    arrays: Option<Vec<DataArray>>,
}

impl Joined {
    /// Without any block yet.
    pub(super) fn new(owner: &'static str) -> Self {
        Self { owner, arrays: None }
    }

    /// Puts a block's arrays behind those of the blocks before.
    pub(super) fn add(&mut self, own: Vec<DataArray>, warnings: &mut Vec<String>) {
        let Some(all) = &mut self.arrays else {
            self.arrays = Some(own);
            return;
        };
        let mut own: HashMap<String, DataArray> = own.into_iter().map(|array| (array.name.clone(), array)).collect();
        let owner = self.owner;
        let mut leave_out = |name: &str| {
            warnings.push(format!(
                "the {owner} array `{name}` is left out: not all blocks have it with the same type and components"
            ));
        };
        all.retain_mut(|array| {
            let more = own.remove(&array.name);
            let is_joined =
                more.is_some_and(|more| more.components == array.components && append(&mut array.values, more.values));
            if !is_joined {
                leave_out(&array.name);
            }
            is_joined
        });
        let mut rest: Vec<&String> = own.keys().collect();
        rest.sort();
        rest.into_iter().for_each(|name| leave_out(name));
    }

    /// The arrays of all blocks.
    pub(super) fn into_arrays(self) -> Vec<DataArray> {
        self.arrays.unwrap_or_default()
    }
}
