//! Meshes of chance: what they are before anything is done to them.

use glam::DVec3;
use tetrascope::mesh::TetMesh;

use super::mesh_changes;
use crate::meshes::{Random, Tets, bent_block, grid, hexahedra};
use crate::shapes::{self, Shape};

/// A mesh, and what it is.
pub(super) struct Made {
    pub(super) kind: &'static str,
    pub(super) changes: Vec<&'static str>,
    pub(super) tets: Tets,
    /// Of a grid that lies along the axes: cells along each.
    pub(super) grid: Option<[usize; 3]>,
}

/// A number from 0 to below `count`.
pub(super) fn pick(random: &mut Random, count: usize) -> usize {
    ((random.unit() * count as f64) as usize).min(count - 1)
}

/// The mesh of a seed with everything that is done to it; scalars are 0.
pub(super) fn mesh(random: &mut Random, seed: u64) -> Made {
    let (kind, tets, grid) = base(random, seed);
    let mut made = Made { kind, changes: Vec::new(), tets, grid };
    mesh_changes::change(random, &mut made, seed);
    made.tets.scalars.resize(made.tets.points.len(), 0.0);
    made
}

fn base(random: &mut Random, seed: u64) -> (&'static str, Tets, Option<[usize; 3]>) {
    match pick(random, 20) {
        0..=5 => ("Delaunay", of_shape(&shapes::delaunay(5 + pick(random, 20), seed)), None),
        6 => ("convex", of_shape(&shapes::convex(seed)), None),
        7 => ("holes", of_shape(&shapes::with_holes(seed)), None),
        8 => ("nested shells", of_shape(&shapes::nested_shells(seed)), None),
        9 => ("parts", of_shape(&shapes::parts(seed)), None),
        10 => ("spiral", of_shape(&shapes::spiral(seed)), None),
        11 => ("scattered", of_shape(&shapes::scattered(seed)), None),
        12 => {
            let n = 1 + pick(random, 3);
            ("bent block", of_mesh(&bent_block(n, random.between(0.0, 0.15), seed).mesh), None)
        }
        13..=15 => {
            let cells: [usize; 3] = std::array::from_fn(|_| 1 + pick(random, 5));
            let side = 2.0 / 5.0;
            let origin = -DVec3::from(cells.map(|n| n as f64)) * (0.5 * side);
            if random.unit() < 0.5 {
                ("grid of five tetrahedra", of_mesh(&grid(cells, origin, side).mesh), Some(cells))
            } else {
                ("grid of six tetrahedra", of_mesh(&hexahedra(cells, origin, side).mesh), Some(cells))
            }
        }
        16 => {
            let cells = [3 + pick(random, 6), 3 + pick(random, 6), 1];
            ("sheet", of_mesh(&hexahedra(cells, DVec3::new(-1.0, -1.0, 0.0), 0.25).mesh), None)
        }
        17 => ("ring", ring(random), None),
        18 => ("single cell", single(random), None),
        _ => ("stack", stack(random), None),
    }
}

fn of_shape(shape: &Shape) -> Tets {
    let cells = shape.tetrahedra.iter().map(|cell| cell.map(|v| v.0)).collect();
    Tets { points: shape.points.clone(), cells, scalars: vec![0.0; shape.points.len()] }
}

fn of_mesh(mesh: &TetMesh) -> Tets {
    let points: Vec<DVec3> = mesh.positions().iter().map(|&p| mesh.frame().to_world(p)).collect();
    let cells = mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect();
    Tets { scalars: vec![0.0; points.len()], points, cells }
}

/// Needles around a polygon, each over the next: no order of whole cells is right, or, where they hardly rise, nearly none.
fn ring(random: &mut Random) -> Tets {
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    let count = 3 + pick(random, 3) as u32;
    let rise = 0.3 * 10.0_f64.powf(-random.between(0.0, 8.0));
    let wide = random.between(0.05, 0.2);
    for i in 0..count {
        let turn = glam::DQuat::from_rotation_z(f64::from(i) * std::f64::consts::TAU / f64::from(count));
        let first = points.len() as u32;
        let corners =
            [[-1.2, -0.5 - wide, -rise], [-1.2, -0.5 + wide, -rise], [1.2, -0.5, 0.7 * rise], [1.2, -0.5, 1.3 * rise]];
        points.extend(corners.map(|p| turn * DVec3::from(p)));
        cells.push([0, 1, 2, 3].map(|corner| first + corner));
    }
    Tets { scalars: vec![0.0; points.len()], points, cells }
}

/// One cell: of chance, a needle, a cap or a sliver.
fn single(random: &mut Random) -> Tets {
    let thin = 10.0_f64.powf(-random.between(0.0, 9.0));
    let points: Vec<DVec3> = match pick(random, 4) {
        0 => (0..4).map(|_| random.point()).collect(),
        1 => [[0.0, 0.0, -1.0], [thin, 0.0, -1.0], [0.0, thin, -1.0], [0.0, 0.0, 1.0]].map(DVec3::from).into(),
        2 => [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, thin]].map(DVec3::from).into(),
        _ => [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, thin], [0.0, 1.0, thin]].map(DVec3::from).into(),
    };
    Tets { scalars: vec![0.0; 4], points, cells: vec![[0, 1, 2, 3]] }
}

/// Many thin layers of one prism: hundreds of cells along a ray.
fn stack(random: &mut Random) -> Tets {
    let layers = 20 + pick(random, 200) as u32;
    let mut points = Vec::new();
    for layer in 0..=layers {
        let z = 2.0 * f64::from(layer) / f64::from(layers) - 1.0;
        points.extend([[-1.0, -0.7, z], [1.0, -0.7, z], [0.0, 1.0, z]].map(DVec3::from));
    }
    let mut cells = Vec::new();
    for layer in 0..layers {
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|i| 3 * layer + i);
        // Each side is cut through its lowest number, which is a or b.
        cells.extend([[a, b, c, f], [a, b, f, e], [a, d, e, f]]);
    }
    Tets { scalars: vec![0.0; points.len()], points, cells }
}
