//! What a word of the command line means: numbers, points, names.

use tetrascope::{IsosurfaceSection, LengthAxisName, OpacityName, Shading, TableSettings, TargetBits};

/// A number that is not negative, or a fraction of two: `0.004`, `1e-3`, `1/255`.
pub(crate) fn fraction(text: &str) -> Result<f64, String> {
    let number = |part: &str| -> Result<f64, String> {
        let part = part.trim();
        part.parse().map_err(|_| format!("\"{part}\" is not a number; give one, or a fraction such as 1/255"))
    };
    let value = match text.split_once('/') {
        Some((above, below)) => number(above)? / number(below)?,
        None => number(text)?,
    };
    if !value.is_finite() {
        return Err(format!("\"{text}\" is not a finite number"));
    }
    if value < 0.0 { Err(format!("\"{text}\" is negative")) } else { Ok(value) }
}

/// An error that can be wanted: no channel is off by more than 1.
pub(super) fn wanted_error(text: &str) -> Result<f64, String> {
    let error = fraction(text)?;
    if error > 1.0 { Err(format!("{error} is more than 1; give a number from 0 to 1")) } else { Ok(error) }
}

/// Control points of `N` numbers each; a type of its own, as a bare `Vec` would be taken for a repeated option.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Points<const N: usize>(pub(crate) Vec<[f64; N]>);

fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let mut out = [0.0_f64; N];
    if parts.len() != N {
        return Err(format!("\"{text}\" has {} numbers; give {N}, with commas between", parts.len()));
    }
    for (slot, part) in out.iter_mut().zip(parts) {
        *slot = part.parse().map_err(|_| format!("\"{part}\" is not a number"))?;
        if !slot.is_finite() {
            return Err(format!("{slot} is not a finite number"));
        }
    }
    Ok(out)
}

pub(crate) fn vector(text: &str) -> Result<[f64; 3], String> {
    numbers(text)
}

pub(super) fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |part: &str| part.trim().parse().map_err(|_| format!("\"{text}\" is no size; give 512 or 640x480"));
    match text.split_once(['x', 'X', '×']) {
        Some((width, height)) => Ok((side(width)?, side(height)?)),
        None => side(text).map(|both| (both, both)),
    }
}

fn points<const N: usize, const VALUES: usize>(text: &str) -> Result<Points<N>, String> {
    let entries = text.split(';').map(str::trim).filter(|entry| !entry.is_empty());
    let parsed: Result<Vec<_>, String> = entries
        .map(|entry| {
            let (scalar, values) =
                entry.split_once(':').ok_or_else(|| format!("\"{entry}\" has no colon behind its scalar"))?;
            let ([scalar], values) = (numbers::<1>(scalar)?, numbers::<VALUES>(values)?);
            Ok(std::array::from_fn(|i| if i == 0 { scalar } else { values[i - 1] }))
        })
        .collect();
    match parsed? {
        list if list.is_empty() => Err("give at least one control point".to_owned()),
        list => Ok(Points(list)),
    }
}

pub(super) fn color_points(text: &str) -> Result<Points<4>, String> {
    points::<4, 3>(text)
}

/// What an isosurface looks like when only its value is given: nearly white, so that every light shows on it.
const ISOSURFACE_COLOR: [f64; 3] = [0.9; 3];

pub(super) fn isosurface(text: &str) -> Result<IsosurfaceSection, String> {
    let Some((value, look)) = text.split_once(':') else {
        let [value] = numbers(text)?;
        return Ok(IsosurfaceSection::new(value, ISOSURFACE_COLOR));
    };
    let [value] = numbers(value)?;
    match look.split(',').count() {
        3 => Ok(IsosurfaceSection::new(value, numbers(look)?)),
        4 => {
            let [r, g, b, opacity] = numbers(look)?;
            Ok(IsosurfaceSection { opacity, ..IsosurfaceSection::new(value, [r, g, b]) })
        }
        other => Err(format!("\"{look}\" has {other} numbers; give red, green, blue, and an opacity if it is not 1")),
    }
}

pub(super) fn shading(name: &str) -> Result<Shading, String> {
    match name {
        "none" => Ok(Shading::None),
        "flat" => Ok(Shading::Flat),
        "smooth" => Ok(Shading::Smooth),
        _ => Err("there are none, flat and smooth".to_owned()),
    }
}

pub(super) fn length_axis(name: &str) -> Result<LengthAxisName, String> {
    match name {
        "linear" => Ok(LengthAxisName::Linear),
        "logarithmic" => Ok(LengthAxisName::Logarithmic),
        _ => Err("there are linear and logarithmic".to_owned()),
    }
}

pub(super) fn target_bits(text: &str) -> Result<u32, String> {
    let bits = text.parse().ok().filter(|&bits| TargetBits::of(bits).is_some());
    bits.ok_or_else(|| "there are targets of 16 and 32 bits".to_owned())
}

pub(super) fn table_size() -> clap::builder::RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(i64::from(TableSettings::LEAST)..=i64::from(TableSettings::MOST))
}

pub(super) fn extinction_points(text: &str) -> Result<Points<2>, String> {
    points::<2, 1>(text)
}

pub(crate) fn number(text: &str) -> Result<f64, String> {
    numbers::<1>(text).map(|[number]| number)
}

pub(super) fn range(text: &str) -> Result<[f64; 2], String> {
    let [low, high] = numbers(text)?;
    if low < high { Ok([low, high]) } else { Err(format!("{low} is not below {high}; give LOW,HIGH")) }
}

/// Points have a colon each, values over the whole range commas between them, and names neither.
pub(super) fn opacity(text: &str) -> Result<OpacityName, String> {
    if text.contains(':') {
        return points::<2, 1>(text).map(|points| OpacityName::Points(points.0));
    }
    if text.contains(',') {
        let values = text.split(',').map(number).collect::<Result<_, _>>()?;
        return Ok(OpacityName::Values(values));
    }
    Ok(OpacityName::Name(text.to_owned()))
}
