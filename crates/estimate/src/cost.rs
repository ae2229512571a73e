//! What a frame of the CPU back end is expected to take, method by method: for choosing among them, never for saying how long a frame will be.
//!
//! The time of a method is that of the blocks of eight pixels that cells cover, in proportion to how much a block computes, and that of
//! setting the cells up, which all methods share. The constants are nanoseconds on one core of a server with AVX-512, fitted to
//! frames of 120 random scenes and of the blunt fin; only their ratios count, and these hold to about a third.

use tetrascope_integrate::{Integration, OpticalModel, TableSettings};

use crate::survey::Survey;

/// What a frame takes whatever is in it: threads that wake up, memory that is cleared.
const FRAME: f64 = 120_000.0;
/// A cell that is drawn: setting it up, finding its tiles, beginning with it in each.
const CELL: f64 = 450.0;
/// The same with its fan.
const CELL_WITH_FAN: f64 = 900.0;
/// An entry of a table, once a transfer function.
const TABLE_ENTRY: f64 = 200.0;

/// How much work a method has with a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Work {
    /// Cells that are drawn.
    pub(crate) cells: f64,
    /// Blocks of eight pixels that they cover, all together.
    pub(crate) blocks: f64,
    /// Pieces of the transfer function that a cell has.
    pub(crate) pieces: f64,
}

impl Work {
    /// - `fragments`: pairs of a pixel and a cell
    pub(crate) fn new(survey: &Survey, cells: f64, fragments: f64) -> Self {
        let each = fragments / cells.max(1.0);
        // A cell's inner blocks, those along its outline, and one that it begins.
        let blocks = cells * (each / 8.0 + 0.7 * each.sqrt() + 0.3);
        Self { cells, blocks, pieces: survey.pieces }
    }

    /// Nanoseconds of a picture, its table included: of one core, on the machine that the constants are from.
    pub(crate) fn nanoseconds(
        &self,
        integration: Integration,
        model: OpticalModel,
        tables: Option<&TableSettings>,
    ) -> f64 {
        let cell = if integration.needs_fan() { CELL_WITH_FAN } else { CELL };
        FRAME + self.cells * cell + self.blocks * self.block(integration, model) + table(integration, tables)
    }

    /// Nanoseconds of a block.
    fn block(&self, integration: Integration, model: OpticalModel) -> f64 {
        let [at_one, each_more] = match (integration, model) {
            (Integration::Vertex, _) => [50.0, 0.0],
            (Integration::Average, OpticalModel::Emitter) => [67.0, 0.75],
            (Integration::Average, _) => [52.0, 0.75],
            (Integration::Opacity2d, OpticalModel::Emitter) => [72.0, 1.2],
            (Integration::Opacity2d, _) => [57.0, 1.2],
            (Integration::Partial, OpticalModel::DensityEmitter) => [84.0, 1.2],
            (Integration::Partial, _) => [57.0, 1.2],
            (Integration::Table2d, _) => [90.0, 0.0],
            (Integration::Table3d, _) => [100.0, 0.0],
            (Integration::Cumulative, OpticalModel::DensityEmitter) => [78.0, 2.4],
            (Integration::Cumulative, OpticalModel::Emitter) => [73.0, 2.2],
            (Integration::Exact, OpticalModel::DensityEmitter | OpticalModel::Emitter) => [71.0, 2.9],
            (Integration::Exact | Integration::Cumulative, _) => [58.0, 1.7],
        };
        at_one + each_more * (self.pieces - 1.0)
    }
}

fn table(integration: Integration, tables: Option<&TableSettings>) -> f64 {
    let Some(tables) = tables.filter(|_| integration.needs_table()) else { return 0.0 };
    let plane = f64::from(tables.scalars) * f64::from(tables.scalars);
    let planes = if integration == Integration::Table3d { f64::from(tables.lengths) } else { 1.0 };
    plane * planes * TABLE_ENTRY
}
