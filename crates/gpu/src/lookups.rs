//! What integration looks up on the device: pieces of the transfer function, tables, and the numbers that place them.

use bytemuck::Zeroable;
use tetrascope_integrate::{
    Integration, Isosurfaces, LengthAxis, MethodError, OpticalModel, Piece, PsiTable, ScalarAxis, SurfaceRole, Table2d,
    Table3d, TableDomain, TableSettings, TransferFunction,
};
use tetrascope_mesh::ChordLengths;
use tetrascope_scene::{IsosurfaceMethod, Mixing, Plan};
use tetrascope_shaders::Slot;
use tetrascope_shaders::layout::{LATTICE_STEP, OpticsUniform};
use wgpu::Buffer;

use crate::kernel::Named;
use crate::{Gpu, GpuError};

#[cfg(test)]
#[path = "lookups_tests.rs"]
mod tests;

/// Where the first piece begins and the last one ends: beyond any scalar of the lattice.
const LATTICE_END: i32 = 1 << 30;
/// The largest extinction and color: opaque, or brighter than any picture, and products with lengths stay finite.
const LARGEST: f64 = 1e30;
/// Vectors of 16 bytes that a piece takes.
const VECTORS: usize = 3;

/// Units of a field on the lattice.
pub(crate) struct FieldUnits<'a> {
    /// The renderer's unit of scalar: scalars are multiplied by it. A power of two.
    pub(crate) scalar_factor: f64,
    /// The scalar at 0 of the lattice, in the renderer's unit.
    pub(crate) scalar_middle: f64,
    /// Lowest and highest scalar, in the renderer's unit.
    pub(crate) scalar_range: [f64; 2],
    /// World length of a local unit.
    pub(crate) world_per_local: f64,
    /// Lengths of segments, world length; `None` if no cell has a volume. Asked for where the integration has a table.
    pub(crate) chord_lengths: &'a dyn Fn() -> Option<ChordLengths>,
}

/// What the integration of a plan looks up.
#[derive(Debug)]
pub(crate) struct Lookups {
    key: Key,
    optics: Buffer,
    pieces: Buffer,
    table: Option<Buffer>,
    table_entries: u64,
    bytes: u64,
}

/// What lookups depend on.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    transfer: TransferFunction,
    model: OpticalModel,
    integration: Integration,
    /// Sizes of the table, where there is one.
    settings: Option<TableSettings>,
    /// Values of the isosurfaces at which the table's integrals stop. What the surfaces look like does not count.
    stops: Vec<f64>,
}

impl Key {
    fn of(plan: &Plan) -> Self {
        let settings = plan.table_settings();
        let surfaces = if settings.is_some() { stops(plan) } else { Isosurfaces::default() };
        Self {
            transfer: plan.transfer.clone(),
            model: plan.model,
            integration: plan.integration,
            settings,
            stops: surfaces.as_slice().iter().map(|surface| surface.value).collect(),
        }
    }
}

/// The isosurfaces at which the integral stops in the table itself; they are drawn behind it.
fn stops(plan: &Plan) -> Isosurfaces {
    match &plan.isosurfaces {
        Some(isosurfaces) if matches!(isosurfaces.method, IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. }) => {
            isosurfaces.surfaces.visible()
        }
        _ => Isosurfaces::default(),
    }
}

/// The files for the slots `volume` and `model`.
///
/// Where several ways to integrate are one and the same, one file serves them. `vertex` has no rays; its fans take the transfer function
/// from the file of `average`.
pub(crate) fn slots(integration: Integration, model: OpticalModel) -> [Slot<'static>; 2] {
    use Integration as I;
    use OpticalModel as O;
    let model_file = match model {
        O::DensityEmitter => "integrate/density_emitter.wgsl",
        O::Emitter => "integrate/emitter.wgsl",
        O::Absorption => "integrate/absorption.wgsl",
        O::Emission => "integrate/emission.wgsl",
    };
    let volume = match (integration, model) {
        (I::Average | I::Vertex, _) => "integrate/average.wgsl",
        (I::Partial, O::DensityEmitter) => "integrate/partial.wgsl",
        (I::Opacity2d | I::Partial, _) => "integrate/ends.wgsl",
        (I::Table2d, _) => "integrate/table_2d.wgsl",
        (I::Table3d, _) => "integrate/table_3d.wgsl",
        (I::Cumulative, O::DensityEmitter | O::Emitter) => "integrate/cumulative.wgsl",
        (I::Cumulative | I::Exact, _) => "integrate/exact.wgsl",
    };
    [("volume", volume), ("model", model_file)]
}

