//! A color map: colors along 0 to 1, and the space in which they are mixed.

use crate::adapt::{Encoding, Piece, control_points};
use crate::check::{Origin, normalize};
use crate::ciede::MAX_PATHS;
use crate::error::shown;
use crate::space::{Blend, blends};
use crate::{ColorError, ColorSpace, Opacity, linear_from_srgb, names, srgb_from_linear};

/// Where a map has which color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorPoint {
    /// From 0 to 1 in a [`ColorMap`]; any finite number where one is made.
    pub x: f64,
    /// sRGB, 0 to 1.
    pub rgb: [f64; 3],
}

/// Colors along 0 to 1.
///
/// Below the first point and above the last their colors go on. Two points at one place make a step: at the place itself the first counts.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorMap {
    name: String,
    points: Vec<ColorPoint>,
    space: ColorSpace,
    nan_color: Option<[f64; 3]>,
    opacity: Option<Opacity>,
    /// Where one way of mixing ends and the next begins: `(end, piece)`, ascending, the last ends at 1. Steps have none.
    pieces: Vec<(f64, Stretch)>,
}

/// A piece of a map with the part of a way between two points that it shows.
#[derive(Clone, Debug, PartialEq)]
struct Stretch {
    start: f64,
    blend: Blend,
}

impl ColorMap {
    /// The map that has a name, with `_r` at its end backwards.
    ///
    /// matplotlib's names and ParaView's are known ([`all_names`](crate::all_names)). A name as it is written counts before one that
    /// differs in
    /// case, and matplotlib's before ParaView's; `matplotlib:NAME` and `paraview:NAME` say which is meant.
    ///
    /// # Errors
    ///
    /// An unknown name; the error has the nearest ones.
    pub fn named(name: &str) -> Result<Self, ColorError> {
        names::find(name)
    }

    /// A map of points, which may lie anywhere and in any order: the lowest becomes 0 and the highest 1.
    ///
    /// # Errors
    ///
    /// No point, several points that all lie at one place, a number that is not finite, a channel outside of 0 to 1 (by more than a
    /// thousandth,
    /// else it is clamped); more than 256 points in [`ColorSpace::LabCiede2000`], whose paths take time.
    pub fn new(name: &str, space: ColorSpace, points: &[ColorPoint]) -> Result<Self, ColorError> {
        Self::of_points(Origin { file: "color map", preset: name }, space, points)
    }

    pub(crate) fn of_points(origin: Origin<'_>, space: ColorSpace, points: &[ColorPoint]) -> Result<Self, ColorError> {
        let mut checked = Vec::with_capacity(points.len());
        for (number, point) in points.iter().enumerate() {
            let place = format!("color point {}", number + 1);
            let mut rgb = [0.0; 3];
            for ((channel, value), what) in rgb.iter_mut().zip(point.rgb).zip(["red", "green", "blue"]) {
                *channel = origin.share(&place, what, value)?;
            }
            checked.push((point.x, rgb));
        }
        if space == ColorSpace::LabCiede2000 && checked.len() > MAX_PATHS {
            let problem = format!("{} color points in the space Lab/CIEDE2000, more than {MAX_PATHS}", checked.len());
            return Err(origin.invalid("", problem, "save it in another color space"));
        }
        let points = normalize(origin, "color point", checked)?;
        let points: Vec<_> = points.into_iter().map(|(x, rgb)| ColorPoint { x, rgb }).collect();
        let pieces = pieces(space, &points);
        Ok(Self { name: shown(origin.preset), points, space, nan_color: None, opacity: None, pieces })
    }

    /// The map with what a preset has besides its colors.
    pub(crate) fn with(mut self, nan_color: Option<[f64; 3]>, opacity: Option<Opacity>) -> Self {
        self.nan_color = nan_color;
        self.opacity = opacity;
        self
    }

    /// The map's name as its author wrote it, without control characters and at most 200 characters long.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The control points, ascending from 0 to 1; at least one.
    pub fn points(&self) -> &[ColorPoint] {
        &self.points
    }

    /// Where colors between points are found.
    pub fn space(&self) -> ColorSpace {
        self.space
    }

    /// The color of what is not a number, sRGB, where the preset says one.
    pub fn nan_color(&self) -> Option<[f64; 3]> {
        self.nan_color
    }

    /// The opacity that the preset has besides its colors.
    pub fn opacity(&self) -> Option<&Opacity> {
        self.opacity.as_ref()
    }

