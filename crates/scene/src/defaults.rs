//! What a scene looks like when it does not say: a camera that shows the whole mesh, and a transfer function that shows
//! its structure at any size.
//!
//! Every default is a multiple of the mesh's size or of the field's range, so that a mesh in millimeters gives the picture
//! of the same mesh in meters.

use glam::DVec3;
#[cfg(feature = "file")]
use tetrascope_colors::{ColorMap, HALF_GRAY_LEVEL};

use crate::MeshFacts;

/// The full vertical angle of view, degrees.
pub const FOV_Y_DEGREES: f64 = 30.0;

/// Optical depth of a ray as long as the diagonal of the bounding box where the scalar is highest.
pub const DIAGONAL_DEPTH: f64 = 8.0;

/// Where a camera stands and how it looks when a scene leaves it open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Radius of the sphere around the bounding box.
    pub radius: f64,
    /// From the target to the eye, world length.
    pub distance: f64,
}

/// How far away a perspective eye has to be for the bounding sphere to fill the smaller side of the picture.
///
/// - `fov_y_degrees`: full vertical angle, above 0 and below 180
pub fn fit_perspective(facts: &MeshFacts, fov_y_degrees: f64, width: u32, height: u32) -> Fit {
    let radius = sphere_radius(facts);
    let vertical = (fov_y_degrees.to_radians() / 2.0).tan();
    let smaller = vertical * smaller_side(width, height) / f64::from(height.max(1));
    // The sphere touches the pyramid of the view: sin of the half angle is radius over distance.
    Fit { radius, distance: radius / smaller.atan().sin() }
}

/// Full height of an orthographic view whose smaller side the bounding sphere fills.
pub fn fit_orthographic(facts: &MeshFacts, width: u32, height: u32) -> f64 {
    2.0 * sphere_radius(facts) * f64::from(height.max(1)) / smaller_side(width, height)
}

/// An up direction for a line of sight: +y, or where one looks along y, what is farther along it on a map.
pub fn up_for(sight: DVec3) -> DVec3 {
    let across = DVec3::new(sight.x, 0.0, sight.z);
    // Within a thousandth of a radian of the y axis, +y would turn the picture by chance.
    if across.length() > 1e-3 * sight.length() {
        DVec3::Y
    } else if sight.y < 0.0 {
        DVec3::NEG_Z
    } else {
        DVec3::Z
    }
}

/// The color map that stands where a scene names none.
pub const COLOR_MAP: &str = "viridis";

/// The default color map over a range of the field, linear RGB, within half a gray level. A constant field gets one color.
#[cfg(feature = "file")]
pub fn color(range: (f64, f64)) -> Vec<[f64; 4]> {
    ColorMap::named(COLOR_MAP).map(|map| color_of(&map, range)).unwrap_or_default()
}

/// A color map over a range of the field, linear RGB, within half a gray level.
#[cfg(feature = "file")]
pub(crate) fn color_of(map: &ColorMap, (low, high): (f64, f64)) -> Vec<[f64; 4]> {
    let mut points = map.linear_points(low, high, HALF_GRAY_LEVEL);
    keep_ends_of_steps(&mut points);
    points
}

/// A range of a few units in the last place has fewer floats than points: of those at one scalar the first and the last stay, a step.
#[cfg(feature = "file")]
pub(crate) fn keep_ends_of_steps<const N: usize>(points: &mut Vec<[f64; N]>) {
    let mut kept: Vec<[f64; N]> = Vec::with_capacity(points.len());
    for point in points.drain(..) {
        match kept.as_mut_slice() {
            [.., before, last] if before[0] == point[0] && last[0] == point[0] => *last = point,
            _ => kept.push(point),
        }
    }
    *points = kept;
}

/// Extinction from 0 at the lowest scalar to [`DIAGONAL_DEPTH`] over the diagonal at the highest; of a constant field half
/// of that everywhere. Per world unit of length.
pub fn extinction(facts: &MeshFacts) -> Vec<[f64; 2]> {
    extinction_over(facts.scalar_range, facts)
}

/// The same over another range.
pub(crate) fn extinction_over((low, high): (f64, f64), facts: &MeshFacts) -> Vec<[f64; 2]> {
    let highest = DIAGONAL_DEPTH / facts.diagonal();
    if low >= high { vec![[low, highest / 2.0]] } else { vec![[low, 0.0], [high, highest]] }
}

fn smaller_side(width: u32, height: u32) -> f64 {
    f64::from(width.min(height).max(1))
}

fn sphere_radius(facts: &MeshFacts) -> f64 {
    facts.diagonal() / 2.0
}
