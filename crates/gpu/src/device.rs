//! Adapters, and the device that one of them gives.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use wgpu::{Adapter, Backends, Device, Features, Instance, InstanceDescriptor, Limits, Queue};

use crate::GpuError;

/// What is used where an adapter has it, and never needed.
const WELCOME: Features = Features::TIMESTAMP_QUERY.union(Features::FLOAT32_BLENDABLE);

/// Bytes that a choice may limit bindings to, at least.
const LEAST_BINDING: u64 = 1 << 16;

/// An adapter, as it calls itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterDescription {
    /// Name of the device.
    pub name: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Through what it is reached: `vulkan`, `metal`, `dx12`, `gl`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    pub kind: &'static str,
    /// Whether it can draw: it has what every browser gives.
    pub is_capable: bool,
    /// Whether it blends into 32-bit floats.
    pub blends_32_bits: bool,
    /// Whether it tells how long a stage takes.
    pub has_timestamps: bool,
    /// Bytes that one binding may have.
    pub largest_binding: u64,
    /// Bytes that one buffer may have.
    pub largest_buffer: u64,
}

impl AdapterDescription {
    /// Whether it is a program for processors.
    pub fn is_software(&self) -> bool {
        self.kind == "cpu"
    }
}

/// Which adapter is wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AdapterChoice {
    /// A part of its name, or a number in the list of [`adapters`]; `None` takes the fastest kind there is.
    pub name: Option<String>,
    /// Asks for no more than every browser gives, whatever the adapter has.
    pub default_limits: bool,
    /// Binds no more bytes at once, whatever the device takes: larger meshes and pictures are then drawn in parts. At least 64 KiB.
    pub largest_binding: Option<u64>,
}

/// An open device. Everything that is drawn with it shares it.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: Device,
    pub(crate) queue: Queue,
    description: AdapterDescription,
    /// Why the device is gone, once it is.
    lost: Arc<Mutex<Option<String>>>,
    /// Bytes of the buffers that the attempt under way asked for.
    asked: AtomicU64,
    /// Bytes of one binding, at most.
    most: u64,
}

/// An instance that reaches whatever there is, without a window.
fn instance() -> Instance {
    let mut descriptor = InstanceDescriptor::new_without_display_handle();
    descriptor.backends = Backends::PRIMARY | Backends::GL;
    Instance::new(descriptor)
}

fn all_adapters() -> Vec<Adapter> {
    let mut adapters = pollster::block_on(instance().enumerate_adapters(Backends::all()));
    // Fast kinds first; of one kind those that can blend 32 bits, as GL cannot.
    adapters.sort_by_key(|adapter| {
        let description = describe(adapter);
        let kind = ["discrete", "integrated", "virtual", "other", "cpu"];
        let speed = kind.iter().position(|kind| *kind == description.kind).unwrap_or(kind.len());
        (!description.is_capable, speed, !description.blends_32_bits)
    });
    adapters
}

fn describe(adapter: &Adapter) -> AdapterDescription {
    let (info, limits, features) = (adapter.get_info(), adapter.limits(), adapter.features());
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "discrete",
        wgpu::DeviceType::IntegratedGpu => "integrated",
        wgpu::DeviceType::VirtualGpu => "virtual",
        wgpu::DeviceType::Cpu => "cpu",
        wgpu::DeviceType::Other => "other",
    };
    let driver = format!("{} {}", info.driver, info.driver_info).trim().to_owned();
    AdapterDescription {
        name: info.name,
        driver,
        backend: info.backend.to_string(),
        kind,
        is_capable: can_draw(adapter),
        blends_32_bits: features.contains(Features::FLOAT32_BLENDABLE),
        has_timestamps: features.contains(Features::TIMESTAMP_QUERY),
        largest_binding: limits.max_storage_buffer_binding_size,
        largest_buffer: limits.max_buffer_size,
    }
}

/// Whether it has what every browser's WebGPU has.
fn can_draw(adapter: &Adapter) -> bool {
    let flags = adapter.get_downlevel_capabilities().flags;
    flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS) && Limits::default().check_limits(&adapter.limits())
}

/// All adapters that this machine has, the one that is taken without a name first.
pub fn adapters() -> Vec<AdapterDescription> {
    all_adapters().iter().map(describe).collect()
}

