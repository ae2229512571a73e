//! What hardware blends into, and pictures for display.

use tetrascope_scene::TargetBits;
use tetrascope_shaders::{Binding, Program};
use wgpu::{
    CommandEncoder, Features, RenderPassTimestampWrites, RenderPipeline, TextureFormat, TextureUsages, TextureView,
};

use crate::kernel::{Named, bind};
use crate::{Gpu, GpuError};

/// The most precise target that a device blends into.
pub(crate) fn best_target(gpu: &Gpu) -> TargetBits {
    if blends(gpu, TargetBits::ThirtyTwo) { TargetBits::ThirtyTwo } else { TargetBits::Sixteen }
}

/// Whether a device blends into a target: 16 bits every one does.
pub(crate) fn blends(gpu: &Gpu, bits: TargetBits) -> bool {
    bits == TargetBits::Sixteen || gpu.device.features().contains(Features::FLOAT32_BLENDABLE)
}

pub(crate) fn format_of(bits: TargetBits) -> TextureFormat {
    match bits {
        TargetBits::ThirtyTwo => TextureFormat::Rgba32Float,
        TargetBits::Sixteen => TextureFormat::Rgba16Float,
    }
}

/// The brightest light that one cell may add: 16-bit floats end at 65504, and their infinity would darken what comes before it.
pub(crate) fn most_light(bits: TargetBits) -> f32 {
    match bits {
        TargetBits::ThirtyTwo => f32::MAX,
        TargetBits::Sixteen => 60_000.0,
    }
}

/// A texture that triangles are blended into: linear light and opacity.
#[derive(Debug)]
pub(crate) struct Target {
    pub(crate) view: TextureView,
    pub(crate) precision: TargetBits,
    size: [u32; 2],
}

impl Target {
    /// Most pixels a row or a column that a device takes: larger pictures are drawn in parts.
    pub(crate) fn largest_side(gpu: &Gpu) -> u32 {
        gpu.device.limits().max_texture_dimension_2d
    }

    /// A target for pictures up to a size, or parts of them.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] for a side beyond [`Self::largest_side`].
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], precision: TargetBits) -> Result<Self, GpuError> {
        let size = size.map(|side| side.max(1));
        let most = Self::largest_side(gpu);
        if size.iter().any(|side| *side > most) {
            let bytes =
                |[width, height]: [u32; 2]| u64::from(width) * u64::from(height) * u64::from(precision.bits() / 2);
            let adapter = gpu.description().name.clone();
            let (needed, limit) = (bytes(size), bytes(size.map(|side| side.min(most))));
            return Err(GpuError::TooLarge { what: "a target of triangles", needed, limit, adapter });
        }
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let view = texture(gpu, "triangles", size, format_of(precision), usage).create_view(&Default::default());
        Ok(Self { view, precision, size })
    }

    /// Width and height, pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Memory that it takes.
    pub(crate) fn bytes(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1]) * u64::from(self.precision.bits() / 2)
    }
}

/// A flat texture.
pub(crate) fn texture(
    gpu: &Gpu,
    label: &str,
    [width, height]: [u32; 2],
    format: TextureFormat,
    usage: TextureUsages,
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// A pipeline that draws triangles from a program without vertex buffers, and what it binds.
#[derive(Debug)]
pub(crate) struct Drawing {
    pub(crate) pipeline: RenderPipeline,
    pub(crate) bindings: Vec<Binding>,
    label: String,
}

impl Drawing {
    pub(crate) fn new(
        gpu: &Gpu,
        program: &Program,
        [vertex, fragment]: [&str; 2],
        format: TextureFormat,
        blend: Option<wgpu::BlendState>,
    ) -> Self {
        let label = format!("{} {fragment}", program.name());
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(program.name()),
            source: wgpu::ShaderSource::Wgsl(program.source().into()),
        });
        let targets = [Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })];
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&label),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        let mut bindings = program.bindings(vertex);
        bindings.extend(program.bindings(fragment));
        bindings.sort_by_key(|binding| binding.number);
        bindings.dedup_by_key(|binding| binding.number);
        Self { pipeline, bindings, label }
    }

    /// Binds what both of its stages use.
    pub(crate) fn bind(&self, gpu: &Gpu, resources: &[Named<'_>]) -> wgpu::BindGroup {
        bind(gpu, &self.label, &self.pipeline.get_bind_group_layout(0), &self.bindings, resources)
    }

    /// A pass that draws into a view; `clear` empties it first.
    pub(crate) fn pass<'a>(
        &self,
        encoder: &'a mut CommandEncoder,
        view: &TextureView,
        clear: bool,
        timestamp_writes: Option<RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'a> {
        let load = if clear { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })],
            timestamp_writes,
            ..Default::default()
        })
    }
}

/// Shows pictures on a screen.
#[derive(Debug)]
pub(crate) struct Display(Drawing);

impl Display {
    /// - `format`: of the views to draw into, one of those that turn linear light into sRGB
    pub(crate) fn new(gpu: &Gpu, format: TextureFormat) -> Result<Self, GpuError> {
        let program = Program::compose("triangles/resolve.wgsl", &[], &[])?;
        Ok(Self(Drawing::new(gpu, &program, ["cover", "resolve"], format, None)))
    }

    /// Draws `picture` over `background` into a view of the size of the part that is drawn.
    ///
    /// - `resources`: `frame`, `picture`, and `background`, a uniform of linear light
    pub(crate) fn record(&self, gpu: &Gpu, encoder: &mut CommandEncoder, resources: &[Named<'_>], view: &TextureView) {
        let group = self.0.bind(gpu, resources);
        let mut pass = self.0.pass(encoder, view, true, None);
        pass.set_pipeline(&self.0.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
