//! Color and opacity at the vertices of a fan.

use fearless_simd::{Simd, f32x8, prelude::*};

use super::{CellOptics, Method};
use crate::fast::model::Model;
use crate::fast::sample::{Light, Sample};

/// Color and opacity at the vertices, interpolated over the fan's triangles ([Shirley 1990], sections 2.5 and 2.6).
pub(crate) struct Vertex;

impl Method for Vertex {
    const NEEDS_PIECES: bool = false;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        match cell.fan {
            Some(fan) => fan.shade(simd, sample),
            None => Light { rgb: [f32x8::splat(simd, 0.0); 3], opacity: f32x8::splat(simd, 0.0) },
        }
    }
}
