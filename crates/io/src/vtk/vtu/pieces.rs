//! From the arrays of all pieces to one dataset.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use tetrascope_mesh::{Cells, DataArray, Dataset};

use super::super::DAMAGED;
use super::super::cell_types::POLYHEDRON;
use super::super::cells::{CellBuilder, Faces, read_face_stream};
use super::super::named::NamedArrays;
use super::super::scalars::{ByteOrder, append, to_indices};
use super::payload::{decode, place, scalar_type};
use super::xml::{Appended, ArrayElement, Piece, VtuFile};
use crate::{IoError, Loaded, Source};

/// Decodes all arrays and puts the pieces one behind the other.
pub(super) fn assemble(source: &Source, file: &VtuFile<'_>) -> Result<Loaded, IoError> {
    let mut warnings = Vec::new();
    let mut points = Vec::new();
    let mut builder = CellBuilder::new(source);
    let (mut point_arrays, mut cell_arrays) = (Joined::new("point"), Joined::new("cell"));
    for (number, piece) in file.pieces.iter().enumerate() {
        let own = read_points(source, file, piece)?;
        let label = if file.pieces.len() == 1 { "Cells".to_owned() } else { format!("piece {number}, Cells") };
        builder.begin_piece(&label, points.len(), own.len())?;
        points.extend(own);
        read_cells(source, file, piece, &mut builder)?;
        point_arrays.add_piece(source, file, &piece.point_data, piece.point_count, &mut warnings)?;
        cell_arrays.add_piece(source, file, &piece.cell_data, piece.cell_count, &mut warnings)?;
    }
    let cells = Cells::Unstructured(builder.finish(&mut warnings));
    // Every piece repeats what is odd about the names.
    let mut said = HashSet::new();
    warnings.retain(|warning: &String| said.insert(warning.clone()));
    let dataset = Dataset { points, cells, point_arrays: point_arrays.arrays, cell_arrays: cell_arrays.arrays };
    Ok(Loaded::without_time(dataset, describe(file), warnings))
}

fn describe(file: &VtuFile<'_>) -> String {
    let order = match file.byte_order {
        ByteOrder::Little => "little-endian",
        ByteOrder::Big => "big-endian",
    };
    let mut formats = file.pieces.iter().flat_map(|piece| &piece.points).map(|array| array.format.as_str());
    let mut text = format!("VTK XML unstructured grid {}", file.version);
    match (formats.next_back(), file.appended) {
        (Some("ascii") | None, _) => return text + ", ASCII",
        (Some("appended"), Some(Appended::Raw(_))) => text += ", appended raw",
        (Some("appended"), _) => text += ", appended base64",
        _ => text += ", inline base64",
    }
    if let Some(compressor) = file.compressor {
        text = text + ", " + compressor.label();
    }
    text + ", " + order
}

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

fn read_points(source: &Source, file: &VtuFile<'_>, piece: &Piece<'_>) -> Result<Vec<DVec3>, IoError> {
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
    let values = decode(source, file, array, scalar, label)?;
    check_length(source, array, label, values.len(), piece.point_count, 3, "points")?;
    let flat = values.to_f64();
    Ok(flat.as_chunks::<3>().0.iter().map(|&triple| DVec3::from_array(triple)).collect())
}

/// One of the index arrays of `Cells`; nothing where the piece does not have it.
fn indices(source: &Source, file: &VtuFile<'_>, piece: &Piece<'_>, name: &str) -> Result<Option<Vec<i64>>, IoError> {
    let Some(array) = index_array(piece, name) else { return Ok(None) };
    let invalid = |problem: String| source.invalid(place(source, array, name), problem, DAMAGED);
    let scalar = scalar_type(&array.type_name)
        .ok_or_else(|| invalid(format!("the type \"{}\" is no type of numbers", array.type_name)))?;
    let values = to_indices(&decode(source, file, array, scalar, name)?)
        .ok_or_else(|| invalid(format!("indices cannot be of the type {}", array.type_name)))?;
    Ok(Some(values))
}

fn index_array<'p, 'a>(piece: &'p Piece<'a>, name: &str) -> Option<&'p ArrayElement<'a>> {
    piece.cells.iter().find(|array| array.name.eq_ignore_ascii_case(name))
}

/// The faces of polyhedra in either of the two layouts that there are.
enum FaceArrays {
    None,
    /// Up to version 2.2: one stream for all polyhedra, and for each cell where its part ends, or -1.
    Stream {
        faces: Vec<i64>,
        ends: Vec<i64>,
        at: usize,
    },
    /// From version 2.3: points of faces, ends of faces, faces of polyhedra, ends of cells in that list.
    Tables {
        points: Vec<i64>,
        face_ends: Vec<i64>,
        cell_faces: Vec<i64>,
        cell_ends: Vec<i64>,
        /// How many points may still be copied out of `points`.
        copies_left: usize,
    },
}

/// In a mesh two cells share a face; the rest is leeway. The bound is there because one long face that is named again and
/// again would make a small file take any amount of memory.
const CELLS_SHARING_A_FACE: usize = 4;

impl FaceArrays {
    fn read(source: &Source, file: &VtuFile<'_>, piece: &Piece<'_>) -> Result<Self, IoError> {
        let get = |name: &str| indices(source, file, piece, name);
        if let (Some(points), Some(face_ends), Some(cell_faces), Some(cell_ends)) =
            (get("face_connectivity")?, get("face_offsets")?, get("polyhedron_to_faces")?, get("polyhedron_offsets")?)
        {
            let copies_left = points.len().saturating_mul(CELLS_SHARING_A_FACE);
            return Ok(Self::Tables { points, face_ends, cell_faces, cell_ends, copies_left });
        }
        Ok(match (get("faces")?, get("faceoffsets")?) {
            (Some(faces), Some(ends)) => Self::Stream { faces, ends, at: 0 },
            _ => Self::None,
        })
    }

