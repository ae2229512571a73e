//! What has no right order, or hardly one, gets an order all the same, and a report.

use glam::{DQuat, DVec3};
use tetrascope::mesh::{CellId, VertexId};
use tetrascope::order::{Cells, CycleRemedy, MeshVisibility, OrderMethod};
use tetrascope::view::Viewpoint;
use tetrascope_tests::meshes::{Random, grid};

/// Every order of cells that there is.
const METHODS: [OrderMethod; 6] = [
    OrderMethod::None,
    OrderMethod::Bucket { slabs: 20 },
    OrderMethod::Centroid,
    OrderMethod::Power,
    OrderMethod::Mpvo,
    OrderMethod::BspXmpvo,
];

/// Cells without any check.
#[derive(Default)]
struct Raw {
    points: Vec<DVec3>,
    tetrahedra: Vec<[VertexId; 4]>,
}

impl Raw {
    fn cells(&self) -> Cells<'_> {
        Cells { positions: &self.points, tetrahedra: &self.tetrahedra }
    }

    /// Adds a cell with points of its own.
    fn add(&mut self, corners: [DVec3; 4]) {
        let first = self.points.len() as u32;
        self.points.extend(corners);
        self.tetrahedra.push([0, 1, 2, 3].map(|i| VertexId(first + i)));
    }

    /// Adds a grid of cubes, turned.
    fn add_grid(&mut self, side: usize, turn: DQuat) {
        let mesh = grid([side; 3], DVec3::splat(-0.5), 1.0 / side as f64).mesh;
        let first = self.points.len() as u32;
        self.points.extend(mesh.positions().iter().map(|&p| turn * mesh.frame().to_world(p)));
        self.tetrahedra.extend(mesh.tetrahedra().iter().map(|t| t.map(|v| VertexId(v.0 + first))));
    }
}

fn viewpoints() -> Vec<Viewpoint> {
    let mut random = Random::new(7);
    let mut views: Vec<Viewpoint> = (0..4).map(|_| Viewpoint::Eye(random.point() * 3.0)).collect();
    // In planes of the meshes, on their points, along their axes.
    views.extend([DVec3::ZERO, DVec3::new(5.0, 0.25, 0.0), DVec3::new(0.5, 0.5, 0.5)].map(Viewpoint::Eye));
    views.extend(DVec3::AXES.map(Viewpoint::Direction));
    views
}

/// All orders are permutations, and so is what remains after cuts. Gives the numbers of cells in rings, view by view, by `bsp-xmpvo`.
fn check(raw: &Raw, name: &str) -> Vec<usize> {
    let cells = raw.cells();
    let drawn: Vec<CellId> = (0..cells.tetrahedra.len() as u32).map(CellId).collect();
    let visibility = MeshVisibility::new();
    let mut cyclic = Vec::new();
    for method in METHODS {
        let order = visibility.prepare(cells, method);
        for viewpoint in viewpoints() {
            let order = order.order(cells, viewpoint, &drawn);
            let mut listed = order.front_to_back.clone();
            listed.sort_unstable();
            assert_eq!(listed, drawn, "{name}, {method}, {viewpoint:?}");
            assert!(order.cycles.iter().all(|ring| ring.len() > 1), "{name}, {method}: rings of one");
            if method == OrderMethod::BspXmpvo {
                cyclic.push(order.cycles.iter().map(Vec::len).sum());
                let cut = order.cut_cycles(cells, viewpoint);
                let mut listed = cut.front_to_back.clone();
                listed.sort_unstable();
                listed.dedup();
                assert_eq!(listed, drawn, "{name}, after {}, {viewpoint:?}", CycleRemedy::Cut);
                assert!(cut.front_to_back.len() <= 64 * drawn.len(), "{name}: {} pieces", cut.front_to_back.len());
            }
        }
    }
    let tree = visibility.tree(cells).report();
    assert!(tree.fragments <= 8 * tree.faces.max(1), "{name}: {tree:?}");
    cyclic
}

/// Four thousand faces in one plane, with cells on both sides of it that share none.
#[test]
fn coplanar_faces() {
    let mut raw = Raw::default();
    let mut random = Random::new(1);
    for place in 0..2000 {
        let corner = DVec3::new(f64::from(place % 40), f64::from(place / 40), 0.0) / 32.0 - DVec3::new(0.5, 0.75, 0.0);
        let [x, y] = [DVec3::X, DVec3::Y].map(|axis| corner + axis / 32.0);
        for side in [1.0, -1.0] {
            let apex = corner + DVec3::new(0.01, 0.01, side * random.between(0.01, 0.1));
            raw.add([corner, x, y, apex]);
        }
    }
    // Multiples of 1/32, so that rounding makes no overlaps. No two cells overlap, and each pair is parted by the plane or by a line in it.
    assert_eq!(check(&raw, "sheet"), vec![0; 10]);
}

/// Cells without volume between good ones, and points that are there twice.
#[test]
fn flat_cells_and_double_points() {
    let mut raw = Raw::default();
    raw.add_grid(5, DQuat::IDENTITY);
    let good = raw.tetrahedra.clone();
    let copies: Vec<DVec3> = raw.points.clone();
    let first = raw.points.len() as u32;
    raw.points.extend(copies);
    for (number, &[a, b, c, d]) in good.iter().enumerate() {
        match number % 4 {
            // A line, a point, a triangle, four points at two places.
            0 => raw.tetrahedra.push([a, b, a, b]),
            1 => raw.tetrahedra.push([a, a, a, a]),
            2 => raw.tetrahedra.push([b, c, d, VertexId(b.0 + first)]),
            _ => raw.tetrahedra.push([c, VertexId(c.0 + first), d, VertexId(d.0 + first)]),
        }
    }
    assert_eq!(check(&raw, "flat cells"), vec![0; 10]);
}

/// Every cell twice, over the same points and over copies of them.
#[test]
fn cells_that_are_there_twice() {
    let mut raw = Raw::default();
    raw.add_grid(4, DQuat::IDENTITY);
    let copies = raw.tetrahedra.clone();
    raw.tetrahedra.extend(copies);
    raw.add_grid(4, DQuat::IDENTITY);
    check(&raw, "doubles");
}

/// Two blocks that stand in one another: their cells hide one another, and the report has them.
#[test]
fn parts_that_interpenetrate() {
    let mut raw = Raw::default();
    raw.add_grid(6, DQuat::IDENTITY);
    raw.add_grid(6, DQuat::from_rotation_z(0.4) * DQuat::from_rotation_x(0.3));
    let cyclic = check(&raw, "interpenetrating blocks");
    // From outside some faces that pierce each other hide each other; from the middle all are left outwards.
    assert!(cyclic[..4].iter().all(|&cells| cells > 0), "{cyclic:?}");
    let overlaps = MeshVisibility::new().overlaps(raw.cells());
    assert!(overlaps.piercing > 100 && overlaps.is_complete, "{overlaps:?}");
}

/// Nothing, and one cell.
#[test]
fn hardly_anything() {
    let mut raw = Raw::default();
    assert_eq!(check(&raw, "nothing"), vec![0; 10]);
    raw.add([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
    assert_eq!(check(&raw, "one cell"), vec![0; 10]);
}
