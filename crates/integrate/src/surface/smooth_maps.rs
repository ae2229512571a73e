//! The pair of maps with which isosurfaces are shaded at the faces of cells.

use super::maps::{entry, for_all_texels};
use super::{IsosurfaceError, IsosurfaceMap, Isosurfaces};
use crate::RgbaAssoc;

#[cfg(test)]
#[path = "smooth_maps_tests.rs"]
mod tests;

/// An [`IsosurfaceMap`] taken apart into a pass for the front faces of cells and one for their back faces.
///
/// What is shaded at the front face lies over what is shaded at the back face, and a surface takes from each as much as
/// it is near to it. The volume of the cell may be blended between the two passes.
///
/// With the surfaces `k = 1, 2, …` between the centers of two texels, from front to back, `A_k` their opacities, `K_k`
/// their colors, `T_k` the product of `1 - A_j` over those in front and `w_k = (c_k - s_b) / (s_f - s_b)` the weight of
/// the front at the isovalue `c_k`:
///
/// ```text
/// flat   L = Σ T_k A_k (K_k, 1)             the IsosurfaceMap
/// front  F = Σ T_k w_k A_k (K_k, 1)
/// back   B = (L - F) / (1 - F.a)            0 where F.a = 1;  F over B = L
/// ```
///
/// For one opaque surface `F = (w K, w)` and `B = (K, 1)`: the modulated map and the map of the paper. Transparent
/// and several surfaces are an addition. `L - F` is the sum with `1 - w_k` in the place of `w_k` and is computed as
/// that, since the difference would cancel.
///
/// # Shading
///
/// A pass is lit with the intensities at its own face ([`crate::Phong::intensities`]): `rgb * body + opacity *
/// highlight`, the opacity unchanged. All surfaces of a map are lit alike, [`Isosurface::shading`] does not count. Only
/// intensities are interpolated, not normals, and they weaken between faces whose normals differ.
///
/// # Accuracy
///
/// The two passes put over each other are exact where [`IsosurfaceMap`] is. The weights are those of the texels'
/// centers: where both ends of a segment lie up to `d` beside theirs, they are off by up to `d / |s_f - s_b|` to first
/// order. Between ends that differ by no more than a texel or two the weights mean little, as in cells much finer than
/// the map.
///
/// Source: [Röttger 2000], section 8 (the weight is its equation for α), sections 9 and 10.
///
/// [`Isosurface::shading`]: crate::Isosurface::shading
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothMaps {
    front: IsosurfaceMap,
    back: IsosurfaceMap,
}

impl SmoothMaps {
    /// Two maps of `size` times `size` texels over a range of scalars, lowest and highest. Cost as for
    /// [`IsosurfaceMap::new`].
    ///
    /// # Errors
    /// [`IsosurfaceError::MapSize`]; [`IsosurfaceError::MapRange`] for a range that descends or has no finite width.
    pub fn new(surfaces: &Isosurfaces, scalars: [f64; 2], size: u32) -> Result<Self, IsosurfaceError> {
        let mut front = IsosurfaceMap::transparent(scalars, size)?;
        let mut back = front.clone();
        for_all_texels(surfaces, front.axis(), |texel, crossed, width| {
            // Without a surface the width may be 0.
            if crossed.light != RgbaAssoc::TRANSPARENT {
                let at_back = divided(crossed.moment, width);
                let at_front = less(crossed.light, at_back);
                front.entries_mut()[texel] = entry(at_front);
                back.entries_mut()[texel] = entry(behind(at_back, crossed.light.opacity));
            }
        });
        Ok(Self { front, back })
    }

    /// `F`, to be shaded at the front faces.
    pub fn front(&self) -> &IsosurfaceMap {
        &self.front
    }

    /// `B`, to be shaded at the back faces. Its axis is that of the front.
    pub fn back(&self) -> &IsosurfaceMap {
        &self.back
    }
}

/// `B` from `L - F`; `1 - F.a` is the sum of what `L` lets through and of the opacity in `L - F`.
fn behind(at_back: RgbaAssoc, opacity: f64) -> RgbaAssoc {
    let let_through = (1.0 - opacity) + at_back.opacity;
    if let_through > 0.0 { divided(at_back, let_through) } else { RgbaAssoc::TRANSPARENT }
}

/// Not by way of the inverse, which may exceed the largest float.
fn divided(light: RgbaAssoc, by: f64) -> RgbaAssoc {
    RgbaAssoc { rgb: light.rgb.map(|channel| channel / by), opacity: light.opacity / by }
}

/// The difference; rounding may leave a little less than nothing.
fn less(light: RgbaAssoc, part: RgbaAssoc) -> RgbaAssoc {
    let rgb = core::array::from_fn(|channel| (light.rgb[channel] - part.rgb[channel]).max(0.0));
    RgbaAssoc { rgb, opacity: (light.opacity - part.opacity).max(0.0) }
}
