//! The methods by name.

use std::fmt;
use std::str::FromStr;

use crate::Bucket;

/// How cells come to be blended in the right order, by the name that scene files use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OrderMethod {
    /// [`Unordered`](crate::Unordered).
    None,
    /// [`Bucket`].
    Bucket {
        /// Number of slabs.
        slabs: u32,
    },
    /// [`Centroid`](crate::Centroid).
    Centroid,
    /// [`Power`](crate::Power).
    Power,
    /// [`Mpvo`](crate::Mpvo).
    Mpvo,
    /// [`BspXmpvo`](crate::BspXmpvo).
    BspXmpvo,
    /// [`Centroid`](crate::Centroid), and every pixel sorts anew within a window of this many cells ([Callahan 2005]).
    KBuffer {
        /// Cells that a pixel holds back, one or more.
        window: u32,
    },
    /// No order of cells: every pixel sorts what its ray meets.
    PerPixel,
}

/// What a back end does pixel by pixel, besides taking cells in the order that they come in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelSort {
    /// Nothing: cells are blended as they come.
    None,
    /// Holds so many segments back and blends the nearest of them when another one comes.
    Window(u32),
    /// Holds all back and sorts them.
    All,
}

impl OrderMethod {
    /// Whether cells are sorted: not where they come as they are, or where pixels alone sort.
    pub const fn sorts_cells(self) -> bool {
        !matches!(self, Self::None | Self::PerPixel)
    }

    /// The names of all methods.
    pub const NAMES: &'static [&'static str] =
        &["none", "bucket", "centroid", "power", "mpvo", "bsp-xmpvo", "k-buffer", "per-pixel"];

    /// The usual window of `k-buffer`: the larger of the two that [Callahan 2005] have.
    pub const DEFAULT_WINDOW: u32 = 6;

    /// What is left to the pixels.
    pub const fn pixel_sort(self) -> PixelSort {
        match self {
            Self::KBuffer { window } => PixelSort::Window(window),
            Self::PerPixel => PixelSort::All,
            _ => PixelSort::None,
        }
    }
}

impl fmt::Display for OrderMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "none",
            Self::Bucket { .. } => "bucket",
            Self::Centroid => "centroid",
            Self::Power => "power",
            Self::Mpvo => "mpvo",
            Self::BspXmpvo => "bsp-xmpvo",
            Self::KBuffer { .. } => "k-buffer",
            Self::PerPixel => "per-pixel",
        })
    }
}

/// A name that is no visibility order.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no visibility order \"{name}\"; use one of {}", OrderMethod::NAMES.join(", "))]
pub struct UnknownOrder {
    /// The name given.
    pub name: String,
}

impl FromStr for OrderMethod {
    type Err = UnknownOrder;

    fn from_str(name: &str) -> Result<Self, UnknownOrder> {
        match name {
            "none" => Ok(Self::None),
            "bucket" => Ok(Self::Bucket { slabs: Bucket::DEFAULT_SLABS }),
            "centroid" => Ok(Self::Centroid),
            "power" => Ok(Self::Power),
            "mpvo" => Ok(Self::Mpvo),
            "bsp-xmpvo" => Ok(Self::BspXmpvo),
            "k-buffer" => Ok(Self::KBuffer { window: Self::DEFAULT_WINDOW }),
            "per-pixel" => Ok(Self::PerPixel),
            _ => Err(UnknownOrder { name: name.to_owned() }),
        }
    }
}
