//! The two-dimensional pre-integration table: both scalars, and linear in the length.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::table_axes::{cell, scalar_samples};
use crate::table_pairs::{Pairs, entry, weighted};
use crate::{
    Deviation, Isosurfaces, MethodError, OpticalModel, RgbaAssoc, ScalarAxis, Segment, SurfaceRole, TableDomain,
    TableSettings, TransferFunction, deviation,
};

/// Light and opacity of segments of the mean length, tabulated over the scalars at both ends and scaled to other
/// lengths.
///
/// With `n` samples of the scalar, entry `j n + i` belongs to sample `i` at the front and sample `j` at the back: red,
/// green and blue multiplied by the opacity, and the opacity, all four over a segment of the mean length and divided by
/// [`Table2d::scale`]. Scalars are spaced evenly with a sample on either end of the domain ([`ScalarAxis`]).
///
/// A look-up is `scale * length / mean_length` times the entry, interpolated bilinearly; the number of lengths in the
/// settings has no meaning here. Where the opacity would exceed 1 the factor is the one at which it is 1, for the light
/// too: a longer chord adds nothing, and the light keeps its ratio to the opacity. The paper leaves that to the
/// frame buffer, which clamps each of the four by itself.
///
/// # Errors
///
/// The emission model is exact between samples of the length. In all others the opacity `1 - exp(-tau)` is replaced by
/// its chord from 0 through the mean length: with an optical depth `T` there, too transparent below by up to `T² / 8`
/// and too opaque beyond. Largest and mean over the four channels as of [`crate::Table3d`], with the mean of the
/// lengths as the mean length:
///
/// | samples | ramp | three tents | thin shell | box | 256 random entries |
/// | --- | --- | --- | --- | --- | --- |
/// | 64² | 0.33 / 0.040 | 0.85 / 0.043 | 0.89 / 0.025 | 1.00 / 0.045 | 0.55 / 0.045 |
/// | 256² | 0.33 / 0.040 | 0.40 / 0.042 | 0.76 / 0.024 | 0.64 / 0.045 | 0.37 / 0.044 |
///
/// More samples lower the largest error and leave the mean, which is that of the length.
///
/// Of a table with [`SurfaceRole::Included`] surfaces their opacity is scaled with the length like the volume's, though
/// a surface has none: it is right at the mean length alone.
///
/// Source: [Röttger 2000], section 4 and eq. (2).
#[derive(Clone, Debug, PartialEq)]
pub struct Table2d {
    model: OpticalModel,
    domain: TableDomain,
    scalars: u32,
    axis: ScalarAxis,
    scale: f64,
    entries: Vec<[f32; 4]>,
}

impl Table2d {
    /// Tabulates a transfer function.
    ///
    /// With surfaces they are in the light as their role says, on the segments that cross them. `progress` is called
    /// after all pairs of scalars that lie equally far apart, with the number of such diagonals that are done and of
    /// all. The calls come from any thread of rayon's pool, may overlap, and may come out of order.
    ///
    /// The same table for any number of threads. Takes `2 n²` exact steps for `n` scalars.
    ///
    /// # Errors
    ///
    /// [`MethodError::TableSize`], [`MethodError::TableDomain`].
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
        let samples = scalar_samples(domain, settings.scalars);
        let pairs = Pairs { transfer, model, scalars: &samples, surfaces };
        let done = AtomicU64::new(0);
        let diagonals: Vec<Vec<_>> = (0..samples.len())
            .into_par_iter()
            .map(|apart| {
                let mut diagonal = Vec::with_capacity(2 * (samples.len() - apart));
                pairs.for_each_apart(apart, domain.mean_length, |front, back, light| {
                    diagonal.push((front, back, light));
                });
                progress(done.fetch_add(1, Ordering::Relaxed) + 1, u64::from(settings.scalars));
                diagonal
            })
            .collect();

        let largest = diagonals.iter().flatten().map(|(_, _, light)| light.opacity).fold(0.0, f64::max);
        // Without any opacity there is nothing to scale by.
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let mut entries = vec![[0.0; 4]; samples.len() * samples.len()];
        for (front, back, light) in diagonals.into_iter().flatten() {
            let scaled = RgbaAssoc { rgb: light.rgb.map(|channel| channel / scale), opacity: light.opacity / scale };
            entries[back * samples.len() + front] = entry(scaled);
        }
        let axis = ScalarAxis::new(domain, settings.scalars);
        Ok(Self { model, domain: *domain, scalars: settings.scalars, axis, scale, entries })
    }

    /// The light of a segment, interpolated between four entries and scaled to its length. A NaN gives NaN.
    pub fn look_up(&self, segment: &Segment) -> RgbaAssoc {
        let (front, front_share) = cell(self.axis.coordinate(segment.scalar_front), self.scalars);
        let (back, back_share) = cell(self.axis.coordinate(segment.scalar_back), self.scalars);
        let n = self.scalars as usize;
        let corners = (0..4).map(|corner| {
            let [i, j] = [corner & 1, corner >> 1];
            let share = |upper: usize, share: f64| if upper == 1 { share } else { 1.0 - share };
            ((back + j) * n + front + i, share(i, front_share) * share(j, back_share))
        });
        let RgbaAssoc { rgb, opacity } = weighted(&self.entries, corners);
        let factor = segment.chord_length * self.per_length();
        if opacity * factor > 1.0 {
            return RgbaAssoc { rgb: rgb.map(|channel| channel / opacity), opacity: 1.0 };
        }
        RgbaAssoc { rgb: rgb.map(|channel| channel * factor), opacity: opacity * factor }
    }

    /// Its own error: the look-up against [`crate::exact`] over all of its domain, see [`deviation()`].
    ///
    /// `transfer` is the transfer function that it was made from. Meaningless for a table with
    /// surfaces, which `exact` does not know.
    pub fn deviation(&self, transfer: &TransferFunction, samples: u32) -> Deviation {
        deviation(transfer, self.model, &self.domain, 1.0, samples, |segment| self.look_up(segment))
    }

    /// What entries are multiplied by at the mean length: the largest opacity there, or 1 if there is none.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// What entries are multiplied by per length.
    pub fn per_length(&self) -> f64 {
        self.scale / self.domain.mean_length
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

    /// Samples along each of the two axes.
    pub fn scalars(&self) -> u32 {
        self.scalars
    }
}