    /// The color at a place from 0 to 1, sRGB from 0 to 1; beyond the ends, that at the end. NaN gives the color at 0.
    pub fn color_at(&self, x: f64) -> [f64; 3] {
        let first = self.points.first().map_or([0.0; 3], |point| point.rgb);
        // NaN as well.
        if x.partial_cmp(&0.0) != Some(core::cmp::Ordering::Greater) {
            return first;
        }
        let x = x.min(1.0);
        let Some((end, stretch)) = self.pieces.get(self.pieces.partition_point(|(end, _)| *end < x)) else {
            return first;
        };
        stretch.blend.at((x - stretch.start) / (end - stretch.start))
    }

    /// The map from its end to its beginning; `_r` is added to the name, or taken from it.
    ///
    /// The opacity turns with it. [`ColorSpace::Step`] keeps its colors where they were between the points.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let name = self.name.strip_suffix("_r").map_or_else(|| format!("{}_r", self.name), str::to_owned);
        let points = self.points.iter().rev().map(|point| ColorPoint { x: 1.0 - point.x, ..*point }).collect();
        let pieces = (self.pieces.iter().rev())
            .map(|(end, Stretch { start, blend })| (1.0 - start, Stretch { start: 1.0 - end, blend: blend.reversed() }))
            .collect();
        let opacity = self.opacity.as_ref().map(Opacity::reversed);
        Self { name, points, pieces, opacity, ..self.clone() }
    }

    /// Control points `[scalar, red, green, blue]` in linear light that stand for the map over a range of a field.
    ///
    /// - `lo`, `hi`: the scalars of 0 and 1, finite; where `lo` is above `hi`, the map runs backwards
    /// - `error`: how far a color between the points may lie from the map's, in sRGB from 0 to 1;
    ///   [`HALF_GRAY_LEVEL`](crate::HALF_GRAY_LEVEL)
    ///   cannot be seen. Not below 1e-5.
    ///
    /// Scalars ascend; two equal ones are a step. Where `lo` is `hi`, it is one point with the color at 0.5. A straight line between two of
    /// the
    /// points, in linear light, encoded as sRGB, is within `error` of [`color_at`](Self::color_at) but at the steps themselves.
    pub fn linear_points(&self, lo: f64, hi: f64, error: f64) -> Vec<[f64; 4]> {
        if lo > hi {
            return self.reversed().linear_points(hi, lo, error);
        }
        if lo >= hi || self.pieces.is_empty() {
            let [r, g, b] = self.color_at(0.5).map(linear_from_srgb);
            return vec![[lo, r, g, b]];
        }
        let pieces: Vec<Piece<'_, 3>> = (self.pieces.iter())
            .map(|(end, stretch)| Piece {
                start: stretch.start,
                end: *end,
                at: Box::new(|share| stretch.blend.at(share)),
            })
            .collect();
        let encoding = Encoding { decode: linear_from_srgb, encode: srgb_from_linear };
        let mut points: Vec<_> = control_points(&pieces, encoding, error)
            .into_iter()
            .map(|(x, [r, g, b])| [scalar_at(lo, hi, x), r, g, b])
            .collect();
        // A step at an end: what lies beyond has the color of the outermost point.
        if let (Some(first), Some((_, stretch))) = (self.points.first(), self.pieces.first())
            && differ(first.rgb, stretch.blend.at(0.0))
        {
            let [r, g, b] = first.rgb.map(linear_from_srgb);
            points.insert(0, [lo, r, g, b]);
        }
        if let (Some(last), Some((_, stretch))) = (self.points.last(), self.pieces.last())
            && differ(last.rgb, stretch.blend.at(1.0))
        {
            let [r, g, b] = last.rgb.map(linear_from_srgb);
            points.push([hi, r, g, b]);
        }
        points
    }
}

/// Whether two colors differ by more than a conversion to another space and back does.
fn differ(a: [f64; 3], b: [f64; 3]) -> bool {
    a.into_iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-3)
}

/// The scalar at a share of a range, within it; it never falls as the share grows.
pub(crate) fn scalar_at(lo: f64, hi: f64, x: f64) -> f64 {
    let width = hi - lo;
    // Of a range wider than the largest float, by halves.
    let scalar = if width.is_finite() { lo + x * width } else { 2.0 * (0.5 * lo + x * (0.5 * hi - 0.5 * lo)) };
    if x >= 1.0 { hi } else { scalar.max(lo).min(hi) }
}

fn pieces(space: ColorSpace, points: &[ColorPoint]) -> Vec<(f64, Stretch)> {
    let mut pieces = Vec::with_capacity(points.len());
    for pair in points.windows(2) {
        let [from, to] = pair else { continue };
        let mut start = from.x;
        for (share, blend) in blends(space, from.rgb, to.rgb) {
            let end = if share >= 1.0 { to.x } else { from.x + share * (to.x - from.x) };
            // Points at one place, and those too near each other for floats, are a step.
            if end > start {
                pieces.push((end, Stretch { start, blend }));
                start = end;
            }
        }
    }
    pieces
}
