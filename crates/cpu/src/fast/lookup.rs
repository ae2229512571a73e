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
    /// Isosurfaces that are part of the table, in the renderer's unit.
    surfaces: Option<(Isosurfaces, SurfaceRole)>,
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

/// What isosurfaces are in the table: none, or, where the integral is to stop in the table itself, all of them. Opaque ones end
/// the integral and are drawn behind it; transparent ones are part of the table's light.
pub(crate) fn role(plan: &Plan) -> Option<SurfaceRole> {
    let isosurfaces = plan.isosurfaces.as_ref()?;
    match isosurfaces.method {
        IsosurfaceMethod::Map { mixing: Mixing::Stopped, .. } if plan.integration.needs_table() => {
            let are_opaque = isosurfaces.surfaces.visible().are_opaque();
            Some(if are_opaque { SurfaceRole::Stop } else { SurfaceRole::Included })
        }
        _ => None,
    }
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
            surfaces: role(plan).map(|role| (surfaces.clone(), role)),
        })
    }
}

impl Lookup {
    /// Builds the table.
    ///
    /// - `transfer`: that of the key over scalars in the renderer's unit
    /// - `scalars`: lowest and highest, likewise
    /// - `lengths`: of segments, world length
    ///
    /// # Errors
    /// [`MethodError`] for sizes out of range.
    pub(crate) fn new(
        key: Key,
        transfer: &TransferFunction,
        scalars: [f64; 2],
        lengths: ChordLengths,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Self, MethodError> {
        // In units of the longest chord, so that 32 bits hold lengths of any unit.
        let transfer = transfer.with_lengths_scaled(lengths.longest, key.model);
        let domain = TableDomain { scalars, mean_length: lengths.mean / lengths.longest, max_length: 1.0 };
        let surfaces = key.surfaces.as_ref().map(|(surfaces, role)| (surfaces, *role));
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
