//! Cells that overlap: where a ray is in two cells at once, no order is right.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::{CellFace, CellId, FaceAdjacency, VertexId};

use crate::Cells;
use crate::convex::points_of;
use crate::signs::side_of;
use crate::touching::{CellSide, Touch};

/// Where cells of a mesh overlap. A ray that is in two cells at once has no order for them, whoever sorts; sorting along every ray
/// by the middles of segments is at least the same from one picture to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overlaps {
    /// Pairs of cells on the same side of a face that they share: the mesh is folded there, or cells are there twice.
    pub folded: usize,
    /// Pairs of boundary faces of which one passes through the inside of the other. Faces that touch, lie in one plane, or meet in their
    /// edges alone do not count.
    pub piercing: usize,
    /// Parts of the mesh that lie inside the cells of others.
    pub contained: usize,
    /// Whether everything was looked at. With very many long faces all across each other, or very many parts, the search ends early.
    pub is_complete: bool,
}

impl Overlaps {
    /// Whether cells are known to overlap.
    pub fn any(&self) -> bool {
        self.folded > 0 || self.piercing > 0 || self.contained > 0
    }
}

/// Looks for overlaps: shared faces and boundary, not every cell against every other. Gives also what touches but for rounding, which is
/// no overlap.
///
/// Exact where it looks; the same for any number of threads. `folded`: of [`folded_pairs`].
pub(crate) fn overlaps(cells: Cells<'_>, adjacency: &FaceAdjacency, folded: usize) -> (Overlaps, Vec<Touch>) {
    let boundary = Boundary::new(cells, adjacency);
    let (piercing, touching, all_faces) = boundary.meetings();
    let (contained, all_parts) = boundary.contained(cells, adjacency);
    (Overlaps { folded, piercing, contained, is_complete: all_faces && all_parts }, touching)
}

/// Pairs of cells that lie on the same side of a face which both have, each once, ascending.
///
/// Exact. A cell without volume overlaps nothing.
pub(crate) fn folded_pairs(cells: Cells<'_>, adjacency: &FaceAdjacency) -> Vec<(CellId, CellId)> {
    let side = |face: CellFace| {
        let (mut points, apex) = points_of(cells, face);
        // Both cells ask about the same plane.
        points.sort_unstable();
        side_of(points.map(|v| cells.positions[v.index()]), cells.positions[apex.index()])
    };
    let mut pairs: Vec<(CellId, CellId)> = adjacency
        .table()
        .par_iter()
        .enumerate()
        .flat_map_iter(|(cell, neighbors)| {
            let here = CellId(cell as u32);
            (0..4_u8).filter_map(move |corner| {
                let other = CellId(neighbors[usize::from(corner)]);
                if other.0 == FaceAdjacency::NONE || other <= here {
                    return None;
                }
                let face = CellFace { cell: here, corner };
                let [a, b, c] = points_of(cells, face).0;
                let corners = cells.tetrahedra[other.index()];
                let away = (0..4_u8).find(|&i| ![a, b, c].contains(&corners[usize::from(i)]))?;
                let (mine, theirs) = (side(face), side(CellFace { cell: other, corner: away }));
                (mine != 0 && mine == theirs).then_some((here, other))
            })
        })
        .collect();
    for shared in adjacency.non_manifold_faces() {
        let sides: Vec<(CellId, i8)> = shared.iter().map(|&face| (face.cell, side(face))).collect();
        // A few cells; of a thousand about one face each overlaps the next.
        for (place, &(cell, mine)) in sides.iter().enumerate() {
            let next =
                sides[place + 1..].iter().filter(|&&(_, theirs)| mine != 0 && theirs == mine).take(MOST_AT_A_FACE);
            pairs.extend(next.map(|&(other, _)| (cell.min(other), cell.max(other))));
        }
    }
    let has_volume = |cell: CellId| side(CellFace { cell, corner: 0 }) != 0;
    pairs.extend(adjacency.duplicates().iter().filter(|pair| has_volume(pair[0])).map(|&[a, b]| (a.min(b), a.max(b))));
    pairs.par_sort_unstable();
    pairs.dedup();
    pairs
}

/// Pairs as relations: each cell hides the other.
pub(crate) fn both_ways(pairs: &[(CellId, CellId)]) -> Vec<(CellId, CellId)> {
    let mut relations: Vec<(CellId, CellId)> = pairs.iter().flat_map(|&(a, b)| [(a, b), (b, a)]).collect();
    relations.par_sort_unstable();
    relations
}

