//! Unstructured grids: one or several parts, one behind the other in each dataset.

use glam::DVec3;
use hdf5_reader::group::Group;
use tetrascope_mesh::DataArray;

use super::arrays::read_arrays;
use super::container::{Container, DAMAGED};
use super::steps::Steps;
use crate::IoError;
use crate::vtk::cell_types::POLYHEDRON;
use crate::vtk::cells::{CellBuilder, Faces};

/// In a mesh two cells share a face; the rest is leeway. Without a bound, one long face that is named again and again would make a small
/// file take any amount of memory.
const CELLS_SHARING_A_FACE: usize = 4;

/// VTK's empty cell, for cells that are not to be drawn.
const EMPTY: i64 = 0;
/// Flags of `vtkGhostType` for cells: the cell is another part's too, or hidden.
const NOT_OWN: i64 = 1 | 32;

/// Adds the grid of a group; gives its arrays of points and of cells.
///
/// # Errors
/// [`IoError::Invalid`] where datasets are missing, too short, or name points that are not there.
pub(super) fn read_grid(
    file: &Container<'_>,
    group: &Group,
    steps: &Steps,
    label: &str,
    points: &mut Vec<DVec3>,
    builder: &mut CellBuilder<'_>,
    warnings: &mut Vec<String>,
) -> Result<(Vec<DataArray>, Vec<DataArray>), IoError> {
    let parts = Parts::read(file, group, steps)?;
    let (point_count, cell_count) = (total(&parts.points), total(&parts.cells));
    let first_point = steps.entry(file, "PointOffsets")?.unwrap_or(0);
    let first_cell = steps.entry(file, "CellOffsets")?.unwrap_or(0);
    let first_id = steps.entry(file, "ConnectivityIdOffsets")?.unwrap_or(0);

    let first_added = points.len();
    let own = file.rows(group, "Points", first_point, point_count)?.to_f64();
    let (triples, rest) = own.as_chunks::<3>();
    if !rest.is_empty() || triples.len() as u64 != point_count {
        return Err(file.source.invalid(
            format!("{label}, dataset `Points`"),
            "points have 3 coordinates each",
            DAMAGED,
        ));
    }
    points.extend(triples.iter().map(|&triple| DVec3::from_array(triple)));

    let point_start = |name: &str| Ok(steps.array_entry(file, "PointDataOffsets", name)?.unwrap_or(first_point));
    let point_arrays = read_arrays(file, group, "point", point_count, &point_start, warnings)?;
    let cell_start = |name: &str| Ok(steps.array_entry(file, "CellDataOffsets", name)?.unwrap_or(first_cell));
    let cell_arrays = read_arrays(file, group, "cell", cell_count, &cell_start, warnings)?;
    let ghosts = cell_arrays.iter().find(|array| array.name == "vtkGhostType" && array.components == 1);
    let ghosts = ghosts.map(|array| array.values.to_f64());

    let connectivity = file.index_rows(group, "Connectivity", first_id, total(&parts.ids))?;
    // Each part has one offset more than cells.
    let offset_count = cell_count.saturating_add(parts.cells.len() as u64);
    let offsets = file.index_rows(group, "Offsets", first_cell.saturating_add(parts.first), offset_count)?;
    let types = file.index_rows(group, "Types", first_cell, cell_count)?;
    let mut faces = FaceLists::read(file, group, &parts)?;
    let (mut types, mut offsets, mut connectivity) = (types.as_slice(), offsets.as_slice(), connectivity.as_slice());
    let (mut point_base, mut cell, mut left_out) = (first_added, 0, 0);
    for part in 0..parts.points.len() {
        let place = if parts.points.len() == 1 { label.to_owned() } else { format!("{label}, part {part}") };
        let cells = usize_of(parts.cells[part]);
        builder.begin_piece(&place, point_base, usize_of(parts.points[part]))?;
        let (own_types, later_types) = types.split_at(cells);
        let (own_offsets, later_offsets) = offsets.split_at(cells + 1);
        let (own_ids, later_ids) = connectivity.split_at(usize_of(parts.ids[part]));
        faces.begin_part(&parts, part);
        for (index, &kind) in own_types.iter().enumerate() {
            let row = |ends: &[i64]| {
                Some(usize::try_from(*ends.get(index)?).ok()?..usize::try_from(*ends.get(index + 1)?).ok()?)
            };
            let own = row(own_offsets).and_then(|range| own_ids.get(range));
            let own = own.ok_or_else(|| builder.invalid("`Offsets` falls there, or is outside `Connectivity`"))?;
            let is_ghost =
                ghosts.as_ref().and_then(|flags| flags.get(cell)).is_some_and(|&flags| flags as i64 & NOT_OWN != 0);
            cell += 1;
            if is_ghost {
                left_out += 1;
                builder.push(EMPTY, own)?;
            } else if kind == POLYHEDRON {
                let faces = faces.of_cell(index).map_err(|problem| builder.invalid(problem))?;
                builder.push_polyhedron(own, &faces)?;
            } else {
                builder.push(kind, own)?;
            }
        }
        (types, offsets, connectivity) = (later_types, later_offsets, later_ids);
        point_base += usize_of(parts.points[part]);
    }
    if left_out > 0 {
        warnings.push(format!("{left_out} cells are hidden, or another part's too (vtkGhostType), and not drawn"));
    }
    Ok((point_arrays, cell_arrays))
}