    /// The faces of a cell. The error says what is wrong with it.
    fn of_cell(&mut self, cell: usize) -> Result<Faces, String> {
        match self {
            Self::None => Err("it is a polyhedron, but the file lists no faces".to_owned()),
            Self::Stream { faces, ends, at } => {
                let end = *ends.get(cell).ok_or("faceoffsets has no entry for it")?;
                let (own, used) = read_face_stream(&faces[*at..])?;
                *at += used;
                if i64::try_from(*at) != Ok(end) {
                    return Err(format!("its faces end at {at}, where faceoffsets says {end}"));
                }
                Ok(own)
            }
            Self::Tables { points, face_ends, cell_faces, cell_ends, copies_left } => {
                let faces = row(cell_ends, cell, cell_faces)
                    .ok_or_else(|| broken_row("polyhedron_offsets", cell_ends, cell))?;
                let mut own = Vec::with_capacity(faces.len());
                for &face in faces {
                    let points =
                        usize::try_from(face).ok().and_then(|face| row(face_ends, face, points)).ok_or_else(|| {
                            format!("face {face} of it is not in face_offsets, or is outside face_connectivity")
                        })?;
                    *copies_left = copies_left
                        .checked_sub(points.len())
                        .ok_or_else(|| format!("more than {CELLS_SHARING_A_FACE} cells share each face"))?;
                    own.push(points.to_vec());
                }
                Ok(own)
            }
        }
    }
}

/// Row `index` of `values`, where row ends are listed.
fn row<'v>(ends: &[i64], index: usize, values: &'v [i64]) -> Option<&'v [i64]> {
    let end = usize::try_from(*ends.get(index)?).ok()?;
    let start = if index == 0 { 0 } else { usize::try_from(ends[index - 1]).ok()? };
    values.get(start..end)
}

fn broken_row(name: &str, ends: &[i64], index: usize) -> String {
    let before = if index == 0 { 0 } else { ends.get(index - 1).copied().unwrap_or(-1) };
    match ends.get(index) {
        Some(end) => {
            format!("{name} goes from {before} to {end} there, which falls or is outside the array it points into")
        }
        None => format!("{name} has no entry for it"),
    }
}

fn read_cells(
    source: &Source,
    file: &VtuFile<'_>,
    piece: &Piece<'_>,
    builder: &mut CellBuilder<'_>,
) -> Result<(), IoError> {
    let required = |name: &str| match indices(source, file, piece, name)? {
        Some(found) => Ok(found),
        None if piece.cell_count == 0 => Ok(Vec::new()),
        None => {
            let problem = format!("the array `{name}` is missing, though {} cells are declared", piece.cell_count);
            Err(source.invalid("element Cells", problem, DAMAGED))
        }
    };
    let connectivity = required("connectivity")?;
    let (ends, types) = (required("offsets")?, required("types")?);
    for (values, name) in [(&ends, "offsets"), (&types, "types")] {
        if u64::try_from(values.len()) != Ok(piece.cell_count) {
            let problem = format!("it has {} values, where {} were expected", values.len(), piece.cell_count);
            // Found only here: counting the lines of the whole file for every piece takes time with the square of their number.
            let place = index_array(piece, name).map_or_else(|| name.to_owned(), |array| place(source, array, name));
            return Err(source.invalid(place, problem, DAMAGED));
        }
    }
    let mut faces = FaceArrays::read(source, file, piece)?;
    for (cell, &kind) in types.iter().enumerate() {
        let points =
            row(&ends, cell, &connectivity).ok_or_else(|| builder.invalid(broken_row("offsets", &ends, cell)))?;
        if kind == POLYHEDRON {
            let own = faces.of_cell(cell).map_err(|problem| builder.invalid(problem))?;
            builder.push_polyhedron(points, &own)?;
        } else {
            builder.push(kind, points)?;
        }
    }
    Ok(())
}

/// Arrays of one kind over all pieces.
struct Joined {
    owner: &'static str,
    arrays: Vec<DataArray>,
    any_piece: bool,
}

impl Joined {
    fn new(owner: &'static str) -> Self {
        Self { owner, arrays: Vec::new(), any_piece: false }
    }

    /// Puts a piece's arrays behind those of the pieces before; what is not in all of them goes.
    ///
    /// Pieces without points (or cells) do not count: parallel writers leave their arrays out.
    fn add_piece(
        &mut self,
        source: &Source,
        file: &VtuFile<'_>,
        elements: &[ArrayElement<'_>],
        tuples: u64,
        warnings: &mut Vec<String>,
    ) -> Result<(), IoError> {
        if tuples == 0 {
            return Ok(());
        }
        let owner = self.owner;
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
        if !self.any_piece {
            self.any_piece = true;
            self.arrays = named.into_arrays();
            return Ok(());
        }
        let mut own: Vec<_> = named.into_arrays().into_iter().map(Some).collect();
        let by_name: HashMap<String, usize> =
            own.iter().flatten().enumerate().map(|(index, array)| (array.name.clone(), index)).collect();
        self.arrays.retain_mut(|all| {
            let joined = by_name
                .get(&all.name)
                .and_then(|&index| own[index].take())
                .is_some_and(|array| array.components == all.components && append(&mut all.values, array.values));
            if !joined {
                warnings.push(format!(
                    "the {owner} array `{}` is left out: not all pieces have it with the same type and components",
                    all.name
                ));
            }
            joined
        });
        for array in own.into_iter().flatten() {
            warnings.push(format!("the {owner} array `{}` is left out: not all pieces have it", array.name));
        }
        Ok(())
    }
}
