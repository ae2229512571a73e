//! Gradients inside a cell, for the light: interpolated between its corners, in the camera's axes.

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::DVec3;

use super::cell::Cell;
use crate::geometry::PixelSpace;

/// The gradient of the field inside one cell, as a function of the place in pixel space: linear, or constant.
///
/// Components are along the axes of the camera (right, down, forward), lengths in the mesh's local unit, scalars in the
/// renderer's; the light asks for directions alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellGradient {
    /// A corner in pixel space, its depth from [`PixelSpace::start`], and the gradient there.
    anchor: [f32; 3],
    at_anchor: [f32; 3],
    /// Slope of each component along the axes of pixel space.
    slope: [[f32; 3]; 3],
    /// Lowest and highest value of each component among the corners: rounding in a thin cell stays within.
    range: [[f32; 2]; 3],
}

/// Slope in pixel space of a function with these values at a cell's corners; zero for a cell without volume.
fn slope(cell: &Cell, values: [f64; 4]) -> DVec3 {
    let [a, b, c, d] = cell.corners;
    let (ab, ac, ad) = (b - a, c - a, d - a);
    let (nb, nc, nd) = (ac.cross(ad), ad.cross(ab), ab.cross(ac));
    let six_volume = ab.dot(nb);
    let sum = nb * (values[1] - values[0]) + nc * (values[2] - values[0]) + nd * (values[3] - values[0]);
    let slope = sum / six_volume;
    if slope.is_finite() { slope } else { DVec3::ZERO }
}

impl CellGradient {
    /// The gradient of the scalar, which is one for the whole cell.
    pub(crate) fn constant(cell: &Cell, space: &PixelSpace) -> Self {
        let gradient = space.gradient_in_view(slope(cell, cell.scalars)).to_array().map(|g| g as f32);
        let range = gradient.map(|g| [g, g]);
        Self { anchor: [0.0; 3], at_anchor: gradient, slope: [[0.0; 3]; 3], range }
    }

    /// Linear between gradients at the corners, given along the mesh's axes.
    pub(crate) fn linear(cell: &Cell, at_corners: [DVec3; 4], space: &PixelSpace) -> Self {
        let at_corners = at_corners.map(|g| space.direction_in_view(g).to_array());
        let component = |axis: usize| at_corners.map(|g| g[axis]);
        let range = |values: [f64; 4]| {
            let low = values.iter().fold(f64::INFINITY, |m, &g| m.min(g));
            [low as f32, values.iter().fold(f64::NEG_INFINITY, |m, &g| m.max(g)) as f32]
        };
        Self {
            anchor: (cell.corners[0] - DVec3::Z * space.start).to_array().map(|x| x as f32),
            at_anchor: at_corners[0].map(|g| g as f32),
            slope: [0, 1, 2].map(|axis| slope(cell, component(axis)).to_array().map(bounded)),
            range: [0, 1, 2].map(|axis| range(component(axis))),
        }
    }

    /// The gradient at a place in pixel space, its depth from [`PixelSpace::start`].
    #[inline(always)]
    pub(crate) fn at<S: Simd>(&self, simd: S, place: [f32x8<S>; 3]) -> [f32x8<S>; 3] {
        let [x, y, z] = [place[0] - self.anchor[0], place[1] - self.anchor[1], place[2] - self.anchor[2]];
        let mut gradient = [x; 3];
        for (axis, component) in gradient.iter_mut().enumerate() {
            let [per_x, per_y, per_z] = self.slope[axis].map(|s| f32x8::splat(simd, s));
            let value = per_z.mul_add(z, per_y.mul_add(y, per_x.mul_add(x, f32x8::splat(simd, self.at_anchor[axis]))));
            let [low, high] = self.range[axis];
            *component = value.max(low).min(high);
        }
        gradient
    }
}

/// To f32, and not so large that a product with a length overflows: what lies beyond is cut to the corners' range anyway.
fn bounded(slope: f64) -> f32 {
    slope.clamp(-1e30, 1e30) as f32
}
