//! Linear cells: faces cut through their smallest point index, cells coned from theirs.

/// Faces of a linear cell, each counterclockwise seen from outside, as places in the cell's list of points.
pub(super) type Faces = &'static [&'static [u8]];

pub(super) const TETRAHEDRON: Faces = &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];

pub(super) const HEXAHEDRON: Faces =
    &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

/// Points as the hexahedron's, but the third and fourth of each layer change places.
pub(super) const VOXEL: Faces =
    &[&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[1, 3, 7, 5], &[3, 2, 6, 7], &[2, 0, 4, 6]];

pub(super) const WEDGE: Faces = &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];

pub(super) const PYRAMID: Faces = &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]];

pub(super) const PENTAGONAL_PRISM: Faces =
    &[&[0, 4, 3, 2, 1], &[5, 6, 7, 8, 9], &[0, 1, 6, 5], &[1, 2, 7, 6], &[2, 3, 8, 7], &[3, 4, 9, 8], &[4, 0, 5, 9]];

pub(super) const HEXAGONAL_PRISM: Faces = &[
    &[0, 5, 4, 3, 2, 1],
    &[6, 7, 8, 9, 10, 11],
    &[0, 1, 7, 6],
    &[1, 2, 8, 7],
    &[2, 3, 9, 8],
    &[3, 4, 10, 9],
    &[4, 5, 11, 10],
    &[5, 0, 6, 11],
];

/// The largest number of points that [`cut`] takes.
pub(super) const MOST_POINTS: usize = 12;

/// Cuts a convex cell into the cone from its point of smallest index over the faces that do not touch it, each face
/// cut into triangles that meet in its own point of smallest index.
///
/// A face that two cells share is cut the same way by both, also where it touches the apex: the apex then is the
/// face's smallest index too. A cell whose points lie as its kind says gives tetrahedra of positive volume. Where a
/// point is named twice (a hexahedron collapsed to a wedge, say) the number of tetrahedra stays; some have no volume.
pub(super) fn cut(points: &[u32], faces: Faces, mut emit: impl FnMut([u32; 4])) {
    let apex = smallest(points.iter().copied());
    for face in faces {
        if face.iter().any(|&place| usize::from(place) == apex) {
            continue;
        }
        fan(face.len(), |place| points[usize::from(face[place])], |[a, b, c]| emit([points[apex], a, b, c]));
    }
}

/// Cuts a polygon into the triangles that meet in its point of smallest index; they turn as the polygon does.
pub(super) fn fan(len: usize, point: impl Fn(usize) -> u32, mut emit: impl FnMut([u32; 3])) {
    let first = smallest((0..len).map(&point));
    for step in 1..len.saturating_sub(1) {
        emit([point(first), point((first + step) % len), point((first + step + 1) % len)]);
    }
}

/// The place of the smallest number, the first of equal ones.
fn smallest(numbers: impl Iterator<Item = u32>) -> usize {
    numbers.enumerate().min_by_key(|&(place, number)| (number, place)).map_or(0, |(place, _)| place)
}
