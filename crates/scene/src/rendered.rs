//! A picture, and what it took.

use std::fmt;
use std::time::{Duration, Instant};

use tetrascope_order::Guarantee;
use tetrascope_view::LinearImage;

use crate::{GpuPath, Stage, TargetBits};

/// A picture, and what it took.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture: linear, premultiplied, with no background.
    pub image: LinearImage,
    /// Wall time of each stage, in the order in which they ran.
    pub timings: Vec<(Stage, Duration)>,
    /// What was done.
    pub counts: Counts,
    /// How far the order can be trusted in which cells were blended.
    pub order: OrderReport,
    /// The device that drew it; `None` for back ends that need none.
    pub device: Option<DeviceReport>,
}

/// What a device was, and what it was given to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceReport {
    /// As its driver calls it.
    pub name: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Through what it is reached: `vulkan`, `metal`, `dx12`, `gl`.
    pub api: String,
    /// How cells became pixels.
    pub path: GpuPath,
    /// Bits of a channel of the target, where triangles were blended.
    pub target_bits: Option<TargetBits>,
    /// Memory of the device in use for the picture.
    pub buffers: Vec<DeviceBuffer>,
    /// Time of each stage as the device measured it, in the order in which they ran; empty where it has no clock.
    pub stages: Vec<(String, Duration)>,
    /// The variants of pipelines that drew it.
    pub pipelines: Vec<String>,
    /// What else is worth knowing, in sentences.
    pub notes: Vec<String>,
}

impl DeviceReport {
    /// Bytes of all buffers of one role.
    pub fn bytes(&self, role: BufferRole) -> u64 {
        self.buffers.iter().filter(|buffer| buffer.role == role).map(|buffer| buffer.bytes).sum()
    }
}

/// Memory of a device in use for a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceBuffer {
    /// What is in it.
    pub label: String,
    /// What it is kept for.
    pub role: BufferRole,
    /// Bytes.
    pub bytes: u64,
}

/// What memory of a device is kept for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BufferRole {
    /// Mesh and field: as long as these are drawn.
    Mesh,
    /// The visibility order.
    Order,
    /// Lookups of the transfer function and the isosurfaces: until these change.
    Lookup,
    /// One frame.
    Frame,
}

impl BufferRole {
    /// All roles, those that last longest first.
    pub const ALL: [Self; 4] = [Self::Mesh, Self::Order, Self::Lookup, Self::Frame];
}

impl fmt::Display for BufferRole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mesh => "mesh and field",
            Self::Order => "order",
            Self::Lookup => "lookups",
            Self::Frame => "frame",
        })
    }
}

/// How far the order of a picture can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OrderReport {
    /// What is promised, sorting in the pixels included.
    pub guarantee: Guarantee,
    /// Rings of cells that hide one another, where the order looks for them; [`Counts::cyclic`] has their cells.
    pub rings: u64,
    /// Of these, those that are there after cuts, if the plan asks for cuts.
    pub rings_left: u64,
}

/// What was done for a picture.
///
/// Nothing in it depends on the machine's speed: two pictures of one plan have the same counts. What a back end does not count is `None`, and
/// never 0; [`Self::counts_fragments`] says it of those that are counted in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Tetrahedra of the mesh.
    pub cells: u64,
    /// Of these, left out since the transfer function makes them invisible.
    pub transparent: u64,
    /// Of the visible ones, left out since they lie outside the picture or behind the eye.
    pub outside: u64,
    /// Tetrahedra that were set up and drawn; one that was cut counts as often as it has pieces.
    pub drawn: u64,
    /// Of these, drawn in f64 pixel by pixel: a face is seen nearly edge-on, the cell reaches the plane of the eye, or it is a piece.
    pub careful: u64,
    /// Pairs of a pixel and a tetrahedron whose chord was integrated.
    pub fragments: u64,
    /// Isosurfaces met by rays.
    pub crossings: u64,
    /// Tetrahedra of the mesh that hide one another in rings, where the order looks for them: no order of whole cells is right there.
    pub cyclic: u64,
    /// Of the fragments, those that their pixel held back and sorted.
    pub sorted: u64,
    /// Most fragments that one tile of the picture held back at one time.
    pub most_held: u64,
    /// Whether fragments, crossings and what is sorted are counted. Hardware that rasterizes triangles counts nothing of them: they are
    /// 0 then, and mean nothing.
    pub counts_fragments: bool,
    /// Cells that a visibility order sorted: for this picture, or earlier where its order was kept; 0 where nothing depends on the order
    /// or pixels sort alone. A back end may sort more cells than it draws.
    pub ordered: u64,
    /// Entries of the table that the integration looked light up in; 0 without one.
    pub table_entries: u64,
    /// Texels of the maps that isosurfaces were looked up in, of all maps together; 0 without one.
    pub map_entries: u64,
    /// Points whose gradients were interpolated: all of the mesh, or 0. They are computed once and kept.
    pub point_gradients: u64,
    /// Gradients of cells that were set up for light, one a cell, or two where it has a constant and an interpolated one. `None` where
    /// that is not counted: pixels then compute what they need.
    pub cell_gradients: Option<u64>,
    /// Drawn cells that isosurfaces may cut, or whose volume is lit. `None` where that is not counted.
    pub with_effects: Option<u64>,
    /// Fragments that light fell on, those in cells that a lit surface may cut included. `None` where that is not counted.
    pub lit: Option<u64>,
    /// Drawn cells that were made fans of triangles, for the integration that is defined on them or for an interpolation that starts
    /// from them; without these 0.
    pub fans: u64,
}

/// Measures stages one after another.
#[derive(Clone, Debug)]
pub struct Stopwatch {
    since: Instant,
    timings: Vec<(Stage, Duration)>,
}

impl Stopwatch {
    /// The first stage begins now.
    pub fn start() -> Self {
        Self { since: Instant::now(), timings: Vec::new() }
    }

    /// Ends a stage that began when the last one ended.
    pub fn lap(&mut self, stage: Stage) {
        let now = Instant::now();
        self.timings.push((stage, now - self.since));
        self.since = now;
    }

    /// Wall time of each stage, for [`Rendered::timings`].
    pub fn finish(self) -> Vec<(Stage, Duration)> {
        self.timings
    }
}