impl Lookups {
    /// Makes and uploads what a plan's integration looks up.
    ///
    /// `progress` is called as by [`Table3d::build`] where there is a table.
    ///
    /// # Errors
    /// [`GpuError::Method`] for a table of no possible size, [`GpuError::TooLarge`] for one that the device does not take.
    pub(crate) fn new(
        gpu: &Gpu,
        plan: &Plan,
        field: &FieldUnits<'_>,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Self, GpuError> {
        let key = Key::of(plan);
        let transfer = plan.transfer.with_scalars_scaled(field.scalar_factor);
        let local = transfer.with_lengths_scaled(field.world_per_local, plan.model);
        let mut vectors = pack(local.pieces(), plan.model, field.scalar_middle);
        let mut optics = OpticsUniform::zeroed();
        optics.piece_count = (vectors.len() / VECTORS) as u32;
        if slots(plan.integration, plan.model)[0].1 == "integrate/partial.wgsl" {
            optics.psi_start = vectors.len() as u32;
            vectors.extend(psi_pairs());
        }
        let pieces_bytes = size_of_val(vectors.as_slice()) as u64;
        fits(gpu, "the transfer function", pieces_bytes)?;

        let surfaces = stops(plan).with_scalars_scaled(field.scalar_factor);
        let entries = match key.settings {
            Some(settings) => tabulate(gpu, plan, &transfer, &surfaces, &settings, field, &mut optics, progress)?,
            None => Vec::new(),
        };
        let table = (!entries.is_empty()).then(|| gpu.storage_of("table", &entries));
        let bytes = pieces_bytes + size_of_val(entries.as_slice()) as u64 + size_of::<OpticsUniform>() as u64;
        Ok(Self {
            key,
            optics: gpu.uniform_of("optics", &optics),
            pieces: gpu.storage_of("pieces", &vectors),
            table,
            table_entries: entries.len() as u64,
            bytes,
        })
    }

    /// Whether they are what a plan asks for.
    pub(crate) fn is_for(&self, plan: &Plan) -> bool {
        self.key == Key::of(plan)
    }

    /// The files for the slots `volume` and `model`.
    pub(crate) fn slots(&self) -> [Slot<'static>; 2] {
        slots(self.key.integration, self.key.model)
    }

    /// What to bind.
    pub(crate) fn resources(&self) -> Vec<Named<'_>> {
        let mut all = vec![("optics", self.optics.as_entire_binding()), ("pieces", self.pieces.as_entire_binding())];
        all.extend(self.table.as_ref().map(|table| ("table", table.as_entire_binding())));
        all
    }

    /// Number of entries of the table; 0 without one.
    pub(crate) fn table_entries(&self) -> u64 {
        self.table_entries
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        self.bytes
    }
}

fn fits(gpu: &Gpu, what: &'static str, needed: u64) -> Result<(), GpuError> {
    let limit = gpu.largest_binding();
    if needed > limit {
        return Err(GpuError::TooLarge { what, needed, limit, adapter: gpu.description().name.clone() });
    }
    Ok(())
}

/// Entries of a plan's table; where it lies is written to `optics`.
#[expect(clippy::too_many_arguments, reason = "each is another part of what a table depends on")]
fn tabulate(
    gpu: &Gpu,
    plan: &Plan,
    transfer: &TransferFunction,
    surfaces: &Isosurfaces,
    settings: &TableSettings,
    field: &FieldUnits<'_>,
    optics: &mut OpticsUniform,
    progress: &(dyn Fn(u64, u64) + Sync),
) -> Result<Vec<[f32; 4]>, GpuError> {
    settings.check()?;
    let is_three_dimensional = plan.integration == Integration::Table3d;
    let slices = if is_three_dimensional { u64::from(settings.lengths) } else { 1 };
    fits(gpu, "the table", 16 * u64::from(settings.scalars).pow(2) * slices)?;

    // Only a mesh without volume has no lengths: nothing is looked up in it, whatever the table covers.
    let lengths = (field.chord_lengths)().unwrap_or(ChordLengths { mean: 1.0, longest: 1.0 });
    // In units of the longest chord, so that 32 bits hold lengths of any unit.
    let transfer = transfer.with_lengths_scaled(lengths.longest, plan.model);
    let mean_length = lengths.mean / lengths.longest;
    let domain = TableDomain { scalars: field.scalar_range, mean_length, max_length: 1.0 };
    let stops = (!surfaces.is_empty()).then_some((surfaces, SurfaceRole::Stop));
    let per_local = field.world_per_local / lengths.longest;
    let build = || -> Result<_, MethodError> {
        Ok(if is_three_dimensional {
            let table = Table3d::build(&transfer, plan.model, &domain, settings, stops, progress)?;
            (table.entries().to_vec(), table.scalar_axis(), per_local)
        } else {
            let table = Table2d::build(&transfer, plan.model, &domain, settings, stops, progress)?;
            (table.entries().to_vec(), table.scalar_axis(), table.per_length() * per_local)
        })
    };
    let (entries, axis, per_length) = build()?;

    place(optics, &axis, field.scalar_middle);
    optics.table_scalars = settings.scalars;
    optics.table_lengths = if is_three_dimensional { settings.lengths } else { 0 };
    optics.table_per_length = small(per_length);
    // Two nodes are the ends, however the others would be spaced.
    let is_logarithmic = settings.length_axis == LengthAxis::Logarithmic && settings.lengths > 2;
    optics.table_is_logarithmic = u32::from(is_three_dimensional && is_logarithmic);
    Ok(entries)
}

