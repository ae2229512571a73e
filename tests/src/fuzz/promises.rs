//! What holds of everything that is read, and of every refusal.

use std::path::{Path, PathBuf};

use tetrascope::{Cells, DataArray, Dataset, Error, IoError, StructuredBlock};
use tetrascope_colors::Presets;

/// Longest message, and longest warning, in characters: names and words of a file are in it, but not whole files.
const LONGEST_MESSAGE: usize = 4096;

/// Colors and opacities of presets are finite and from 0 to 1 wherever they are asked for.
pub(super) fn check_presets(presets: &Presets) -> Result<(), String> {
    for map in presets.maps() {
        for n in 0..=8 {
            let x = f64::from(n) / 8.0;
            let opacity = map.opacity().map_or(1.0, |opacity| opacity.at(x));
            let color = map.color_at(x);
            if color.iter().chain([&opacity]).any(|value| !(0.0..=1.0).contains(value)) {
                return Err(format!("the color at {x} is {color:?}, of opacity {opacity}"));
            }
        }
    }
    Ok(())
}

pub(super) fn cell_count(dataset: &Dataset) -> usize {
    match &dataset.cells {
        Cells::Unstructured(cells) => cells.connectivity.len().max(cells.kinds.len()),
        Cells::Structured(blocks) => blocks.iter().map(StructuredBlock::point_count).sum(),
    }
}

/// Whether it was read; an error has to name one of the files, a place, what is wrong and a remedy.
pub(super) fn is_read<T>(result: &Result<T, IoError>, paths: &[&Path]) -> Result<bool, String> {
    let Err(error) = result else { return Ok(true) };
    check_error(error)?;
    check_words(&error.to_string(), paths)?;
    Ok(false)
}

/// Fails unless an error of a file has all that its kind promises.
///
/// # Errors
/// In words.
fn check_error(error: &IoError) -> Result<(), String> {
    let missing = |what: &str| Err(format!("the message has no {what}: {error}"));
    match error {
        IoError::Invalid { place, problem, remedy, .. } => {
            for (text, what) in [(place, "place"), (problem, "problem"), (remedy, "remedy")] {
                if text.trim().is_empty() {
                    return missing(what);
                }
            }
        }
        IoError::Unsupported { what, remedy, .. } => {
            for (text, what) in [(what, "problem"), (remedy, "remedy")] {
                if text.trim().is_empty() {
                    return missing(what);
                }
            }
        }
        IoError::Read { .. } => {}
        _ => return Err(format!("a file is not written here: {error}")),
    }
    Ok(())
}

pub(super) fn check_words(text: &str, paths: &[&Path]) -> Result<(), String> {
    if !paths.iter().any(|path| text.contains(&path.display().to_string())) {
        return Err(format!("the message does not name the file: {text}"));
    }
    check_length(text)
}

pub(super) fn check_length(text: &str) -> Result<(), String> {
    let length = text.chars().count();
    if length > LONGEST_MESSAGE {
        let start: String = text.chars().take(200).collect();
        return Err(format!("a message of {length} characters: {start}..."));
    }
    if let Some(control) = text.chars().find(|c| c.is_control() && !"\n\t".contains(*c)) {
        return Err(format!("a message has the control character {control:?}: {text:?}"));
    }
    Ok(())
}

/// Fails unless a dataset keeps what its types promise.
pub(super) fn check_dataset(dataset: &Dataset) -> Result<(), String> {
    let broken = |what: &str| Err(format!("the dataset breaks its promise: {what}"));
    let points = dataset.points.len();
    let cells = match &dataset.cells {
        Cells::Unstructured(cells) => {
            let rows = &cells.offsets;
            if rows.len() != cells.kinds.len() + 1 || rows[0] != 0 || !rows.is_sorted() {
                return broken("offsets");
            }
            if rows.last() != Some(&cells.connectivity.len()) {
                return broken("connectivity");
            }
            let faces = cells.polyhedra.iter().flatten().flatten();
            if cells.connectivity.iter().chain(faces).any(|&point| point as usize >= points) {
                return broken("a point that is not there");
            }
            if cells.kinds.iter().filter(|&&kind| kind == tetrascope::CellKind::Polyhedron).count()
                != cells.polyhedra.len()
            {
                return broken("faces");
            }
            cells.kinds.len()
        }
        Cells::Structured(blocks) => {
            let mut next = 0;
            for block in blocks {
                let hidden = block.hidden_points.len();
                if block.first_point != next || !(hidden == 0 || hidden == block.point_count()) {
                    return broken("blocks");
                }
                next += block.point_count();
            }
            if next != points {
                return broken("points of blocks");
            }
            blocks.iter().map(StructuredBlock::cell_count).sum()
        }
    };
    let fits = |array: &DataArray, tuples: usize| {
        let values = tuples.checked_mul(array.components);
        array.components > 0 && !array.name.is_empty() && values == Some(array.values.len())
    };
    for (arrays, tuples) in [(&dataset.point_arrays, points), (&dataset.cell_arrays, cells)] {
        if let Some(array) = arrays.iter().find(|array| !fits(array, tuples)) {
            return Err(format!(
                "the array {:?} has not one tuple of {} for each of {tuples}",
                array.name, array.components
            ));
        }
    }
    Ok(())
}

/// Where an error of the whole way from file to picture lies, for the tests of real files.
///
/// # Errors
/// In words, if the error of a file has not all that its kind promises.
pub fn check_whole(error: &Error, path: &Path) -> Result<(), String> {
    if let Error::Io(error) = error {
        check_error(error)?;
    }
    check_words(&error.to_string(), &[path, &PathBuf::from(path).with_extension("q")])
}
