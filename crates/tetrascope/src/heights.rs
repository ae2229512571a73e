//! Heights for the order `power`, kept in a file beside the mesh.

use std::path::PathBuf;
use std::sync::Arc;

use tetrascope_io::{IoError, read_heights, write_heights};
use tetrascope_order::{Cells, MeshVisibility};
use tetrascope_scene::{Backend, Completed, Plan};

use crate::made::Known;
use crate::{Error, VolumeField};

impl VolumeField<'_> {
    /// The file of a mesh's heights: the mesh file's name with `.heights` behind it; `None` for a mesh that is in no file.
    pub fn heights_path(&self) -> Option<PathBuf> {
        let mut path = self.mesh_path?.as_os_str().to_owned();
        path.push(".heights");
        Some(PathBuf::from(path))
    }

    /// Takes the heights that were kept, if there are any and they are proven; a warning if they do not fit.
    pub(crate) fn read_heights(&self) -> Result<Option<String>, Error> {
        if self.made.known.get().is_some() {
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
        let (count, points) = (heights.len(), self.mesh().joined_positions().len());
        if count != points {
            return Ok(Some(format!(
                "{} has {count} heights for {points} points: it is of another mesh. New heights are looked for",
                path.display()
            )));
        }
        let visibility = MeshVisibility::with_heights(heights);
        let tetrahedra = self.mesh().joined_tetrahedra();
        let cells = Cells { positions: self.mesh().joined_positions(), tetrahedra: &tetrahedra };
        let certificate = visibility.quick_certificate(cells);
        if !certificate.is_exact() {
            return Ok(Some(format!(
                "{}: its heights do not order this mesh ({} of {} faces are violated): it is of another mesh. New heights are looked for",
                path.display(),
                certificate.violated,
                certificate.faces
            )));
        }
        self.made.known.get_or_init(|| Known { visibility: Arc::new(visibility), has_read_heights: true });
        Ok(None)
    }

    /// Writes heights that were looked for and proven, if the scene says so, whichever order it was given then: they need not be looked for
    /// again. A warning if none are proven, or if the file cannot be written.
    ///
    /// Proven is what [`PowerCertificate::is_exact`](tetrascope_order::PowerCertificate::is_exact) says; gaps of the mesh may stay open.
    pub fn keep_heights(&self, completed: &Completed, plan: &Plan) -> Option<String> {
        let is_asked = completed.file.quality.keep_heights == Some(true);
        if !is_asked || plan.backend == Backend::Reference {
            return None;
        }
        let visibility = self.visibility();
        let (Some(heights), Some(path)) = (visibility.found_heights(), self.heights_path()) else {
            return None;
        };
        let certificate = visibility.power(self.cells()).certificate();
        if !certificate.is_exact() {
            return Some(format!(
                "no heights were found that order this mesh ({} of {} faces between cells are not proven, and {} cells are too thin for \
                 their key), and none are kept: quality.keep_heights has them looked for every time",
                certificate.violated + certificate.folded + certificate.flat,
                certificate.faces,
                certificate.imprecise
            ));
        }
        write_heights(&path, heights).err().map(|error| format!("{error}. The heights are not kept"))
    }
}