/// Cells at one face that one of them is paired with: enough that all hang together, however many there are.
const MOST_AT_A_FACE: usize = 8;

/// Triangles that the search for piercing faces looks at for one face on average, and in any case, beyond which it ends. Meshes in use
/// need some tens.
const VISITS_PER_FACE: usize = 500;
const VISITS: usize = 1 << 22;

/// Faces looked at between two looks at the budget.
const CHUNK: usize = 1 << 12;

/// How far rays from the middles of parts run askew.
const SKEWS: [[f64; 2]; 2] = [[7.391e-4, -5.547e-4], [-3.717e-4, 8.839e-4]];

/// Parts that are looked for inside others.
const PARTS: usize = 1 << 12;

/// Faces in a leaf of the tree.
const LEAF: usize = 4;

#[derive(Clone, Copy)]
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    const NOTHING: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    fn around(points: &[DVec3]) -> Self {
        points.iter().fold(Self::NOTHING, |all, &p| Self { low: all.low.min(p), high: all.high.max(p) })
    }

    fn and(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}

/// A boundary face.
#[derive(Clone, Copy)]
struct Outer {
    side: CellSide,
    numbers: [VertexId; 3],
}

/// A box around some of the boundary faces.
struct Node {
    bounds: Bounds,
    faces: std::ops::Range<usize>,
    children: Option<[usize; 2]>,
}

/// The boundary faces in boxes around boxes, halved along the longest side; they stand in the order of the leaves.
struct Boundary {
    faces: Vec<Outer>,
    nodes: Vec<Node>,
}

impl Boundary {
    fn new(cells: Cells<'_>, adjacency: &FaceAdjacency) -> Self {
        let position = |v: VertexId| cells.positions[v.index()];
        let mut faces: Vec<Outer> = adjacency
            .boundary_faces()
            .par_iter()
            .map(|&face| {
                let (numbers, apex) = points_of(cells, face);
                let points = numbers.map(position);
                let apex = position(apex);
                let side = CellSide { points, apex, cell: face.cell, cell_side: side_of(points, apex) };
                Outer { side, numbers }
            })
            .collect();
        let mut nodes = Vec::new();
        grow(&mut nodes, &mut faces, 0);
        Self { faces, nodes }
    }

    /// How many pairs of faces pierce each other, those that touch but for rounding, and whether all were looked at.
    fn meetings(&self) -> (usize, Vec<Touch>, bool) {
        let budget = VISITS + VISITS_PER_FACE * self.faces.len();
        let largest =
            self.nodes.first().map_or(0.0, |all| all.bounds.low.abs().max(all.bounds.high.abs()).max_element());
        let (mut pairs, mut touching, mut visits) = (0, Vec::new(), 0);
        for start in (0..self.faces.len()).step_by(CHUNK) {
            if visits > budget {
                return (pairs, touching, false);
            }
            let found = (start..self.faces.len().min(start + CHUNK)).into_par_iter().map(|number| {
                let face = &self.faces[number];
                let bounds = Bounds::around(&face.side.points);
                let (mut pairs, mut touching, mut visits) = (0, Vec::new(), 0);
                self.visit(0, &bounds, &mut |place| {
                    visits += 1;
                    let other = &self.faces[place];
                    // Each pair once.
                    if place <= number || !bounds.meets(&Bounds::around(&other.side.points)) {
                        return;
                    }
                    // Two with a common edge meet there alone, or lie in one plane.
                    let shared = other.numbers.iter().filter(|number| face.numbers.contains(number)).count();
                    pairs += usize::from(shared < 2 && pierce(&face.side.points, &other.side.points));
                    touching.extend(Touch::of(&face.side, &other.side, largest));
                });
                (pairs, touching, visits)
            });
            // Collected, so that the order does not depend on threads.
            for (more, also, looks) in found.collect::<Vec<_>>() {
                (pairs, visits) = (pairs + more, visits + looks);
                touching.extend(also);
            }
        }
        (pairs, touching, true)
    }

    /// Parts of which a cell lies inside another part, and whether all were looked at.
    fn contained(&self, cells: Cells<'_>, adjacency: &FaceAdjacency) -> (usize, bool) {
        let part_of = parts(adjacency);
        let mut firsts: Vec<CellId> =
            (0..part_of.len() as u32).map(CellId).filter(|c| part_of[c.index()] == c.0).collect();
        if firsts.len() < 2 {
            return (0, true);
        }
        let is_complete = firsts.len() <= PARTS;
        firsts.truncate(PARTS);
        let count = firsts.par_iter().filter(|&&first| self.is_inside_another(cells, first, &part_of)).count();
        (count, is_complete)
    }

