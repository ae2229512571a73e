//! Color and extinction of what a scene says by names, by a file, or not at all.

use tetrascope_colors::{ColorMap, HALF_GRAY_LEVEL, Opacity, OpacityPoint, OpacityUnit};

use crate::file::{OpacityName, PresetMap, TransferSection};
use crate::text::short;
use crate::{Decision, MeshFacts, SceneError, defaults};

pub(super) type ControlPoints = (Vec<[f64; 4]>, Vec<[f64; 2]>);

/// Where color and opacity begin and end.
struct Domain {
    low: f64,
    high: f64,
    /// Why there.
    reason: &'static str,
}

impl Domain {
    fn ends(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    fn is_constant(&self) -> bool {
        self.low >= self.high
    }

    /// "0 to 5", for reports.
    fn text(&self) -> String {
        format!("{} to {}", short(self.low), short(self.high))
    }
}

/// Puts points in place of everything else, and says where they come from.
pub(super) fn fill_transfer(
    section: &mut TransferSection,
    facts: &MeshFacts,
    decisions: &mut Vec<Decision>,
    warnings: &mut Vec<String>,
) -> Result<ControlPoints, SceneError> {
    let domain = domain_of(section, facts)?;
    let preset = take_preset(section, warnings)?;
    let has_range = section.range.take().is_some();
    let uses_range = section.color.is_none()
        || (section.extinction.is_none() && !matches!(section.opacity, Some(OpacityName::Points(_))));
    if has_range && !uses_range {
        warnings.push("transfer.range has no effect: colors and extinction have points of their own".to_owned());
    }
    let color = match section.color.take() {
        Some(points) => {
            let unused = [section.colormap.take().map(|_| "colormap"), preset.as_ref().map(|_| "preset")];
            warnings.extend(unused.into_iter().flatten().map(|key| {
                format!("the colors of transfer.{key} have no effect: transfer.color has points of its own")
            }));
            points
        }
        None => colors_of(section, preset.as_ref(), &domain, decisions, warnings)?,
    };
    let extinction = match section.extinction.take() {
        Some(points) => {
            if section.opacity.take().is_some() {
                warnings.push("transfer.opacity has no effect: transfer.extinction has points of its own".to_owned());
            }
            if section.opacity_length.take().is_some() {
                warnings.push(
                    "transfer.opacity_length has no effect: transfer.extinction is per unit of length".to_owned(),
                );
            }
            points
        }
        None => extinction_of(section, preset.as_ref(), &domain, facts, decisions, warnings)?,
    };
    (section.color, section.extinction) = (Some(color.clone()), Some(extinction.clone()));
    Ok((color, extinction))
}

fn domain_of(section: &TransferSection, facts: &MeshFacts) -> Result<Domain, SceneError> {
    let Some([low, high]) = section.range else {
        let (low, high) = facts.scalar_range;
        return Ok(Domain { low, high, reason: "the field's range" });
    };
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(SceneError::value(
            "transfer.range",
            format!("{low}, {high}"),
            "give two numbers that ascend; a color map runs backwards with _r at the end of its name",
        ));
    }
    Ok(Domain { low, high, reason: "the range that was asked for" })
}

/// What the preset's file holds; the scene names it no more.
fn take_preset(section: &mut TransferSection, warnings: &mut Vec<String>) -> Result<Option<ColorMap>, SceneError> {
    let name = section.preset_name.take();
    let Some(path) = section.preset.take() else {
        if name.is_some() {
            warnings.push("transfer.preset_name has no effect: there is no transfer.preset".to_owned());
        }
        return Ok(None);
    };
    let PresetMap { map, warnings: odd } = section.preset_map.take().ok_or(SceneError::PresetNotRead { path })?;
    warnings.extend(odd);
    Ok(Some(map))
}