/// Where the samples of a table's scalars lie on the lattice.
fn place(optics: &mut OpticsUniform, axis: &ScalarAxis, middle: f64) {
    optics.table_start = lattice(axis.start, middle);
    optics.table_per_scalar = small(axis.per_scalar);
    let samples_per_step = axis.per_scalar * LATTICE_STEP;
    if samples_per_step > 0.0 {
        let steps = 1.0 / samples_per_step;
        let whole = steps.floor().min(f64::from(LATTICE_END));
        optics.table_step = whole as i32;
        optics.table_rest = small((steps - whole) * samples_per_step);
    }
}

/// The table of psi: each entry in the low half, and in the high half the next one along the balance, so that one load brings both.
fn psi_pairs() -> Vec<[u32; 4]> {
    let entries = PsiTable::shared().entries().as_flattened();
    let pair = |index: usize| {
        let next = entries.get(index + 1).copied().unwrap_or_default();
        entries.get(index).map_or(0, |&entry| u32::from(entry) | u32::from(next) << 16)
    };
    (0..entries.len()).step_by(4).map(|first| [0, 1, 2, 3].map(|side| pair(first + side))).collect()
}

/// A scalar in the renderer's unit as lattice steps about the middle of the range.
fn lattice(scalar: f64, middle: f64) -> i32 {
    let end = f64::from(LATTICE_END);
    ((scalar - middle) / LATTICE_STEP).round().clamp(-end, end) as i32
}

/// To f32, finite and with a finite product with any length or share.
fn small(value: f64) -> f32 {
    value.clamp(-LARGEST, LARGEST) as f32
}

/// Pieces as the shaders read them: see `integrate/pieces.wgsl`.
///
/// Ends move to the nearest lattice step, with the values there. Pieces narrower than a step may vanish, and then it is as if their two
/// ends were a step.
fn pack(pieces: &[Piece], model: OpticalModel, middle: f64) -> Vec<[u32; 4]> {
    let mut vectors = Vec::with_capacity(VECTORS * pieces.len());
    let mut contributing = 0u32;
    for piece in pieces {
        let (start, end) = (lattice(piece.start, middle), lattice(piece.end, middle));
        if start == end {
            continue;
        }
        // Beyond the lattice, the value where it ends.
        let scalar =
            |own: f64, at: i32| if at.abs() == LATTICE_END { middle + f64::from(at) * LATTICE_STEP } else { own };
        let scalars = [scalar(piece.start, start), scalar(piece.end, end)];
        let extinction = scalars.map(|scalar| piece.extinction_at(scalar));
        let color = scalars.map(|scalar| piece.color_at(scalar));
        let adds = |side: usize| {
            (model.needs_extinction() && extinction[side] > 0.0)
                || (!model.is_dark_without_extinction() && color[side].iter().any(|&channel| channel > 0.0))
        };
        let flags = u32::from(adds(0)) | u32::from(adds(1)) << 1;
        let [rho, next_rho] = extinction.map(|value| small(value).to_bits());
        let [[r, g, b], [next_r, next_g, next_b]] = color.map(|rgb| rgb.map(|value| small(value).to_bits()));
        let inverse_width = 1.0 / ((f64::from(end) - f64::from(start)) * LATTICE_STEP);
        vectors.push([start as u32, end as u32, rho, next_rho]);
        vectors.push([r, g, b, contributing << 2 | flags]);
        vectors.push([next_r, next_g, next_b, small(inverse_width).to_bits()]);
        contributing += u32::from(flags != 0);
    }
    vectors
}
