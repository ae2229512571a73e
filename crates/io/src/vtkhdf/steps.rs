//! Where in the datasets the rows of one time step begin.

use hdf5_reader::group::Group;

use super::container::Container;
use crate::IoError;

/// The time steps of a file, of which one is chosen.
pub(super) struct Steps {
    /// Nothing in files that know no time.
    group: Option<Group>,
    step: u64,
}

impl Steps {
    /// The chosen step, and the times of all.
    ///
    /// # Errors
    /// [`IoError::Invalid`] where there is no such step, or the times are damaged.
    pub(super) fn choose(file: &Container<'_>, root: &Group) -> Result<(Self, Vec<f64>, usize), IoError> {
        let Some(group) = file.group(root, "Steps") else {
            let step = file.source.step(&[])?;
            return Ok((Self { group: None, step: 0 }, Vec::new(), step));
        };
        let count = file.shape(&group, "Values").and_then(|shape| shape.first().copied()).unwrap_or(0);
        let times = file.rows(&group, "Values", 0, count)?.to_f64();
        let step = file.source.step(&times)?;
        let group = (!times.is_empty()).then_some(group);
        Ok((Self { group, step: step as u64 }, times, step))
    }

    /// The same step of a part of the file that has steps of its own, or none.
    pub(super) fn of_block(&self, file: &Container<'_>, block: &Group) -> Self {
        let group = self.group.as_ref().and_then(|_| file.group(block, "Steps"));
        Self { group, step: self.step }
    }

    /// Whether there are any.
    pub(super) fn is_some(&self) -> bool {
        self.group.is_some()
    }

    /// The number of the chosen step.
    pub(super) fn number(&self) -> u64 {
        self.step
    }

    /// The step's entry in a list of `Steps`; nothing where there is no such list.
    pub(super) fn entry(&self, file: &Container<'_>, list: &str) -> Result<Option<u64>, IoError> {
        self.group.as_ref().map_or(Ok(None), |group| entry(file, group, list, self.step))
    }

    /// Where the step's tuples of an array begin; nothing where the array follows the mesh.
    ///
    /// - `list`: `PointDataOffsets` or `CellDataOffsets`
    pub(super) fn array_entry(&self, file: &Container<'_>, list: &str, array: &str) -> Result<Option<u64>, IoError> {
        match self.group.as_ref().and_then(|group| file.group(group, list)) {
            Some(group) => entry(file, &group, array, self.step),
            None => Ok(None),
        }
    }
}

fn entry(file: &Container<'_>, group: &Group, list: &str, step: u64) -> Result<Option<u64>, IoError> {
    if file.shape(group, list).is_none() {
        return Ok(None);
    }
    let row = file.index_rows(group, list, step, 1)?;
    // What is negative is nowhere: no dataset has so many rows.
    Ok(row.first().map(|&first| u64::try_from(first).unwrap_or(u64::MAX)))
}
