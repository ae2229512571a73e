//! Merged with the order across faces, the arrows give every ray its cells in the right order, and no false cycle.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec3, IVec3};
use proptest::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};
use tetrascope_view::Viewpoint;

use super::overlap::{Seen, is_before, overlap};
use super::*;
use crate::signs::{eye_side, side_of};

/// Points and cells.
#[derive(Clone, Debug, Default)]
struct Mesh {
    points: Vec<DVec3>,
    tetrahedra: Vec<[VertexId; 4]>,
}

/// The six ways through a cube from one corner to the opposite one: axes in their turn.
const WAYS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

impl Mesh {
    /// Cubes of side 1, each cut into six tetrahedra along its diagonal; points moved by up to `jitter` along each
    /// axis.
    ///
    /// Without jitter the cells are those of a regular triangulation of space, some left out, so there is no cycle; a
    /// jitter of a few percent leaves the lifted cells convex.
    fn cubes(size: i32, jitter: f64, is_full: impl Fn(IVec3) -> bool) -> Self {
        let mut mesh = Self::default();
        let mut numbers = BTreeMap::new();
        for place in (0..size * size * size).map(|i| IVec3::new(i % size, i / size % size, i / size / size)) {
            if !is_full(place) {
                continue;
            }
            for (turn, way) in WAYS.iter().enumerate() {
                let mut corner = place;
                let mut cell = [VertexId(0); 4];
                for (i, vertex) in cell.iter_mut().enumerate() {
                    *vertex = *numbers.entry(corner.to_array()).or_insert_with(|| {
                        let number = mesh.points.len() as u32;
                        mesh.points.push(corner.as_dvec3() + noise(u64::from(number)) * jitter);
                        VertexId(number)
                    });
                    if i < 3 {
                        corner[way[i]] += 1;
                    }
                }
                // Either way round: orders may not assume a positive volume.
                if turn % 3 == 0 {
                    cell.swap(0, 2);
                }
                mesh.tetrahedra.push(cell);
            }
        }
        mesh
    }

    fn add(&mut self, other: &Self, moved: impl Fn(DVec3) -> DVec3) {
        let first = self.points.len() as u32;
        self.points.extend(other.points.iter().map(|&p| moved(p)));
        self.tetrahedra.extend(other.tetrahedra.iter().map(|cell| cell.map(|v| VertexId(v.0 + first))));
    }

    fn cells(&self) -> Cells<'_> {
        Cells { positions: &self.points, tetrahedra: &self.tetrahedra }
    }

    fn corners(&self, cell: usize) -> [DVec3; 4] {
        self.tetrahedra[cell].map(|v| self.points[v.index()])
    }
}

