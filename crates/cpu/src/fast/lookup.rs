//! The table of an integration by table, kept from frame to frame.

use tetrascope_integrate::{
    Isosurfaces, MethodError, OpticalModel, SurfaceRole, Table2d, Table3d, TableDomain, TableSettings, TransferFunction,
};
use tetrascope_mesh::ChordLengths;
use tetrascope_scene::{IsosurfaceMethod, Mixing, Plan};

use super::record::CellRecord;

/// A table and what it was made from.
#[derive(Debug)]
pub(crate) struct Lookup {
    key: Key,
    table: Table,
    /// The unit of its lengths, world length.
    length: f64,
    /// Coordinate of a scalar: `(scalar - start) * per_scalar`, scalars in the renderer's unit.
    start: f64,
    per_scalar: f64,
}

#[derive(Debug)]
pub(crate) enum Table {
    Two(Table2d),
    Three(Table3d),
}

/// What a table depends on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    transfer: TransferFunction,
    model: OpticalModel,
    is_three_dimensional: bool,
    settings: TableSettings,
    /// Values of the isosurfaces at which the integral stops, in the renderer's unit.
    stops: Vec<f64>,
}

/// A table as one cell sees it.
#[derive(Clone, Copy)]
pub(crate) struct CellTable<'a> {
    pub(crate) table: &'a Table,
    /// Coordinate of the cell's reference scalar.
    pub(crate) at_reference: f32,
    pub(crate) per_scalar: f32,
    /// The cell's unit of length in the table's.
    pub(crate) length: f32,
}

/// Whether the integral stops at isosurfaces in the table itself; they are drawn behind it.
fn stops(plan: &Plan) -> bool {
    let method = plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.method);
    matches!(method, Some(IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. }))
}

/// Surfaces that count by their values alone: a table that ends there does not know what they look like.
fn values_alone(surfaces: &Isosurfaces) -> Vec<f64> {
    surfaces.as_slice().iter().map(|surface| surface.value).collect()
}

impl Key {
    /// What a plan asks for; `None` if its integration has no table.
    ///
    /// - `surfaces`: those to be seen, in the renderer's unit
    pub(crate) fn of(plan: &Plan, surfaces: &Isosurfaces) -> Option<Self> {
        let settings = plan.table_settings()?;
        Some(Self {
            transfer: plan.transfer.clone(),
            model: plan.model,
            is_three_dimensional: plan.integration == tetrascope_integrate::Integration::Table3d,
            settings,
            stops: if stops(plan) { values_alone(surfaces) } else { Vec::new() },
        })
    }
}

impl Lookup {
    /// Number of entries of the table.
    pub(crate) fn entries(&self) -> u64 {
        match &self.table {
            Table::Two(table) => table.entries().len() as u64,
            Table::Three(table) => table.entries().len() as u64,
        }
    }

    /// Builds the table.
    ///
    /// - `transfer`: that of the key over scalars in the renderer's unit
    /// - `surfaces`: those of the key, should it stop at any
    /// - `scalars`: lowest and highest, likewise
    /// - `lengths`: of segments, world length
    ///
    /// # Errors
    /// [`MethodError`] for sizes out of range.
    pub(crate) fn new(
        key: Key,
        transfer: &TransferFunction,
        surfaces: &Isosurfaces,
        scalars: [f64; 2],
        lengths: ChordLengths,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Self, MethodError> {
        // In units of the longest chord, so that 32 bits hold lengths of any unit.
        let transfer = transfer.with_lengths_scaled(lengths.longest, key.model);
        let domain = TableDomain { scalars, mean_length: lengths.mean / lengths.longest, max_length: 1.0 };
        let surfaces = (!key.stops.is_empty()).then_some((surfaces, SurfaceRole::Stop));
        let (table, axis) = if key.is_three_dimensional {
            let table = Table3d::build(&transfer, key.model, &domain, &key.settings, surfaces, progress)?;
            let axis = table.scalar_axis();
            (Table::Three(table), axis)
        } else {
            let table = Table2d::build(&transfer, key.model, &domain, &key.settings, surfaces, progress)?;
            let axis = table.scalar_axis();
            (Table::Two(table), axis)
        };
        Ok(Self { key, table, length: lengths.longest, start: axis.start, per_scalar: axis.per_scalar })
    }

    /// Whether it is what a plan asks for.
    pub(crate) fn is_for(&self, key: &Key) -> bool {
        self.key == *key
    }

    /// As a cell sees it.
    #[inline(always)]
    pub(crate) fn localize(&self, record: &CellRecord) -> CellTable<'_> {
        CellTable {
            table: &self.table,
            at_reference: ((record.scalar_reference - self.start) * self.per_scalar) as f32,
            per_scalar: self.per_scalar as f32,
            length: (record.length / self.length) as f32,
        }
    }
}
