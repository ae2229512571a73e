//! Presets as ParaView saves them today: a list of objects in JSON, or a single one.

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::check::Origin;
use crate::map::ColorPoint;
use crate::opacity::{Opacity, OpacityPoint};
use crate::{ColorError, ColorMap, ColorSpace};

/// What can be done about a preset of which something is missing.
pub(crate) const SAVE_AGAIN: &str = "save the preset again";

/// One preset. Keys that are not here say nothing about a color: groups, authors, ranges.
#[derive(Clone, Debug, Default, Deserialize)]
pub(crate) struct Preset {
    #[serde(rename = "Name", default)]
    pub(crate) name: Option<String>,
    #[serde(rename = "ColorSpace", default)]
    pub(crate) color_space: Option<String>,
    #[serde(rename = "HSVWrap", default)]
    pub(crate) hsv_wrap: Switch,
    /// `x, red, green, blue` a point.
    #[serde(rename = "RGBPoints", default)]
    pub(crate) rgb_points: Option<Vec<f64>>,
    /// `x, opacity, midpoint, sharpness` a point.
    #[serde(rename = "Points", default)]
    pub(crate) points: Option<Vec<f64>>,
    #[serde(rename = "NanColor", default)]
    pub(crate) nan_color: Option<Vec<f64>>,
    #[serde(rename = "UseLogScale", default)]
    pub(crate) log_scale: Switch,
    /// Colors of categories.
    #[serde(rename = "IndexedColors", default)]
    pub(crate) indexed_colors: Option<IgnoredAny>,
}

/// A switch, which is a number in some files and true or false in others.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(untagged)]
pub(crate) enum Switch {
    #[default]
    Absent,
    Bool(bool),
    Number(f64),
}

impl Switch {
    fn is_on(self) -> bool {
        match self {
            Self::Absent => false,
            Self::Bool(on) => on,
            Self::Number(number) => number != 0.0,
        }
    }
}