/// Three numbers from -1 to 1 (SplitMix64).
fn noise(seed: u64) -> DVec3 {
    let number = |i: u64| {
        let mut z = (3 * seed + i).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    DVec3::new(number(0), number(1), number(2))
}

/// A name, the side of a box in cubes, and which of these are there.
type Shape = (&'static str, i32, fn(IVec3) -> bool);

/// Shapes in a box of cubes, each with gaps along some ray.
fn shapes() -> Vec<Shape> {
    vec![
        ("two parts", 5, |p| p.x < 2 || p.x > 2 && p.y < 3),
        ("through-hole", 4, |p| !(p.x == 1 || p.x == 2) || p.y != 1),
        ("nested shells", 5, |p| {
            let ring = (p - IVec3::splat(2)).abs().max_element();
            ring == 2 || ring == 0
        }),
        ("spiral", 7, |p| {
            // A wall that winds in, one layer high.
            const ROWS: [&str; 7] = ["#######", "......#", "#####.#", "#...#.#", "#.###.#", "#.....#", "#######"];
            p.z == 3 && ROWS[p.y as usize].as_bytes()[p.x as usize] == b'#'
        }),
        ("L", 4, |p| p.x < 1 || p.y < 1),
        ("cubes that touch in edges and points", 4, |p| (p.x + p.y + p.z) % 2 == 0),
    ]
}

/// The cells on a ray with more than 1e-6 in each, nearest first.
fn along_ray(mesh: &Mesh, origin: DVec3, direction: DVec3, from: f64) -> Vec<CellId> {
    let mut met: Vec<(f64, CellId)> = Vec::new();
    for cell in 0..mesh.tetrahedra.len() {
        let corners = mesh.corners(cell);
        let (mut start, mut end) = (from, f64::INFINITY);
        for i in 0..4 {
            let [a, b, c] = [1, 2, 3].map(|k| corners[(i + k) % 4]);
            let normal = (b - a).cross(c - a);
            let inward = normal * normal.dot(corners[i] - a).signum();
            let (height, slope) = (inward.dot(origin - a), inward.dot(direction));
            if slope > 0.0 {
                start = f64::max(start, -height / slope);
            } else if slope < 0.0 {
                end = f64::min(end, -height / slope);
            } else if height < 0.0 {
                end = f64::NEG_INFINITY;
            }
        }
        if end - start > 1e-6 {
            met.push((0.5 * (start + end), CellId(cell as u32)));
        }
    }
    met.sort_by(|a, b| a.0.total_cmp(&b.0));
    met.into_iter().map(|(_, cell)| cell).collect()
}

/// Arrows across shared faces between cells with a volume.
fn arrows_across_faces(mesh: &Mesh, adjacency: &FaceAdjacency, viewpoint: Viewpoint) -> Vec<(CellId, CellId)> {
    let mut arrows = Vec::new();
    for cell in 0..mesh.tetrahedra.len() {
        let corners = mesh.corners(cell);
        for i in 0..4 {
            let Some(neighbor) = adjacency.neighbor(CellId(cell as u32), i) else { continue };
            let face = [1, 2, 3].map(|k| corners[(i + k) % 4]);
            let (own, eye) = (side_of(face, corners[i]), eye_side(face, viewpoint));
            if own * eye > 0 {
                arrows.push((CellId(cell as u32), neighbor));
            }
        }
    }
    arrows
}

/// Kahn's algorithm: for every cell its place, or nothing if there is a cycle.
fn places(cells: usize, arrows: &[(CellId, CellId)]) -> Option<Vec<usize>> {
    let mut waits = vec![0; cells];
    let mut next = vec![Vec::new(); cells];
    for &(front, back) in arrows {
        waits[back.index()] += 1;
        next[front.index()].push(back.index());
    }
    let mut order: Vec<usize> = (0..cells).filter(|&cell| waits[cell] == 0).collect();
    let mut done = 0;
    while let Some(&cell) = order.get(done) {
        done += 1;
        for &back in &next[cell] {
            waits[back] -= 1;
            if waits[back] == 0 {
                order.push(back);
            }
        }
    }
    let mut places = vec![0; cells];
    order.iter().enumerate().for_each(|(place, &cell)| places[cell] = place);
    (done == cells).then_some(places)
}

fn arrows_of(tree: &BspTree, viewpoint: Viewpoint) -> (Vec<(CellId, CellId)>, ArrowReport) {
    let mut arrows = Vec::new();
    let report = tree.arrows(viewpoint, &mut |front, back| arrows.push((front, back)));
    assert_eq!(report.arrows, arrows.len());
    (arrows, report)
}

/// Every exit with every entry, without tree and tiles.
fn all_pairs(tree: &BspTree, viewpoint: Viewpoint) -> BTreeSet<(CellId, CellId)> {
    let seen: Vec<(Seen, CellId, bool)> = tree
        .faces
        .iter()
        .map(|f| (Seen { points: f.points, eye_side: eye_side(f.points, viewpoint) }, f.cell, f.cell_side))
        .map(|(seen, cell, cell_side)| (seen, cell, seen.eye_side == cell_side))
        .filter(|(seen, ..)| seen.eye_side != 0)
        .collect();
    let mut arrows = BTreeSet::new();
    for (front, a, _) in seen.iter().filter(|s| s.2) {
        for (back, b, _) in seen.iter().filter(|s| !s.2) {
            if overlap(viewpoint, front, back, false) && is_before(viewpoint, front, back) {
                arrows.insert((*a, *b));
            }
        }
    }
    arrows
}

/// From around the mesh, from inside it, from one of its points' planes, and along axes and other directions.
fn viewpoints(size: f64) -> Vec<Viewpoint> {
    let middle = DVec3::splat(0.5 * size);
    let mut viewpoints: Vec<Viewpoint> =
        (0..12).map(|i| Viewpoint::Eye(middle + noise(1000 + i) * size * if i % 2 == 0 { 0.6 } else { 2.5 })).collect();
    viewpoints.push(Viewpoint::Eye(DVec3::new(1.0, 2.0, -3.0)));
    viewpoints.push(Viewpoint::Eye(middle.floor()));
    viewpoints.extend((0..4).map(|i| Viewpoint::Direction(noise(2000 + i).normalize_or(DVec3::Z))));
    viewpoints.extend([DVec3::X, -DVec3::Z, DVec3::new(0.0, 0.6, 0.8)].map(Viewpoint::Direction));
    viewpoints
}

/// The order of the merged arrows along random rays, and the arrows against all pairs.
fn check_order(name: &str, mesh: &Mesh, size: f64) {
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let tree = BspTree::new(mesh.cells(), &adjacency);
    let mut pairs = 0;
    for (v, viewpoint) in viewpoints(size).into_iter().enumerate() {
        let (across, report) = arrows_of(&tree, viewpoint);
        assert!(report.is_complete, "{name}, {viewpoint:?}");
        if v % 4 == 0 {
            let expected: Vec<_> = all_pairs(&tree, viewpoint).into_iter().collect();
            assert_eq!(across, expected, "{name}, {viewpoint:?}");
        }
        let mut arrows = arrows_across_faces(mesh, &adjacency, viewpoint);
        arrows.extend(across);
        let places = places(mesh.tetrahedra.len(), &arrows).unwrap_or_else(|| panic!("cycle: {name}, {viewpoint:?}"));
        for r in 0..25 {
            let target = DVec3::splat(0.5 * size) + noise((v * 1000 + r) as u64) * 0.5 * size;
            let (origin, direction, from) = match viewpoint {
                Viewpoint::Eye(eye) => (eye, (target - eye).normalize_or(DVec3::X), 0.0),
                Viewpoint::Direction(direction) => (target, direction, -10.0 * size),
            };
            for pair in along_ray(mesh, origin, direction, from).windows(2) {
                let [front, back] = [pair[0], pair[1]].map(|cell| places[cell.index()]);
                assert!(front < back, "{name}, {viewpoint:?}, {pair:?}");
                pairs += 1;
            }
        }
    }
    assert!(pairs > 200, "{name}: only {pairs} pairs seen");
}

#[test]
fn gaps_are_ordered_in_every_shape() {
    for (name, size, is_full) in shapes() {
        for jitter in [0.0, 0.04] {
            check_order(name, &Mesh::cubes(size, jitter, is_full), f64::from(size));
        }
    }
}

/// Two blocks that touch in a plane with other diagonals and points of their own: only the plane orders them.
#[test]
fn gaps_of_no_width_are_ordered() {
    let block = Mesh::cubes(2, 0.0, |_| true);
    let mut mesh = block.clone();
    mesh.add(&block, |p| DVec3::new(2.0 + p.x, 2.0 - p.y, p.z));
    // And one that touches both with cubes of another size.
    mesh.add(&block, |p| DVec3::new(2.0 * p.x, p.y, 2.0 + p.z));
    check_order("blocks that touch", &mesh, 4.0);
}

/// The example of the module's text: one convex block, cut askew by the plane of another part's face.
#[test]
fn plane_through_a_block_makes_no_cycle() {
    let block = Mesh::cubes(3, 0.0, |_| true);
    let mut mesh = block.clone();
    mesh.add(&Mesh::cubes(1, 0.0, |_| true), |p| DVec3::new(4.0 + p.x, p.y + p.x, p.z + 0.7 * p.x));
    check_order("block and askew cube", &mesh, 5.0);
}

#[test]
fn convex_mesh_has_nothing_to_compare() {
    let mesh = Mesh::cubes(6, 0.0, |_| true);
    let tree = BspTree::new(mesh.cells(), &FaceAdjacency::new(&mesh.tetrahedra));
    for viewpoint in viewpoints(6.0) {
        let (arrows, _) = arrows_of(&tree, viewpoint);
        assert!(arrows.is_empty(), "{viewpoint:?}");
    }
    let (_, report) = arrows_of(&tree, Viewpoint::Eye(DVec3::new(-3.0, 9.0, 20.0)));
    assert_eq!(report.compared, 0);
}

/// Whatever the ray, an exit or entry that it meets first has a fragment that comes first.
#[test]
fn fragments_come_front_to_back() {
    let mesh = Mesh::cubes(5, 0.04, |p| (p - IVec3::splat(2)).abs().max_element() != 1);
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let tree = BspTree::new(mesh.cells(), &adjacency);
    assert!(tree.report().is_complete());
    let middle = DVec3::splat(2.5);
    // Cells of the inner cube are seen behind the near wall and before the far one.
    let is_inner = |cell: CellId| (mesh.cells().centroid(cell) - middle).abs().max_element() < 0.6;
    for viewpoint in viewpoints(5.0) {
        let Viewpoint::Eye(eye) = viewpoint else { continue };
        let mut fragments = Vec::new();
        tree.front_to_back(viewpoint, &mut |fragment| fragments.push(fragment));
        let entries = |cell: CellId| {
            fragments.iter().enumerate().filter(move |(_, f)| f.cell == cell && f.faces_eye).map(|(i, _)| i)
        };
        let exits = |cell: CellId| {
            fragments.iter().enumerate().filter(move |(_, f)| f.cell == cell && !f.faces_eye).map(|(i, _)| i)
        };
        let inner: Vec<CellId> = (0..mesh.tetrahedra.len() as u32).map(CellId).filter(|&c| is_inner(c)).collect();
        for r in 0..40 {
            let target = middle + noise(r) * 0.4;
            let met = along_ray(&mesh, eye, (target - eye).normalize_or(DVec3::X), 0.0);
            for pair in met.windows(2) {
                // A step into the inner cube or out of it is a step across the gap.
                if inner.contains(&pair[0]) != inner.contains(&pair[1]) {
                    let first_exit = exits(pair[0]).min().unwrap();
                    let last_entry = entries(pair[1]).max().unwrap();
                    assert!(first_exit < last_entry, "{viewpoint:?}, {pair:?}");
                }
            }
        }
    }
}

/// Thousands of faces in one plane take one node.
#[test]
fn coplanar_faces_share_nodes() {
    let size = 40;
    let mesh = Mesh::cubes(size, 0.0, |p| p.z == 0 || p.z == 2 && p.x % 2 == 0);
    let tree = BspTree::new(mesh.cells(), &FaceAdjacency::new(&mesh.tetrahedra));
    let report = tree.report();
    assert!(report.faces > 9000 && report.is_complete(), "{report:?}");
    assert!(report.fragments < 2 * report.faces && report.depth < 150, "{report:?}");
    let (arrows, counts) = arrows_of(&tree, Viewpoint::Eye(DVec3::new(20.0, 30.0, 50.0)));
    assert!(counts.is_complete && !arrows.is_empty());
}

/// A round surface has no plane of its own that halves it.
#[test]
fn round_surface_makes_no_list() {
    let size = 24;
    let mut mesh = Mesh::cubes(size, 0.0, |p| p.x % 23 == 0 || p.y % 23 == 0 || p.z % 23 == 0);
    for p in &mut mesh.points {
        let cube = (*p - 12.0) / 12.0;
        *p = cube.normalize_or(DVec3::X) * (1.0 + 0.2 * cube.abs().max_element());
    }
    let tree = BspTree::new(mesh.cells(), &FaceAdjacency::new(&mesh.tetrahedra));
    let report = tree.report();
    assert!(report.faces > 6000 && report.is_complete(), "{report:?}");
    assert!(report.depth < 100 && report.fragments < 4 * report.faces, "{report:?}");
}

/// Cells without volume between two parts, points that are there twice, cells that name a point twice.
#[test]
fn flat_cells_are_seen_through() {
    let mut mesh = Mesh::cubes(3, 0.0, |p| p.x != 1);
    let first = mesh.tetrahedra.len();
    // Flat cells on faces of the mesh.
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    for face in adjacency.boundary_faces().iter().take(20) {
        let mut cell = mesh.tetrahedra[face.cell.index()];
        let others: Vec<VertexId> = (0..4).filter(|&i| i != usize::from(face.corner)).map(|i| cell[i]).collect();
        let middle = (mesh.points[others[0].index()] + mesh.points[others[1].index()]) * 0.5;
        cell[usize::from(face.corner)] = VertexId(mesh.points.len() as u32);
        mesh.points.push(middle);
        mesh.tetrahedra.push(cell);
    }
    mesh.tetrahedra.push([0, 0, 1, 2].map(VertexId));
    mesh.tetrahedra.push([3, 3, 3, 3].map(VertexId));
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let tree = BspTree::new(mesh.cells(), &adjacency);
    assert_eq!(tree.report().flat_cells, 22);
    let mut whole = mesh.clone();
    whole.tetrahedra.truncate(first);
    let without = BspTree::new(whole.cells(), &FaceAdjacency::new(&whole.tetrahedra));
    for viewpoint in viewpoints(3.0) {
        assert_eq!(arrows_of(&tree, viewpoint), arrows_of(&without, viewpoint), "{viewpoint:?}");
    }
}

#[test]
fn nothing_gives_nothing() {
    let mesh = Mesh::default();
    let tree = BspTree::new(mesh.cells(), &FaceAdjacency::new(&mesh.tetrahedra));
    assert_eq!(tree.report(), TreeReport::default());
    let (arrows, report) = arrows_of(&tree, Viewpoint::Direction(DVec3::Z));
    assert!(arrows.is_empty() && report.is_complete);
}

/// The tree is cut off where a thousand faces go through one another; arrows are what all pairs give nevertheless.
#[test]
fn interpenetrating_cells_stay_bounded() {
    let mut mesh = Mesh::default();
    for cell in 0..150 {
        // Long and thin, all through the middle.
        let (end, across) = (noise(3 * cell), noise(3 * cell + 1) * 0.05);
        let wide = noise(3 * cell + 2) * 0.05;
        let first = mesh.points.len() as u32;
        mesh.points.extend([end, -end, -end + across, -end + wide]);
        mesh.tetrahedra.push([0, 1, 2, 3].map(|i| VertexId(first + i)));
    }
    let tree = BspTree::new(mesh.cells(), &FaceAdjacency::new(&mesh.tetrahedra));
    let report = tree.report();
    assert!(report.fragments <= 8 * report.faces, "{report:?}");
    for viewpoint in viewpoints(1.0) {
        let (arrows, counts) = arrows_of(&tree, viewpoint);
        assert!(counts.is_complete);
        for (front, back) in all_pairs(&tree, viewpoint) {
            assert!(arrows.contains(&(front, back)), "{viewpoint:?}");
        }
    }
}

#[test]
fn same_for_any_number_of_threads() {
    let mesh = Mesh::cubes(12, 0.04, |p| (p.x + p.y) % 3 != 0 || p.z % 4 == 0);
    let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let tree = BspTree::new(mesh.cells(), &adjacency);
            (tree.report(), arrows_of(&tree, Viewpoint::Eye(DVec3::new(4.3, 5.1, 20.0))))
        })
    };
    let one = run(1);
    assert!(one.0.faces > 2000 && !one.1.0.is_empty());
    assert!(one == run(2) && one == run(3));
}