    /// Whether a cell's middle lies inside another part: a ray from there leaves it more often than it enters it. Two rays have to say
    /// so, as one may run through an edge, where nothing is counted.
    fn is_inside_another(&self, cells: Cells<'_>, cell: CellId, part_of: &[u32]) -> bool {
        let Some(Node { bounds, .. }) = self.nodes.first() else { return false };
        let middle = cells.centroid(cell);
        let length = 2.0 * (bounds.high - bounds.low).max_element();
        // Along an axis, so that few boxes are met; askew, as meshes have edges along axes.
        SKEWS.iter().all(|&[y, z]| {
            let far = middle + DVec3::new(1.0, y, z) * length;
            let mut depth = 0;
            self.visit(0, &Bounds::around(&[middle, far]), &mut |number| {
                let face = &self.faces[number];
                let CellSide { points, cell_side, .. } = face.side;
                if part_of[face.side.cell.index()] != part_of[cell.index()] && crosses(middle, far, &points) {
                    depth += if side_of(points, middle) == cell_side { 1 } else { -1 };
                }
            });
            depth > 0
        })
    }

    /// Visits the faces of all leaves that a box meets.
    fn visit(&self, node: usize, bounds: &Bounds, sink: &mut impl FnMut(usize)) {
        let Some(node) = self.nodes.get(node) else { return };
        if !node.bounds.meets(bounds) {
            return;
        }
        match &node.children {
            Some(children) => children.iter().for_each(|&child| self.visit(child, bounds, sink)),
            None => node.faces.clone().for_each(sink),
        }
    }
}

/// Adds the node of some faces, of which the first has the number `start`.
fn grow(nodes: &mut Vec<Node>, faces: &mut [Outer], start: usize) -> usize {
    let bounds = faces.iter().map(|face| Bounds::around(&face.side.points)).fold(Bounds::NOTHING, Bounds::and);
    let index = nodes.len();
    nodes.push(Node { bounds, faces: start..start + faces.len(), children: None });
    if faces.len() > LEAF {
        let side = bounds.high - bounds.low;
        let axis = (0..3).max_by(|&i, &j| side[i].total_cmp(&side[j])).unwrap_or(0);
        let middle = faces.len() / 2;
        let center = |face: &Outer| face.side.points.iter().map(|p| p[axis]).sum::<f64>();
        faces.select_nth_unstable_by(middle, |a, b| center(a).total_cmp(&center(b)));
        let (first, second) = faces.split_at_mut(middle);
        let children = [grow(nodes, first, start), grow(nodes, second, start + middle)];
        nodes[index].children = Some(children);
    }
    index
}

/// For every cell the first cell of its part: cells that hang together by faces.
fn parts(adjacency: &FaceAdjacency) -> Vec<u32> {
    let table = adjacency.table();
    let mut part_of = vec![u32::MAX; table.len()];
    let mut open = Vec::new();
    for first in 0..table.len() {
        if part_of[first] != u32::MAX {
            continue;
        }
        part_of[first] = first as u32;
        open.push(first);
        while let Some(cell) = open.pop() {
            for &next in table[cell].iter().filter(|&&next| next != FaceAdjacency::NONE) {
                if part_of[next as usize] == u32::MAX {
                    part_of[next as usize] = first as u32;
                    open.push(next as usize);
                }
            }
        }
    }
    part_of
}

/// Whether a segment passes through the inside of a triangle. Exact; touching its rim does not count.
fn crosses(p: DVec3, q: DVec3, face: &[DVec3; 3]) -> bool {
    if side_of(*face, p) * side_of(*face, q) >= 0 {
        return false;
    }
    let sides = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| side_of([p, q, face[i]], face[j]));
    sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2]
}

/// Whether an edge of one triangle passes through the inside of the other.
fn pierce(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    let has_edge_through = |from: &[DVec3; 3], face: &[DVec3; 3]| {
        [[0, 1], [1, 2], [2, 0]].iter().any(|&[i, j]| crosses(from[i], from[j], face))
    };
    has_edge_through(a, b) || has_edge_through(b, a)
}