/// The presets of a file, none of them checked.
///
/// # Errors
///
/// What is not JSON, or has another type than the key wants, with line and column.
pub(crate) fn parse(file: &str, bytes: &[u8]) -> Result<Vec<Preset>, ColorError> {
    let single = bytes.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{');
    let presets =
        if single { serde_json::from_slice(bytes).map(|preset| vec![preset]) } else { serde_json::from_slice(bytes) };
    presets.map_err(|error| ColorError::Invalid {
        file: file.to_owned(),
        place: format!("line {}, column {}", error.line(), error.column()),
        problem: format!("not a preset in JSON: {}", crate::error::shown(&without_place(&error.to_string()))),
        remedy: "export the preset from ParaView again".to_owned(),
    })
}

/// A message of the parser without the line and column that are said already.
fn without_place(message: &str) -> String {
    message.rsplit_once(" at line ").map_or(message, |(message, _)| message).to_owned()
}

impl Preset {
    /// The preset's name; one without is called by what it is.
    pub(crate) fn name(&self) -> &str {
        self.name.as_deref().filter(|name| !name.trim().is_empty()).unwrap_or("unnamed preset")
    }

    /// The map, and what is odd about it.
    ///
    /// # Errors
    ///
    /// Colors for categories alone, an unknown color space, points that are not in fours, and whatever [`ColorMap::new`] and
    /// [`Opacity::new`] refuse.
    pub(crate) fn map(&self, file: &str) -> Result<(ColorMap, Option<String>), ColorError> {
        let origin = Origin { file, preset: self.name() };
        let Some(numbers) = &self.rgb_points else {
            return Err(self.without_colors(origin));
        };
        let space_name = self.color_space.as_deref().unwrap_or("RGB");
        let space =
            ColorSpace::from_name(space_name, self.hsv_wrap.is_on()).ok_or_else(|| ColorError::Unsupported {
                file: file.to_owned(),
                what: format!(
                    "the color space \"{}\" of preset \"{}\"",
                    crate::error::shown(space_name),
                    crate::error::shown(self.name())
                ),
                remedy: "save the preset in RGB, HSV, Lab, Diverging, Lab/CIEDE2000, Prolab or Step".to_owned(),
            })?;
        let mut points: Vec<_> =
            fours(origin, "RGBPoints", numbers)?.map(|[x, r, g, b]| ColorPoint { x, rgb: [r, g, b] }).collect();
        if self.log_scale.is_on() {
            for (number, point) in points.iter_mut().enumerate() {
                point.x = logarithm(origin, &format!("color point {}", number + 1), point.x)?;
            }
        }
        let map = ColorMap::of_points(origin, space, &points)?;
        let nan_color = self.nan_color.as_deref().map(|color| nan_color(origin, color)).transpose()?;
        let opacity = self.points.as_deref().map(|numbers| self.opacity(origin, numbers)).transpose()?.flatten();
        let odd = self.indexed_colors.is_some().then(|| {
            format!(
                "preset \"{}\" has colors for categories too; those along its range are taken",
                crate::error::shown(self.name())
            )
        });
        Ok((map.with(nan_color, opacity), odd))
    }

    /// The opacity of a list of numbers; none where the list is empty.
    fn opacity(&self, origin: Origin<'_>, numbers: &[f64]) -> Result<Option<Opacity>, ColorError> {
        if numbers.is_empty() {
            return Ok(None);
        }
        let mut points = Vec::new();
        for (number, [x, opacity, midpoint, sharpness]) in fours(origin, "Points", numbers)?.enumerate() {
            let place = format!("opacity point {}", number + 1);
            let x = if self.log_scale.is_on() { logarithm(origin, &place, x)? } else { x };
            points.push(OpacityPoint { x, opacity, midpoint, sharpness });
        }
        Opacity::of_points(origin, &points).map(|opacity| Some(opacity.renamed(origin.preset)))
    }

    /// Why a preset has no colors along a range.
    fn without_colors(&self, origin: Origin<'_>) -> ColorError {
        if self.indexed_colors.is_some() {
            return ColorError::Unsupported {
                file: origin.file.to_owned(),
                what: format!(
                    "preset \"{}\", which has colors for categories alone,",
                    crate::error::shown(self.name())
                ),
                remedy: "choose a preset with colors along a range (RGBPoints)".to_owned(),
            };
        }
        let remedy = if self.points.is_some() { "it has opacities alone; export the colors too" } else { SAVE_AGAIN };
        origin.invalid("", "it has no colors (RGBPoints)", remedy)
    }
}

/// A list of numbers in fours.
fn fours<'a>(
    origin: Origin<'_>,
    key: &str,
    numbers: &'a [f64],
) -> Result<impl Iterator<Item = [f64; 4]> + 'a, ColorError> {
    let (fours, rest) = numbers.as_chunks::<4>();
    if !rest.is_empty() {
        let problem = format!("{} numbers, which are no multiple of 4", numbers.len());
        return Err(origin.invalid(key, problem, SAVE_AGAIN));
    }
    Ok(fours.iter().copied())
}

/// ParaView spreads a preset with a logarithmic scale evenly before it fits it to a field.
fn logarithm(origin: Origin<'_>, place: &str, x: f64) -> Result<f64, ColorError> {
    if x > 0.0 {
        return Ok(x.log10());
    }
    let problem = format!("its position is {x}, and the preset's scale is logarithmic");
    Err(origin.invalid(place, problem, "save the preset with positions above 0"))
}

/// The color of what is not a number.
pub(crate) fn nan_color(origin: Origin<'_>, color: &[f64]) -> Result<[f64; 3], ColorError> {
    let [red, green, blue] = color else {
        return Err(origin.invalid("NanColor", format!("{} numbers, not 3", color.len()), SAVE_AGAIN));
    };
    let share = |what, value: f64| origin.share("NanColor", what, value);
    Ok([share("red", *red)?, share("green", *green)?, share("blue", *blue)?])
}
