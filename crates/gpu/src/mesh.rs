//! The mesh on the device.

use wgpu::Buffer;

use crate::lattice::Lattice;
use crate::{Gpu, GpuError};

/// Bytes of a tetrahedron that stay on the device: four indices, and the range of its scalars in 16 bits each.
pub(crate) const BYTES_PER_CELL: u64 = 20;
/// Bytes of a point that stay on the device.
pub(crate) const BYTES_PER_POINT: u64 = 16;

/// Points and cells on the device. A mesh with more cells than one binding holds is in several parts.
#[derive(Debug)]
pub(crate) struct MeshBuffers {
    /// The points on the lattice.
    pub(crate) vertices: Buffer,
    /// The same as a view has them; made anew in every frame.
    pub(crate) points: Buffer,
    pub(crate) parts: Vec<MeshPart>,
    pub(crate) cell_count: u32,
    pub(crate) point_count: u32,
}

/// A run of cells.
#[derive(Debug)]
pub(crate) struct MeshPart {
    pub(crate) cells: Buffer,
    pub(crate) ranges: Buffer,
    /// The first of them in the mesh and how many, for shaders.
    pub(crate) chunk: Buffer,
}

impl MeshBuffers {
    /// Uploads a mesh.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the points, or one number a cell, do not fit into one binding.
    pub(crate) fn new(gpu: &Gpu, lattice: &Lattice) -> Result<Self, GpuError> {
        let limit = gpu.largest_binding();
        let too_large =
            |what, needed| GpuError::TooLarge { what, needed, limit, adapter: gpu.description().name.clone() };
        let (points, cells) = (lattice.vertices.len() as u64, lattice.cells.len() as u64);
        if points * BYTES_PER_POINT > limit {
            return Err(too_large("the mesh's points, of which every cell may be made,", points * BYTES_PER_POINT));
        }
        if cells * 4 > limit {
            return Err(too_large("the order of the mesh's tetrahedra", cells * 4));
        }
        let most = (limit / 16) as usize;
        let parts =
            lattice.cells.chunks(most).zip(lattice.ranges.chunks(most)).enumerate().map(|(part, (cells, ranges))| {
                MeshPart {
                    cells: gpu.storage_of("cells", cells),
                    ranges: gpu.storage_of("ranges", ranges),
                    chunk: gpu.uniform_of("chunk", &[(part * most) as u32, cells.len() as u32, 0, 0]),
                }
            });
        Ok(Self {
            vertices: gpu.storage_of("vertices", &lattice.vertices),
            points: gpu.storage("points", points * BYTES_PER_POINT),
            parts: parts.collect(),
            cell_count: cells as u32,
            point_count: points as u32,
        })
    }

    /// Bytes of the cells, and of the points with what every view makes of them.
    pub(crate) fn bytes(&self) -> [(&'static str, u64); 2] {
        let (cells, points) = (u64::from(self.cell_count), u64::from(self.point_count));
        [("cells", cells * BYTES_PER_CELL), ("points", points * 2 * BYTES_PER_POINT)]
    }
}
