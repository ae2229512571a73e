//! Who computes a picture, and what may be asked of a GPU.

use std::fmt;
use std::str::FromStr;

/// Who computes the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Backend {
    /// Projected tetrahedra on all cores, 32-bit floats per pixel.
    #[default]
    Cpu,
    /// The same on a graphics card, within rounding.
    Gpu,
    /// Every pixel's ray against every tetrahedron in 64-bit floats: slow, and what the others are compared with. It
    /// orders the cells along each ray by itself and takes no [`OrderMethod`](tetrascope_order::OrderMethod).
    Reference,
}

impl Backend {
    /// All back ends.
    pub const ALL: [Self; 3] = [Self::Cpu, Self::Gpu, Self::Reference];
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
            Self::Reference => "reference",
        })
    }
}

/// A name that is none of the back ends'.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no back end named \"{name}\"; there are cpu, gpu and reference")]
pub struct UnknownBackend {
    /// The name.
    pub name: String,
}

impl FromStr for Backend {
    type Err = UnknownBackend;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .into_iter()
            .find(|backend| backend.to_string() == name)
            .ok_or_else(|| UnknownBackend { name: name.to_owned() })
    }
}

/// What a plan asks of the GPU; what is `None` is left to the back end, which knows the device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct GpuOptions {
    /// How cells become pixels.
    pub path: Option<GpuPath>,
    /// Bits of a channel of the target that triangles are blended into.
    pub target_bits: Option<TargetBits>,
    /// A part of the adapter's name, or its number in the list of adapters.
    pub adapter: Option<String>,
}

/// How a GPU makes pixels of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GpuPath {
    /// Fans of triangles, rasterized and blended by the hardware: the method of the papers ([Shirley 1990], [Marroquim 2006]).
    Triangles,
    /// A rasterizer in compute programs: tiles, front to back, in 32-bit floats on any device.
    Compute,
}

impl GpuPath {
    /// Both paths.
    pub const ALL: [Self; 2] = [Self::Triangles, Self::Compute];
}

impl fmt::Display for GpuPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Triangles => "triangles",
            Self::Compute => "compute",
        })
    }
}

/// A name that is none of the paths'.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no path named \"{name}\" on a GPU; there are triangles and compute")]
pub struct UnknownGpuPath {
    /// The name.
    pub name: String,
}

impl FromStr for GpuPath {
    type Err = UnknownGpuPath;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .into_iter()
            .find(|path| path.to_string() == name)
            .ok_or_else(|| UnknownGpuPath { name: name.to_owned() })
    }
}

/// Bits of a channel of the target that triangles are blended into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TargetBits {
    /// Half floats, which every adapter blends. Rounding adds up over the cells that a ray meets: within 1e-2 up to 500 of them.
    Sixteen,
    /// Floats, which only some adapters blend.
    ThirtyTwo,
}

impl TargetBits {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Sixteen, Self::ThirtyTwo];

    /// The number.
    pub const fn bits(self) -> u32 {
        match self {
            Self::Sixteen => 16,
            Self::ThirtyTwo => 32,
        }
    }

    /// The target of so many bits, if there is one.
    pub fn of(bits: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|target| target.bits() == bits)
    }
}
