//! Programs on a device: pipelines that are bound by name.

use tetrascope_shaders::{Binding, Program};
use wgpu::{BindGroup, BindingResource, Buffer, BufferUsages, CommandEncoder, ComputePass, ComputePipeline};

use crate::Gpu;

/// Things to bind, by the names that the shaders give them. A kernel takes those that it uses.
pub(crate) type Named<'a> = (&'a str, BindingResource<'a>);

/// One compute entry point, ready to run.
#[derive(Debug)]
pub(crate) struct Kernel {
    name: String,
    pipeline: ComputePipeline,
    bindings: Vec<Binding>,
}

impl Kernel {
    /// Builds the pipeline of an entry point.
    pub(crate) fn new(gpu: &Gpu, program: &Program, entry_point: &str) -> Self {
        let name = format!("{} {entry_point}", program.name());
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(program.name()),
            source: wgpu::ShaderSource::Wgsl(program.source().into()),
        });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&name),
            layout: None,
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        Self { name, pipeline, bindings: program.bindings(entry_point) }
    }

    /// What it binds.
    pub(crate) fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    /// Binds what it uses.
    ///
    /// # Panics
    /// If something that it uses is not among `resources`: a defect here.
    pub(crate) fn bind(&self, gpu: &Gpu, resources: &[Named<'_>]) -> BindGroup {
        bind(gpu, &self.name, &self.pipeline.get_bind_group_layout(0), &self.bindings, resources)
    }

    /// Runs it over so many groups, in as many dimensions as it takes; see `include/list.wgsl`.
    pub(crate) fn run(&self, pass: &mut ComputePass<'_>, group: &BindGroup, groups: u32) {
        if groups > 0 {
            let [x, y] = spread(groups);
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    /// A pass of its own with this kernel alone, over a rectangle of groups.
    pub(crate) fn run_over(&self, encoder: &mut CommandEncoder, group: &BindGroup, [x, y]: [u32; 2]) {
        let descriptor = wgpu::ComputePassDescriptor { label: Some(&self.name), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(x, y, 1);
    }

    /// A pass of its own with this kernel alone.
    pub(crate) fn run_alone(&self, encoder: &mut CommandEncoder, group: &BindGroup, groups: u32) {
        let descriptor = wgpu::ComputePassDescriptor { label: Some(&self.name), timestamp_writes: None };
        self.run(&mut encoder.begin_compute_pass(&descriptor), group, groups);
    }
}

/// Binds what a pipeline uses of what there is.
///
/// # Panics
/// If something that it uses is not among `resources`: a defect here.
pub(crate) fn bind(
    gpu: &Gpu,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    bindings: &[Binding],
    resources: &[Named<'_>],
) -> BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = bindings
        .iter()
        .map(|binding| {
            let found = resources.iter().find(|(name, _)| *name == binding.name);
            let Some((_, resource)) = found else { panic!("{label} uses {}, which nobody gave", binding.name) };
            wgpu::BindGroupEntry { binding: binding.number, resource: resource.clone() }
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

/// Groups as a grid: no dimension may have more than 65535. May have some to spare.
pub(crate) fn spread(groups: u32) -> [u32; 2] {
    const MOST: u32 = 65_535;
    let rows = groups.div_ceil(MOST).max(1);
    [groups.div_ceil(rows), rows]
}

impl Gpu {
    /// A buffer of so many bytes, zeros; at least one that can be bound.
    pub(crate) fn buffer(&self, label: &str, bytes: u64, usage: BufferUsages) -> Buffer {
        self.asks_for(bytes);
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes.max(16).next_multiple_of(16),
            usage,
            mapped_at_creation: false,
        })
    }

    /// A storage buffer that can be written, and copied from.
    pub(crate) fn storage(&self, label: &str, bytes: u64) -> Buffer {
        self.buffer(label, bytes, BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC)
    }

    /// A storage buffer with contents.
    pub(crate) fn storage_of<T: bytemuck::NoUninit>(&self, label: &str, contents: &[T]) -> Buffer {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        let buffer = self.storage(label, bytes.len() as u64);
        if !bytes.is_empty() {
            self.queue.write_buffer(&buffer, 0, bytes);
        }
        buffer
    }

    /// A uniform buffer with contents.
    pub(crate) fn uniform_of<T: bytemuck::NoUninit>(&self, label: &str, contents: &T) -> Buffer {
        let bytes = bytemuck::bytes_of(contents);
        let buffer = self.buffer(label, bytes.len() as u64, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// Waits for the contents of a buffer that can be mapped: its first `bytes`, after all that was submitted.
    ///
    /// # Errors
    /// What the driver says if the device does not answer.
    pub(crate) fn contents(&self, buffer: &Buffer, bytes: u64) -> Result<Vec<u8>, String> {
        let slice = buffer.slice(..bytes);
        let (sender, receiver) = std::sync::mpsc::channel();
        slice.map_async(wgpu::MapMode::Read, move |result| {
            // Nobody waits any more if the device is gone.
            let _ = sender.send(result);
        });
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| error.to_string())?;
        receiver.recv().map_err(|error| error.to_string())?.map_err(|error| error.to_string())?;
        let contents = slice.get_mapped_range().map_err(|error| error.to_string())?.to_vec();
        buffer.unmap();
        Ok(contents)
    }

    /// Submits commands and waits for the contents of any buffer: the first `bytes` of it.
    ///
    /// # Errors
    /// As [`Self::contents`].
    #[cfg(test)]
    pub(crate) fn read(&self, mut encoder: CommandEncoder, from: &Buffer, bytes: u64) -> Result<Vec<u8>, String> {
        let bytes = bytes.next_multiple_of(4);
        let target = self.buffer("read-back", bytes, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        encoder.copy_buffer_to_buffer(from, 0, &target, 0, bytes);
        self.queue.submit([encoder.finish()]);
        self.contents(&target, bytes)
    }

    /// An encoder for commands.
    pub(crate) fn encoder(&self, label: &str) -> CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) })
    }
}
