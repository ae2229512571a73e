//! Which cell a set of faces is: OpenFOAM's cells are faces alone.

use tetrascope_mesh::CellKind;

/// The faces of one cell, each with its normal out of the cell by the right hand's rule.
#[derive(Debug, Default)]
pub(super) struct FacesOfCell {
    corners: Vec<u32>,
    ends: Vec<usize>,
}

/// The faces of each kind, as places in its list of points in VTK's order, normals outward.
const TETRAHEDRON: &[&[usize]] = &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
const PYRAMID: &[&[usize]] = &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]];
/// As VTK's documentation has the wedge and OpenFOAM's own converter writes it: the normal of (0, 1, 2) points out of the cell.
const WEDGE: &[&[usize]] = &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]];
const HEXAHEDRON: &[&[usize]] =
    &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

impl FacesOfCell {
    /// Starts another cell.
    pub(super) fn clear(&mut self) {
        self.corners.clear();
        self.ends.clear();
    }

    /// Adds a face; a `reversed` one has its normal into the cell and keeps its first point.
    pub(super) fn push(&mut self, face: &[u32], reversed: bool) {
        if reversed {
            self.corners.extend(face.iter().take(1).chain(face.iter().skip(1).rev()));
        } else {
            self.corners.extend(face);
        }
        self.ends.push(self.corners.len());
    }

    /// All faces.
    pub(super) fn faces(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(&start, &end)| self.corners.get(start..end).unwrap_or_default())
    }

    /// The points of all faces, as often as they are named.
    pub(super) fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// The kind and its points in VTK's order, where the faces are exactly those of a tetrahedron, pyramid, wedge or hexahedron with
    /// as many different points; nothing for any other cell.
    pub(super) fn linear_cell(&self) -> Option<(CellKind, Vec<u32>)> {
        if !(4..=6).contains(&self.ends.len()) || self.faces().any(|face| !(3..=4).contains(&face.len())) {
            return None;
        }
        let triangles = self.faces().filter(|face| face.len() == 3).count();
        let (kind, model, base_size) = match (triangles, self.ends.len() - triangles) {
            (4, 0) => (CellKind::Tetrahedron, TETRAHEDRON, 3),
            (4, 1) => (CellKind::Pyramid, PYRAMID, 4),
            (2, 3) => (CellKind::Wedge, WEDGE, 3),
            (0, 6) => (CellKind::Hexahedron, HEXAHEDRON, 4),
            _ => return None,
        };
        let base = self.faces().find(|face| face.len() == base_size)?;
        let apex = || self.corners.iter().copied().find(|corner| !base.contains(corner));
        let above = |points: &[u32]| points.iter().map(|&point| self.above(base, point)).collect::<Option<Vec<u32>>>();
        let reversed = || base.iter().take(1).chain(base.iter().skip(1).rev()).copied().collect::<Vec<u32>>();
        let points = match kind {
            CellKind::Wedge => [base.to_vec(), above(base)?].concat(),
            CellKind::Hexahedron => {
                let bottom = reversed();
                let top = above(&bottom)?;
                [bottom, top].concat()
            }
            _ => [reversed(), vec![apex()?]].concat(),
        };
        self.matches(model, &points).then_some((kind, points))
    }

    /// The other end of the edge that goes from a point of the base out of the base.
    fn above(&self, base: &[u32], point: u32) -> Option<u32> {
        let next_to = |face: &[u32]| {
            let at = face.iter().position(|&corner| corner == point)?;
            let after = face.get((at + 1) % face.len()).copied()?;
            let before = face.get((at + face.len() - 1) % face.len()).copied()?;
            [after, before].into_iter().find(|corner| !base.contains(corner))
        };
        self.faces().find_map(next_to)
    }

    /// Whether the faces are those of the model, turned as there.
    fn matches(&self, model: &[&[usize]], points: &[u32]) -> bool {
        let different =
            points.iter().enumerate().all(|(i, point)| !points.iter().skip(i + 1).any(|other| other == point));
        let has = |wanted: &&[usize]| {
            let corner = |place: usize| wanted.get(place % wanted.len()).and_then(|&i| points.get(i));
            let is_it = |face: &[u32]| {
                face.len() == wanted.len()
                    && (0..wanted.len())
                        .any(|turn| face.iter().enumerate().all(|(i, found)| corner(i + turn) == Some(found)))
            };
            self.faces().any(is_it)
        };
        different && model.len() == self.ends.len() && model.iter().all(has)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faces_of(model: &[&[usize]]) -> FacesOfCell {
        let mut faces = FacesOfCell::default();
        for (i, face) in model.iter().enumerate() {
            let mut face: Vec<u32> = face.iter().map(|&i| 10 + i as u32).collect();
            let turn = i % face.len();
            face.rotate_left(turn);
            // Every other face is the one of a neighbor.
            if i % 2 == 1 {
                face[1..].reverse();
            }
            faces.push(&face, i % 2 == 1);
        }
        faces
    }

    #[test]
    fn linear_cells_are_found_whatever_face_is_first() {
        for (model, kind, count) in [
            (TETRAHEDRON, CellKind::Tetrahedron, 4),
            (PYRAMID, CellKind::Pyramid, 5),
            (WEDGE, CellKind::Wedge, 6),
            (HEXAHEDRON, CellKind::Hexahedron, 8),
        ] {
            for first in 0..model.len() {
                let mut model = model.to_vec();
                model.rotate_left(first);
                let (found, points) = faces_of(&model).linear_cell().unwrap();
                assert_eq!((found, points.len()), (kind, count));
            }
        }
    }

    #[test]
    fn other_cells_are_none() {
        // A hexahedron with an edge drawn together: six faces, of which two are triangles.
        let collapsed: &[&[usize]] =
            &[&[0, 3, 2, 1], &[4, 5, 6], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 4, 6], &[3, 0, 4]];
        assert_eq!(faces_of(collapsed).linear_cell(), None);
        // One face turned inside, one repeated, one missing.
        let mut turned = faces_of(TETRAHEDRON);
        turned.corners.swap(0, 1);
        assert_eq!(turned.linear_cell(), None);
        let repeated: &[&[usize]] = &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[1, 2, 3]];
        assert_eq!(faces_of(repeated).linear_cell(), None);
        assert_eq!(faces_of(&HEXAHEDRON[..5]).linear_cell(), None);
        assert_eq!(FacesOfCell::default().linear_cell(), None);
    }
}
