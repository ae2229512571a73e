//! What a scene looks like when it does not say: a camera that shows the whole mesh, and a transfer function that shows
//! its structure at any size.
//!
//! Every default is a multiple of the mesh's size or of the field's range, so that a mesh in millimeters gives the picture
//! of the same mesh in meters.

use glam::DVec3;

use crate::MeshFacts;

/// The full vertical angle of view, degrees.
pub const FOV_Y_DEGREES: f64 = 30.0;

/// Optical depth of a ray as long as the diagonal of the bounding box where the scalar is highest.
pub const DIAGONAL_DEPTH: f64 = 8.0;

/// Control points of the default color: a colormap in linear light needs more points than in sRGB to look the same between
/// them. With 33 the largest difference from the map itself is below 3 of 255 in sRGB (test `viridis_is_close`).
const COLOR_POINTS: u32 = 33;

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

/// Viridis over the field's range, linear RGB. A constant field gets one color.
pub fn color(range: (f64, f64)) -> Vec<[f64; 4]> {
    let (low, high) = range;
    if low >= high {
        let [r, g, b] = viridis(0.5);
        return vec![[low, r, g, b]];
    }
    let mut points = Vec::with_capacity(COLOR_POINTS as usize);
    let mut last = f64::NEG_INFINITY;
    for i in 0..COLOR_POINTS {
        let t = f64::from(i) / f64::from(COLOR_POINTS - 1);
        let scalar = if i + 1 == COLOR_POINTS { high } else { (low * (1.0 - t) + high * t).clamp(low, high) };
        // A range of a few units in the last place has fewer floats than points.
        if scalar > last {
            let [r, g, b] = viridis(t);
            points.push([scalar, r, g, b]);
            last = scalar;
        }
    }
    points
}

/// Extinction from 0 at the lowest scalar to [`DIAGONAL_DEPTH`] over the diagonal at the highest; of a constant field half
/// of that everywhere. Per world unit of length.
pub fn extinction(facts: &MeshFacts) -> Vec<[f64; 2]> {
    let highest = DIAGONAL_DEPTH / facts.diagonal();
    let (low, high) = facts.scalar_range;
    if low >= high { vec![[low, highest / 2.0]] } else { vec![[low, 0.0], [high, highest]] }
}

fn smaller_side(width: u32, height: u32) -> f64 {
    f64::from(width.min(height).max(1))
}

fn sphere_radius(facts: &MeshFacts) -> f64 {
    facts.diagonal() / 2.0
}

/// The colormap in linear light; `t` from 0 to 1.
fn viridis(t: f64) -> [f64; 3] {
    let color = colorous::VIRIDIS.eval_continuous(t);
    [color.r, color.g, color.b].map(|byte| linear_from_srgb(f64::from(byte) / 255.0))
}

/// IEC 61966-2-1, from encoded to linear light; 0 to 1.
pub(crate) fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
