//! Meshes made of random numbers.

use glam::DVec3;
use tetrascope::mesh::{Cells, DataArray, Dataset, Decomposition, StructuredBlock, decompose};

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
