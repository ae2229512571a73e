//! Boundary faces that pierce one another: parts of a mesh that stand in each other.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::{FaceAdjacency, VertexId};

use crate::Cells;
use crate::bsp::side_of;
use crate::convex::points_of;

/// Pairs of boundary faces of which one passes through the inside of the other.
///
/// Where cells overlap no order is right, and orders do not look for it: a ray is in both at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piercing {
    /// Pairs found. Faces that touch, lie in one plane, or meet in their edges alone do not count.
    pub pairs: usize,
    /// Whether all pairs were looked at; with very many long faces all across each other the search ends early.
    pub is_complete: bool,
}

/// Boxes compared for one face on average, beyond which the search ends. Meshes in use need some tens.
const VISITS_PER_FACE: usize = 2000;

/// Faces in a leaf of the tree.
const LEAF: usize = 4;

#[derive(Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    const NOTHING: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn around(triangle: &[DVec3; 3]) -> Self {
        triangle.iter().fold(Self::NOTHING, |all, &p| Self { low: all.low.min(p), high: all.high.max(p) })
    }

    fn and(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}

/// Looks at all boundary faces. Exact for each pair; the same for any number of threads.
pub(crate) fn piercing(cells: Cells<'_>, adjacency: &FaceAdjacency) -> Piercing {
    let position = |v: VertexId| cells.positions[v.index()];
    let mut triangles: Vec<[DVec3; 3]> =
        adjacency.boundary_faces().par_iter().map(|&face| points_of(cells, face).0.map(position)).collect();
    let tree = Tree::new(&mut triangles);
    let counts: Vec<(usize, usize)> = (0..triangles.len())
        .into_par_iter()
        .map(|number| {
            let bounds = Bounds::around(&triangles[number]);
            let (mut pairs, mut visits) = (0, 0);
            tree.visit(0, &bounds, &mut visits, &mut |other| {
                // Each pair once.
                pairs += usize::from(other > number && pierce(&triangles[number], &triangles[other]));
            });
            (pairs, visits)
        })
        .collect();
    Piercing {
        pairs: counts.iter().map(|(pairs, _)| pairs).sum(),
        is_complete: counts.iter().all(|&(_, visits)| visits < VISITS_PER_FACE * LEAF),
    }
}

/// Whether an edge of one triangle passes through the inside of the other.
fn pierce(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    let crosses = |p: DVec3, q: DVec3, face: &[DVec3; 3]| {
        if side_of(*face, p) * side_of(*face, q) >= 0 {
            return false;
        }
        let sides = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| side_of([p, q, face[i]], face[j]));
        sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2]
    };
    let has_edge_through = |from: &[DVec3; 3], face: &[DVec3; 3]| {
        [[0, 1], [1, 2], [2, 0]].iter().any(|&[i, j]| crosses(from[i], from[j], face))
    };
    has_edge_through(a, b) || has_edge_through(b, a)
}

/// Boxes around boxes, halved along the longest side; the triangles stand in the order of the leaves.
struct Tree {
    /// A node's box, its first and last triangle, and its two children, if it has any.
    nodes: Vec<(Bounds, [usize; 2], Option<[usize; 2]>)>,
}

impl Tree {
    fn new(triangles: &mut [[DVec3; 3]]) -> Self {
        let mut tree = Self { nodes: Vec::new() };
        tree.add(triangles, 0);
        tree
    }

    /// Adds the node of some triangles, of which the first has the number `start`.
    fn add(&mut self, triangles: &mut [[DVec3; 3]], start: usize) -> usize {
        let bounds = triangles.iter().map(Bounds::around).fold(Bounds::NOTHING, Bounds::and);
        let index = self.nodes.len();
        self.nodes.push((bounds, [start, start + triangles.len()], None));
        if triangles.len() > LEAF {
            let side = bounds.high - bounds.low;
            let axis = (0..3).max_by(|&i, &j| side[i].total_cmp(&side[j])).unwrap_or(0);
            let middle = triangles.len() / 2;
            let center = |t: &[DVec3; 3]| t[0][axis] + t[1][axis] + t[2][axis];
            triangles.select_nth_unstable_by(middle, |a, b| center(a).total_cmp(&center(b)));
            let (first, second) = triangles.split_at_mut(middle);
            let children = [self.add(first, start), self.add(second, start + middle)];
            self.nodes[index].2 = Some(children);
        }
        index
    }

    fn visit(&self, node: usize, bounds: &Bounds, visits: &mut usize, sink: &mut impl FnMut(usize)) {
        let (own, [start, end], children) = &self.nodes[node];
        if *visits >= VISITS_PER_FACE * LEAF || !own.meets(bounds) {
            return;
        }
        match children {
            Some(children) => children.iter().for_each(|&child| self.visit(child, bounds, visits, sink)),
            None => {
                *visits += end - start;
                (*start..*end).for_each(sink);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(points: &[DVec3], tetrahedra: &[[u32; 4]]) -> usize {
        let tetrahedra: Vec<_> = tetrahedra.iter().map(|t| t.map(VertexId)).collect();
        let found = piercing(Cells { positions: points, tetrahedra: &tetrahedra }, &FaceAdjacency::new(&tetrahedra));
        assert!(found.is_complete);
        found.pairs
    }

    #[test]
    fn faces_that_touch_do_not_pierce() {
        let corner = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let beside = |away: DVec3| [corner.to_vec(), corner.map(|p| p + away).to_vec()].concat();
        let two = [[0, 1, 2, 3], [4, 5, 6, 7]];
        assert_eq!(count(&[], &[]), 0);
        assert_eq!(count(&corner, &two[..1]), 0);
        // Apart, in a point, in one place.
        for away in [DVec3::X * 2.0, DVec3::X, DVec3::ZERO] {
            assert_eq!(count(&beside(away), &two), 0, "{away}");
        }
        assert!(count(&beside(DVec3::splat(0.1)), &two) > 0);
        // Neighbors share a face and its edges.
        let pair = [corner.to_vec(), vec![DVec3::splat(1.0)]].concat();
        assert_eq!(count(&pair, &[[0, 1, 2, 3], [1, 2, 3, 4]]), 0);
        // A tip that comes back through the first cell.
        let back = [corner.to_vec(), vec![DVec3::splat(-1.0)]].concat();
        assert_eq!(count(&back, &[[0, 1, 2, 3], [1, 2, 3, 4]]), 0, "it lies around the first cell and pierces nothing");
    }

    #[test]
    fn every_pair_is_found_once() {
        // A row of thin needles through one large face.
        let mut points = vec![DVec3::new(-9.0, -9.0, 0.0), DVec3::new(9.0, -9.0, 0.0), DVec3::new(0.0, 9.0, 0.0)];
        points.push(DVec3::new(0.0, 0.0, -9.0));
        let mut tetrahedra = vec![[0, 1, 2, 3]];
        for needle in 0..40 {
            let place = DVec3::new(f64::from(needle) * 0.1 - 2.0, 0.03, 0.0);
            let first = points.len() as u32;
            points.extend(
                [(0.0, 0.0, 0.5), (0.01, 0.0, -0.1), (0.0, 0.01, -0.1), (0.01, 0.01, -0.1)]
                    .map(|(x, y, z)| place + DVec3::new(x, y, z)),
            );
            tetrahedra.push([0, 1, 2, 3].map(|i| first + i));
        }
        // The tip is above the face, the rest below: three faces of each needle pass through it.
        assert_eq!(count(&points, &tetrahedra), 3 * 40);
    }
}
