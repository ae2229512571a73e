//! A stand-in for the renderer that runs a frame: to be replaced when that is merged.

use std::sync::Arc;

use tetrascope_mesh::TetMesh;
use tetrascope_order::MeshVisibility;
use tetrascope_scene::{Plan, Progress, Rendered, check_scalars};

use crate::{Gpu, GpuError};

/// Draws one field on one mesh with a device, again and again.
#[derive(Debug)]
pub struct GpuRenderer {
    gpu: Arc<Gpu>,
    visibility: Arc<MeshVisibility>,
}

impl GpuRenderer {
    /// Gives a mesh and a field to the device.
    ///
    /// - `scalars`: one a point of the mesh
    /// - `visibility`: of the mesh as [`TetMesh::ascending_tetrahedra`] has its cells
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(
        gpu: Arc<Gpu>,
        mesh: &TetMesh,
        scalars: &[f64],
        visibility: Arc<MeshVisibility>,
    ) -> Result<Self, GpuError> {
        check_scalars(mesh, scalars)?;
        Ok(Self { gpu, visibility })
    }

    /// Draws a picture as the plan says; the plan's back end is ignored.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn render(&self, plan: &Plan, _progress: &dyn Progress) -> Result<Rendered, GpuError> {
        plan.check()?;
        plan.check_on_gpu()?;
        let problem = format!("nothing is drawn yet ({} references)", Arc::strong_count(&self.visibility));
        Err(GpuError::Driver { adapter: self.gpu.description().name.clone(), frame: 1, problem })
    }
}
