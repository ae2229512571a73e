//! Points, faces, and the cells that they enclose.

use std::path::Path;

use glam::DVec3;
use tetrascope_mesh::{ArrayValues, CellKind, UnstructuredCells};

use super::{
    file::{FoamFile, existing},
    lists::{ListReader, NONE, Rows},
    shapes::FacesOfCell,
    words::{Bad, Words},
};
use crate::IoError;

/// What a folder `polyMesh` holds.
#[derive(Debug, Default)]
pub(super) struct PolyMesh {
    /// World coordinates.
    pub(super) points: Vec<DVec3>,
    /// Points of every face; its normal points from its owner to its neighbor by the right hand's rule.
    pub(super) faces: Rows,
    /// The cell on the one side of every face.
    pub(super) owners: Vec<u32>,
    /// The cell on the other side of the first faces, or [`NONE`]; the faces behind them are on the boundary.
    pub(super) neighbors: Vec<u32>,
    /// Number of cells.
    pub(super) cell_count: usize,
    /// Whether any of its files is in binary.
    pub(super) binary: bool,
    /// Bytes of all its files, unpacked.
    pub(super) bytes: usize,
}

/// Where the files of a mesh lie: points may move while faces stay.
#[derive(Debug)]
pub(super) struct MeshFolders<'a> {
    pub(super) points: &'a Path,
    pub(super) faces: &'a Path,
}

/// What is needed of one kind of file, read by [`FoamFile`]'s rules.
type ReadContent<'r, T> = &'r mut dyn FnMut(&mut ListReader<'_, '_>, &FoamFile) -> Result<T, Bad>;

impl PolyMesh {
    /// Reads the files of a mesh; `open` gives one by its path without `.gz`.
    ///
    /// # Errors
    /// [`IoError`] with the file and the place.
    pub(super) fn read(
        folders: &MeshFolders<'_>,
        open: &mut dyn FnMut(&Path) -> Result<FoamFile, IoError>,
    ) -> Result<Self, IoError> {
        let mut mesh = Self::default();

        let points = open(&folders.points.join("points"))?;
        let class = ["vectorField", "vectorIOField", "pointField"];
        mesh.points = mesh.content(&points, &class, &mut |lists, _| Ok(to_points(lists.tuples(3, 0)?)))?;
        drop(points);

        let file = open(&folders.faces.join("faces"))?;
        mesh.faces = mesh.content(&file, &["faceList", "faceCompactList"], &mut |lists, file| {
            if file.header.class == "faceCompactList" { lists.compact_rows() } else { lists.rows() }
        })?;
        mesh.check_faces(&file)?;
        drop(file);

        let faces = mesh.faces.len();
        let file = open(&folders.faces.join("owner"))?;
        mesh.owners = mesh.content(&file, &["labelList"], &mut |lists, _| lists.labels(faces))?;
        mesh.check_owners(&file)?;
        drop(file);

        let file = open(&folders.faces.join("neighbour"))?;
        mesh.neighbors = mesh.content(&file, &["labelList"], &mut |lists, _| lists.labels(faces))?;
        mesh.check_neighbors(&file)?;
        Ok(mesh)
    }

    fn content<T>(&mut self, file: &FoamFile, classes: &[&str], read: ReadContent<'_, T>) -> Result<T, IoError> {
        file.expect_class(classes)?;
        self.binary |= file.header.binary;
        self.bytes = self.bytes.saturating_add(file.source.bytes.len());
        let mut words: Words<'_> = file.words();
        let mut lists = ListReader { words: &mut words, header: &file.header };
        read(&mut lists, file).map_err(|bad| file.invalid(bad))
    }

    fn check_faces(&self, file: &FoamFile) -> Result<(), IoError> {
        let remedy = "the files of the mesh do not belong together, or are damaged; run checkMesh";
        for index in 0..self.faces.len() {
            let face = self.faces.row(index);
            if face.len() < 3 {
                let problem = format!("it has {} points, a face has at least 3", face.len());
                return Err(file.source.invalid(format!("face {index}"), problem, remedy));
            }
            if let Some(point) = face.iter().find(|&&point| point as usize >= self.points.len()) {
                let problem = format!("it names point {point}, there are {}", self.points.len());
                return Err(file.source.invalid(format!("face {index}"), problem, remedy));
            }
        }
        Ok(())
    }

    /// Every cell has a face that it owns or neighbors, so that there are fewer cells than faces: numbers of cells reserve nothing more.
    fn check_owners(&mut self, file: &FoamFile) -> Result<(), IoError> {
        if self.owners.len() != self.faces.len() {
            return Err(file.invalid(Bad {
                at: file.header.end,
                problem: format!("there are {} owners for {} faces", self.owners.len(), self.faces.len()),
            }));
        }
        self.cell_count = self.count_cells(file, &self.owners)?;
        Ok(())
    }