/// How many points, cells and point numbers each part of a step has.
struct Parts {
    /// The step's first part among those of all steps.
    first: u64,
    points: Vec<u64>,
    cells: Vec<u64>,
    ids: Vec<u64>,
}

impl Parts {
    fn read(file: &Container<'_>, group: &Group, steps: &Steps) -> Result<Self, IoError> {
        let first = steps.entry(file, "PartOffsets")?.unwrap_or(0);
        let all = file.shape(group, "NumberOfPoints").and_then(|shape| shape.first().copied()).unwrap_or(0);
        let count = steps.entry(file, "NumberOfParts")?.unwrap_or_else(|| all.saturating_sub(first));
        let list = |name: &str| counts(file, group, name, first, count);
        Ok(Self {
            first,
            points: list("NumberOfPoints")?,
            cells: list("NumberOfCells")?,
            ids: list("NumberOfConnectivityIds")?,
        })
    }
}

fn counts(file: &Container<'_>, group: &Group, name: &str, first: u64, count: u64) -> Result<Vec<u64>, IoError> {
    let list = file.index_rows(group, name, first, count)?;
    // What is negative is more than any file holds, and found so when it is read.
    Ok(list.iter().map(|&count| u64::try_from(count).unwrap_or(u64::MAX)).collect())
}

fn total(counts: &[u64]) -> u64 {
    counts.iter().fold(0, |sum, &count| sum.saturating_add(count))
}

