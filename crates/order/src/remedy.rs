//! What is done about cells that hide one another in a ring.

use std::fmt;
use std::str::FromStr;

/// What is done about cells that hide one another in a ring, where no order of whole cells is right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CycleRemedy {
    /// They are blended by the distance of their centroids, and reported.
    #[default]
    Report,
    /// Members are cut until no ring is left ([`Order::cut_cycles`](crate::Order::cut_cycles)); rings that cannot be cut, since their
    /// cells overlap or are too many, are left to the pixels.
    Cut,
    /// The pixels that they cover are sorted ray by ray; a back end does that.
    PerPixel,
}

impl CycleRemedy {
    /// All remedies.
    pub const ALL: [Self; 3] = [Self::Report, Self::Cut, Self::PerPixel];
}

impl fmt::Display for CycleRemedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Report => "report",
            Self::Cut => "cut",
            Self::PerPixel => "per-pixel",
        })
    }
}

/// A name that is no remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no remedy for cycles \"{name}\"; use report, cut or per-pixel")]
pub struct UnknownRemedy {
    /// The name given.
    pub name: String,
}

impl FromStr for CycleRemedy {
    type Err = UnknownRemedy;

    fn from_str(name: &str) -> Result<Self, UnknownRemedy> {
        Self::ALL
            .into_iter()
            .find(|remedy| remedy.to_string() == name)
            .ok_or_else(|| UnknownRemedy { name: name.to_owned() })
    }
}