fn colors_of(
    section: &mut TransferSection,
    preset: Option<&ColorMap>,
    domain: &Domain,
    decisions: &mut Vec<Decision>,
    warnings: &mut Vec<String>,
) -> Result<Vec<[f64; 4]>, SceneError> {
    let named =
        |name: &str| ColorMap::named(name).map_err(|error| SceneError::Color { key: "transfer.colormap", error });
    let map = match (section.colormap.take(), preset) {
        (Some(name), preset) => {
            if preset.is_some_and(|preset| preset.opacity().is_none()) {
                warnings.push(
                    "transfer.preset has no effect: its colors give way to transfer.colormap, and it has no opacity"
                        .to_owned(),
                );
            }
            named(&name)?
        }
        (None, Some(preset)) => preset.clone(),
        (None, None) => named(defaults::COLOR_MAP)?,
    };
    let (choice, reason) = if domain.is_constant() {
        (format!("one color of {}", map.name()), "the field is constant")
    } else {
        (format!("{} over {}", map.name(), domain.text()), domain.reason)
    };
    decisions.push(Decision::new("color", choice, reason));
    Ok(defaults::color_of(&map, domain.ends()))
}

fn extinction_of(
    section: &mut TransferSection,
    preset: Option<&ColorMap>,
    domain: &Domain,
    facts: &MeshFacts,
    decisions: &mut Vec<Decision>,
    warnings: &mut Vec<String>,
) -> Result<Vec<[f64; 2]>, SceneError> {
    let asked_length = section.opacity_length.take();
    let length = asked_length.unwrap_or_else(|| facts.diagonal() / defaults::DIAGONAL_DEPTH);
    if !(length > 0.0 && (1.0 / length).is_finite()) {
        return Err(SceneError::value("transfer.opacity_length", length, "give a length above 0, in world units"));
    }
    let over_range = |opacity: &Opacity| {
        let unit = OpacityUnit::ExtinctionPerLength(length);
        let mut points = opacity.extinction_points(domain.low, domain.high, unit, HALF_GRAY_LEVEL);
        defaults::keep_ends_of_steps(&mut points);
        points
    };
    let (choice, points) = match (section.opacity.take(), preset.and_then(ColorMap::opacity)) {
        (Some(OpacityName::Name(name)), _) => {
            let opacity =
                Opacity::named(&name).map_err(|error| SceneError::Color { key: "transfer.opacity", error })?;
            (format!("{name} over {}", domain.text()), over_range(&opacity))
        }
        (Some(OpacityName::Values(values)), _) => {
            let last = values.len().saturating_sub(1).max(1) as f64;
            let points = values.iter().enumerate().map(|(i, value)| OpacityPoint::straight(i as f64 / last, *value));
            let opacity = Opacity::new(&points.collect::<Vec<_>>())
                .map_err(|error| SceneError::Color { key: "transfer.opacity", error })?;
            (format!("{} values over {}", values.len(), domain.text()), over_range(&opacity))
        }
        (Some(OpacityName::Points(points)), _) => {
            if let Some(point) = points.iter().find(|point| !(0.0..=1.0).contains(&point[1])) {
                return Err(SceneError::value("transfer.opacity", point[1], "give opacities from 0 to 1"));
            }
            ("by points".to_owned(), points.into_iter().map(|[scalar, opacity]| [scalar, opacity / length]).collect())
        }
        (None, Some(opacity)) => (format!("the preset's over {}", domain.text()), over_range(opacity)),
        (None, None) => {
            if asked_length.is_some() {
                warnings.push("transfer.opacity_length has no effect: there is no opacity".to_owned());
            }
            return Ok(default_extinction(domain, facts, decisions, warnings));
        }
    };
    let source = if asked_length.is_some() { "asked for" } else { "an eighth of the mesh's diagonal" };
    decisions.push(Decision::new(
        "opacity",
        choice,
        format!("1 is an extinction of {}, one over a length of {}, {source}", short(1.0 / length), short(length)),
    ));
    Ok(points)
}

fn default_extinction(
    domain: &Domain,
    facts: &MeshFacts,
    decisions: &mut Vec<Decision>,
    warnings: &mut Vec<String>,
) -> Vec<[f64; 2]> {
    let points = defaults::extinction_over(domain.ends(), facts);
    let highest = points.last().map_or(0.0, |point| point[1]);
    if domain.is_constant() {
        let choice = format!("{} everywhere", short(highest));
        decisions.push(Decision::new("extinction", choice, "4 over the mesh's diagonal; the field is constant"));
        warnings.push(format!(
            "the field is {} everywhere: the picture shows the mesh's shape and nothing else",
            short(domain.low)
        ));
    } else {
        let choice = format!("0 at {} to {} at {}", short(domain.low), short(highest), short(domain.high));
        decisions.push(Decision::new("extinction", choice, "8 over the mesh's diagonal at the highest scalar"));
    }
    points
}