impl Gpu {
    /// Opens an adapter.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`], [`GpuError::NoSuchAdapter`] and [`GpuError::Device`].
    pub fn open(choice: &AdapterChoice) -> Result<Self, GpuError> {
        let adapters = all_adapters();
        let descriptions: Vec<AdapterDescription> = adapters.iter().map(describe).collect();
        let place = match &choice.name {
            None => descriptions.iter().position(|description| description.is_capable),
            Some(name) => Some(
                find(&descriptions, name)
                    .ok_or_else(|| GpuError::NoSuchAdapter { name: name.clone(), known: known(&descriptions) })?,
            ),
        };
        let place = place.ok_or_else(|| GpuError::NoAdapter {
            problem: match descriptions.first() {
                None => "no driver answers".to_owned(),
                Some(first) => format!("\"{}\" lacks what every browser gives", first.name),
            },
        })?;
        Self::open_adapter(&adapters[place], choice)
    }

    fn open_adapter(adapter: &Adapter, choice: &AdapterChoice) -> Result<Self, GpuError> {
        let description = describe(adapter);
        let mut limits = Limits::default();
        if !choice.default_limits {
            let most = adapter.limits();
            limits.max_buffer_size = most.max_buffer_size;
            limits.max_storage_buffer_binding_size = most.max_storage_buffer_binding_size;
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("tetrascope"),
            required_features: adapter.features() & WELCOME,
            required_limits: limits,
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| GpuError::Device { adapter: description.name.clone(), problem: error.to_string() })?;
        let lost = Arc::new(Mutex::new(None));
        let told = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, message| {
            *told.lock().unwrap_or_else(PoisonError::into_inner) = Some(format!("{reason:?}, {message}"));
        });
        let limits = device.limits();
        // Whole vectors.
        let taken = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) & !15;
        let most = choice.largest_binding.map_or(taken, |most| most.max(LEAST_BINDING).min(taken));
        Ok(Self { device, queue, description, lost, asked: AtomicU64::new(0), most })
    }

    /// What it is.
    pub fn description(&self) -> &AdapterDescription {
        &self.description
    }

    /// Why it is gone, if it is.
    pub(crate) fn lost(&self) -> Option<String> {
        self.lost.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Runs what is done for a frame, and says what the driver had against it.
    ///
    /// - `frame`: its number, for messages; 0 before the first
    ///
    /// # Errors
    /// Those of `work`; [`GpuError::Lost`], [`GpuError::OutOfMemory`] and [`GpuError::Driver`], whatever `work` gave.
    pub(crate) fn attempt<T>(&self, frame: u64, work: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
        self.asked.store(0, Ordering::Relaxed);
        let scopes = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory]
            .map(|filter| self.device.push_error_scope(filter));
        let done = work();
        let adapter = self.description.name.clone();
        let mut found = None;
        // The last one first.
        for scope in scopes.into_iter().rev() {
            let error = pollster::block_on(scope.pop());
            found = found.or(error);
        }
        if let Some(problem) = self.lost() {
            return Err(GpuError::Lost { adapter, frame, problem });
        }
        match found {
            None => done,
            Some(wgpu::Error::OutOfMemory { .. }) => {
                Err(GpuError::OutOfMemory { adapter, needed: self.asked.load(Ordering::Relaxed) })
            }
            Some(error) => Err(GpuError::Driver { adapter, frame, problem: error.to_string() }),
        }
    }

    /// Notes bytes of a buffer.
    pub(crate) fn asks_for(&self, bytes: u64) {
        self.asked.fetch_add(bytes, Ordering::Relaxed);
    }

    /// Bytes that one binding may have on this device.
    pub(crate) fn largest_binding(&self) -> u64 {
        self.most
    }
}

fn find(descriptions: &[AdapterDescription], name: &str) -> Option<usize> {
    // A number in the list; a larger one is a part of a name.
    if let Some(number) = name.parse::<usize>().ok().filter(|number| *number < descriptions.len()) {
        return Some(number);
    }
    let name = name.to_lowercase();
    let text = |d: &AdapterDescription| format!("{} {} {}", d.backend, d.name, d.driver).to_lowercase();
    descriptions.iter().position(|description| text(description).contains(&name))
}

fn known(descriptions: &[AdapterDescription]) -> String {
    if descriptions.is_empty() {
        return "none".to_owned();
    }
    let names: Vec<String> = descriptions.iter().map(|d| format!("\"{}\" ({})", d.name, d.backend)).collect();
    names.join(", ")
}
