//! The ways to a picture that all tests of whole scenes compare.

use std::fmt;

use tetrascope::{Backend, Choice, Error, GpuPath, LinearImage, SceneFile, Silent, Volume};

use crate::gpu;

/// Who draws a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The fast renderer.
    Cpu,
    /// The renderer in f64.
    Reference,
    /// Tiles in compute programs.
    Compute,
    /// Silhouettes that the hardware blends, in 32 bits unless the scene asks for others.
    Triangles,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Cpu, Self::Reference, Self::Compute, Self::Triangles];

    /// Those that need no device.
    pub const CPU: [Self; 2] = [Self::Cpu, Self::Reference];

    /// Whether it needs a device.
    pub fn needs_gpu(self) -> bool {
        matches!(self, Self::Compute | Self::Triangles)
    }

    /// All that this machine has; says loudly where those of the GPU are left out.
    pub fn here(test: &str) -> Vec<Self> {
        let has_gpu = gpu::gpu(test).is_some();
        Self::ALL.into_iter().filter(|way| has_gpu || !way.needs_gpu()).collect()
    }

    /// The scene with this way asked for by name.
    pub fn scene(self, scene: &SceneFile) -> SceneFile {
        let mut scene = scene.clone();
        let (backend, path) = match self {
            Self::Cpu => (Backend::Cpu, None),
            Self::Reference => (Backend::Reference, None),
            Self::Compute => (Backend::Gpu, Some(GpuPath::Compute)),
            Self::Triangles => (Backend::Gpu, Some(GpuPath::Triangles)),
        };
        scene.quality.backend = Choice::Named(backend);
        if let Some(path) = path {
            scene.quality.adapter = Some(gpu::adapter());
            scene.quality.gpu_path = Some(Choice::Named(path));
            let asked_for = scene.quality.target_bits.filter(|_| path == GpuPath::Triangles);
            scene.quality.target_bits = (path == GpuPath::Triangles).then_some(asked_for.unwrap_or(32));
        }
        scene
    }

    /// The picture of a scene, with everything that the user is told.
    ///
    /// # Errors
    /// As [`tetrascope::render_volume`].
    pub fn draw(self, volume: &Volume, scene: &SceneFile) -> Result<Drawn, Error> {
        let picture = tetrascope::render_volume(volume, &self.scene(scene), &Silent)?;
        Ok(Drawn { image: picture.image, warnings: picture.warnings })
    }

    /// The picture alone, on so many threads.
    ///
    /// # Errors
    /// As [`tetrascope::render_volume`].
    pub fn draw_on(self, volume: &Volume, scene: &SceneFile, threads: usize) -> Result<LinearImage, Error> {
        let field = volume.field(scene.mesh.field.as_deref())?;
        let mut completed = self.scene(scene).complete(&field.facts)?;
        completed.scene.threads = Some(threads);
        let plan = field.plan(&mut completed)?;
        Ok(field.render(&plan, &Silent)?.image)
    }
}

/// A picture, and what was said about it.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Linear, premultiplied.
    pub image: LinearImage,
    /// One sentence each.
    pub warnings: Vec<String>,
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cpu => "cpu",
            Self::Reference => "reference",
            Self::Compute => "gpu compute",
            Self::Triangles => "gpu triangles",
        })
    }
}
