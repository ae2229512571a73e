//! Arrays of one step, in files that hold several.

use std::collections::HashMap;

use super::attributes::Attributes;
use super::file::{ArrayElement, Listed, XmlFile};
use crate::IoError;

/// The last step, up to the one that is read, that an array is listed for; nothing where it says nothing of steps.
///
/// An array that is the same in several steps is written for the first of them alone, or for each at one offset.
pub(super) fn last_step(attributes: &Attributes<'_, '_>, step: usize) -> Result<Option<Listed>, IoError> {
    let Some(text) = attributes.get("TimeStep")?.filter(|text| !text.trim().is_empty()) else { return Ok(None) };
    let steps = text.split_ascii_whitespace().filter_map(|word| word.parse().ok());
    Ok(Some(steps.filter(|listed: &usize| *listed <= step).max().map_or(Listed::Later, Listed::In)))
}

/// Leaves of the arrays of one name the last one that is listed.
pub(super) fn keep_last_listed(arrays: &mut Vec<ArrayElement<'_>>) {
    let mut last: HashMap<String, usize> = HashMap::new();
    for array in arrays.iter() {
        if let Some(Listed::In(step)) = array.listed {
            let known = last.entry(array.name.clone()).or_insert(step);
            *known = step.max(*known);
        }
    }
    arrays.retain(|array| match array.listed {
        None => true,
        Some(Listed::Later) => false,
        Some(Listed::In(step)) => last.get(&array.name) == Some(&step),
    });
}

/// Whether each step is a piece of its own whose arrays all say that they are of the first one, as VTK writes it where the numbers are not appended.
pub(super) fn is_piece_a_step(file: &XmlFile<'_>) -> bool {
    let mut arrays = file.pieces.iter().flat_map(|piece| piece.arrays().chain(&piece.cells));
    file.times.len() > 1
        && file.pieces.len() == file.times.len()
        && arrays.all(|array| array.listed == Some(Listed::In(0)))
}
