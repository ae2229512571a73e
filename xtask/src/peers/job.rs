//! A scene as files that other programs read: the mesh as VTU, everything else as JSON.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tetrascope::mesh::{ArrayValues, CellKind, Cells, DataArray, Dataset, UnstructuredCells};
use tetrascope::{OpticalModel, Projection, Scene, SceneFile, VolumeField, write_vtu};

use super::Subject;
use crate::Failure;

/// One of VTK's mappers for tetrahedra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mapper {
    /// `vtkProjectedTetrahedraMapper`.
    Projected,
    /// `vtkUnstructuredGridVolumeRayCastMapper`, with its function by Bunyk and partial pre-integration.
    RayCast,
}

/// Which cells are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Subset {
    /// All that the mesh has.
    All,
    /// Those that have a volume.
    WithVolume,
}

/// The files of a scene.
#[derive(Debug)]
pub(super) struct Job {
    folder: PathBuf,
    name: String,
    /// What all mappers are told alike.
    common: Value,
    pub(super) size: [u32; 2],
    /// Whether the mesh has cells that are left out by [`Subset::WithVolume`].
    pub(super) has_flat_cells: bool,
}

/// Why VTK has nothing like a scene; `None` if it has.
pub(super) fn untranslatable(scene: &SceneFile) -> Option<&'static str> {
    if scene.optics.model != OpticalModel::DensityEmitter {
        Some("VTK has no such optical model")
    } else if scene.isosurface.is_empty() {
        None
    } else {
        Some("VTK's mappers have no isosurfaces")
    }
}

impl Job {
    /// Writes the mesh, and without its cells of no volume where it has such.
    pub(super) fn write(subject: &Subject, folder: &Path) -> Result<Self, Failure> {
        let field = subject.volume.field(subject.scene.mesh.field.as_deref())?;
        let scene = subject.scene.complete(&field.facts)?.scene;
        let with_volume = with_volume(&field);
        let given = &subject.volume.dataset;
        let drawn = field.on_mesh.mesh.tetrahedra().len();
        let tetrahedra = match &given.cells {
            Cells::Unstructured(cells) if cells.kinds.iter().all(|kind| *kind == CellKind::Tetrahedron) => {
                Some(cells.kinds.len())
            }
            _ => None,
        };
        let has_flat_cells = tetrahedra.is_some_and(|count| count > drawn);
        let job = Self {
            folder: folder.to_owned(),
            name: subject.name.clone(),
            common: common(&scene, subject.is_merged),
            size: [scene.width, scene.height],
            has_flat_cells,
        };
        write_vtu(&job.mesh(Subset::WithVolume), &with_volume)?;
        // Projected tetrahedra take nothing but tetrahedra, and a field of that name.
        let all = if tetrahedra.is_some() { with_values(given, &field.field.values) } else { with_volume };
        write_vtu(&job.mesh(Subset::All), &all)?;
        Ok(job)
    }

    fn mesh(&self, subset: Subset) -> PathBuf {
        let ending = if subset == Subset::All { "all" } else { "with-volume" };
        self.folder.join(format!("{}-{ending}.vtu", self.name))
    }

    /// Writes what one mapper is to do. Gives the file's path and those of the pictures of the first and the second frame.
    pub(super) fn order(
        &self,
        mapper: Mapper,
        subset: Subset,
        is_aligned: bool,
    ) -> Result<(PathBuf, [PathBuf; 2]), Failure> {
        let mapper = if mapper == Mapper::Projected { "projected-tetrahedra" } else { "ray-cast" };
        let place = if is_aligned { "-aligned" } else { "" };
        let cells = if subset == Subset::All { "" } else { "-with-volume" };
        let stem = format!("{}-{mapper}{place}{cells}", self.name);
        let pictures = ["first", "second"].map(|frame| self.folder.join(format!("{stem}-{frame}.f32")));
        for picture in &pictures {
            // What an earlier run left must not pass for this one's.
            if picture.exists() {
                fs::remove_file(picture)?;
            }
        }
        let mut job = self.common.clone();
        job["mesh"] = json!(self.mesh(subset));
        job["mapper"] = json!(mapper);
        job["aligned"] = json!(is_aligned);
        job["pictures"] = json!(pictures);
        let path = self.folder.join(format!("{stem}.json"));
        fs::write(&path, serde_json::to_string_pretty(&job)?)?;
        Ok((path, pictures))
    }
}

/// Camera, size and transfer function, all numbers as the scene has them.
pub(super) fn common(scene: &Scene, is_merged: bool) -> Value {
    let camera = &scene.camera;
    let mut placed = json!({
        "eye": camera.eye.to_array(),
        "target": camera.target.to_array(),
        "up": camera.up.to_array(),
    });
    match camera.projection {
        Projection::Perspective { fov_y } => {
            placed["projection"] = json!("perspective");
            placed["fov_y"] = json!(fov_y.to_degrees());
        }
        Projection::Orthographic { height } => {
            placed["projection"] = json!("orthographic");
            placed["height"] = json!(height);
        }
    }
    json!({
        "field": FIELD,
        "camera": placed,
        "size": [scene.width, scene.height],
        "color": scene.color,
        "extinction": scene.extinction,
        "merged": is_merged,
    })
}

/// The name of the scalar in all meshes that are written.
const FIELD: &str = "field";

/// The points and cells of a dataset with one scalar a point.
fn with_values(given: &Dataset, values: &[f64]) -> Dataset {
    Dataset { point_arrays: vec![scalar(values)], cell_arrays: Vec::new(), ..given.clone() }
}

fn scalar(values: &[f64]) -> DataArray {
    DataArray { name: FIELD.to_owned(), components: 1, values: ArrayValues::F64(values.to_vec()) }
}

/// The tetrahedra that we draw, in world coordinates.
fn with_volume(field: &VolumeField<'_>) -> Dataset {
    let mesh = &field.on_mesh.mesh;
    let count = mesh.tetrahedra().len();
    Dataset {
        points: mesh.positions().iter().map(|&p| mesh.frame().to_world(p)).collect(),
        cells: Cells::Unstructured(UnstructuredCells {
            kinds: vec![CellKind::Tetrahedron; count],
            offsets: (0..=count).map(|cell| 4 * cell).collect(),
            connectivity: mesh.tetrahedra().iter().flatten().map(|v| v.0).collect(),
            polyhedra: Vec::new(),
        }),
        point_arrays: vec![scalar(&field.on_mesh.scalars)],
        cell_arrays: Vec::new(),
    }
}
