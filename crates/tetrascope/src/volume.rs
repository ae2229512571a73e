//! A mesh that was read and cut into tetrahedra, and a field on it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use tetrascope_cpu::{CpuRenderer, reference};
use tetrascope_gpu::GpuError;
use tetrascope_io::{ReadOptions, file_length, read_mesh};
use tetrascope_mesh::{Cells, Dataset, Decomposition, StructuredBlock, decompose};
use tetrascope_scene::{
    ArraySummary, Backend, Field, FieldError, FieldOnMesh, MeshFacts, Plan, Progress, Rendered, Stage, Work,
    place_on_mesh, select_cell_field, select_field, summarize_arrays,
};

use crate::Error;
use crate::made::Made;
use crate::memory;
use crate::threads::on_threads;

/// The path of the built-in sample: a name in place of a file, in scene files and on the command line.
pub const SAMPLE: &str = "builtin:rings";

/// Hexahedra along a side of the sample: coarse enough that its thin shells lie well inside cells.
const SAMPLE_CELLS: usize = 24;

/// A mesh with its arrays, cut into tetrahedra.
#[derive(Clone, Debug)]
pub struct Volume {
    /// The file that it came from, for messages.
    pub source_name: String,
    /// The mesh file itself; `None` for what was never in a file.
    pub path: Option<PathBuf>,
    /// The format, with what was found out about it.
    pub format: String,
    /// What the reader found odd and how it was treated.
    pub warnings: Vec<String>,
    /// Points, cells and arrays as the file has them.
    pub dataset: Dataset,
    /// The tetrahedra, and what was left out.
    pub decomposition: Decomposition,
    /// The times of all steps that the file has; empty where it knows no time.
    pub times: Vec<f64>,
    /// Which of these was read.
    pub step: usize,
    /// Wall time of reading and of cutting.
    pub timings: [(&'static str, Duration); 2],
}

impl Volume {
    /// Reads a mesh file and cuts its cells into tetrahedra.
    ///
    /// The path [`SAMPLE`] stands for [`Volume::sample`].
    ///
    /// # Errors
    /// [`Error::Io`] if the file is not read, [`Error::Mesh`] if nothing in it has a volume, [`Error::MeshMemory`] if either cannot be held.
    pub fn load(path: &Path, options: &ReadOptions) -> Result<Self, Error> {
        if is_builtin(path) {
            let source_name = path.display().to_string();
            options.step.of(&[]).map_err(|problem| Error::NoSuchStep { source_name, problem })?;
            return if path == Path::new(SAMPLE) {
                Self::sample()
            } else {
                Err(Error::NoSuchSample { name: path.to_owned() })
            };
        }
        let start = Instant::now();
        // What cannot be looked at is the reader's to tell.
        memory::check_file(file_length(path) + options.solution.as_deref().map_or(0, file_length))
            .map_err(|error| Error::MeshMemory { source_name: path.display().to_string(), error })?;
        let loaded = read_mesh(path, options)?;
        let read = start.elapsed();
        let mut volume = Self::from_dataset(loaded.dataset, &path.display().to_string())?;
        volume.path = Some(path.to_owned());
        volume.format = loaded.format;
        volume.warnings = loaded.warnings;
        (volume.times, volume.step) = (loaded.times, loaded.step);
        volume.timings[0].1 = read;
        Ok(volume)
    }

    /// A mesh that the caller has made. `source_name` is what messages call it.
    ///
    /// # Errors
    /// [`Error::Mesh`] if nothing in it has a volume, [`Error::MeshMemory`] if its tetrahedra cannot be held.
    pub fn from_dataset(dataset: Dataset, source_name: &str) -> Result<Self, Error> {
        memory::check_mesh(cell_count(&dataset.cells), dataset.points.len())
            .map_err(|error| Error::MeshMemory { source_name: source_name.to_owned(), error })?;
        let start = Instant::now();
        let decomposition =
            decompose(&dataset).map_err(|error| Error::Mesh { source_name: source_name.to_owned(), error })?;
        Ok(Self {
            source_name: source_name.to_owned(),
            path: None,
            format: "in memory".to_owned(),
            warnings: Vec::new(),
            times: Vec::new(),
            step: 0,
            dataset,
            decomposition,
            timings: [("read", Duration::ZERO), ("decompose", start.elapsed())],
        })
    }

    /// The built-in sample: the distance from a sphere on a coarse mesh, after [Röttger 2000], figure 3.
    ///
    /// # Errors
    /// None in practice; the sample takes the way of every other mesh.
    pub fn sample() -> Result<Self, Error> {
        let start = Instant::now();
        let dataset = tetrascope_mesh::rings_sample(SAMPLE_CELLS);
        let made = start.elapsed();
        let mut volume = Self::from_dataset(dataset, SAMPLE)?;
        "built-in sample".clone_into(&mut volume.format);
        volume.timings[0].1 = made;
        Ok(volume)
    }

    /// Which time step was read; `None` of a file that knows no time.
    pub fn step_of_several(&self) -> Option<usize> {
        (!self.times.is_empty()).then_some(self.step)
    }

    /// All arrays with their ranges.
    pub fn arrays(&self) -> Vec<ArraySummary> {
        summarize_arrays(&self.dataset)
    }

    /// The field of this name, see [`select_field`]; without a name the first scalar.
    ///
    /// # Errors
    /// [`Error::Field`] with all arrays if there is none of this name, or if it has no finite value.
    pub fn field(&self, name: Option<&str>) -> Result<VolumeField<'_>, Error> {
        self.place(select_field(&self.dataset, name))
    }

    /// The cell array of this name as one constant a cell, see [`select_cell_field`]; without a name the first scalar one.
    ///
    /// # Errors
    /// [`Error::Field`] with all arrays if there is none of this name, if it has no finite value, or if the cells have too many corners;
    /// [`Error::MeshMemory`] if these cannot be held.
    pub fn cell_field(&self, name: Option<&str>) -> Result<VolumeField<'_>, Error> {
        memory::check_cell_points(cell_count(&self.dataset.cells))
            .map_err(|error| Error::MeshMemory { source_name: self.source_name.clone(), error })?;
        self.place(select_cell_field(&self.dataset, name))
    }

