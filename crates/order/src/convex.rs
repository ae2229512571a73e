//! Whether a mesh is convex.

use rayon::prelude::*;
use tetrascope_mesh::{CellFace, CellId, FaceAdjacency, VertexId};

use crate::Cells;
use crate::signs::side_of;

/// A boundary face's points, and the corner of its cell that is not one of them.
pub(crate) fn points_of(cells: Cells<'_>, face: CellFace) -> ([VertexId; 3], VertexId) {
    let [a, b, c, d] = cells.tetrahedra[face.cell.index()];
    match face.corner {
        0 => ([b, c, d], a),
        1 => ([a, c, d], b),
        2 => ([a, b, d], c),
        _ => ([a, b, c], d),
    }
}

/// Whether a mesh fills a convex body: then whatever a ray meets it meets without a gap.
///
/// It does if its boundary is one closed surface, and at each of its points no face's plane has another face of that point in front of
/// it. Edges alone would not tell: a star of cells that winds twice about an axis is bent outwards at every edge. All is tested without
/// rounding; so a box whose sides are flat only to rounding is not convex. A mesh that is folded or has faces of three cells is not, nor
/// is one with cells without volume. Nor, by way of a bound on the work, is one with more than [`MOST_FACES`] boundary faces at a point.
pub(crate) fn is_convex(cells: Cells<'_>, adjacency: &FaceAdjacency) -> bool {
    let boundary = adjacency.boundary_faces();
    if boundary.is_empty() || !adjacency.non_manifold_faces().is_empty() || !lies_flat(cells, adjacency) {
        return false;
    }
    // Every edge with its face, so that the two of an edge come side by side.
    let mut edges: Vec<([u32; 2], u32)> = (0..)
        .zip(boundary)
        .flat_map(|(number, &face)| {
            let [a, b, c] = points_of(cells, face).0.map(|v| v.0);
            [[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], number))
        })
        .collect();
    edges.par_sort_unstable();
    let is_two = |pair: &[([u32; 2], u32)]| pair.len() == 2 && pair[0].0 == pair[1].0;
    let is_closed =
        edges.chunks(2).all(is_two) && edges.chunks(2).zip(edges.chunks(2).skip(1)).all(|(a, b)| a[0].0 != b[0].0);
    is_closed && is_connected(&edges, boundary.len()) && points_stand_out(cells, boundary)
}

/// Boundary faces at a point, beyond which a mesh does not count as convex. Each is compared with each.
const MOST_FACES: usize = 512;

/// Whether at every point of the boundary all of its faces lie behind the planes of all others.
fn points_stand_out(cells: Cells<'_>, boundary: &[CellFace]) -> bool {
    let mut corners: Vec<(VertexId, u32)> =
        (0..).zip(boundary).flat_map(|(number, &face)| points_of(cells, face).0.map(|point| (point, number))).collect();
    corners.par_sort_unstable();
    let position = |v: VertexId| cells.positions[v.index()];
    let around: Vec<&[(VertexId, u32)]> = corners.chunk_by(|a, b| a.0 == b.0).collect();
    around.into_par_iter().all(|around| {
        around.len() <= MOST_FACES
            && around.iter().all(|&(_, number)| {
                let (plane, apex) = points_of(cells, boundary[number as usize]);
                let inside = side_of(plane.map(position), position(apex));
                let is_behind =
                    |v: VertexId| plane.contains(&v) || side_of(plane.map(position), position(v)) * inside >= 0;
                inside != 0
                    && around
                        .iter()
                        .all(|&(_, other)| points_of(cells, boundary[other as usize]).0.into_iter().all(is_behind))
            })
    })
}

/// Whether the two cells of every face lie on different sides of it, whatever the order of their points.
fn lies_flat(cells: Cells<'_>, adjacency: &FaceAdjacency) -> bool {
    let position = |v: VertexId| cells.positions[v.index()];
    adjacency.table().par_iter().enumerate().all(|(cell, neighbors)| {
        (0..4).all(|corner| {
            let neighbor = neighbors[corner];
            // Each face once.
            if neighbor == FaceAdjacency::NONE || (neighbor as usize) < cell {
                return true;
            }
            let (face, apex) = points_of(cells, CellFace { cell: CellId(cell as u32), corner: corner as u8 });
            let other = cells.tetrahedra[neighbor as usize].into_iter().find(|v| !face.contains(v));
            let side = |v: VertexId| side_of(face.map(position), position(v));
            other.is_some_and(|other| side(apex) * side(other) < 0)
        })
    })
}

