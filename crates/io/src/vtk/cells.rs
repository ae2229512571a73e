//! Cells as rows of point indices: every index is checked once, here, for both file formats.

use tetrascope_mesh::{CellKind, UnstructuredCells};

use super::DAMAGED;
use super::cell_types::{kind_of, number_of_flat, point_count_of};
use crate::{IoError, Source};

/// The faces of one polyhedron, as point indices of its piece.
pub(crate) type Faces = Vec<Vec<i64>>;

/// Collects cells; indices count from the first point of the current piece.
pub(crate) struct CellBuilder<'a> {
    source: &'a Source,
    cells: UnstructuredCells,
    point_base: u32,
    point_count: u32,
    /// Number of cells before the current piece, so that messages count as the piece does.
    cell_base: usize,
    place: String,
    too_few: Tally,
    too_many: Tally,
}

/// How often something odd was met, and the first case in words.
#[derive(Default)]
struct Tally {
    count: usize,
    first: String,
}

impl Tally {
    fn note(&mut self, first: impl FnOnce() -> String) {
        if self.count == 0 {
            self.first = first();
        }
        self.count += 1;
    }
}

impl<'a> CellBuilder<'a> {
    /// A builder without cells.
    pub(crate) fn new(source: &'a Source) -> Self {
        Self {
            source,
            cells: UnstructuredCells::default(),
            point_base: 0,
            point_count: 0,
            cell_base: 0,
            place: String::new(),
            too_few: Tally::default(),
            too_many: Tally::default(),
        }
    }

    /// Starts a piece whose points follow the `point_base` points of those before.
    ///
    /// # Errors
    /// [`IoError::Unsupported`] where a point index would not fit into 32 bits.
    pub(crate) fn begin_piece(&mut self, place: &str, point_base: usize, point_count: usize) -> Result<(), IoError> {
        let fits = point_base.checked_add(point_count).is_some_and(|end| u32::try_from(end).is_ok());
        let (Ok(base), Ok(count), true) = (u32::try_from(point_base), u32::try_from(point_count), fits) else {
            return Err(self.source.unsupported(
                format!("a mesh of more than {} points", u32::MAX),
                "split the mesh or write a coarser one",
            ));
        };
        (self.point_base, self.point_count) = (base, count);
        place.clone_into(&mut self.place);
        self.cell_base = self.cells.kinds.len();
        Ok(())
    }

    /// The points before those of the current piece.
    pub(crate) fn point_base(&self) -> u32 {
        self.point_base
    }

    /// The points of the current piece.
    pub(crate) fn point_count(&self) -> u32 {
        self.point_count
    }

    /// Adds cells that need no check; their points count from the first one of all.
    pub(crate) fn push_all(&mut self, cells: UnstructuredCells) {
        if self.cells.kinds.is_empty() && self.cells.connectivity.is_empty() {
            self.cells = cells;
            return;
        }
        let base = self.cells.connectivity.len();
        self.cells.connectivity.extend(cells.connectivity);
        self.cells.kinds.extend(cells.kinds);
        self.cells.offsets.extend(cells.offsets.iter().skip(1).map(|end| base + end));
        self.cells.polyhedra.extend(cells.polyhedra);
    }

    /// Adds a cell that names its points.
    ///
    /// Points beyond those that its kind has are left out; too few are kept, for the mesh to count the cell as malformed.
    /// Both are reported by [`finish`](Self::finish).
    pub(crate) fn push(&mut self, kind_number: i64, points: &[i64]) -> Result<(), IoError> {
        let mut kind = self.kind(kind_number)?;
        // Exodus's reader gives the number of the empty cell to what its points tell well enough.
        if let (CellKind::Flat, Ok(number @ 1..)) = (kind, u8::try_from(kind_number))
            && number_of_flat(points.len()) != Some(number)
        {
            kind = CellKind::FlatOf(number);
        }
        let mut used = points;
        if let Some(needed) = point_count_of(kind) {
            let number = self.number();
            let say = || format!("cell {number} ({kind:?}) has {} points, its kind has {needed}", points.len());
            if points.len() < needed {
                self.too_few.note(say);
            } else if points.len() > needed {
                self.too_many.note(say);
                used = &points[..needed];
            }
        }
        // The points that are not used are checked too: an index out of range there tells of a damaged file as well.
        for &point in &points[used.len()..] {
            self.index(point)?;
        }
        self.push_row(kind, used)
    }

