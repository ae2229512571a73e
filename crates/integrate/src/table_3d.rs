//! The three-dimensional pre-integration table: both scalars and the length.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::table_axes::{LengthNodes, cell, scalar_samples};
use crate::table_pairs::{Pairs, entry, weighted};
use crate::{
    Deviation, Isosurfaces, MethodError, OpticalModel, RgbaAssoc, ScalarAxis, Segment, SurfaceRole, TableDomain,
    TableSettings, TransferFunction, deviation,
};

/// Light and opacity of segments, tabulated over the scalars at both ends and the length.
///
/// With `n` samples of the scalar and `m` of the length, entry `(k n + j) n + i` is the light from sample `i` at the
/// front to sample `j` at the back over the length of node `k`: red, green and blue multiplied by the opacity, and the
/// opacity. Scalars are spaced evenly with a sample on either end of the domain ([`ScalarAxis`]), lengths as
/// [`crate::LengthAxis`] says, with a node on 0 and one on the longest chord.
///
/// Every entry is the exact integral, rounded to 32 bits. Between samples the look-up is linear along each of the three
/// axes. Scalars beyond the domain are taken as its nearer end, and a chord longer than the longest as that one: it is
/// too transparent, and nothing says so.
///
/// # Errors of the look-up
///
/// Where the transfer function is smooth the error falls with the square of the number of samples. At a peak narrower
/// than the distance of two samples the largest error does not fall at all, the mean one does. Largest and mean over
/// the four channels, density emitter, 40,000 segments of any two scalars and lengths from 1/1000 to 1/2 of the
/// scalars' range (as many in each octave), transfer functions as the example `table_errors` has them:
///
/// | samples | lengths | ramp | three tents | thin shell | box | 256 random entries |
/// | --- | --- | --- | --- | --- | --- | --- |
/// | 64² | 64 linear | 0.004 / 0.0001 | 0.43 / 0.0018 | 0.78 / 0.0027 | 0.70 / 0.0011 | 0.34 / 0.0026 |
/// | 128² | 128 linear | 0.001 / 0.00003 | 0.11 / 0.0004 | 0.43 / 0.0014 | 0.46 / 0.0003 | 0.26 / 0.0012 |
/// | 64² | 64 logarithmic | 0.007 / 0.0003 | 0.43 / 0.0017 | 0.78 / 0.0027 | 0.70 / 0.0009 | 0.35 / 0.0026 |
/// | 256² | 32 linear | 0.003 / 0.0004 | 0.08 / 0.0014 | 0.37 / 0.0010 | 0.22 / 0.0019 | 0.07 / 0.0008 |
/// | 256² | 32 logarithmic | 0.006 / 0.0005 | 0.07 / 0.0007 | 0.20 / 0.0007 | 0.22 / 0.0007 | 0.07 / 0.0008 |
///
/// Of the ramp, the largest error is at the kink of its color; with a color linear throughout it is 0.0007 / 0.0001 at
/// 64³. In fine cells, whose scalars differ by at most 0.05:
///
/// | samples | lengths | ramp | three tents | thin shell | box | 256 random entries |
/// | --- | --- | --- | --- | --- | --- | --- |
/// | 64² | 64 linear | 0.007 / 0.0001 | 0.42 / 0.0052 | 0.89 / 0.0070 | 0.74 / 0.0030 | 0.73 / 0.0165 |
/// | 128² | 128 linear | 0.003 / 0.00004 | 0.19 / 0.0013 | 0.51 / 0.0030 | 0.34 / 0.0009 | 0.60 / 0.0080 |
/// | 256² | 32 logarithmic | 0.005 / 0.0005 | 0.09 / 0.0005 | 0.44 / 0.0011 | 0.42 / 0.0006 | 0.15 / 0.0030 |
///
/// Thin cells suffer where the length axis is linear: below the first node the opacity is that of the chord from 0. A
/// logarithmic axis is coarser near the longest chord for that. Segments whose ends lie close together see only the
/// diagonal of the table, where a peak between two samples is missed at its full height: finer cells make it worse.
///
/// In a table with surfaces the light jumps where an end passes a surface, and the look-up smears the jump over the
/// distance of two samples.
///
/// Source: [Röttger 2000], section 3.
#[derive(Clone, Debug, PartialEq)]
pub struct Table3d {
    model: OpticalModel,
    domain: TableDomain,
    settings: TableSettings,
    axis: ScalarAxis,
    lengths: LengthNodes,
    entries: Vec<[f32; 4]>,
}

