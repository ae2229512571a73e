//! The opacity curves that PyVista has names for. There they are tables of bytes, here the formulas behind them.

use crate::ColorError;
use crate::error::shown;
use crate::opacity::{Curve, Opacity, OpacityPoint};

/// Where `geom` begins, of 255: what PyVista takes for 0, which equal factors cannot leave.
const GEOMETRIC_START: f64 = 1e-6 / 255.0;

/// Half the width of the sigmoids that have a number.
const SIGMOIDS: [u8; 12] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 15, 20];

/// Half the width of `sigmoid`.
const SIGMOID: f64 = 10.0;

/// The first of 256 steps, which `foreground` leaves out.
const BACKGROUND: f64 = 1.0 / 256.0;

/// All names, without `_r`.
fn plain_names() -> impl Iterator<Item = String> {
    ["linear", "geom", "sigmoid", "foreground"]
        .into_iter()
        .map(str::to_owned)
        .chain(SIGMOIDS.iter().map(|width| format!("sigmoid_{width}")))
}

/// The names that [`Opacity::named`] knows; each but `foreground` is also known with `_r`, backwards.
pub fn opacity_names() -> Vec<String> {
    plain_names()
        .flat_map(|name| if name == "foreground" { vec![name] } else { vec![name.clone(), format!("{name}_r")] })
        .collect()
}

/// Looks a name up, in any case.
pub(crate) fn find(name: &str) -> Result<Opacity, ColorError> {
    let wanted = name.to_ascii_lowercase();
    if let Some(plain) = wanted.strip_suffix("_r").filter(|plain| *plain != "foreground") {
        return curve(plain).map(|curve| curve.reversed()).ok_or_else(|| unknown(name));
    }
    curve(&wanted).ok_or_else(|| unknown(name))
}

fn curve(name: &str) -> Option<Opacity> {
    let through = |points: &[(f64, f64)]| {
        let points: Vec<_> = points.iter().map(|&(x, opacity)| OpacityPoint::straight(x, opacity)).collect();
        Opacity::new(&points).ok().map(|curve| curve.renamed(name))
    };
    let sigmoid = |width: f64| Opacity::of_curve(name, Curve::Sigmoid([-width, width]));
    match name {
        "linear" => through(&[(0.0, 0.0), (1.0, 1.0)]),
        "foreground" => through(&[(0.0, 0.0), (BACKGROUND, 0.0), (BACKGROUND, 1.0), (1.0, 1.0)]),
        "geom" => Some(Opacity::of_curve(name, Curve::Geometric([GEOMETRIC_START, 1.0]))),
        "sigmoid" => Some(sigmoid(SIGMOID)),
        _ => {
            let width = name.strip_prefix("sigmoid_")?;
            SIGMOIDS.iter().find(|number| number.to_string() == width).map(|&number| sigmoid(f64::from(number)))
        }
    }
}

fn unknown(name: &str) -> ColorError {
    let names = plain_names().collect::<Vec<_>>().join(", ");
    ColorError::UnknownName {
        what: "opacity".to_owned(),
        name: shown(name),
        remedy: format!("the names are {names}, and all but foreground with _r; or give points (0:0, 0.3:0.9, 1:0)"),
    }
}
