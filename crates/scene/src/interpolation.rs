//! How what a ray has inside a cell is found at a pixel.

use std::fmt;
use std::str::FromStr;

/// How the scalars at both ends of a ray's way through a cell, and its length, are found at a pixel.
///
/// Without perspective all three are linear on the screen over each triangle of the cell's fan, and all ways give the same. With it they
/// are not: the difference grows with the size of a cell for its distance. Ten cells away, the length is off by 2 % in the median with
/// [`Self::Screen`] and by 1.4 % with [`Self::Perspective`], a hundred cells away by a tenth of that.
///
/// On the CPU, pieces of cut cells and cells that reach the plane of the eye, or are seen so nearly edge-on that they are drawn in
/// 64 bits, have no fan: they are drawn exactly in every way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// From the planes of the faces that the ray meets: what is linear in perspective is one over the depth, at each end by itself.
    #[default]
    Exact,
    /// Linear over the fan's triangles with the perspective correction of graphics hardware, by the depth of the front alone: the
    /// back of the cell, which lies deeper, is not where it puts it ([Kraus 2004]).
    Perspective,
    /// Linear on the screen over the fan's triangles, as the papers have it ([Shirley 1990], section 2.6).
    Screen,
}

impl Interpolation {
    /// All ways.
    pub const ALL: [Self; 3] = [Self::Exact, Self::Perspective, Self::Screen];

    /// The name in a scene file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Perspective => "perspective",
            Self::Screen => "screen",
        }
    }
}

impl fmt::Display for Interpolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A name that is none of the ways'.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no interpolation named \"{name}\"; there are exact, perspective and screen")]
pub struct UnknownInterpolation {
    /// The name.
    pub name: String,
}

impl FromStr for Interpolation {
    type Err = UnknownInterpolation;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .into_iter()
            .find(|way| way.name() == name)
            .ok_or_else(|| UnknownInterpolation { name: name.to_owned() })
    }
}