impl Table3d {
    /// Tabulates a transfer function.
    ///
    /// With surfaces they are in the light as their role says, on the segments that cross them. `progress` is called
    /// after each slice of one length with the number of slices that are done and of all. The calls come from any
    /// thread of rayon's pool, may overlap, and may come out of order.
    ///
    /// The same table for any number of threads. Takes `2 n² m` exact steps for `n` scalars and `m` lengths.
    ///
    /// # Errors
    ///
    /// [`MethodError::TableSize`], [`MethodError::TableDomain`], [`MethodError::TableMemory`].
    pub fn build(
        transfer: &TransferFunction,
        model: OpticalModel,
        domain: &TableDomain,
        settings: &TableSettings,
        surfaces: Option<(&Isosurfaces, SurfaceRole)>,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Self, MethodError> {
        settings.check()?;
        domain.check()?;
        let (scalars, lengths) = (settings.scalars as usize, LengthNodes::new(domain, settings));
        let size = scalars * scalars * settings.lengths as usize;
        let mut entries: Vec<[f32; 4]> = Vec::new();
        let no_memory = |_| MethodError::TableMemory { bytes: size * size_of::<[f32; 4]>() };
        entries.try_reserve_exact(size).map_err(no_memory)?;
        entries.resize(size, [0.0; 4]);

        let samples = scalar_samples(domain, settings.scalars);
        let pairs = Pairs { transfer, model, scalars: &samples, surfaces };
        let done = AtomicU64::new(0);
        entries.par_chunks_mut(scalars * scalars).zip(0..settings.lengths).for_each(|(slice, node)| {
            let length = lengths.length(node);
            for apart in 0..scalars {
                pairs.for_each_apart(apart, length, |front, back, light| {
                    slice[back * scalars + front] = entry(light);
                });
            }
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, u64::from(settings.lengths));
        });
        let axis = ScalarAxis::new(domain, settings.scalars);
        Ok(Self { model, domain: *domain, settings: *settings, axis, lengths, entries })
    }

    /// The light of a segment, interpolated between eight entries. A NaN gives NaN.
    pub fn look_up(&self, segment: &Segment) -> RgbaAssoc {
        let scalars = self.settings.scalars;
        let (front, front_share) = cell(self.axis.coordinate(segment.scalar_front), scalars);
        let (back, back_share) = cell(self.axis.coordinate(segment.scalar_back), scalars);
        let (node, node_share) = cell(self.lengths.coordinate(segment.chord_length), self.settings.lengths);
        let n = scalars as usize;
        let corners = (0..8).map(|corner| {
            let [i, j, k] = [corner & 1, (corner >> 1) & 1, corner >> 2];
            let share = |upper: usize, share: f64| if upper == 1 { share } else { 1.0 - share };
            let index = ((node + k) * n + back + j) * n + front + i;
            (index, share(i, front_share) * share(j, back_share) * share(k, node_share))
        });
        weighted(&self.entries, corners)
    }

    /// Its own error: the look-up against [`crate::exact`] over all of its domain, see [`deviation()`].
    ///
    /// `transfer` is the transfer function that it was made from. Meaningless for a table with
    /// surfaces, which `exact` does not know.
    pub fn deviation(&self, transfer: &TransferFunction, samples: u32) -> Deviation {
        deviation(transfer, self.model, &self.domain, 1.0, samples, |segment| self.look_up(segment))
    }

    /// All entries, in the order given above.
    pub fn entries(&self) -> &[[f32; 4]] {
        &self.entries
    }

    /// The axis of both scalars.
    pub fn scalar_axis(&self) -> ScalarAxis {
        self.axis
    }

    /// What it covers.
    pub fn domain(&self) -> &TableDomain {
        &self.domain
    }

    /// How many samples it has.
    pub fn settings(&self) -> &TableSettings {
        &self.settings
    }

    pub(crate) fn length_nodes(&self) -> &LengthNodes {
        &self.lengths
    }
}
