//! Who draws a scene that leaves it open.

use tetrascope_estimate::ROUNDING_OF_32_BITS;
use tetrascope_gpu::{AdapterDescription, GpuError};
use tetrascope_scene::{Backend, Completed, rough};

use crate::{Error, VolumeField};

impl VolumeField<'_> {
    /// Settles a back end that was left open: a GPU where there is one that can draw the scene, else the CPU, with the reason.
    ///
    /// # Errors
    /// [`Error::Scene`] as [`Scene::plan`](tetrascope_scene::Scene::plan).
    pub(crate) fn settle_backend(&self, completed: &mut Completed) -> Result<(), Error> {
        if !completed.leaves_backend_open() {
            return Ok(());
        }
        if completed.max_error() < ROUNDING_OF_32_BITS {
            let reason =
                format!("the others compute in 32 bits, and an error of {} is wanted", rough(completed.max_error()));
            return Ok(completed.settle_backend(Backend::Reference, &reason)?);
        }
        if let Some(conflict) = completed.scene.why_not_on_gpu() {
            return Ok(completed.settle_backend(Backend::Cpu, &conflict.to_string())?);
        }
        let adapter = completed.scene.gpu.adapter.clone();
        let (backend, reason) = match self.try_gpu(adapter.as_deref()) {
            Ok(Ok(reason)) => (Backend::Gpu, reason),
            Ok(Err(reason)) => (Backend::Cpu, reason),
            Err(error) => {
                completed.warnings.push(format!("the back end is cpu, as the GPU failed: {error}"));
                (Backend::Cpu, "the GPU failed".to_owned())
            }
        };
        Ok(completed.settle_backend(backend, &reason)?)
    }

    /// Why the GPU draws, or why the CPU does; an error where a GPU is there and failed.
    fn try_gpu(&self, adapter: Option<&str>) -> Result<Result<String, String>, GpuError> {
        let gpu = match self.gpu(adapter) {
            Ok(gpu) => gpu,
            Err(GpuError::NoAdapter { problem }) => return Ok(Err(format!("no graphics card was found, {problem}"))),
            Err(error) => return Err(error),
        };
        let device = gpu.description();
        // Software that was asked for by name is meant.
        if is_software(device) && adapter.is_none() {
            let reason = format!("no graphics card was found, and \"{}\" is software for processors", device.name);
            return Ok(Err(reason));
        }
        self.gpu_renderer(adapter)?;
        Ok(Ok(format!("\"{}\" by {} is there and takes the mesh", device.name, device.backend)))
    }
}

/// Whether an adapter is a program for processors; the CPU back end is faster than Vulkan on these.
fn is_software(device: &AdapterDescription) -> bool {
    device.kind == "cpu"
}

/// The adapter that `quality.backend = "auto"` draws with, as its place in a list of all; `None` where it draws with the CPU.
///
/// - `adapters`: as [`tetrascope_gpu::adapters`] has them, the one that is taken without a name first
pub fn adapter_of_auto(adapters: &[AdapterDescription]) -> Option<usize> {
    let taken = adapters.iter().position(|adapter| adapter.is_capable)?;
    (!is_software(&adapters[taken])).then_some(taken)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(kind: &'static str, is_capable: bool) -> AdapterDescription {
        AdapterDescription {
            name: kind.to_owned(),
            driver: String::new(),
            backend: "vulkan".to_owned(),
            kind,
            is_capable,
            blends_32_bits: true,
            has_timestamps: true,
            largest_binding: 1 << 27,
            largest_buffer: 1 << 28,
        }
    }

    #[test]
    fn software_is_not_taken_by_itself() {
        let (card, chip) = (adapter("discrete", true), adapter("integrated", true));
        let (software, old) = (adapter("cpu", true), adapter("discrete", false));
        for (adapters, taken) in [
            (vec![], None),
            (vec![card.clone(), chip.clone(), software.clone()], Some(0)),
            (vec![chip, software.clone()], Some(0)),
            (vec![software.clone()], None),
            (vec![software, old.clone()], None),
            (vec![old], None),
        ] {
            assert_eq!(adapter_of_auto(&adapters), taken, "{adapters:?}");
        }
    }
}
