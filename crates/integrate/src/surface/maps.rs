//! Isosurfaces by look-up: a map over the scalars at both ends of a segment.

use super::{IsosurfaceError, Isosurfaces};
use crate::{RgbaAssoc, Segment};

#[cfg(test)]
#[path = "maps_tests.rs"]
pub(in crate::surface) mod tests;

/// How scalars become texels, along either axis of a map.
///
/// The coordinate of a scalar is `(scalar - start) * per_scalar`, 0 to `texels` over the map's range; its texel is the
/// whole part, clamped to `0..texels`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelAxis {
    /// Scalar of the coordinate 0.
    pub start: f64,
    /// Texels per unit of the scalar; 0 where the range has no width, and then there is one texel that is used.
    pub per_scalar: f64,
    /// Number of texels.
    pub texels: u32,
    width: f64,
}

impl TexelAxis {
    /// Divides a range of scalars, lowest and highest, evenly.
    ///
    /// # Errors
    /// [`IsosurfaceError::MapSize`]; [`IsosurfaceError::MapRange`] for a range that descends or has no finite width.
    pub fn new([lo, hi]: [f64; 2], texels: u32) -> Result<Self, IsosurfaceError> {
        if !(IsosurfaceMap::LEAST..=IsosurfaceMap::MOST).contains(&texels) {
            let (least, most) = (IsosurfaceMap::LEAST, IsosurfaceMap::MOST);
            return Err(IsosurfaceError::MapSize { size: texels, least, most });
        }
        let width = hi - lo;
        if !(width.is_finite() && width >= 0.0) {
            return Err(IsosurfaceError::MapRange { lo, hi });
        }
        // A range that is too narrow for its inverse is as good as one scalar.
        let per_scalar = Some(f64::from(texels) / width).filter(|number| number.is_finite());
        Ok(Self { start: lo, per_scalar: per_scalar.unwrap_or(0.0), texels, width })
    }

    /// The texel of a scalar; those outside of the range take the nearest.
    #[inline]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the conversion saturates")]
    pub fn texel(&self, scalar: f64) -> u32 {
        (((scalar - self.start) * self.per_scalar) as u32).min(self.texels - 1)
    }

    /// The scalar that stands for all of a texel: the middle; of the first and the last one the end of the range, so that no
    /// surface inside of the range lies beyond both.
    pub fn center(&self, texel: u32) -> f64 {
        let share = match texel {
            0 => 0.0,
            _ if texel + 1 >= self.texels => 1.0,
            _ => (f64::from(texel) + 0.5) / f64::from(self.texels),
        };
        self.start + share * self.width
    }

    /// Where a map has a surface of this value: at the boundary between the two texels whose centers lie on either side of it.
    ///
    /// Values outside of the range, and the lowest one, have no boundary and are given back as they are.
    pub fn boundary(&self, value: f64) -> f64 {
        let (mut below, mut above) = (0, self.texels - 1);
        if !(self.center(below) < value && value <= self.center(above)) {
            return value;
        }
        while above - below > 1 {
            let middle = below + (above - below) / 2;
            if self.center(middle) < value { below = middle } else { above = middle }
        }
        self.start + f64::from(above) / f64::from(self.texels) * self.width
    }
}

/// The surfaces that a segment crosses, seen from its front, for all pairs of scalars at its ends.
///
/// Texel `(front, back)` has what lies between the centers of the two texels: all surfaces whose ranks are between
/// theirs ([`Isosurfaces::rank`]), in the order in which the ray meets them, each with the color of the side that it
/// shows and its opacity, unshaded. The look-up takes the texel as it is and costs the same for any number of surfaces.
///
/// # Accuracy
///
/// Where both scalars have the rank of their texels' centers the map is exact, to a rounding to 32 bits. Elsewhere a
/// surface is found up to half a texel of scalar beside its place, in the first and the last texel up to a whole one,, and two that share a texel are found together.
///
/// # No gaps
///
/// A texel depends on one scalar alone. Where two cells see the same scalar in the face between them, the ray leaves
/// the one in the texel in which it enters the other, and no surface is missed or met twice. [Röttger 2000], section 7,
/// thickens the surfaces to close gaps and doubles transparent ones at every edge; here neither happens.
///
/// Source: [Röttger 2000], section 7 for the map (with its appendix for why it is the limit of a transfer function) and
/// section 9 for several surfaces with two colors. Transparent surfaces within one map are an addition.
#[derive(Clone, Debug, PartialEq)]
pub struct IsosurfaceMap {
    axis: TexelAxis,
    entries: Vec<[f32; 4]>,
}

impl IsosurfaceMap {
    /// The least number of texels along a side.
    pub const LEAST: u32 = 2;
    /// The largest number along a side: a map of it takes 256 MiB.
    pub const MOST: u32 = 4096;

