//! Meshes made of random numbers.

use glam::DVec3;
use tetrascope::mesh::{
    CellKind, Cells, DataArray, Dataset, Decomposition, StructuredBlock, TetMesh, UnstructuredCells, decompose,
};

/// A small generator of random numbers, so that a failing mesh is named by its seed.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The numbers of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03)
    }

    /// A number from 0 to below 1 (splitmix64).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number between two others.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A point in the cube from -1 to 1.
    pub fn point(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }
}

/// A bent block of `n` cells a side about the origin, of size about 2, whose inner points are moved by up to `jitter` of a cell.
///
/// Its boundary is curved, so it is not convex. Cells stay positive up to a jitter of 0.15.
pub fn bent_block(n: usize, jitter: f64, seed: u64) -> Decomposition {
    decompose(&bent_block_dataset(n, jitter, seed)).expect("a block has cells")
}

/// The same before it is cut into tetrahedra.
pub fn bent_block_dataset(n: usize, jitter: f64, seed: u64) -> Dataset {
    let mut random = Random::new(seed);
    let side = n + 1;
    let mut points = Vec::with_capacity(side * side * side);
    for k in 0..side {
        for j in 0..side {
            for i in 0..side {
                let at = DVec3::new(i as f64, j as f64, k as f64);
                let moved = at + random.point() * jitter;
                let p = moved * (2.0 / n as f64) - 1.0;
                // A gentle bend that keeps the order of points.
                points.push(DVec3::new(p.x + 0.2 * p.z * p.z, p.y + 0.15 * (1.5 * p.x).sin(), p.z - 0.1 * p.y * p.y));
            }
        }
    }
    Dataset {
        points,
        cells: Cells::Structured(vec![StructuredBlock { dims: [side; 3], first_point: 0, hidden_points: Vec::new() }]),
        point_arrays: Vec::<DataArray>::new(),
        cell_arrays: Vec::new(),
    }
}

/// A regular grid of cubes, cut as a structured block, with its lowest corner at `origin`.
pub fn grid(cells: [usize; 3], origin: DVec3, cell: f64) -> Decomposition {
    let dims = cells.map(|n| n + 1);
    let mut points = Vec::new();
    for k in 0..dims[2] {
        for j in 0..dims[1] {
            points.extend((0..dims[0]).map(|i| origin + DVec3::new(i as f64, j as f64, k as f64) * cell));
        }
    }
    let block = StructuredBlock { dims, first_point: 0, hidden_points: Vec::new() };
    decompose(&Dataset { points, cells: Cells::Structured(vec![block]), ..Dataset::default() })
        .expect("a grid has cells")
}

/// The same grid as unstructured hexahedra: six tetrahedra each.
pub fn hexahedra(cells: [usize; 3], origin: DVec3, cell: f64) -> Decomposition {
    let dims = cells.map(|n| n + 1);
    let at = |i: usize, j: usize, k: usize| (i + dims[0] * (j + dims[1] * k)) as u32;
    let (mut points, mut connectivity) = (Vec::new(), Vec::new());
    for k in 0..dims[2] {
        for j in 0..dims[1] {
            points.extend((0..dims[0]).map(|i| origin + DVec3::new(i as f64, j as f64, k as f64) * cell));
        }
    }
    for k in 0..cells[2] {
        for j in 0..cells[1] {
            for i in 0..cells[0] {
                for [x, y, z] in
                    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
                {
                    connectivity.push(at(i + x, j + y, k + z));
                }
            }
        }
    }
    let count = cells.iter().product();
    let cells = Cells::Unstructured(UnstructuredCells {
        kinds: vec![CellKind::Hexahedron; count],
        offsets: (0..=count).map(|c| 8 * c).collect(),
        connectivity,
        polyhedra: Vec::new(),
    });
    decompose(&Dataset { points, cells, ..Dataset::default() }).expect("a grid has cells")
}

/// Tetrahedra that can be cut, turned and renumbered: world coordinates, point indices, one scalar a point.
#[derive(Clone, Debug, Default)]
pub struct Tets {
    /// World coordinates.
    pub points: Vec<DVec3>,
    /// Four points each, either way round.
    pub cells: Vec<[u32; 4]>,
    /// One a point.
    pub scalars: Vec<f64>,
}

impl Tets {
    /// The cells of a mesh, with a smooth field that has its extremes inside and a little of chance.
    pub fn of(mesh: &TetMesh, random: &mut Random) -> Self {
        let points: Vec<DVec3> = mesh.positions().iter().map(|&p| mesh.frame().to_world(p)).collect();
        let field = |p: &DVec3| (2.1 * p.x + 0.3).sin() * (1.7 * p.y).cos() + 0.5 * (2.3 * p.z).sin();
        let local: Vec<DVec3> = mesh.positions().to_vec();
        let scalars = local.iter().map(|p| field(p) + random.between(-0.2, 0.2)).collect();
        let cells = mesh.tetrahedra().iter().map(|t| t.map(|v| v.0)).collect();
        Self { points, cells, scalars }
    }

    /// A bent block of `n` cells a side with a field of chance, named by its seed.
    pub fn block(n: usize, seed: u64) -> Self {
        Self::of(&bent_block(n, 0.12, seed).mesh, &mut Random::new(seed ^ 0xF1E1D))
    }

    /// The mesh of them; all must have volume.
    ///
    /// # Panics
    /// If a cell has none.
    pub fn mesh(&self) -> TetMesh {
        let made = TetMesh::from_tetrahedra(&self.points, &self.cells).expect("there are cells");
        assert_eq!(made.mesh.tetrahedra().len(), self.cells.len(), "cells without volume");
        made.mesh
    }

    /// Lowest and highest scalar.
    pub fn range(&self) -> (f64, f64) {
        self.scalars.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &s| (l.min(s), h.max(s)))
    }

    fn add_point(&mut self, parents: &[u32], shares: &[f64]) -> u32 {
        let mean =
            |value: &dyn Fn(u32) -> DVec3| parents.iter().zip(shares).map(|(&p, &w)| value(p) * w).sum::<DVec3>();
        let point = mean(&|p| self.points[p as usize]);
        let scalar = mean(&|p| DVec3::splat(self.scalars[p as usize])).x;
        self.points.push(point);
        self.scalars.push(scalar);
        self.points.len() as u32 - 1
    }

    /// Splits all cells that have all of `parents` as corners at a point of those: shares are positive and add up to 1.
    ///
    /// Two parents split an edge, three a face, four a cell. The scalar there is the interpolated one.
    pub fn split(&mut self, parents: &[u32], shares: &[f64]) {
        let new = self.add_point(parents, shares);
        let mut cells = Vec::with_capacity(self.cells.len() + 8);
        for &cell in &self.cells {
            if parents.iter().all(|p| cell.contains(p)) {
                cells.extend(parents.iter().map(|p| cell.map(|v| if v == *p { new } else { v })));
            } else {
                cells.push(cell);
            }
        }
        self.cells = cells;
    }
}
