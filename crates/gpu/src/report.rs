//! What a device was given to do, for people.

use std::time::Duration;

use tetrascope_scene::{BufferRole, DeviceBuffer, DeviceReport, GpuPath, Stage};

use crate::draw::{Drawing, Means, Path};
use crate::frame::{ordered, sorted};
use crate::kept::Kept;
use crate::kernels::{Variant, describe};
use crate::sorting::InPixels;
use crate::triangles::LightAt;

impl Drawing<'_> {
    /// What drew the picture, with which memory, and how long it took.
    pub(crate) fn report(
        &self,
        kept: &Kept,
        means: &Means,
        sort: InPixels,
        stages: Vec<(Stage, Duration)>,
        notes: Vec<String>,
    ) -> DeviceReport {
        let renderer = self.renderer;
        let description = renderer.gpu.description();
        let (path, target_bits) = match self.path {
            Path::Compute => (GpuPath::Compute, None),
            Path::Triangles(bits) => (GpuPath::Triangles, Some(bits)),
        };
        let mut buffers: Vec<DeviceBuffer> = Vec::new();
        let mut add = |role, label: &str, bytes: u64| {
            if bytes > 0 {
                buffers.push(DeviceBuffer { label: label.to_owned(), role, bytes });
            }
        };
        for (label, bytes) in renderer.mesh.bytes() {
            add(BufferRole::Mesh, label, bytes);
        }
        add(BufferRole::Mesh, "gradients", kept.gradient_bytes().unwrap_or_default());
        for (role, label, bytes) in kept.bytes() {
            add(role, label, bytes);
        }
        add(BufferRole::Lookup, "transfer function", means.lookups.bytes());
        add(BufferRole::Lookup, "isosurfaces and light", means.effects.bytes());
        let pipelines = match self.path {
            Path::Compute => {
                let programs = ordered(means, sort).into_iter().chain(sorted(means, sort, kept.slice(&renderer.gpu)));
                let described = |(file, variant): (&str, Variant)| match renderer.kernels.get(
                    &renderer.gpu,
                    file,
                    "draw",
                    &variant,
                ) {
                    Ok(kernel) => describe(file, &variant, &kernel),
                    Err(_) => variant.describe(file),
                };
                programs.map(described).collect()
            }
            Path::Triangles(_) => vec![means.variant.describe(LightAt::of(self.plan).file())],
        };
        DeviceReport {
            name: description.name.clone(),
            driver: description.driver.clone(),
            api: description.backend.clone(),
            path,
            target_bits,
            buffers,
            stages: stages.into_iter().map(|(stage, time)| (stage.to_string(), time)).collect(),
            pipelines,
            notes,
        }
    }
}
