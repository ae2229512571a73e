//! Opacity along 0 to 1, and what it means for a length.

use core::str::FromStr;

use crate::adapt::{Encoding, Piece, control_points};
use crate::check::{Origin, normalize};
use crate::map::scalar_at;
use crate::sharpness::{Half, halves, is_straight};
use crate::{ColorError, opacity_names};

/// The optical depth that stands for full opacity, which no finite one has: all but a twelfth of a gray level is taken. A larger one would
/// make
/// steeper extinctions for what cannot be seen.
const FULL_DEPTH: f64 = 8.0;

/// Where an opacity is how large, and how it goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpacityPoint {
    /// From 0 to 1 in an [`Opacity`]; any finite number where one is made.
    pub x: f64,
    /// 0 to 1.
    pub opacity: f64,
    /// Where on the way to the next point the opacity is halfway, as a share of the way; 0.5 is in the middle.
    pub midpoint: f64,
    /// 0 for a straight way to the next point; up to 1, where it is nearly a step at the midpoint.
    pub sharpness: f64,
}

impl OpacityPoint {
    /// A point with a straight way to the next.
    pub fn straight(x: f64, opacity: f64) -> Self {
        Self { x, opacity, midpoint: 0.5, sharpness: 0.0 }
    }
}

/// What a number for an opacity means, since programs differ. Lengths are in units of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OpacityUnit {
    /// The share of light that a length takes: the extinction is −ln(1 − opacity) over the length. VTK's mappers for images take its unit
    /// distance so.
    /// Full opacity stands for an optical depth of 8.
    OverLength(f64),
    /// The extinction in units of one over a length: opacity over the length. VTK's mappers for unstructured grids take its unit distance
    /// so.
    ExtinctionPerLength(f64),
}

/// Opacity along 0 to 1, with a name or points of its own.
///
/// Two points at one place make a step: at the place itself the second counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Opacity {
    name: String,
    /// `(end, start, curve)`, ascending, from 0 to 1; at least one.
    pieces: Vec<(f64, f64, Curve)>,
}

/// Opacity over one piece, by the share of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Curve {
    /// Straight from one value to another.
    Line([f64; 2]),
    /// Half of another way between two points.
    Half(Half),
    /// From the first value to the second by equal factors, neither 0.
    Geometric([f64; 2]),
    /// 1 / (1 + exp(−t)) with t between these.
    Sigmoid([f64; 2]),
}

impl Curve {
    fn at(self, share: f64) -> f64 {
        match self {
            Self::Line([from, to]) => (1.0 - share) * from + share * to,
            Self::Half(half) => half.at(share),
            Self::Geometric([from, to]) => from.powf(1.0 - share) * to.powf(share),
            Self::Sigmoid([from, to]) => 1.0 / (1.0 + (-((1.0 - share) * from + share * to)).exp()),
        }
    }

    fn reversed(self) -> Self {
        match self {
            Self::Line([from, to]) => Self::Line([to, from]),
            Self::Half(half) => Self::Half(half.reversed()),
            Self::Geometric([from, to]) => Self::Geometric([to, from]),
            Self::Sigmoid([from, to]) => Self::Sigmoid([to, from]),
        }
    }
}

impl Opacity {
    /// The curve that PyVista knows by a name ([`opacity_names`](crate::opacity_names)).
    ///
    /// # Errors
    ///
    /// An unknown name; the error lists all.
    pub fn named(name: &str) -> Result<Self, ColorError> {
        opacity_names::find(name)
    }

    /// A curve through points, which may lie anywhere and in any order: the lowest becomes 0 and the highest 1. One point is a constant.
    ///
    /// # Errors
    ///
    /// No point, several points that all lie at one place, a position that is not finite, another number outside of 0 to 1 (by more than a
    /// thousandth, else it is clamped).
    pub fn new(points: &[OpacityPoint]) -> Result<Self, ColorError> {
        Self::of_points(Origin { file: "opacity", preset: "" }, points)
    }

    pub(crate) fn of_points(origin: Origin<'_>, points: &[OpacityPoint]) -> Result<Self, ColorError> {
        let mut checked = Vec::with_capacity(points.len());
        for (number, point) in points.iter().enumerate() {
            let place = format!("opacity point {}", number + 1);
            let opacity = origin.share(&place, "opacity", point.opacity)?;
            let midpoint = origin.share(&place, "midpoint", point.midpoint)?;
            checked.push((point.x, (opacity, midpoint, origin.share(&place, "sharpness", point.sharpness)?)));
        }
        let points = normalize(origin, "opacity point", checked)?;
        let mut pieces = Vec::with_capacity(2 * points.len());
        for pair in points.windows(2) {
            let [(from, (first, midpoint, sharpness)), (to, (second, ..))] = *pair else { continue };
            if midpoint == 0.5 && is_straight(sharpness) {
                if to > from {
                    pieces.push((to, from, Curve::Line([first, second])));
                }
                continue;
            }
            let mut start = from;
            for (share, half) in halves([first, second], midpoint, sharpness) {
                let end = if share >= 1.0 { to } else { from + share * (to - from) };
                // Points at one place are a step.
                if end > start {
                    pieces.push((end, start, Curve::Half(half)));
                    start = end;
                }
            }
        }
        if let (true, Some((_, (opacity, ..)))) = (pieces.is_empty(), points.first()) {
            pieces.push((1.0, 0.0, Curve::Line([*opacity; 2])));
        }
        Ok(Self { name: "points".to_owned(), pieces })
    }

