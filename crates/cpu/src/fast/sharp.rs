//! Cells in which the transfer function changes faster than 32 bits know a scalar, or is denser than they know a depth, integrated in f64, ray by ray.

use fearless_simd::{Simd, f32x8, prelude::*};
use tetrascope_integrate::{Integration, Integrator, MethodError, OpticalModel, Segment};

use super::cell::CarefulCell;
use super::optics::Optics;
use super::sample::{LANES, Light, Sample};
use crate::geometry::PixelSpace;

/// What such cells are integrated with; `None` for methods that sample the transfer function, which have no digits to lose.
///
/// # Errors
/// As [`Integrator::new`].
pub(crate) fn integrator(integration: Integration, optics: &Optics) -> Result<Option<Integrator>, MethodError> {
    let has_corrections = matches!(optics.model, OpticalModel::DensityEmitter | OpticalModel::Emitter);
    let integration = match integration {
        Integration::Exact => Integration::Exact,
        Integration::Cumulative if has_corrections => Integration::Cumulative,
        // As `Job::draw`: without light, or without opacity, running integrals are exact.
        Integration::Cumulative => Integration::Exact,
        _ => return Ok(None),
    };
    Integrator::new(integration, optics.transfer(), optics.model, None, &|_, _| ()).map(Some)
}

/// Such a cell, and all that its light depends on.
#[derive(Clone, Copy)]
pub(crate) struct SharpCell<'a> {
    pub(crate) cell: &'a CarefulCell,
    /// The record's reference pixel.
    pub(crate) pixel: [u16; 2],
    pub(crate) integrator: &'a Integrator,
    pub(crate) space: &'a PixelSpace,
}

impl SharpCell<'_> {
    /// The light of a block.
    #[inline(always)]
    pub(crate) fn shade<S: Simd>(&self, simd: S, sample: &Sample<S>) -> Light<S> {
        self.shade_between(simd, sample, [f64::NEG_INFINITY, f64::INFINITY])
    }

    /// The light of the parts of a block's segments whose scalars lie between two. Out of line: few cells ask for it.
    ///
    /// Lanes in which the sample has no length have none. A segment of one scalar lies in one part as a whole, as the sample says.
    #[cold]
    #[inline(never)]
    pub(crate) fn shade_between<S: Simd>(&self, simd: S, sample: &Sample<S>, [below, above]: [f64; 2]) -> Light<S> {
        let mut place = [[0.0_f32; LANES]; 2];
        for (lanes, values) in place.iter_mut().zip(sample.place) {
            values.store_slice(lanes);
        }
        let one_scalar = sample.front.simd_eq(sample.back).to_bitmask();
        let covered = (sample.covered & sample.length.simd_gt(0.0)).to_bitmask();
        let (mut rgb, mut opacity) = ([[0.0_f32; LANES]; 3], [0.0_f32; LANES]);
        for lane in (0..LANES).filter(|lane| covered >> lane & 1 != 0) {
            let [u, w] = [0, 1].map(|axis| {
                let from_reference = f64::from(place[axis][lane]);
                PixelSpace::center(u32::from(self.pixel[axis]), self.space.size[axis]) + from_reference
            });
            let Some(span) = self.cell.clip.span_behind(&self.cell.cuts, self.space.is_perspective, u, w) else {
                continue;
            };
            let whole = (span.scalar[1] - span.scalar[0]).abs();
            let [scalar_front, scalar_back] = span.scalar.map(|scalar| scalar.max(below).min(above));
            let is_whole = one_scalar >> lane & 1 != 0 || whole == 0.0;
            let share = if !is_whole { (scalar_back - scalar_front).abs() / whole } else { 1.0 };
            let segment = Segment {
                scalar_front,
                scalar_back,
                chord_length: share * (span.depth[1] - span.depth[0]) * self.space.ray_stretch(u, w),
            };
            let light = self.integrator.integrate(&segment);
            for (lanes, value) in rgb.iter_mut().zip(light.rgb) {
                lanes[lane] = value as f32;
            }
            opacity[lane] = light.opacity as f32;
        }
        Light { rgb: rgb.map(|lanes| f32x8::load_array(simd, lanes)), opacity: f32x8::load_array(simd, opacity) }
    }
}
