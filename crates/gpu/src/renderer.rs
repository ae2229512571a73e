//! Draws one field on one mesh, again and again.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::DVec3;
use tetrascope_mesh::{ChordLengths, Frame as MeshFrame, TetMesh, VertexId, segment_lengths};
use tetrascope_order::{Cells, MeshVisibility};
use tetrascope_scene::{Plan, Progress, Rendered, check_scalars};

use crate::draw::Drawing;
use crate::kept::Kept;
use crate::kernels::Kernels;
use crate::lattice::{Lattice, bare};
use crate::mesh::MeshBuffers;
use crate::stopwatch::DeviceStopwatch;
use crate::{Gpu, GpuError};

/// Draws one field on one mesh, again and again.
///
/// On the device: 20 bytes a tetrahedron and 32 a point, for the order 8 more a tetrahedron (12 if the CPU made it, 21 by centroids, 53 by `power`), and what a frame takes; 16 more a point
/// where a plan asks for interpolated gradients. [`Rendered::device`] has the numbers. On the host 16 bytes a tetrahedron and 32 a point, for
/// orders that the CPU makes.
///
/// Positions are whole multiples of 2⁻²⁹ of the mesh's size: nothing smaller than some thousand of these is drawn in its right
/// shape. The same plan gives the same bits on one device and driver.
#[derive(Debug)]
pub struct GpuRenderer {
    pub(crate) gpu: Arc<Gpu>,
    pub(crate) frame: MeshFrame,
    pub(crate) positions: Vec<DVec3>,
    pub(crate) tetrahedra: Vec<[VertexId; 4]>,
    /// The same over points that neighbors share, where they do not.
    joined: Option<Vec<[VertexId; 4]>>,
    /// Points that are there once; others follow.
    joined_points: usize,
    /// In the renderer's unit.
    pub(crate) scalars: Vec<f64>,
    pub(crate) field: FieldNumbers,
    pub(crate) mesh: MeshBuffers,
    pub(crate) visibility: Arc<MeshVisibility>,
    pub(crate) kernels: Kernels,
    pub(crate) stopwatch: Option<DeviceStopwatch>,
    lengths: OnceLock<Option<ChordLengths>>,
    /// What goes on from frame to frame; one frame is drawn at a time.
    kept: Mutex<Kept>,
}

/// How scalars of the plan become those of the device.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FieldNumbers {
    pub(crate) scalar_factor: f64,
    pub(crate) scalar_middle: f64,
    pub(crate) scalar_range: [f64; 2],
}

impl GpuRenderer {
    /// Uploads a mesh and a field.
    ///
    /// - `scalars`: one a point of the mesh
    /// - `visibility`: what is known of the visibility orders of this mesh; shared with whoever else draws it. Cells are those of the mesh, each
    ///   with its points in ascending order
    ///
    /// # Errors
    /// [`GpuError::Plan`] if `scalars` does not fit the mesh or holds a value that is not finite where a tetrahedron uses it,
    /// [`GpuError::TooLarge`] and [`GpuError::OutOfMemory`] if the device cannot hold the mesh.
    pub fn new(
        gpu: Arc<Gpu>,
        mesh: &TetMesh,
        scalars: &[f64],
        visibility: Arc<MeshVisibility>,
    ) -> Result<Self, GpuError> {
        check_scalars(mesh, scalars)?;
        let lattice = Lattice::new(mesh, scalars);
        let (buffers, stopwatch) =
            gpu.attempt(0, || Ok((MeshBuffers::new(&gpu, &lattice)?, DeviceStopwatch::new(&gpu))))?;
        let field = FieldNumbers {
            scalar_factor: lattice.scalar_factor,
            scalar_middle: lattice.scalar_middle,
            scalar_range: lattice.scalar_range,
        };
        Ok(Self {
            frame: mesh.frame(),
            positions: mesh.positions().to_vec(),
            joined: mesh.has_points_of_cells().then(|| mesh.joined_tetrahedra()),
            joined_points: mesh.joined_positions().len(),
            tetrahedra: lattice.cells.iter().map(|cell| bare(cell).map(VertexId)).collect(),
            scalars: scalars.iter().map(|scalar| scalar * field.scalar_factor).collect(),
            field,
            mesh: buffers,
            visibility,
            kernels: Kernels::default(),
            stopwatch,
            lengths: OnceLock::new(),
            kept: Mutex::default(),
            gpu,
        })
    }

    /// Draws a picture as the plan says; the plan's back end and number of threads are ignored.
    ///
    /// # Errors
    /// [`GpuError`]. [`GpuError::Lost`] and [`GpuError::Driver`] name the frame, counted from 1; nothing of it is given.
    pub fn render(&self, plan: &Plan, progress: &dyn Progress) -> Result<Rendered, GpuError> {
        plan.check()?;
        plan.check_on_gpu()?;
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.frame += 1;
        let frame = kept.frame;
        let done = self.gpu.attempt(frame, || Drawing::new(self, plan, progress)?.draw(&mut kept));
        if matches!(done, Err(GpuError::OutOfMemory { .. } | GpuError::Driver { .. })) {
            // What could not be made is there in name only: the next frame begins anew, with the memory that this gives back.
            *kept = Kept::default();
            kept.frame = frame;
            self.kernels.forget();
        }
        done
    }

    /// Draws a picture, and shows it over the plan's background in a view of the picture's size, without a way through the host.
    ///
    /// - `format`: the view's; one that turns linear light into sRGB
    ///
    /// # Errors
    /// Those of [`Self::render`], and [`GpuError::NotWhole`] for a picture that this device draws in parts.
    pub fn show(
        &self,
        plan: &Plan,
        progress: &dyn Progress,
        view: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<Rendered, GpuError> {
        let rendered = self.render(plan, progress)?;
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let frame = kept.frame;
        let size = [plan.view.width, plan.view.height];
        self.gpu.attempt(frame, || kept.show(&self.gpu, size, plan.background, view, format))?;
        Ok(rendered)
    }

    /// The device.
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// What is kept from frame to frame, to be compared.
    #[cfg(test)]
    pub(crate) fn kept_buffers(&self) -> crate::kept::KeptBuffers {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.buffers(self.kernels.count())
    }

    /// Cells of a tile that pixels that sort look at in a run from now on; 0 for all.
    #[cfg(test)]
    pub(crate) fn set_slice(&self, slice: u32) {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).slice = Some(slice);
    }

    /// The mesh as visibility orders see it.
    pub(crate) fn cells(&self) -> Cells<'_> {
        Cells {
            positions: &self.positions[..self.joined_points],
            tetrahedra: self.joined.as_ref().unwrap_or(&self.tetrahedra),
        }
    }

    /// Lengths of segments, world length; computed when first asked for. `None` if no cell has a volume.
    pub(crate) fn chord_lengths(&self) -> Option<ChordLengths> {
        *self.lengths.get_or_init(|| {
            let local = segment_lengths(&self.positions, &self.tetrahedra)?;
            let scale = self.frame.scale;
            let lengths = ChordLengths { mean: local.mean * scale, longest: local.longest * scale };
            (lengths.mean > 0.0 && lengths.longest.is_finite()).then_some(lengths)
        })
    }
}
