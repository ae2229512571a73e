//! Images: points at equal distances.

use glam::{DMat3, DVec3};
use hdf5_reader::group::Group;
use tetrascope_mesh::{Cells, DataArray, Dataset};

use super::arrays::group_of;
use super::container::{Container, DAMAGED};
use super::steps::Steps;
use crate::IoError;
use crate::grid::{RegularGrid, check_dims};
use crate::vtk::named::NamedArrays;

/// Flag of `vtkGhostType` for points: hidden.
const HIDDEN: u8 = 2;

/// Reads the image of a group.
///
/// # Errors
/// [`IoError::Invalid`] where the extent is none, or arrays do not fit it.
pub(super) fn read_image(
    file: &Container<'_>,
    group: &Group,
    steps: &Steps,
    warnings: &mut Vec<String>,
) -> Result<Dataset, IoError> {
    let attribute = |name: &str| file.attribute(group, name);
    let invalid = |place: &str, problem: String| file.source.invalid(format!("attribute `{place}`"), problem, DAMAGED);
    let extent = attribute("WholeExtent").unwrap_or_default();
    let &[i0, i1, j0, j1, k0, k1] = extent.as_slice() else {
        return Err(invalid("WholeExtent", format!("it has {} numbers, where 6 are needed", extent.len())));
    };
    let mut dims = [0; 3];
    for (dim, (low, high)) in dims.iter_mut().zip([(i0, i1), (j0, j1), (k0, k1)]) {
        // Numbers beyond the range of usize are clamped, which is too many in any case.
        *dim = (high - low + 1.0).max(0.0) as usize;
    }
    let count = check_dims(dims).map_err(|problem| invalid("WholeExtent", problem))?;
    file.budget().take(file.source, "attribute `WholeExtent`", count as u64)?;
    let triple = |name: &str, otherwise: f64| match attribute(name) {
        None => Ok(DVec3::splat(otherwise)),
        Some(values) => <[f64; 3]>::try_from(values)
            .map(DVec3::from_array)
            .map_err(|values| invalid(name, format!("it has {} numbers, where 3 are needed", values.len()))),
    };
    let (origin, spacing) = (triple("Origin", 0.0)?, triple("Spacing", 1.0)?);
    // Row after row, as VTK keeps its matrices; the columns are the directions of the axes.
    let direction = match attribute("Direction").map(<[f64; 9]>::try_from) {
        None => DMat3::IDENTITY,
        Some(Ok(rows)) => DMat3::from_cols_array(&rows).transpose(),
        Some(Err(values)) => {
            return Err(invalid("Direction", format!("it has {} numbers, where 9 are needed", values.len())));
        }
    };
    let first = origin + direction * (spacing * DVec3::new(i0, j0, k0));
    let steps_of_axes = [direction.x_axis * spacing.x, direction.y_axis * spacing.y, direction.z_axis * spacing.z];
    let mut dataset = RegularGrid { dims, origin: first, steps: steps_of_axes }.dataset();
    dataset.point_arrays = arrays(file, group, steps, "point", dims, warnings)?;
    let cells = dims.map(|n| n.saturating_sub(1));
    dataset.cell_arrays = arrays(file, group, steps, "cell", cells, warnings)?;
    hide_points(&mut dataset);
    Ok(dataset)
}

/// Arrays whose dimensions are k, j, i, then the components; with time steps, the step before them.
fn arrays(
    file: &Container<'_>,
    group: &Group,
    steps: &Steps,
    owner: &str,
    dims: [usize; 3],
    warnings: &mut Vec<String>,
) -> Result<Vec<DataArray>, IoError> {
    let mut arrays = NamedArrays::default();
    let list = if owner == "point" { "PointDataOffsets" } else { "CellDataOffsets" };
    let Some(group) = file.group(group, group_of(owner)) else { return Ok(Vec::new()) };
    let [i, j, k] = dims.map(|n| n as u64);
    for name in file.datasets(&group)? {
        let shape = file.shape(&group, &name).unwrap_or_default();
        let of_one = shape.strip_prefix(&[k, j, i]).map(|rest| (rest, 0, k));
        let of_step = match shape.split_first() {
            Some((_, rest)) if steps.is_some() => {
                let first = steps.array_entry(file, list, &name)?.unwrap_or(steps.number());
                rest.strip_prefix(&[k, j, i]).map(|rest| (rest, first, 1))
            }
            _ => None,
        };
        let found = if steps.is_some() { of_step.or(of_one) } else { of_one };
        let components = found.and_then(|(rest, ..)| match rest {
            [] => Some(1),
            &[components] => usize::try_from(components).ok().filter(|&components| components > 0),
            _ => None,
        });
        let (Some((_, first, count)), Some(components)) = (found, components) else {
            warnings.push(format!(
                "the {owner} array `{name}` is left out: its dimensions are {shape:?}, not {k}, {j}, {i}"
            ));
            continue;
        };
        let values = file.rows(&group, &name, first, count)?;
        arrays.add(owner, &name, components, values, warnings);
    }
    Ok(arrays.into_arrays())
}

fn hide_points(dataset: &mut Dataset) {
    let flags = dataset.point_arrays.iter().find(|array| array.name == "vtkGhostType" && array.components == 1);
    let hidden: Option<Vec<bool>> =
        flags.map(|array| array.values.to_f64().iter().map(|&flags| flags as u8 & HIDDEN != 0).collect());
    if let (Some(hidden), Cells::Structured(blocks)) = (hidden, &mut dataset.cells)
        && let [block] = blocks.as_mut_slice()
        && hidden.contains(&true)
    {
        block.hidden_points = hidden;
    }
}
