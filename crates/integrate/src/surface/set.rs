//! A set of isosurfaces, and which of them lie between two scalars.

use core::ops::Range;

use thiserror::Error;

use super::TexelAxis;

#[cfg(test)]
#[path = "set_tests.rs"]
mod tests;

/// A surface on which the scalar has one value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isosurface {
    /// The scalar on it; finite.
    pub value: f64,
    /// Linear RGB of the side that faces rising scalars: what is seen where the ray meets it with the scalar falling.
    pub color: [f64; 3],
    /// Linear RGB of the other side.
    pub back_color: [f64; 3],
    /// Share of the light behind that it hides, 0 to 1.
    pub opacity: f64,
    /// How light falls on it.
    pub shading: SurfaceShading,
}

/// How light falls on an isosurface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SurfaceShading {
    /// Its color, everywhere.
    #[default]
    None,
    /// One normal a cell: the direction of the cell's gradient.
    Flat,
    /// The gradients of the points, interpolated.
    Smooth,
}

/// Isosurfaces by ascending value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Isosurfaces {
    surfaces: Vec<Isosurface>,
}

/// Why isosurfaces cannot be drawn, or not by a map.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum IsosurfaceError {
    /// A number is out of range.
    #[error("isosurface {index}: {component} is {value}; {expected}")]
    Value {
        /// Which one, in the order given, from 0.
        index: usize,
        /// `"value"`, `"color"`, `"back_color"` or `"opacity"`.
        component: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        expected: &'static str,
    },
    /// A map's size is out of range.
    #[error("a map of {size} by {size} texels is not possible; give {least} to {most}")]
    MapSize {
        /// Texels a side.
        size: u32,
        /// The least number.
        least: u32,
        /// The largest number.
        most: u32,
    },
    /// A map cannot cover a range of scalars.
    #[error("no map covers scalars from {lo} to {hi}; give a range that ascends and whose width is finite")]
    MapRange {
        /// Where it begins.
        lo: f64,
        /// Where it ends.
        hi: f64,
    },
}

impl Isosurfaces {
    /// Sorts surfaces by their value; those of one value stay in the order given.
    ///
    /// # Errors
    /// [`IsosurfaceError`] for a value that is not finite, a color that is negative or not finite, an opacity outside 0
    /// to 1.
    pub fn new(mut surfaces: Vec<Isosurface>) -> Result<Self, IsosurfaceError> {
        for (index, surface) in surfaces.iter().enumerate() {
            let refuse = |component, value, expected| Err(IsosurfaceError::Value { index, component, value, expected });
            if !surface.value.is_finite() {
                return refuse("value", surface.value, "give a finite number");
            }
            if !(0.0..=1.0).contains(&surface.opacity) {
                return refuse("opacity", surface.opacity, "give a number from 0 to 1");
            }
            for (component, color) in [("color", surface.color), ("back_color", surface.back_color)] {
                if let Some(&bad) = color.iter().find(|c| !(c.is_finite() && **c >= 0.0)) {
                    return refuse(component, bad, "give finite numbers, zero or more");
                }
            }
        }
        surfaces.sort_by(|a, b| a.value.total_cmp(&b.value));
        Ok(Self { surfaces })
    }

    /// The surfaces, by ascending value.
    pub fn as_slice(&self) -> &[Isosurface] {
        &self.surfaces
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.surfaces.is_empty()
    }

    /// Number of surfaces whose value is not above a scalar: on which side of each of them it lies.
    ///
    /// A ray from a scalar of rank `p` to one of rank `q` crosses the surfaces between `p` and `q`, so that along a
    /// chain of segments every crossing counts once, whatever the scalars at the joints are.
    #[inline]
    pub fn rank(&self, scalar: f64) -> usize {
        self.surfaces.partition_point(|surface| surface.value <= scalar)
    }

    /// The surfaces that a segment between two scalars crosses.
    #[inline]
    pub fn between(&self, first: f64, second: f64) -> Range<usize> {
        let (low, high) = if first <= second { (first, second) } else { (second, first) };
        self.rank(low)..self.rank(high)
    }

    /// What shading the most demanding of them needs.
    pub fn shading(&self) -> SurfaceShading {
        self.surfaces.iter().map(|surface| surface.shading).max().unwrap_or_default()
    }

    /// Whether nothing shows through any of them.
    pub fn are_opaque(&self) -> bool {
        self.surfaces.iter().all(|surface| surface.opacity == 1.0)
    }

    /// The same surfaces where a map of these texels has them.
    #[must_use]
    pub fn on_texels(&self, axis: &TexelAxis) -> Self {
        let moved = |surface: &Isosurface| Isosurface { value: axis.boundary(surface.value), ..*surface };
        Self { surfaces: self.surfaces.iter().map(moved).collect() }
    }

    /// Those that can be seen: without the ones of opacity 0.
    #[must_use]
    pub fn visible(&self) -> Self {
        Self { surfaces: self.surfaces.iter().copied().filter(|surface| surface.opacity > 0.0).collect() }
    }

    /// The same surfaces of a field that counts from another scalar: values less `base`, which is finite.
    #[must_use]
    pub fn with_scalars_from(&self, base: f64) -> Self {
        let from =
            |surface: &Isosurface| Isosurface { value: (surface.value - base).clamp(f64::MIN, f64::MAX), ..*surface };
        Self { surfaces: self.surfaces.iter().map(from).collect() }
    }

    /// The same surfaces of a field in another unit: values at `factor` times theirs; `factor` is positive.
    #[must_use]
    pub fn with_scalars_scaled(&self, factor: f64) -> Self {
        let scale =
            |surface: &Isosurface| Isosurface { value: (surface.value * factor).clamp(f64::MIN, f64::MAX), ..*surface };
        Self { surfaces: self.surfaces.iter().map(scale).collect() }
    }
}