/// Whether the faces hang together by their edges.
fn is_connected(edges: &[([u32; 2], u32)], faces: usize) -> bool {
    let mut parent: Vec<u32> = (0..faces as u32).collect();
    let mut parts = faces;
    fn root(parent: &mut [u32], mut face: u32) -> u32 {
        while parent[face as usize] != face {
            parent[face as usize] = parent[parent[face as usize] as usize];
            face = parent[face as usize];
        }
        face
    }
    for pair in edges.chunks(2) {
        let [a, b] = [pair[0].1, pair[1].1].map(|face| root(&mut parent, face));
        if a != b {
            parent[a as usize] = b;
            parts -= 1;
        }
    }
    parts == 1
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn convex(points: &[DVec3], tetrahedra: &[[u32; 4]]) -> bool {
        let tetrahedra: Vec<_> = tetrahedra.iter().map(|t| t.map(VertexId)).collect();
        is_convex(Cells { positions: points, tetrahedra: &tetrahedra }, &FaceAdjacency::new(&tetrahedra))
    }

    #[test]
    fn bodies() {
        let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        assert!(convex(&corner, &[[0, 1, 2, 3]]));
        let far = [corner.to_vec(), corner.map(|p| p + 5.0).to_vec()].concat();
        assert!(!convex(&far, &[[0, 1, 2, 3], [4, 5, 6, 7]]), "two parts");
        let apex = |p: DVec3| [corner.to_vec(), vec![p]].concat();
        assert!(convex(&apex(DVec3::splat(0.4)), &[[0, 1, 2, 3], [1, 2, 3, 4]]));
        assert!(convex(&apex(DVec3::splat(4.0)), &[[0, 1, 2, 3], [1, 2, 3, 4]]), "a tip over the middle of the face");
        assert!(
            !convex(&apex(DVec3::new(1.0, 1.0, -0.5)), &[[0, 1, 2, 3], [1, 2, 3, 4]]),
            "a tip beyond the faces' planes"
        );
        assert!(!convex(&apex(-DVec3::splat(1.0)), &[[0, 1, 2, 3], [0, 1, 2, 4]]), "bent inwards");
        assert!(!convex(&[], &[]));
    }

    /// Five cells about an axis, each turned by two fifths from the last: closed, bent outwards at every edge, and wound twice.
    #[test]
    fn a_star_that_winds_twice_is_not_convex() {
        let around = |i: u32| {
            let angle = f64::from(i) * std::f64::consts::TAU / 5.0;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let points: Vec<DVec3> = [DVec3::Z, -DVec3::Z].into_iter().chain((0..5).map(around)).collect();
        let about = |step: u32| -> Vec<[u32; 4]> { (0..5).map(|i| [0, 1, 2 + i, 2 + (i + step) % 5]).collect() };
        assert!(convex(&points, &about(1)));
        assert!(!convex(&points, &about(2)));
    }

    #[test]
    fn the_order_of_points_in_a_cell_is_nothing() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.4)];
        for cells in [[[0, 1, 2, 3], [1, 2, 3, 4]], [[1, 0, 2, 3], [1, 2, 3, 4]], [[3, 1, 2, 0], [4, 3, 2, 1]]] {
            assert!(convex(&points, &cells), "{cells:?}");
        }
        // Folded: the second cell lies inside the first, and their common boundary is no tetrahedron's.
        let inside = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.1)];
        assert!(!convex(&inside, &[[0, 1, 2, 3], [1, 2, 3, 4]]));
        // A star of four cells about a point outside of their hull's first face: closed and convex outside, folded inside.
        let star = [[1, 2, 3, 4], [0, 2, 3, 4], [0, 1, 3, 4], [0, 1, 2, 4]];
        assert!(convex(&inside, &star));
        let outside = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.6)];
        assert!(!convex(&outside, &star));
    }

    #[test]
    fn flat_sides_are_convex() {
        let cube: Vec<DVec3> =
            (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
        let five = [[0, 3, 5, 6], [1, 0, 3, 5], [2, 0, 3, 6], [4, 0, 5, 6], [7, 3, 5, 6]];
        assert!(convex(&cube, &five));
        assert!(convex(&cube, &five[..4]), "a corner is cut off by a plane");
        assert!(!convex(&cube, &five[1..]), "the inside is missing: the parts touch in edges");
    }
}
