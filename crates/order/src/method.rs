//! The methods by name.

use std::fmt;
use std::str::FromStr;

use crate::{Bucket, Cells, Centroid, Mpvo, Unordered, VisibilityOrder};

/// A visibility order by the name that scene files use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OrderMethod {
    /// [`Unordered`].
    None,
    /// [`Bucket`].
    Bucket {
        /// Number of slabs.
        slabs: u32,
    },
    /// [`Centroid`].
    Centroid,
    /// [`Mpvo`].
    Mpvo,
}

impl OrderMethod {
    /// The names of all methods that are here.
    pub const NAMES: &'static [&'static str] = &["none", "bucket", "centroid", "mpvo"];

    /// Names of the scene file's specification whose methods are not here yet.
    const PLANNED: &'static [&'static str] = &["power", "bsp-xmpvo", "k-buffer", "per-pixel"];

    /// The method, ready for a mesh: what it has to know of the mesh it learns here, once.
    pub fn prepare(self, cells: Cells<'_>) -> Box<dyn VisibilityOrder> {
        match self {
            Self::None => Box::new(Unordered),
            Self::Bucket { slabs } => Box::new(Bucket { slabs }),
            Self::Centroid => Box::new(Centroid),
            Self::Mpvo => Box::new(Mpvo::new(cells)),
        }
    }
}

impl fmt::Display for OrderMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "none",
            Self::Bucket { .. } => "bucket",
            Self::Centroid => "centroid",
            Self::Mpvo => "mpvo",
        })
    }
}

/// A name that is no visibility order here.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UnknownOrder {
    /// The specification knows the name, this version does not have the method.
    #[error("the visibility order \"{name}\" is not in this version; use one of {}", OrderMethod::NAMES.join(", "))]
    NotYet {
        /// The name given.
        name: String,
    },
    /// Nobody knows the name.
    #[error("there is no visibility order \"{name}\"; use one of {}", OrderMethod::NAMES.join(", "))]
    NoSuchName {
        /// The name given.
        name: String,
    },
}

impl FromStr for OrderMethod {
    type Err = UnknownOrder;

    fn from_str(name: &str) -> Result<Self, UnknownOrder> {
        match name {
            "none" => Ok(Self::None),
            "bucket" => Ok(Self::Bucket { slabs: Bucket::DEFAULT_SLABS }),
            "centroid" => Ok(Self::Centroid),
            "mpvo" => Ok(Self::Mpvo),
            _ if Self::PLANNED.contains(&name) => Err(UnknownOrder::NotYet { name: name.to_owned() }),
            _ => Err(UnknownOrder::NoSuchName { name: name.to_owned() }),
        }
    }
}
