//! The arrays of a piece: data of points and cells, coordinates, indices.

use glam::DVec3;
use tetrascope_mesh::DataArray;

use super::super::DAMAGED;
use super::super::named::NamedArrays;
use super::file::{ArrayElement, Piece, XmlFile};
use super::payload::{Wanted, decode, place, scalar_type};
use crate::{IoError, Source};

/// Checks a length against tuples times components; declared counts may be anything, so in 128 bits.
fn check_length(
    source: &Source,
    array: &ArrayElement<'_>,
    label: &str,
    found: usize,
    tuples: u64,
    components: usize,
    owner: &str,
) -> Result<(), IoError> {
    let expected = u128::from(tuples) * components as u128;
    if found as u128 == expected {
        return Ok(());
    }
    Err(source.invalid(
        place(source, array, label),
        format!("it has {found} values, where {expected} were expected ({tuples} {owner} of {components})"),
        DAMAGED,
    ))
}

/// The coordinates of all points.
pub(super) fn read_points(source: &Source, file: &XmlFile<'_>, piece: &Piece<'_>) -> Result<Vec<DVec3>, IoError> {
    let label = "Points";
    let Some(array) = piece.points.first() else {
        return match piece.point_count {
            0 => Ok(Vec::new()),
            n => Err(source.invalid("element Piece", format!("it declares {n} points but has no Points"), DAMAGED)),
        };
    };
    let invalid = |problem: String| source.invalid(place(source, array, label), problem, DAMAGED);
    let scalar = scalar_type(&array.type_name)
        .ok_or_else(|| invalid(format!("the type \"{}\" is no type of numbers", array.type_name)))?;
    if let Some(components) = array.components.as_deref().filter(|text| text.trim() != "3") {
        return Err(invalid(format!("points have 3 components, not \"{components}\"")));
    }
    let flat = Wanted { source, file, array, scalar, label }.decode_f64()?;
    check_length(source, array, label, flat.len(), piece.point_count, 3, "points")?;
    Ok(flat.as_chunks::<3>().0.iter().map(|&triple| DVec3::from_array(triple)).collect())
}

/// One of the index arrays of `Cells`; nothing where the piece does not have it.
pub(super) fn indices(
    source: &Source,
    file: &XmlFile<'_>,
    piece: &Piece<'_>,
    name: &str,
) -> Result<Option<Vec<i64>>, IoError> {
    let Some(wanted) = wanted_indices(source, file, piece, name)? else { return Ok(None) };
    let mut numbers = Vec::new();
    if wanted.turn_indices(&mut numbers, 0, Some)? && wanted.scalar.is_whole() {
        return Ok(Some(numbers));
    }
    let problem = format!("indices cannot be of the type {}", wanted.array.type_name);
    Err(source.invalid(place(source, wanted.array, name), problem, DAMAGED))
}

/// One of the index arrays of `Cells`, to be decoded; nothing where the piece does not have it.
pub(super) fn wanted_indices<'w>(
    source: &'w Source,
    file: &'w XmlFile<'_>,
    piece: &'w Piece<'_>,
    name: &'w str,
) -> Result<Option<Wanted<'w>>, IoError> {
    let Some(array) = index_array(piece, name) else { return Ok(None) };
    let scalar = scalar_type(&array.type_name).ok_or_else(|| {
        let problem = format!("the type \"{}\" is no type of numbers", array.type_name);
        source.invalid(place(source, array, name), problem, DAMAGED)
    })?;
    Ok(Some(Wanted { source, file, array, scalar, label: name }))
}

/// Where one of these arrays is.
pub(super) fn index_array<'p, 'a>(piece: &'p Piece<'a>, name: &str) -> Option<&'p ArrayElement<'a>> {
    piece.cells.iter().find(|array| array.name.eq_ignore_ascii_case(name))
}

/// The arrays of a piece's points or cells, in the order of the file; none where it has no points or cells, as parallel writers leave them out.
///
/// - `owner`: "point" or "cell"
pub(super) fn read_data(
    source: &Source,
    file: &XmlFile<'_>,
    elements: &[ArrayElement<'_>],
    owner: &'static str,
    tuples: u64,
    warnings: &mut Vec<String>,
) -> Result<Vec<DataArray>, IoError> {
    if tuples == 0 {
        return Ok(Vec::new());
    }
    let mut named = NamedArrays::default();
    let plural = format!("{owner}s");
    for element in elements {
        let label = format!("{owner} array `{}`", element.name);
        let Some(scalar) = scalar_type(&element.type_name) else {
            warnings.push(format!("the {label} is left out: \"{}\" is no type of numbers", element.type_name));
            continue;
        };
        let components = match element.components.as_deref().map(|text| (text, text.trim().parse::<usize>())) {
            None => 1,
            Some((_, Ok(n))) if n > 0 => n,
            Some((text, _)) => {
                let problem = format!("it has \"{text}\" components, where at least 1 is needed");
                return Err(source.invalid(place(source, element, &label), problem, DAMAGED));
            }
        };
        let values = decode(source, file, element, scalar, &label)?;
        check_length(source, element, &label, values.len(), tuples, components, &plural)?;
        named.add(owner, &element.name, components, values, warnings);
    }
    Ok(named.into_arrays())
}

/// The coordinates of a rectilinear grid along one direction.
pub(super) fn read_coordinates(
    source: &Source,
    file: &XmlFile<'_>,
    piece: &Piece<'_>,
    axis: usize,
    count: usize,
) -> Result<Vec<f64>, IoError> {
    let label = ["x coordinates", "y coordinates", "z coordinates"].get(axis).copied().unwrap_or("coordinates");
    let Some(array) = piece.coordinates.get(axis) else {
        return Err(source.invalid("element Coordinates", format!("the array of the {label} is missing"), DAMAGED));
    };
    let scalar = scalar_type(&array.type_name).ok_or_else(|| {
        let problem = format!("the type \"{}\" is no type of numbers", array.type_name);
        source.invalid(place(source, array, label), problem, DAMAGED)
    })?;
    let values = Wanted { source, file, array, scalar, label }.decode_f64()?;
    check_length(source, array, label, values.len(), count as u64, 1, "coordinates")?;
    Ok(values)
}
