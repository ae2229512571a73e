//! The faces of polyhedra, in either of the two layouts that VTK has written.

use super::super::cells::{Faces, read_face_stream};
use super::arrays::indices;
use super::file::{Piece, XmlFile};
use crate::{IoError, Source};

/// The faces of polyhedra in either of the two layouts that there are.
pub(super) enum FaceArrays {
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
    /// Reads them, if there are any.
    pub(super) fn read(source: &Source, file: &XmlFile<'_>, piece: &Piece<'_>) -> Result<Self, IoError> {
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
    pub(super) fn of_cell(&mut self, cell: usize) -> Result<Faces, String> {
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
pub(super) fn row<'v>(ends: &[i64], index: usize, values: &'v [i64]) -> Option<&'v [i64]> {
    let end = usize::try_from(*ends.get(index)?).ok()?;
    let start = if index == 0 { 0 } else { usize::try_from(ends[index - 1]).ok()? };
    values.get(start..end)
}

/// What is wrong with a row that is not there.
pub(super) fn broken_row(name: &str, ends: &[i64], index: usize) -> String {
    let before = if index == 0 { 0 } else { ends.get(index - 1).copied().unwrap_or(-1) };
    match ends.get(index) {
        Some(end) => {
            format!("{name} goes from {before} to {end} there, which falls or is outside the array it points into")
        }
        None => format!("{name} has no entry for it"),
    }
}
