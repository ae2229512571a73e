//! Isosurfaces looked up in maps over the scalars at both ends of a segment.

use fearless_simd::{Simd, f32x8, prelude::*};
use tetrascope_integrate::surface::{IsosurfaceMap, SmoothMaps, TexelAxis};
use tetrascope_integrate::{IsosurfaceError, Isosurfaces, SurfaceShading};
use tetrascope_scene::{IsosurfaceMethod, Mixing, Plan};

use super::methods::CellOptics;
use super::record::CellRecord;
use super::sample::{LANES, Light, Sample};
use super::surfaces::{CellWithEffects, Joint, Shade};

/// The maps of a plan, and what they were made from.
#[derive(Debug)]
pub(crate) struct Maps {
    key: Key,
    passes: Passes,
    axis: TexelAxis,
    /// How light falls on the surfaces: on all of them alike.
    shading: SurfaceShading,
}

/// How a surface gets into a cell.
#[derive(Debug)]
enum Passes {
    /// One map behind a volume whose integral stops at the surface ([Röttger 2000], sections 7 and 10).
    Behind(IsosurfaceMap),
    /// A map for the front faces and one for the back faces (section 8), behind such a volume.
    BothBehind(SmoothMaps),
    /// The same with the whole cell's volume between them (section 10).
    Around(SmoothMaps),
}

/// What maps depend on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    surfaces: Isosurfaces,
    size: u32,
    mixing: Mixing,
}

impl Key {
    /// What a plan asks for; `None` if it has no maps.
    ///
    /// - `surfaces`: those to be seen, in the renderer's unit
    pub(crate) fn of(plan: &Plan, surfaces: &Isosurfaces) -> Option<Self> {
        match plan.isosurfaces.as_ref()?.method {
            IsosurfaceMethod::Exact => None,
            IsosurfaceMethod::Map { size, mixing } => {
                (!surfaces.is_empty()).then(|| Self { surfaces: surfaces.clone(), size, mixing })
            }
        }
    }
}

impl Maps {
    /// Builds the maps over the field's scalars, lowest and highest.
    ///
    /// # Errors
    /// [`IsosurfaceError`] for a size out of range.
    pub(crate) fn new(key: Key, scalars: [f64; 2]) -> Result<Self, IsosurfaceError> {
        let is_smooth = key.surfaces.shading() == SurfaceShading::Smooth;
        let (passes, axis) = if key.mixing == Mixing::Stopped && !is_smooth {
            let map = IsosurfaceMap::new(&key.surfaces, scalars, key.size)?;
            let axis = map.axis();
            (Passes::Behind(map), axis)
        } else {
            let maps = SmoothMaps::new(&key.surfaces, scalars, key.size)?;
            let axis = maps.front().axis();
            (if key.mixing == Mixing::Stopped { Passes::BothBehind(maps) } else { Passes::Around(maps) }, axis)
        };
        let shading = key.surfaces.shading();
        Ok(Self { key, passes, axis, shading })
    }

    /// The surfaces where the maps have them.
    pub(crate) fn surfaces(&self) -> Isosurfaces {
        self.key.surfaces.on_texels(&self.axis)
    }

    /// Number of texels, of all maps together.
    pub(crate) fn entries(&self) -> u64 {
        match &self.passes {
            Passes::Behind(map) => map.entries().len() as u64,
            Passes::BothBehind(maps) | Passes::Around(maps) => {
                (maps.front().entries().len() + maps.back().entries().len()) as u64
            }
        }
    }

    /// Whether they are what a plan asks for.
    pub(crate) fn is_for(&self, key: &Key) -> bool {
        self.key == *key
    }

    /// The texels of both ends of a block's segments.
    #[inline(always)]
    pub(crate) fn texels<S: Simd>(&self, simd: S, record: &CellRecord, sample: &Sample<S>) -> [f32x8<S>; 2] {
        let at_reference = ((record.scalar_reference - self.axis.start) * self.axis.per_scalar) as f32;
        let at_reference = f32x8::splat(simd, at_reference);
        let per_scalar = f32x8::splat(simd, self.axis.per_scalar as f32);
        [sample.front, sample.back]
            .map(|scalar| to_lanes(simd, self.axis.texel_lanes(simd, per_scalar.mul_add(scalar, at_reference))))
    }

    /// The light of a block, and the number of lanes in which a surface is seen.
    #[inline(always)]
    pub(crate) fn shade<S: Simd>(
        &self,
        simd: S,
        cell: CellOptics<'_>,
        with_effects: &CellWithEffects<'_>,
        sample: &Sample<S>,
        joint: &mut Joint,
        shade: Shade<S>,
    ) -> (Light<S>, u64) {
        let own = self.texels(simd, with_effects.record, sample);
        let front = joint.carry(simd, sample, with_effects.slack(simd, sample), own);
        // On the diagonal nothing is crossed.
        let front = sample.covered.select(front, own[1]);
        let (front, back) = (to_texels(front), to_texels(own[1]));

        let (near, far) = match &self.passes {
            Passes::Behind(map) => (map.look_up_lanes(simd, front, back), None),
            Passes::BothBehind(maps) | Passes::Around(maps) => {
                (maps.front().look_up_lanes(simd, front, back), Some(maps.back().look_up_lanes(simd, front, back)))
            }
        };
        let opacity = far.map_or(near.1, |far| near.1 + far.1);
        let seen = opacity.simd_gt(f32x8::splat(simd, 0.0));
        let rays = with_effects.rays(simd, sample);
        let volume = with_effects.volume(simd, cell, sample, &rays, shade);
        // In most blocks of most cells there is no surface: then nothing is to be lit.
        if !seen.any_true() {
            return (volume, 0);
        }
        let at_depth = |depth| with_effects.intensities(simd, &rays, depth, self.shading);
        let near = shaded(near, at_depth(sample.depth[0]));
        let light = match far {
            None => over(volume, near),
            Some(far) => {
                let far = shaded(far, at_depth(sample.depth[1]));
                if matches!(self.passes, Passes::Around(_)) {
                    over(near, over(volume, far))
                } else {
                    over(volume, over(near, far))
                }
            }
        };
        (light, u64::from(seen.to_bitmask().count_ones()))
    }
}

/// A pass of a map with what the light makes of it.
#[inline(always)]
fn shaded<S: Simd>((mut rgb, opacity): ([f32x8<S>; 3], f32x8<S>), intensities: Option<[f32x8<S>; 2]>) -> Light<S> {
    if let Some([body, highlight]) = intensities {
        for channel in &mut rgb {
            *channel = channel.mul_add(body, highlight * opacity);
        }
    }
    Light { rgb, opacity }
}

/// The first in front of the second.
#[inline(always)]
fn over<S: Simd>(front: Light<S>, behind: Light<S>) -> Light<S> {
    let mut rgb = front.rgb;
    let through = 1.0 - front.opacity;
    for (channel, behind) in rgb.iter_mut().zip(behind.rgb) {
        *channel = through.mul_add(behind, *channel);
    }
    Light { rgb, opacity: front.opacity_with(&behind) }
}

#[inline(always)]
fn to_lanes<S: Simd>(simd: S, texels: [u32; LANES]) -> f32x8<S> {
    f32x8::load_array(simd, texels.map(|texel| texel as f32))
}

#[inline(always)]
fn to_texels<S: Simd>(texels: f32x8<S>) -> [u32; LANES] {
    let mut lanes = [0.0; LANES];
    texels.store_slice(&mut lanes);
    lanes.map(|texel| texel as u32)
}