    fn place(&self, field: Result<Field, FieldError>) -> Result<VolumeField<'_>, Error> {
        let named = |error| Error::Field { source_name: self.source_name.clone(), error };
        let field = field.map_err(named)?;
        let on_mesh = place_on_mesh(&field, &self.decomposition).map_err(named)?;
        let facts = MeshFacts::new(&self.decomposition.mesh, on_mesh.range).ok_or_else(|| Error::Mesh {
            source_name: self.source_name.clone(),
            error: tetrascope_mesh::MeshError::NoCells { points: self.dataset.points.len() },
        })?;
        Ok(VolumeField { field, on_mesh, facts, mesh_path: self.path.as_deref(), made: Arc::default() })
    }
}

/// A scalar on the tetrahedra of a [`Volume`], ready to be drawn.
///
/// What the renderer learns of mesh and field it keeps from picture to picture; clones share it.
#[derive(Clone, Debug)]
pub struct VolumeField<'a> {
    /// Name, origin, notes and warnings of the choice.
    pub field: Field,
    /// The tetrahedra on which it is finite.
    pub on_mesh: FieldOnMesh<'a>,
    /// What defaults are made from.
    pub facts: MeshFacts,
    pub(crate) mesh_path: Option<&'a Path>,
    pub(crate) made: Arc<Made>,
}

impl VolumeField<'_> {
    /// Draws the field as the plan says, with the back end that the plan names and no other.
    ///
    /// # Errors
    /// [`Error::Render`]; [`Error::is_interrupted`] is true of it where `progress` said so; with the back end `gpu` [`Error::Gpu`]: a device that was lost is opened anew for the next picture.
    pub fn render(&self, plan: &Plan, progress: &dyn Progress) -> Result<Rendered, Error> {
        let start = Instant::now();
        let (mut rendered, prepared) = match plan.backend {
            Backend::Reference => {
                return Ok(reference::render(self.mesh(), &self.on_mesh.scalars, plan, progress)?);
            }
            Backend::Cpu => {
                let renderer = self.renderer_on(plan.threads)?;
                let prepared = start.elapsed();
                // A frame that fails leaves nothing of it.
                let held = self.made.forget_frame();
                let rendered = renderer.render(plan, progress)?;
                self.made.has_drawn(rendered.counts.drawn.max(held));
                (rendered, prepared)
            }
            Backend::Gpu => {
                let adapter = plan.gpu.adapter.as_deref();
                on_threads(plan.threads, || {
                    let renderer = self.gpu_renderer(adapter)?;
                    let prepared = start.elapsed();
                    let rendered = renderer.render(plan, progress).inspect_err(|error| {
                        if matches!(error, GpuError::Lost { .. }) {
                            self.forget_device(adapter);
                        }
                    })?;
                    Ok::<_, Error>((rendered, prepared))
                })??
            }
        };
        // Making the renderer is a part of preparing, unless it was there already.
        match rendered.timings.iter_mut().find(|(stage, _)| *stage == Stage::Prepare) {
            Some((_, time)) => *time += prepared,
            None => rendered.timings.insert(0, (Stage::Prepare, prepared)),
        }
        Ok(rendered)
    }

    /// What a plan asks for on this field, without drawing anything.
    ///
    /// # Errors
    /// [`Error::Render`] for maps of isosurfaces of no possible size.
    pub fn work(&self, plan: &Plan) -> Result<Work, Error> {
        let wrong = |error| Error::Render(tetrascope_scene::PlanError::from(error).into());
        Work::of(plan, self.mesh(), &self.on_mesh.scalars).map_err(wrong)
    }

    /// [`Self::renderer`], made on so many threads if it is not made yet.
    pub(crate) fn renderer_on(&self, threads: Option<usize>) -> Result<&CpuRenderer, Error> {
        on_threads(threads, || self.renderer())?
    }
}

/// Cells that may have a volume.
fn cell_count(cells: &Cells) -> usize {
    match cells {
        Cells::Unstructured(cells) => cells.kinds.iter().filter(|kind| !kind.is_flat()).count(),
        Cells::Structured(blocks) => blocks.iter().map(StructuredBlock::cell_count).sum(),
    }
}

/// Where a path in a scene file leads: relative to the scene file's folder, unless it names a built-in mesh.
pub fn resolve_path(base_dir: &Path, path: &Path) -> PathBuf {
    if is_builtin(path) { path.to_owned() } else { base_dir.join(path) }
}

/// Whether a path names a mesh that is built in.
pub fn is_builtin(path: &Path) -> bool {
    path.to_str().is_some_and(|p| p.starts_with("builtin:"))
}