    /// Adds a polyhedron with its faces; `points` may be empty, then they are those of the faces, each once.
    pub(crate) fn push_polyhedron(&mut self, points: &[i64], faces: &Faces) -> Result<(), IoError> {
        let mut checked = Vec::with_capacity(faces.len());
        for face in faces {
            let face: Result<Vec<u32>, IoError> = face.iter().map(|&point| self.index(point)).collect();
            checked.push(face?);
        }
        if points.is_empty() {
            let mut own: Vec<i64> = faces.iter().flatten().copied().collect();
            own.sort_unstable();
            own.dedup();
            self.push_row(CellKind::Polyhedron, &own)?;
        } else {
            self.push_row(CellKind::Polyhedron, points)?;
        }
        self.cells.polyhedra.push(checked);
        Ok(())
    }

    /// The cells, and warnings about those with too few or too many points.
    pub(crate) fn finish(self, warnings: &mut Vec<String>) -> UnstructuredCells {
        if self.too_few.count > 0 {
            warnings.push(format!(
                "{} cells have too few points for their kind and cannot be drawn; the first: {}",
                self.too_few.count, self.too_few.first
            ));
        }
        if self.too_many.count > 0 {
            warnings.push(format!(
                "{} cells have more points than their kind has; the first ones are used; the first: {}",
                self.too_many.count, self.too_many.first
            ));
        }
        self.cells
    }

    /// An error about the cell that is to be added next.
    pub(crate) fn invalid(&self, problem: impl Into<String>) -> IoError {
        self.source.invalid(format!("{}, cell {}", self.place, self.number()), problem, DAMAGED)
    }

    fn number(&self) -> usize {
        self.cells.kinds.len() - self.cell_base
    }

    fn kind(&self, number: i64) -> Result<CellKind, IoError> {
        kind_of(number).ok_or_else(|| self.invalid(format!("its type is {number}, where 0 to 255 are allowed")))
    }

    fn index(&self, point: i64) -> Result<u32, IoError> {
        match u32::try_from(point) {
            Ok(index) if index < self.point_count => Ok(self.point_base + index),
            _ => Err(self.invalid(format!("it names point {point}, but there are {} points", self.point_count))),
        }
    }

    fn push_row(&mut self, kind: CellKind, points: &[i64]) -> Result<(), IoError> {
        for &point in points {
            let index = self.index(point)?;
            self.cells.connectivity.push(index);
        }
        self.cells.kinds.push(kind);
        self.cells.offsets.push(self.cells.connectivity.len());
        Ok(())
    }
}

/// Takes one polyhedron's faces from a stream: the number of faces, then for each its number of points and the points.
///
/// Gives the faces and how many numbers they took. The error says what is wrong, for the caller to add the place.
pub(crate) fn read_face_stream(stream: &[i64]) -> Result<(Faces, usize), String> {
    let mut at = 0;
    let next_count = |at: &mut usize, what: &str| -> Result<usize, String> {
        let count = *stream.get(*at).ok_or_else(|| format!("its face stream ends before {what}"))?;
        *at += 1;
        // No count can exceed what is left, since each face and each point takes a number of its own.
        usize::try_from(count)
            .ok()
            .filter(|&count| count <= stream.len() - *at)
            .ok_or_else(|| format!("{what} in its face stream is {count}, but {} numbers are left", stream.len() - *at))
    };
    let face_count = next_count(&mut at, "the number of faces")?;
    let mut faces = Vec::with_capacity(face_count);
    for _ in 0..face_count {
        let size = next_count(&mut at, "the number of points of a face")?;
        faces.push(stream[at..at + size].to_vec());
        at += size;
    }
    Ok((faces, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn face_streams() {
        let (faces, used) = read_face_stream(&[2, 3, 0, 1, 2, 4, 3, 2, 1, 0, 99]).unwrap();
        assert_eq!((faces, used), (vec![vec![0, 1, 2], vec![3, 2, 1, 0]], 10));
        for broken in [&[][..], &[-1], &[1 << 40], &[1], &[1, 5, 0, 1], &[2, 3, 0, 1, 2, -3]] {
            assert!(read_face_stream(broken).is_err(), "{broken:?}");
        }
    }
}
