//! What is learned of a field and its mesh, and the renderers that draw it: each made when first asked for.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use tetrascope_cpu::CpuRenderer;
use tetrascope_gpu::{AdapterChoice, Gpu, GpuError, GpuRenderer};
use tetrascope_mesh::{TetMesh, VertexId};
use tetrascope_order::{Cells, MeshVisibility};

use crate::{Error, VolumeField};

/// What a field's pictures have in common. Clones of a field share it.
#[derive(Debug, Default)]
pub(crate) struct Made {
    pub(crate) known: OnceLock<Known>,
    /// Points of each cell in ascending order, as renderers have them; only where no CPU renderer has the same.
    ascending: OnceLock<Vec<[VertexId; 4]>>,
    cpu: OnceLock<CpuRenderer>,
    /// Cells of the largest picture that this renderer drew.
    drawn: AtomicU64,
    devices: Mutex<Vec<Device>>,
}

impl Made {
    /// Cells of the largest picture that the CPU's renderer drew, of which it keeps the memory: 0 before the first. `None` without a
    /// renderer.
    pub(crate) fn last_frame(&self) -> Option<u64> {
        self.cpu.get().map(|_| self.drawn.load(Ordering::Relaxed))
    }

    /// Such a picture is being drawn: gives what was kept before.
    pub(crate) fn forget_frame(&self) -> u64 {
        self.drawn.swap(0, Ordering::Relaxed)
    }

    /// Such a picture was drawn.
    pub(crate) fn has_drawn(&self, cells: u64) {
        self.drawn.fetch_max(cells, Ordering::Relaxed);
    }
}

/// What visibility orders know of the mesh.
#[derive(Debug, Default)]
pub(crate) struct Known {
    pub(crate) visibility: Arc<MeshVisibility>,
    /// Whether it was given heights from a file.
    pub(crate) has_read_heights: bool,
}

/// An open device, by what was asked for, and the field on it.
#[derive(Debug)]
struct Device {
    choice: AdapterChoice,
    gpu: Arc<Gpu>,
    renderer: Option<Arc<GpuRenderer>>,
}

impl VolumeField<'_> {
    /// The fast renderer of this field, made when first asked for.
    ///
    /// # Errors
    /// [`Error::Render`].
    pub fn renderer(&self) -> Result<&CpuRenderer, Error> {
        if let Some(renderer) = self.made.cpu.get() {
            return Ok(renderer);
        }
        let visibility = Arc::clone(self.visibility());
        let renderer = CpuRenderer::with_visibility(self.mesh(), &self.on_mesh.scalars, visibility)?;
        Ok(self.made.cpu.get_or_init(|| renderer))
    }

    /// The device behind an adapter, opened when first asked for.
    pub(crate) fn gpu(&self, adapter: Option<&str>) -> Result<Arc<Gpu>, GpuError> {
        self.with_device(adapter, |device| Ok(Arc::clone(&device.gpu)))
    }

    /// The renderer of this field on such a device, made when first asked for.
    pub(crate) fn gpu_renderer(&self, adapter: Option<&str>) -> Result<Arc<GpuRenderer>, GpuError> {
        self.with_device(adapter, |device| {
            if let Some(renderer) = &device.renderer {
                return Ok(Arc::clone(renderer));
            }
            let (gpu, visibility) = (Arc::clone(&device.gpu), Arc::clone(self.visibility()));
            let renderer = Arc::new(GpuRenderer::new(gpu, self.mesh(), &self.on_mesh.scalars, visibility)?);
            Ok(Arc::clone(device.renderer.insert(renderer)))
        })
    }

    fn with_device<T>(
        &self,
        adapter: Option<&str>,
        ask: impl FnOnce(&mut Device) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let mut devices = self.made.devices.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(device) = devices.iter_mut().find(|device| device.choice.name.as_deref() == adapter) {
            return ask(device);
        }
        let choice = AdapterChoice { name: adapter.map(str::to_owned), ..AdapterChoice::default() };
        let gpu = Arc::new(Gpu::open(&choice)?);
        devices.push(Device { choice, gpu, renderer: None });
        let last = devices.len() - 1;
        ask(&mut devices[last])
    }

    /// Forgets a device that is gone: the next picture opens it anew.
    pub(crate) fn forget_device(&self, adapter: Option<&str>) {
        let mut devices = self.made.devices.lock().unwrap_or_else(PoisonError::into_inner);
        devices.retain(|device| device.choice.name.as_deref() != adapter);
    }

    pub(crate) fn mesh(&self) -> &TetMesh {
        self.on_mesh.mesh.as_ref()
    }

    /// The mesh as visibility orders see it, the same for all renderers.
    pub(crate) fn cells(&self) -> Cells<'_> {
        match self.made.cpu.get() {
            Some(renderer) => renderer.cells(),
            None => Cells {
                positions: self.mesh().joined_positions(),
                tetrahedra: self.made.ascending.get_or_init(|| self.mesh().joined_tetrahedra()),
            },
        }
    }

    /// What visibility orders know of [`Self::cells`].
    pub(crate) fn visibility(&self) -> &Arc<MeshVisibility> {
        &self.made.known.get_or_init(Known::default).visibility
    }
}