    fn check_neighbors(&mut self, file: &FoamFile) -> Result<(), IoError> {
        if self.neighbors.len() > self.faces.len() {
            return Err(file.invalid(Bad {
                at: file.header.end,
                problem: format!("there are {} neighbors for {} faces", self.neighbors.len(), self.faces.len()),
            }));
        }
        // Older programs write -1 for every face of the boundary.
        let inside: Vec<u32> = self.neighbors.iter().copied().filter(|&cell| cell != NONE).collect();
        self.cell_count = self.cell_count.max(self.count_cells(file, &inside)?);
        Ok(())
    }

    fn count_cells(&self, file: &FoamFile, cells: &[u32]) -> Result<usize, IoError> {
        let Some(&largest) = cells.iter().max() else { return Ok(0) };
        if largest as usize >= self.faces.len() {
            return Err(file.invalid(Bad {
                at: file.header.end,
                problem: format!(
                    "a face belongs to cell {largest}, but {} faces enclose no so many cells",
                    self.faces.len()
                ),
            }));
        }
        Ok(largest as usize + 1)
    }

    /// The cells in VTK's order of points, and how many have too few faces to enclose anything: these are [`CellKind::Flat`].
    pub(super) fn cells(&self) -> (UnstructuredCells, usize) {
        let (starts, faces_of_cells) = self.faces_of_cells();
        let mut cells = UnstructuredCells::default();
        let mut without_volume = 0;
        let mut faces = FacesOfCell::default();
        // The cell that last named a point, counted from 1, so that each is listed once without sorting.
        let mut last_cell = vec![0_u32; self.points.len()];
        for (cell, ends) in starts.windows(2).enumerate() {
            let (&[start, end], number) = (ends, cell as u32) else { continue };
            faces.clear();
            for &face in faces_of_cells.get(start..end).unwrap_or_default() {
                let reversed = self.owners.get(face as usize) != Some(&number);
                faces.push(self.faces.row(face as usize), reversed);
            }
            if let Some((kind, points)) = faces.linear_cell() {
                cells.kinds.push(kind);
                cells.connectivity.extend(points);
            } else {
                for &point in faces.corners() {
                    if let Some(last) = last_cell.get_mut(point as usize).filter(|last| **last != number + 1) {
                        *last = number + 1;
                        cells.connectivity.push(point);
                    }
                }
                // Four faces are the fewest that enclose a volume.
                if end - start < 4 {
                    without_volume += 1;
                    cells.kinds.push(CellKind::Flat);
                } else {
                    cells.kinds.push(CellKind::Polyhedron);
                    cells.polyhedra.push(faces.faces().map(<[u32]>::to_vec).collect());
                }
            }
            cells.offsets.push(cells.connectivity.len());
        }
        (cells, without_volume)
    }

    /// The faces of all cells in one list, and where each cell's begin; the last entry is the end.
    fn faces_of_cells(&self) -> (Vec<usize>, Vec<u32>) {
        let mut starts = vec![0_usize; self.cell_count + 1];
        self.each_side(|_, cell| {
            if let Some(count) = starts.get_mut(cell as usize + 1) {
                *count += 1;
            }
        });
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut next = starts.clone();
        let mut faces = vec![0_u32; sum];
        self.each_side(|face, cell| {
            if let Some(place) = next.get_mut(cell as usize) {
                if let Some(slot) = faces.get_mut(*place) {
                    *slot = face;
                }
                *place += 1;
            }
        });
        (starts, faces)
    }

    /// Every face with each cell that it belongs to, owners first. A face with one cell on both sides counts once.
    fn each_side(&self, mut each: impl FnMut(u32, u32)) {
        for (face, &owner) in (0..).zip(&self.owners) {
            each(face, owner);
        }
        for (face, (&neighbor, &owner)) in (0..).zip(self.neighbors.iter().zip(&self.owners)) {
            if neighbor != NONE && neighbor != owner {
                each(face, neighbor);
            }
        }
    }
}

/// Whether a folder holds a mesh.
pub(super) fn is_mesh_folder(folder: &Path) -> bool {
    ["points", "faces", "owner"].iter().all(|name| existing(&folder.join(name)).is_some())
}

fn to_points(values: ArrayValues) -> Vec<DVec3> {
    let point = |p: &[f64; 3]| DVec3::from_array(*p);
    match values {
        ArrayValues::F64(values) => values.as_chunks().0.iter().map(point).collect(),
        other => other.to_f64().as_chunks().0.iter().map(point).collect(),
    }
}
