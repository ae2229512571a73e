//! Where the samples lie: directions, spacings and origin.

use glam::{DMat3, DVec3};

use super::{
    axes::{Axes, Role},
    header::{Field, Header, MEND},
};
use crate::{IoError, Source, grid::RegularGrid};

/// The vectors of `space directions`.
#[derive(Debug)]
pub(super) struct Directions {
    /// From a sample to the next along each axis; `None` where the axis runs along none.
    vectors: Vec<Option<Vec<f64>>>,
}

/// Spaces whose axes are left-handed, with what they are called for short.
const LEFT_HANDED: [&str; 6] =
    ["3d-left-handed", "3d-left-handed-time", "left-anterior-superior", "las", "left-anterior-superior-time", "last"];

impl Directions {
    /// Those of a header, if it has any; one vector an axis, all of the same length.
    pub(super) fn parse(source: &Source, header: &Header<'_>, axes: usize) -> Result<Option<Self>, IoError> {
        let Some(field) = header.field("space directions") else { return Ok(None) };
        let vectors = vectors(source, field)?;
        if vectors.len() != axes {
            let problem = format!("{} vectors stand in `space directions` of {axes} axes", vectors.len());
            return Err(field.invalid(source, problem));
        }
        let mut lengths = vectors.iter().flatten().map(Vec::len);
        let first = lengths.next().unwrap_or(3);
        if lengths.any(|length| length != first) {
            return Err(field.invalid(source, "the vectors of `space directions` differ in length"));
        }
        Ok(Some(Self { vectors }))
    }

    /// Whether an axis runs along a direction in space. One along time alone, the fourth number, does not.
    pub(super) fn of_axis(&self, axis: usize) -> bool {
        let vector = self.vectors.get(axis).and_then(Option::as_ref);
        vector.is_some_and(|vector| vector.len() < 4 || vector.iter().take(3).any(|&number| number != 0.0))
    }

    fn vector(&self, axis: usize) -> Option<DVec3> {
        let vector = self.vectors.get(axis)?.as_ref()?;
        Some(DVec3::new(*vector.first()?, *vector.get(1)?, *vector.get(2)?))
    }

    /// What an axis adds to time a step.
    fn time(&self, axis: usize) -> Option<f64> {
        self.vectors.get(axis)?.as_ref()?.get(3).copied()
    }
}

/// The grid of the samples, in the space that the header names, whatever that is and in whatever unit: coordinates are taken as they stand.
pub(super) fn grid(
    source: &Source,
    header: &Header<'_>,
    axes: &Axes,
    directions: Option<&Directions>,
    warnings: &mut Vec<String>,
) -> Result<RegularGrid, IoError> {
    let line = Line::all(source, header, axes)?;
    let mut steps = [DVec3::ZERO; 3];
    let mut origin = DVec3::ZERO;
    let units = [DVec3::X, DVec3::Y, DVec3::Z];
    for (along, (axis, unit)) in steps.iter_mut().zip(axes.of(Role::Space).zip(units)) {
        if let Some(directions) = directions {
            *along = directions.vector(axis).ok_or_else(|| {
                source.invalid("the field `space directions`", "an axis has no vector of three numbers in it", MEND)
            })?;
        } else if let Some(line) = line.get(axis) {
            *along = unit * line.spacing;
            origin += unit * line.first;
        }
    }
    if let Some(field) = header.field("space origin") {
        let vector = vectors(source, field)?.into_iter().next().flatten().unwrap_or_default();
        let [x, y, z] = [0, 1, 2].map(|i| vector.get(i).copied());
        let (Some(x), Some(y), Some(z)) = (x, y, z) else {
            return Err(field.invalid(source, "`space origin` is not of three numbers, as in (0,0,0)"));
        };
        origin = DVec3::new(x, y, z);
    }
    if !origin.is_finite() || !span_space(steps) {
        let problem = format!(
            "from sample to sample it is {}, from the origin {origin}: that is no grid in space",
            steps.map(|step| step.to_string()).join(", ")
        );
        return Err(source.invalid("the space of the header", problem, MEND));
    }
    warn_of_space(source, header, warnings)?;
    Ok(RegularGrid { dims: axes.dims(), origin, steps })
}

/// Whether three steps are finite and lie in no plane. Their lengths are taken out first, whose product may be no number.
fn span_space(steps: [DVec3; 3]) -> bool {
    let lengths = steps.map(|step| step.abs().max_element());
    let units = [0, 1, 2].map(|i| (steps[i] / lengths[i]).to_array());
    lengths.iter().all(|length| length.is_finite() && *length > 0.0)
        && DMat3::from_cols_array_2d(&units).determinant() != 0.0
}

