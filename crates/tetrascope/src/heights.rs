//! Heights for the order `power`, kept in a file beside the mesh.

use std::path::PathBuf;
use std::sync::Arc;

use tetrascope_cpu::CpuRenderer;
use tetrascope_io::{IoError, read_heights, write_heights};
use tetrascope_order::OrderMethod;
use tetrascope_scene::{Backend, Completed, Plan};

use crate::{Error, VolumeField};

impl VolumeField<'_> {
    /// The file of a mesh's heights: the mesh file's name with `.heights` behind it; `None` for a mesh that is in no file.
    pub fn heights_path(&self) -> Option<PathBuf> {
        let mut path = self.mesh_path?.as_os_str().to_owned();
        path.push(".heights");
        Some(PathBuf::from(path))
    }

    /// Makes the renderer with the heights that were kept, if there are any and they are proven; a warning if they do not fit.
    pub(crate) fn read_heights(&self) -> Result<Option<String>, Error> {
        if self.renderer.get().is_some() {
            return Ok(None);
        }
        let Some(path) = self.heights_path() else {
            return Ok(Some("quality.keep_heights has no effect: the mesh is in no file".to_owned()));
        };
        let heights = match read_heights(&path) {
            Ok(heights) => heights,
            Err(IoError::Read { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Ok(Some(format!("{error}. New heights are looked for"))),
        };
        let (mesh, scalars) = (self.on_mesh.mesh.as_ref(), self.on_mesh.scalars.as_slice());
        let (count, points) = (heights.len(), mesh.positions().len());
        if count != points {
            return Ok(Some(format!(
                "{} has {count} heights for {points} points: it is of another mesh. New heights are looked for",
                path.display()
            )));
        }
        let renderer = CpuRenderer::with_heights(mesh, scalars, heights)?;
        let certificate = renderer.visibility().quick_certificate(renderer.cells());
        if !certificate.is_exact() {
            return Ok(Some(format!(
                "{}: its heights do not order this mesh ({} of {} faces are violated): it is of another mesh. New heights are looked for",
                path.display(),
                certificate.violated,
                certificate.faces
            )));
        }
        self.renderer.get_or_init(|| Arc::new(renderer));
        Ok(None)
    }

    /// Writes heights that were found and proven for a picture, if its scene says so; a warning if that fails.
    ///
    /// # Errors
    /// [`Error::Render`] as [`Self::renderer`].
    pub fn keep_heights(&self, completed: &Completed, plan: &Plan) -> Result<Option<String>, Error> {
        let is_asked = completed.file.quality.keep_heights == Some(true);
        if !is_asked || plan.order != OrderMethod::Power || plan.backend != Backend::Cpu {
            return Ok(None);
        }
        let renderer = self.renderer()?;
        let (Some(heights), Some(path)) = (renderer.visibility().found_heights(), self.heights_path()) else {
            return Ok(None);
        };
        if !renderer.visibility().power(renderer.cells()).certificate().is_exact() {
            return Ok(None);
        }
        Ok(write_heights(&path, heights).err().map(|error| format!("{error}. The heights are not kept")))
    }
}
