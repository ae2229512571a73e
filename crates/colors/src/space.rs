//! The spaces in which colors between two others are found.

use core::f64::consts::PI;

use crate::ciede;
use crate::convert::{hsv, lab, msh, prolab, rgb_from_hsv, rgb_from_lab, rgb_from_msh, rgb_from_prolab};

/// Below this angle, radians, a color counts as gray for [`ColorSpace::Diverging`].
const GRAY: f64 = 0.05;

/// Where colors between two control points are found. The names in ParaView's files are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ColorSpace {
    /// Channel by channel in sRGB as it is encoded; `RGB`.
    Rgb,
    /// Hue, saturation and value; `HSV`. Hue goes the way that does not cross red, or, where it wraps (`HSVWrap`), the shorter way.
    Hsv {
        /// Whether hue may go across red.
        wrap: bool,
    },
    /// CIE Lab, from sRGB with the white point D65; `Lab`.
    Lab,
    /// Magnitude, saturation and hue, with white between two hues that are far apart; `Diverging`. Source: [Moreland 2009].
    Diverging,
    /// Along the shortest path between the colors by the color difference CIEDE2000, on a grid of 17 steps a channel;
    /// `Lab/CIEDE2000`. As in ParaView, the colors of the points are first moved to the grid, by up to 8 gray levels a channel; what
    /// ParaView then
    /// rounds to 8 bits is not rounded here.
    LabCiede2000,
    /// A perspective image of XYZ in which equal steps look equal; `Prolab`. Source: [Konovalenko 2021].
    Prolab,
    /// The color of the upper control point all the way down to the lower one; `Step`.
    Step,
}

impl ColorSpace {
    /// The space that ParaView's files mean by a name, in any case; `None` for a name that they do not have.
    pub fn from_name(name: &str, hsv_wrap: bool) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "rgb" => Self::Rgb,
            "hsv" => Self::Hsv { wrap: hsv_wrap },
            "wrapped" => Self::Hsv { wrap: true },
            "lab" | "cielab" => Self::Lab,
            "diverging" => Self::Diverging,
            "lab/ciede2000" | "labciede2000" | "ciede2000" => Self::LabCiede2000,
            "prolab" => Self::Prolab,
            "step" => Self::Step,
            _ => return None,
        })
    }
}

/// Two colors of which mixtures are wanted, brought into the space once.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Blend {
    /// One color.
    Constant([f64; 3]),
    /// A line in a space.
    Line(Space, [[f64; 3]; 2]),
}

/// Spaces in which a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Space {
    Rgb,
    Hsv,
    Lab,
    Msh,
    Prolab,
}

impl Blend {
    /// The color at a share from 0 to 1, sRGB from 0 to 1.
    pub(crate) fn at(&self, share: f64) -> [f64; 3] {
        let (space, [from, to]) = match self {
            Self::Constant(color) => return *color,
            Self::Line(space, ends) => (space, ends),
        };
        let mixed = core::array::from_fn(|i| (1.0 - share) * from[i] + share * to[i]);
        let color = match space {
            Space::Rgb => mixed,
            Space::Hsv => rgb_from_hsv(mixed),
            Space::Lab => rgb_from_lab(mixed),
            Space::Msh => rgb_from_msh(mixed),
            Space::Prolab => rgb_from_prolab(mixed),
        };
        color.map(|channel| channel.clamp(0.0, 1.0))
    }
}

impl Blend {
    /// From the other end.
    pub(crate) fn reversed(&self) -> Self {
        match self {
            Self::Constant(color) => Self::Constant(*color),
            Self::Line(space, [from, to]) => Self::Line(*space, [*to, *from]),
        }
    }
}

/// The mixtures from one color to the next as pieces `(end, blend)`: each begins where the one before ends, the last ends at 1.
pub(crate) fn blends(space: ColorSpace, from: [f64; 3], to: [f64; 3]) -> Vec<(f64, Blend)> {
    let line = |space, convert: fn([f64; 3]) -> [f64; 3]| vec![(1.0, Blend::Line(space, [convert(from), convert(to)]))];
    match space {
        ColorSpace::Rgb => line(Space::Rgb, |rgb| rgb),
        ColorSpace::Lab => line(Space::Lab, lab),
        ColorSpace::Prolab => line(Space::Prolab, prolab),
        ColorSpace::Step => vec![(1.0, Blend::Constant(to))],
        ColorSpace::Hsv { wrap } => vec![(1.0, Blend::Line(Space::Hsv, hues(hsv(from), hsv(to), wrap)))],
        ColorSpace::Diverging => diverging(msh(from), msh(to)),
        ColorSpace::LabCiede2000 => ciede::path(from, to)
            .windows(2)
            .map(|pair| (pair[1].share, Blend::Line(Space::Lab, [lab(pair[0].rgb), lab(pair[1].rgb)])))
            .collect(),
    }
}

/// Hue across red where that is shorter.
fn hues(mut from: [f64; 3], mut to: [f64; 3], wrap: bool) -> [[f64; 3]; 2] {
    if wrap && (from[0] - to[0]).abs() > 0.5 {
        if from[0] > to[0] { from[0] -= 1.0 } else { to[0] -= 1.0 }
    }
    [from, to]
}

/// One line, or two by way of white.
fn diverging(from: [f64; 3], to: [f64; 3]) -> Vec<(f64, Blend)> {
    let apart = (from[2] - to[2]).abs();
    let apart = if apart > PI { 2.0 * PI - apart } else { apart };
    if from[1] > GRAY && to[1] > GRAY && apart > 0.33 * PI {
        let white = [from[0].max(to[0]).max(88.0), 0.0, 0.0];
        vec![(0.5, toward_gray(from, white)), (1.0, toward_gray(white, to))]
    } else {
        vec![(1.0, toward_gray(from, to))]
    }
}

/// A line in magnitude, saturation and hue; a gray end gets a hue from the other.
fn toward_gray(mut from: [f64; 3], mut to: [f64; 3]) -> Blend {
    if from[1] < GRAY && to[1] > GRAY {
        from[2] = spun_hue(to, from[0]);
    } else if to[1] < GRAY && from[1] > GRAY {
        to[2] = spun_hue(from, to[0]);
    }
    // The shorter way around. VTK 9.7 then always turns upward, and where the shorter way falls it misses the end's color.
    let turn = to[2] - from[2];
    if turn.abs() > PI {
        to[2] -= 2.0 * PI * turn.signum();
    }
    Blend::Line(Space::Msh, [from, to])
}

/// The hue of a gray of this magnitude toward which a color's own hue turns so that perceived steps are about equal.
fn spun_hue([magnitude, saturation, hue]: [f64; 3], gray: f64) -> f64 {
    if magnitude >= gray - 0.1 {
        return hue;
    }
    let spin = saturation * (gray * gray - magnitude * magnitude).sqrt() / (magnitude * saturation.sin());
    // Away from red and purple, which would otherwise appear between.
    if hue > -0.3 * PI { hue + spin } else { hue - spin }
}