/// Cones that are no polygons on a common plane: one triangle before the eye, and one behind it.
#[test]
fn triangles_on_both_sides_of_the_eye_do_not_overlap() {
    let seen = |points: [[f64; 3]; 3]| {
        let points = points.map(DVec3::from);
        Seen { points, eye_side: eye_side(points, Viewpoint::Eye(DVec3::ZERO)) }
    };
    let before = seen([[0.0, 2.0, 1.0], [-2.0, -1.0, 1.0], [2.0, -1.0, 1.0]]);
    // Seen through the eye the two make a star with six points: no edge parts them.
    let behind = seen([[0.0, 2.0, -1.0], [-2.0, -1.0, -1.0], [2.0, -1.0, -1.0]]);
    let eye = Viewpoint::Eye(DVec3::ZERO);
    assert!(!overlap(eye, &before, &behind, false));
    let farther = seen([[0.0, 4.0, 3.0], [-4.0, -2.0, 3.0], [4.0, -2.0, 3.0]]);
    assert!(overlap(eye, &before, &farther, false));
    assert!(is_before(eye, &before, &farther) && !is_before(eye, &farther, &before));
}

fn point() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0_f64).prop_map(DVec3::from)
}

proptest! {
    /// Which triangle a ray meets first, by the predicates and by the ray. Triangles that a common ray meets overlap.
    #[test]
    fn predicates_agree_with_rays(a in [point(), point(), point()], b in [point(), point(), point()], eye in point(),
                                  u in 0.1..0.4, v in 0.1..0.4, parallel: bool) {
        let target: DVec3 = a[0] + (a[1] - a[0]) * u + (a[2] - a[0]) * v;
        let direction = (target - eye).normalize_or(DVec3::X);
        let viewpoint = if parallel { Viewpoint::Direction(direction) } else { Viewpoint::Eye(eye) };
        let [first, second] = [a, b].map(|points| Seen { points, eye_side: eye_side(points, viewpoint) });
        prop_assume!(first.eye_side != 0 && second.eye_side != 0);
        // Where the ray meets the second one, in its own coordinates.
        let normal = (b[1] - b[0]).cross(b[2] - b[0]);
        let t = normal.dot(b[0] - eye) / normal.dot(direction);
        let inside = (0..3).all(|i| {
            let edge = b[(i + 1) % 3] - b[i];
            normal.cross(edge).dot(eye + direction * t - b[i]) > 1e-9
        });
        let distance = (target - eye).length();
        if inside && (parallel || t > 1e-9) {
            prop_assert!(overlap(viewpoint, &first, &second, false) && overlap(viewpoint, &second, &first, false));
            if distance < t - 1e-9 {
                prop_assert!(is_before(viewpoint, &first, &second));
            } else if t < distance - 1e-9 {
                prop_assert!(is_before(viewpoint, &second, &first));
            }
        }
    }

    /// Random cubes out of a box, from random eyes: as all pairs.
    #[test]
    fn arrows_are_those_of_all_pairs(
        full in prop::collection::vec(any::<bool>(), 27), eye in point(), far: bool, jitter in 0.0..0.05,
    ) {
        let mesh = Mesh::cubes(3, jitter, |p| full[(p.x + 3 * p.y + 9 * p.z) as usize]);
        let adjacency = FaceAdjacency::new(&mesh.tetrahedra);
        let tree = BspTree::new(mesh.cells(), &adjacency);
        let viewpoint = Viewpoint::Eye(1.5 + eye * if far { 8.0 } else { 1.5 });
        let (mut arrows, report) = arrows_of(&tree, viewpoint);
        prop_assert!(report.is_complete);
        prop_assert_eq!(&arrows, &all_pairs(&tree, viewpoint).into_iter().collect::<Vec<_>>());
        arrows.extend(arrows_across_faces(&mesh, &adjacency, viewpoint));
        prop_assert!(places(mesh.tetrahedra.len(), &arrows).is_some(), "cycle");
    }
}