/// The time of every step, counted where the header knows none. As many numbers as the axis has samples: that the file has them is the
/// caller's to have seen.
pub(super) fn times(
    source: &Source,
    header: &Header<'_>,
    axes: &Axes,
    directions: Option<&Directions>,
) -> Result<Vec<f64>, IoError> {
    let Some(axis) = axes.step_axis() else { return Ok(Vec::new()) };
    let count = axes.sizes.get(axis).copied().unwrap_or_default();
    let line = Line::all(source, header, axes)?;
    let (first, spacing) = match (directions.and_then(|directions| directions.time(axis)), line.get(axis)) {
        (Some(spacing), _) => {
            let origin = header.field("space origin").map(|field| vectors(source, field)).transpose()?;
            let time = origin.and_then(|vectors| vectors.into_iter().next().flatten()?.get(3).copied());
            (time.unwrap_or(0.0), spacing)
        }
        (None, Some(line)) => (line.first, line.spacing),
        (None, None) => (0.0, 1.0),
    };
    Ok((0..count).map(|step| first + spacing * step as f64).collect())
}

fn warn_of_space(source: &Source, header: &Header<'_>, warnings: &mut Vec<String>) -> Result<(), IoError> {
    if let Some(space) = header.lower("space")
        && LEFT_HANDED.contains(&space.as_str())
    {
        warnings.push(format!(
            "the axes of its space, {space}, are left-handed; coordinates are taken as they stand, so that pictures are mirrored"
        ));
    }
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    if let Some(field) = header.field("measurement frame")
        && !vectors(source, field)?.into_iter().flatten().eq(identity)
    {
        warnings.push("vectors are taken as they stand: the measurement frame of the header is not applied".to_owned());
    }
    Ok(())
}

/// Positions along one axis without a direction.
#[derive(Clone, Copy, Debug)]
struct Line {
    first: f64,
    spacing: f64,
}

impl Line {
    /// By `spacings`, `axis mins`, `axis maxs` and `centers`; NaN and what is not there count as not known, which makes them 1 apart from 0.
    ///
    /// Mins and maxs are those of samples where these are nodes or steps, else of the cells around samples, as the library of the format has it.
    fn all(source: &Source, header: &Header<'_>, axes: &Axes) -> Result<Vec<Self>, IoError> {
        let count = axes.sizes.len();
        let [spacings, mins, maxs] =
            ["spacings", "axis mins", "axis maxs"].map(|name| header.numbers(source, name, count));
        let (spacings, mins, maxs) = (spacings?, mins?, maxs?);
        let centers = header.words(source, "centers", count)?;
        let of = |numbers: &Option<Vec<f64>>, axis: usize| {
            numbers.as_ref().and_then(|numbers| numbers.get(axis)).copied().filter(|number| !number.is_nan())
        };
        let line = |(axis, &size): (usize, &usize)| {
            let node = match centers.as_ref().and_then(|words| words.get(axis)).map(String::as_str) {
                Some("node") => true,
                Some("cell") => false,
                // A first time of 0 is that of the first step.
                _ => axes.roles.get(axis) == Some(&Role::Step),
            };
            let intervals = if node { size.saturating_sub(1).max(1) } else { size } as f64;
            let (min, max) = (of(&mins, axis), of(&maxs, axis));
            let between = min.zip(max).map(|(min, max)| (max - min) / intervals);
            let spacing = of(&spacings, axis).or(between).unwrap_or(1.0);
            let half = if node { 0.0 } else { 0.5 * spacing };
            Self { first: min.map_or(0.0, |min| min + half), spacing }
        };
        Ok(axes.sizes.iter().enumerate().map(line).collect())
    }
}

/// Vectors as `(1,0,0) (0,1,0) none`; one that is all NaN stands for none, as the library of the format has it.
fn vectors(source: &Source, field: &Field) -> Result<Vec<Option<Vec<f64>>>, IoError> {
    let mut vectors = Vec::new();
    let mut rest = field.text.trim_start();
    while !rest.is_empty() {
        if let Some(behind) = rest.strip_prefix("none") {
            vectors.push(None);
            rest = behind.trim_start();
            continue;
        }
        let inside = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
        let numbers = inside.and_then(|(inside, _)| {
            inside.split(',').map(|word| word.trim().parse().ok()).collect::<Option<Vec<f64>>>()
        });
        let (Some((_, behind)), Some(numbers)) = (inside, numbers) else {
            let found: String = rest.chars().take(60).collect();
            return Err(
                field.invalid(source, format!("`{found}` does not begin with a vector, as in (1,0,0), or none"))
            );
        };
        vectors.push((!numbers.iter().all(|number| number.is_nan())).then_some(numbers));
        rest = behind.trim_start();
    }
    Ok(vectors)
}
