//! A segment with the isosurfaces that it crosses: cut there, and composed from front to back.

use super::{Isosurface, Isosurfaces};
use crate::{RgbaAssoc, Segment};

#[cfg(test)]
#[path = "compose_tests.rs"]
mod tests;

/// A place where a ray meets an isosurface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<'a> {
    /// The surface.
    pub surface: &'a Isosurface,
    /// Its index in [`Isosurfaces::as_slice`].
    pub index: usize,
    /// Where on the segment: 0 at the front, 1 at the back, linear in the length. What is linear along the ray has
    /// `1 - share` of its value at the front and `share` of that at the back.
    pub share: f64,
    /// Color of the side that is seen: [`Isosurface::color`] where the scalar falls along the ray, else
    /// [`Isosurface::back_color`].
    pub color: [f64; 3],
}

impl Isosurfaces {
    /// [`Isosurfaces::rank`] at the front and at the back of a segment.
    #[inline]
    pub fn ranks(&self, segment: &Segment) -> [usize; 2] {
        [self.rank(segment.scalar_front), self.rank(segment.scalar_back)]
    }

    /// The light of a segment and of the surfaces that it crosses.
    ///
    /// - `ranks`: [`Isosurfaces::rank`] at the front and at the back; they alone say which surfaces are crossed. A ray
    ///   that passes from one cell to the next hands the rank at its exit on as the rank at the entry, so that each
    ///   crossing counts once even where two cells do not agree on the scalar between them.
    /// - `volume`: the light of a part of the segment without surfaces; called front to back, for parts with a length
    /// - `shade`: the color of a surface under the light, or [`Crossing::color`] as it is; called front to back
    ///
    /// A surface shows `opacity` times its shaded color and hides `opacity` of what lies behind, whatever the optical
    /// model. Behind one that hides all nothing is called. A surface lies at the share `(value - scalar_front) /
    /// (scalar_back - scalar_front)` of the length, clamped to the segment; at the front if both scalars are one and
    /// only the ranks differ.
    ///
    /// Exact but for rounding if `volume` and `shade` are: the lengths of the parts come from differences of
    /// neighboring scalars and keep their digits. The cost is one call of each per crossing.
    ///
    /// Source: the order of several surfaces and the two sides follow [Röttger 2000], section 9. The cut at the surface
    /// is what the maps of section 10 approximate.
    pub fn compose(
        &self,
        ranks: [usize; 2],
        segment: &Segment,
        mut volume: impl FnMut(&Segment) -> RgbaAssoc,
        mut shade: impl FnMut(&Crossing<'_>) -> [f64; 3],
    ) -> RgbaAssoc {
        let Segment { scalar_front, scalar_back, chord_length } = *segment;
        let share = |from: f64, to: f64| share_of(from, to, scalar_front, scalar_back);
        let mut part = |from: f64, to: f64, share: f64, light: RgbaAssoc| {
            if share > 0.0 {
                let part = Segment { scalar_front: from, scalar_back: to, chord_length: chord_length * share };
                light.over(volume(&part))
            } else {
                light
            }
        };

        let [first, last] = ranks.map(|rank| rank.min(self.as_slice().len()));
        let rises = first < last;
        let crossed = first.min(last)..first.max(last);
        let (mut light, mut front) = (RgbaAssoc::TRANSPARENT, scalar_front);
        for step in 0..crossed.len() {
            let index = if rises { crossed.start + step } else { crossed.end - 1 - step };
            let surface = &self.as_slice()[index];
            // Between the surface before and the back, also where ranks and scalars do not agree on which way is up.
            // Not `clamp`, which panics where a scalar is not a number.
            let scalar = surface.value.max(front.min(scalar_back)).min(front.max(scalar_back));
            light = part(front, scalar, share(front, scalar), light);
            front = scalar;

            let color = if rises { surface.back_color } else { surface.color };
            let crossing = Crossing { surface, index, share: share(scalar_front, scalar), color };
            let rgb = shade(&crossing).map(|channel| surface.opacity * channel);
            light = light.over(RgbaAssoc { rgb, opacity: surface.opacity });
            if light.opacity >= 1.0 {
                return light;
            }
        }
        let rest = if scalar_front == scalar_back { 1.0 } else { share(front, scalar_back) };
        part(front, scalar_back, rest, light)
    }
}

/// `(to - from) / (last - first)`, 0 where that has no meaning. Halved, since the widths may exceed the largest float.
fn share_of(from: f64, to: f64, first: f64, last: f64) -> f64 {
    let width = 0.5 * last - 0.5 * first;
    if width == 0.0 { 0.0 } else { (0.5 * to - 0.5 * from) / width }
}
