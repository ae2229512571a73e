//! Light looked up in a table.

use fearless_simd::{Simd, f32x8, prelude::*};
use tetrascope_integrate::lanes::TableLight;

use super::{CellOptics, Method};
use crate::fast::lookup::Table;
use crate::fast::model::Model;
use crate::fast::sample::{Light, Sample};

/// Full pre-integration, or linear in the length ([Röttger 2000], sections 3 and 4). The optical model is in the table.
pub(crate) struct Tabulated<const THREE: bool>;

impl<const THREE: bool> Method for Tabulated<THREE> {
    const NEEDS_PIECES: bool = false;

    #[inline(always)]
    fn shade<S: Simd, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
        let zero = f32x8::splat(simd, 0.0);
        let Some(table) = cell.table else { return Light { rgb: [zero; 3], opacity: zero } };
        let (per_scalar, at_reference) = (f32x8::splat(simd, table.per_scalar), f32x8::splat(simd, table.at_reference));
        let front = per_scalar.mul_add(sample.front, at_reference);
        let back = per_scalar.mul_add(sample.back, at_reference);
        let length = sample.length * table.length;
        let TableLight { rgb, opacity } = match (THREE, table.table) {
            (true, Table::Three(table)) => table.look_up_lanes(simd, front, back, length),
            (false, Table::Two(table)) => table.look_up_lanes(simd, front, back, length),
            _ => TableLight { rgb: [zero; 3], opacity: zero },
        };
        Light { rgb, opacity }
    }
}