/// A count whose rows were read, so that it fits.
fn usize_of(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

/// The faces of polyhedra, in the tables that files since version 2.3 have: those of all parts of the step, one behind the other.
struct FaceLists {
    is_there: bool,
    /// For each part the points of faces, the faces, the faces of polyhedra.
    own: [Vec<u64>; 3],
    points: Rows,
    face_ends: Rows,
    cell_faces: Rows,
    cell_ends: Rows,
    copies_left: usize,
}

/// Rows of which a part has its own.
#[derive(Default)]
struct Rows {
    all: Vec<i64>,
    own: std::ops::Range<usize>,
}

impl Rows {
    fn next(&mut self, count: usize) {
        self.own = self.own.end..self.own.end.saturating_add(count);
    }

    fn own(&self) -> &[i64] {
        self.all.get(self.own.clone()).unwrap_or_default()
    }
}

/// The datasets that count, part by part, the points of faces, the faces, and the faces of polyhedra.
const FACE_COUNTS: [&str; 3] = ["NumberOfFaceConnectivityIds", "NumberOfFaces", "NumberOfPolyhedronToFaceIds"];

impl FaceLists {
    fn read(file: &Container<'_>, group: &Group, parts: &Parts) -> Result<Self, IoError> {
        let is_there = FACE_COUNTS.iter().all(|name| file.shape(group, name).is_some());
        let (points, face_ends, cell_faces, cell_ends) = Default::default();
        let mut lists =
            Self { is_there, own: Default::default(), points, face_ends, cell_faces, cell_ends, copies_left: 0 };
        if !is_there {
            return Ok(lists);
        }
        let count = parts.points.len() as u64;
        // Where the step's first part begins, behind the parts of other steps.
        let mut first = [0; 3];
        for ((own, first), name) in lists.own.iter_mut().zip(&mut first).zip(FACE_COUNTS) {
            *first = total(&counts(file, group, name, 0, parts.first)?);
            *own = counts(file, group, name, parts.first, count)?;
        }
        let first_cell = total(&counts(file, group, "NumberOfCells", 0, parts.first)?);
        let [points, faces, cell_faces] = [0, 1, 2].map(|index| total(&lists.own[index]));
        let rows = |name: &str, first: u64, count: u64| {
            file.index_rows(group, name, first, count).map(|all| Rows { all, own: 0..0 })
        };
        // Each part has one offset more than rows.
        let with_ends = |first: u64, of: u64| (first.saturating_add(parts.first), of.saturating_add(count));
        lists.points = rows("FaceConnectivity", first[0], points)?;
        let (start, length) = with_ends(first[1], faces);
        lists.face_ends = rows("FaceOffsets", start, length)?;
        lists.cell_faces = rows("PolyhedronToFaces", first[2], cell_faces)?;
        let (start, length) = with_ends(first_cell, total(&parts.cells));
        lists.cell_ends = rows("PolyhedronOffsets", start, length)?;
        lists.copies_left = lists.points.all.len().saturating_mul(CELLS_SHARING_A_FACE);
        Ok(lists)
    }

    /// Turns to the next part.
    fn begin_part(&mut self, parts: &Parts, part: usize) {
        let own = |index: usize| self.own[index].get(part).map_or(0, |&count| usize_of(count));
        let [points, faces, cell_faces] = [own(0), own(1), own(2)];
        self.points.next(points);
        self.face_ends.next(faces.saturating_add(1));
        self.cell_faces.next(cell_faces);
        self.cell_ends.next(usize_of(parts.cells[part]).saturating_add(1));
    }

    fn of_cell(&mut self, cell: usize) -> Result<Faces, String> {
        if !self.is_there {
            return Err("it is a polyhedron, but the file lists no faces".to_owned());
        }
        let faces = row(self.cell_ends.own(), cell, self.cell_faces.own())
            .ok_or("`PolyhedronOffsets` falls there, or is outside `PolyhedronToFaces`")?;
        let mut own = Faces::with_capacity(faces.len());
        for &face in faces {
            let points = usize::try_from(face).ok().and_then(|face| row(self.face_ends.own(), face, self.points.own()));
            let points =
                points.ok_or_else(|| format!("face {face} of it is not in `FaceOffsets` or `FaceConnectivity`"))?;
            let left = self.copies_left.checked_sub(points.len());
            self.copies_left = left.ok_or_else(|| format!("more than {CELLS_SHARING_A_FACE} cells share each face"))?;
            own.push(points.to_vec());
        }
        Ok(own)
    }
}

/// Row `index` of `values`, where row starts are listed, and the end of the last.
fn row<'v>(offsets: &[i64], index: usize, values: &'v [i64]) -> Option<&'v [i64]> {
    let (start, end) = (*offsets.get(index)?, *offsets.get(index.checked_add(1)?)?);
    values.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
}
