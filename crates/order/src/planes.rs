//! The planes of cells' faces in 16 bits, for signs that are certain at a glance.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_view::Viewpoint;

use crate::Cells;

/// Cells whose planes are evaluated side by side.
pub(crate) const LANES: usize = 16;

/// Blocks that one task evaluates, about: 8 KiB of planes.
const BLOCKS_PER_TASK: usize = 64;

/// Whole numbers that stand for 1 in a plane, and in the viewpoint. A sum of four products fits 32 bits.
const PLANE_ONE: f64 = 32_767.0;
const EYE_ONE: f64 = 30_000.0;

/// What rounding to whole numbers may do to a sum, in its units: half a unit of each factor times the other one, summed
/// by the 1-norms of two unit vectors (at most √3) and for the offset: `0.5 * (√3 + 1) * (PLANE_ONE + EYE_ONE)` is
/// 85,743. Rounding of the planes themselves in f64 is below 1e-9 of the sum, see [`THINNEST`].
const UNCERTAIN: i32 = 87_000;

/// A face whose sine between two edges is below this has no plane here: in f64 its normal errs by up to 4e-16 / sine.
const THINNEST: f64 = 1e-6;

/// For 16 cells and their four corners the face's outward normal and its offset, by corner and component.
#[derive(Clone, Debug)]
struct Block([[[i16; LANES]; 4]; 4]);

/// The planes of all cells, 32 bytes each.
///
/// A plane in 16 bits tells the sides of a viewpoint that is farther from it than about 1e-4 of the mesh's radius, or of the eye's
/// distance where that is more. That is one face in ten thousand less than all, and says so of itself; the others are for exact
/// arithmetic. Evaluating them costs no multiplication in f64 and no gathering of points.
#[derive(Clone, Debug)]
pub(crate) struct Planes {
    blocks: Vec<Block>,
    center: DVec3,
    /// Half the diagonal of the box around the mesh.
    radius: f64,
}

/// What a glance tells of one cell's faces, as bits by corner.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Glance {
    /// The eye is certainly on the far side of the face from the cell.
    pub front: u8,
    /// The eye is certainly on the cell's side.
    pub behind: u8,
}

impl Planes {
    /// Bytes that it keeps.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.blocks.as_slice())
    }

    /// - `outward`: for a cell and a corner the points of the face, and whether the normal `(q - p) × (r - p)` leads out of the
    ///   cell; `None` where the face is never asked about
    pub(crate) fn new(cells: Cells<'_>, outward: impl Fn(usize, usize) -> Option<([DVec3; 3], bool)> + Sync) -> Self {
        let count = cells.tetrahedra.len();
        let around = |a: [DVec3; 2], b: [DVec3; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let corner = |v: &tetrascope_mesh::VertexId| [cells.positions[v.index()]; 2];
        let [low, high] = cells
            .tetrahedra
            .par_iter()
            .with_min_len(1 << 12)
            .map(|tetrahedron| tetrahedron.iter().map(corner).fold(empty, around))
            .reduce(|| empty, around);
        let (center, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
        let blocks = (0..count.div_ceil(LANES))
            .into_par_iter()
            .map(|block| {
                let mut planes = Block([[[0; LANES]; 4]; 4]);
                for lane in 0..LANES.min(count - block * LANES) {
                    for corner in 0..4 {
                        let Some(plane) = outward(block * LANES + lane, corner)
                            .and_then(|(face, is_outward)| quantized(face, is_outward, center, radius))
                        else {
                            continue;
                        };
                        for (component, value) in plane.into_iter().enumerate() {
                            planes.0[corner][component][lane] = value;
                        }
                    }
                }
                planes
            })
            .collect();
        Self { blocks, center, radius }
    }

    /// Gives every cell a byte: `byte` takes the number of a block's first cell, what is certain of its cells, and the place for their bytes.
    pub(crate) fn glance(
        &self,
        viewpoint: Viewpoint,
        bytes: &mut [u8],
        byte: impl Fn(usize, &[Glance; LANES], &mut [u8]) + Sync,
    ) {
        let eye = self.viewpoint(viewpoint);
        bytes
            .par_chunks_mut(LANES * BLOCKS_PER_TASK)
            .zip(self.blocks.par_chunks(BLOCKS_PER_TASK))
            .enumerate()
            .for_each(|(task, (bytes, blocks))| {
                for (number, (bytes, block)) in bytes.chunks_mut(LANES).zip(blocks).enumerate() {
                    byte((task * BLOCKS_PER_TASK + number) * LANES, &block.glance(eye), bytes);
                }
            });
    }

    /// The viewpoint's coordinates and the factor of a plane's offset, in whole numbers; all 0, which tells nothing, where that cannot be.
    fn viewpoint(&self, viewpoint: Viewpoint) -> [i16; 4] {
        let (place, weight) = match viewpoint {
            Viewpoint::Eye(eye) => ((eye - self.center) / self.radius, 1.0),
            // The eye lies infinitely far against the direction.
            Viewpoint::Direction(direction) => (-direction, 0.0),
        };
        let scale = if weight > 0.0 { place.length().max(1.0) } else { place.length() };
        if !(place.is_finite() && scale.is_finite() && scale > 0.0) {
            return [0; 4];
        }
        [place.x, place.y, place.z, -weight].map(|value| (value / scale * EYE_ONE).round() as i16)
    }
}

impl Block {
    #[inline]
    fn glance(&self, eye: [i16; 4]) -> [Glance; LANES] {
        let (mut front, mut behind) = ([0_u8; LANES], [0_u8; LANES]);
        let [x, y, z, w] = eye.map(i32::from);
        for (corner, [normal_x, normal_y, normal_z, offset]) in self.0.iter().enumerate() {
            for lane in 0..LANES {
                let height = i32::from(normal_x[lane]) * x
                    + i32::from(normal_y[lane]) * y
                    + i32::from(normal_z[lane]) * z
                    + i32::from(offset[lane]) * w;
                front[lane] |= u8::from(height > UNCERTAIN) << corner;
                behind[lane] |= u8::from(height < -UNCERTAIN) << corner;
            }
        }
        std::array::from_fn(|lane| Glance { front: front[lane], behind: behind[lane] })
    }
}

/// A face's outward unit normal and its offset from the center in radii; `None` where rounding leaves no certain plane.
fn quantized([p, q, r]: [DVec3; 3], is_outward: bool, center: DVec3, radius: f64) -> Option<[i16; 4]> {
    let (u, v) = (q - p, r - p);
    let normal = u.cross(v);
    let length = normal.length();
    let sine = length / (u.length() * v.length());
    // Not so where any of them is not a number, or too large or too small for its square.
    if !(sine > THINNEST && length > 1e-140 && length < 1e140 && radius > 0.0) {
        return None;
    }
    let unit = normal * (if is_outward { 1.0 } else { -1.0 } / length);
    let offset = unit.dot((p - center) / radius);
    (offset.abs() <= 1.0 + 1e-9)
        .then(|| [unit.x, unit.y, unit.z, offset].map(|value| (value * PLANE_ONE).round() as i16))
}