    /// A curve by a formula over the whole of 0 to 1.
    pub(crate) fn of_curve(name: &str, curve: Curve) -> Self {
        Self { name: name.to_owned(), pieces: vec![(1.0, 0.0, curve)] }
    }

    /// The curve under another name.
    pub(crate) fn renamed(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// Its name, `points` where it was made of points.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The opacity at a place from 0 to 1; beyond the ends, that at the end. NaN gives the opacity at 0.
    pub fn at(&self, x: f64) -> f64 {
        let x = if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) };
        // The last piece has its end, too.
        let index = self.pieces.partition_point(|(end, ..)| *end <= x).min(self.pieces.len().saturating_sub(1));
        let Some((end, start, curve)) = self.pieces.get(index) else { return 0.0 };
        curve.at((x - start) / (end - start)).clamp(0.0, 1.0)
    }

    /// The curve from its end to its beginning; `_r` is added to a name, or taken from it.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let name = match self.name.strip_suffix("_r") {
            Some(name) => name.to_owned(),
            None if self.name == "points" => self.name.clone(),
            None => format!("{}_r", self.name),
        };
        let pieces = self.pieces.iter().rev().map(|(end, start, curve)| (1.0 - start, 1.0 - end, curve.reversed()));
        Self { name, pieces: pieces.collect() }
    }

    /// Control points `[scalar, opacity]` that stand for the curve over a range of a field.
    ///
    /// - `lo`, `hi`: the scalars of 0 and 1, finite; where `lo` is above `hi`, the curve runs backwards
    /// - `error`: how far an opacity between the points may lie from the curve; not below 1e-5
    ///
    /// Scalars ascend; two equal ones are a step. Where `lo` is `hi`, it is one point with the opacity at 0.5.
    pub fn points(&self, lo: f64, hi: f64, error: f64) -> Vec<[f64; 2]> {
        let straight = |opacity: f64| opacity;
        self.control_points([lo, hi], error, Encoding { decode: straight, encode: straight }, 1.0)
    }

    /// Control points `[scalar, extinction]`, extinction in one over the mesh's unit of length, that stand for the curve over a range of a
    /// field.
    ///
    /// - `lo`, `hi`, `error`: as in [`Opacity::points`]
    /// - the unit's length: finite, above 0
    pub fn extinction_points(&self, lo: f64, hi: f64, unit: OpacityUnit, error: f64) -> Vec<[f64; 2]> {
        let straight = |opacity: f64| opacity;
        let (encoding, length) = match unit {
            OpacityUnit::ExtinctionPerLength(length) => (Encoding { decode: straight, encode: straight }, length),
            OpacityUnit::OverLength(length) => {
                (Encoding { decode: depth_of_opacity, encode: opacity_of_depth }, length)
            }
        };
        self.control_points([lo, hi], error, encoding, 1.0 / length)
    }

    fn control_points(&self, [lo, hi]: [f64; 2], error: f64, encoding: Encoding, factor: f64) -> Vec<[f64; 2]> {
        if lo > hi {
            return self.reversed().control_points([hi, lo], error, encoding, factor);
        }
        if lo >= hi {
            return vec![[lo, factor * (encoding.decode)(self.at(0.5))]];
        }
        let pieces: Vec<Piece<'_, 1>> = (self.pieces.iter())
            .map(|&(end, start, curve)| Piece {
                start,
                end,
                at: Box::new(move |share| [curve.at(share).clamp(0.0, 1.0)]),
            })
            .collect();
        control_points(&pieces, encoding, error)
            .into_iter()
            .map(|(x, [value])| [scalar_at(lo, hi, x), factor * value])
            .collect()
    }
}

/// Optical depth of an opacity.
fn depth_of_opacity(opacity: f64) -> f64 {
    (-(-opacity).ln_1p()).min(FULL_DEPTH)
}

/// Opacity of an optical depth.
fn opacity_of_depth(depth: f64) -> f64 {
    -(-depth).exp_m1()
}

/// A name, evenly spaced opacities (`0, 0.2, 0.9`), or opacities at places (`0:0, 0.3:0.9, 1:0`); commas, semicolons or spaces between
/// them.
impl FromStr for Opacity {
    type Err = ColorError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let is_number = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        if !is_number(text.trim_start()) {
            return Self::named(text.trim());
        }
        let origin = Origin { file: "opacity", preset: "" };
        let words = text.split(|c: char| c.is_whitespace() || c == ',' || c == ';').filter(|word| !word.is_empty());
        let mut points = Vec::new();
        for (number, word) in words.enumerate() {
            let parse = |text: &str| {
                text.parse::<f64>().map_err(|_| {
                    let problem = format!("\"{}\" is not a number", crate::error::shown(text));
                    let remedy = "write opacities (0, 0.2, 0.9) or pairs of place and opacity (0:0, 0.3:0.9, 1:0)";
                    origin.invalid(&format!("point {}", number + 1), problem, remedy)
                })
            };
            points.push(match word.split_once(':') {
                Some((x, opacity)) => (true, OpacityPoint::straight(parse(x)?, parse(opacity)?)),
                #[expect(clippy::cast_precision_loss, reason = "words of a command line")]
                None => (false, OpacityPoint::straight(number as f64, parse(word)?)),
            });
        }
        if points.iter().any(|(placed, _)| *placed != points.first().is_some_and(|(first, _)| *first)) {
            let remedy = "give every opacity a place, or none";
            return Err(origin.invalid("points", "some opacities have a place and some have none", remedy));
        }
        Self::new(&points.into_iter().map(|(_, point)| point).collect::<Vec<_>>())
    }
}