    /// A map of `size` times `size` texels over a range of scalars, lowest and highest.
    ///
    /// Surfaces outside of the range are in it where a center's rank says so. The time is proportional to the number of
    /// entries plus `size` times the number of surfaces.
    ///
    /// # Errors
    /// [`IsosurfaceError::MapSize`]; [`IsosurfaceError::MapRange`] for a range that descends or has no finite width.
    pub fn new(surfaces: &Isosurfaces, scalars: [f64; 2], size: u32) -> Result<Self, IsosurfaceError> {
        let mut map = Self::transparent(scalars, size)?;
        for_all_texels(surfaces, map.axis, |texel, crossed, _| map.entries[texel] = entry(crossed.light));
        Ok(map)
    }

    /// A map that shows nothing.
    pub(super) fn transparent(scalars: [f64; 2], size: u32) -> Result<Self, IsosurfaceError> {
        let axis = TexelAxis::new(scalars, size)?;
        Ok(Self { axis, entries: vec![[0.0; 4]; size as usize * size as usize] })
    }

    /// What both of its axes have in common.
    pub fn axis(&self) -> TexelAxis {
        self.axis
    }

    /// Premultiplied linear RGB and opacity; texel `(front, back)` is entry `front * texels + back`.
    pub fn entries(&self) -> &[[f32; 4]] {
        &self.entries
    }

    pub(super) fn entries_mut(&mut self) -> &mut [[f32; 4]] {
        &mut self.entries
    }

    /// The surfaces of a segment; its length does not count.
    pub fn look_up(&self, segment: &Segment) -> RgbaAssoc {
        self.at(self.axis.texel(segment.scalar_front), self.axis.texel(segment.scalar_back))
    }

    /// A texel's entry; beyond the last texel, that of the last. For renderers that hand the texel at the exit from one
    /// cell on to the next.
    #[inline]
    pub fn at(&self, front: u32, back: u32) -> RgbaAssoc {
        let last = self.axis.texels - 1;
        let [red, green, blue, opacity] = self.entries[(front.min(last) * self.axis.texels + back.min(last)) as usize];
        RgbaAssoc { rgb: [red, green, blue].map(f64::from), opacity: f64::from(opacity) }
    }
}

/// What lies between the centers of two texels.
pub(super) struct Crossed {
    /// The surfaces in front of each other.
    pub(super) light: RgbaAssoc,
    /// Each surface's part of `light`, times its scalar less that of the front.
    pub(super) moment: RgbaAssoc,
}

impl Crossed {
    const NOTHING: Self = Self { light: RgbaAssoc::TRANSPARENT, moment: RgbaAssoc::TRANSPARENT };

    /// Puts a surface behind those that are there.
    fn add(&mut self, color: [f64; 3], opacity: f64, distance: f64) {
        let seen = (1.0 - self.light.opacity) * opacity;
        for (sum, channel) in self.moment.rgb.iter_mut().zip(color) {
            *sum += seen * distance * channel;
        }
        self.moment.opacity += seen * distance;
        self.light = self.light.over(RgbaAssoc { rgb: color.map(|channel| opacity * channel), opacity });
    }
}

/// Calls `put` with each entry's index, with what is crossed there and with the scalar at the back less that at the
/// front.
///
/// Along a row the front stays, so that what is crossed only grows, away from the diagonal in both directions: every
/// surface is added twice a row at most, not once an entry.
pub(super) fn for_all_texels(surfaces: &Isosurfaces, axis: TexelAxis, mut put: impl FnMut(usize, &Crossed, f64)) {
    let centers: Vec<f64> = (0..axis.texels).map(|texel| axis.center(texel)).collect();
    let ranks: Vec<usize> = centers.iter().map(|&center| surfaces.rank(center)).collect();
    let surfaces = surfaces.as_slice();
    for (front, &center) in centers.iter().enumerate() {
        let row = front * centers.len();

        let (mut crossed, mut rank) = (Crossed::NOTHING, ranks[front]);
        for back in front..centers.len() {
            for surface in &surfaces[rank..ranks[back]] {
                crossed.add(surface.back_color, surface.opacity, surface.value - center);
            }
            rank = ranks[back];
            put(row + back, &crossed, centers[back] - center);
        }

        let (mut crossed, mut rank) = (Crossed::NOTHING, ranks[front]);
        for back in (0..front).rev() {
            for surface in surfaces[ranks[back]..rank].iter().rev() {
                crossed.add(surface.color, surface.opacity, surface.value - center);
            }
            rank = ranks[back];
            put(row + back, &crossed, centers[back] - center);
        }
    }
}

/// Rounded to 32 bits; colors beyond them become the largest number.
#[expect(clippy::cast_possible_truncation, reason = "32 bits are the purpose")]
pub(super) fn entry(light: RgbaAssoc) -> [f32; 4] {
    let [red, green, blue] = light.rgb;
    [red, green, blue, light.opacity].map(|number| number.min(f64::from(f32::MAX)) as f32)
}
