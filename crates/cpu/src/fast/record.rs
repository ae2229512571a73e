//! A cell ready to be drawn: planes in f32, about a reference inside it.
//!
//! What is linear on the screen is the nearness: 1/depth in a perspective view, minus the depth in an orthographic one.
//! Each face's nearness is a plane over the pixels; a ray is inside between the nearest of the entry faces' planes and the farthest of
//! the exit faces'. Here nearness is relative to that of a reference point in the cell (perspective: `reference depth / depth - 1`;
//! orthographic: `reference depth - depth`), which keeps thin and far cells from cancelling in f32, and pixels are
//! counted from the reference's. Scalars are relative to the scalar at the reference. With `e` the nearness:
//! - chord length, in units of the reference depth and of the ray's stretch: `(e_f - e_b) / ((1 + e_f) (1 + e_b))`;
//! - scalar: `(G - k e) / (1 + e)` with `G` linear in the pixels. Without the denominators when orthographic.

use super::cell::{CarefulCell, CellPieces, Outline};
use super::effects::CellEffects;
use super::fan::Fan;
use super::gradient::CellGradient;
use super::interpolation::{Interpolated, PerspectiveFan, ScreenFan};
use crate::geometry::{PixelBox, PixelSpace, is_outside_rectangle};
use crate::grid::Tile;

/// A cell, ready to be drawn; two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct CellRecord {
    /// The scalar at the reference.
    pub(crate) scalar_reference: f64,
    /// World length of the cell's unit of length.
    pub(crate) length: f64,
    /// Relative nearness of the four faces' planes, entry faces first: at the reference pixel, per column, per row.
    pub(crate) planes: [[f32; 3]; 4],
    /// `G` per column and row, and `k`.
    pub(crate) scalar: [f32; 3],
    /// Bounds of relative nearness: those of the cell's corners.
    pub(crate) nearness_range: [f32; 2],
    /// Lowest and highest scalar, relative to the reference.
    pub(crate) scalar_range: [f32; 2],
    /// The reference pixel: column and row.
    pub(crate) pixel: [u16; 2],
    pub(crate) outline: Outline,
    pub(crate) pieces: CellPieces,
    /// How many of the planes are of entry faces, 1 to 3; 0 for a cell to be drawn carefully.
    pub(crate) entry_count: u32,
    /// For a cell to be drawn carefully: its number in [`Records::careful`].
    pub(crate) careful: u32,
    /// Its number in [`Records::effects`], or [`NO_EFFECTS`].
    pub(crate) effects: u32,
    /// Depth of the reference in pixel space, from [`PixelSpace::start`].
    pub(crate) depth: f32,
}

/// The number of the effects of a cell that is drawn as volume alone.
pub(crate) const NO_EFFECTS: u32 = u32::MAX;

/// Two lines: a frame fetches as many of them as it draws cells in tiles, scattered in memory.
const _: () = assert!(size_of::<CellRecord>() == 128);

impl CellRecord {
    pub(crate) fn pixel_box(&self) -> PixelBox {
        self.outline.map(u32::from)
    }
}

/// The records of a run of cells in visibility order.
#[derive(Debug, Default)]
pub(crate) struct Records {
    pub(crate) cells: Vec<CellRecord>,
    pub(crate) careful: Vec<CarefulCell>,
    /// One for each of `cells` where the integration asks for fans, else none.
    pub(crate) fans: Vec<Option<Fan>>,
    /// One for each of `cells` where segments are interpolated with the perspective correction of hardware, else none.
    pub(crate) perspective: Vec<Option<PerspectiveFan>>,
    /// One for each of `cells` where segments are interpolated on the screen, else none.
    pub(crate) screen: Vec<Option<ScreenFan>>,
    /// What cells have besides their volume; those that have it.
    pub(crate) effects: Vec<CellEffects>,
    /// Places among `cells` of those in rings whose pixels are to be sorted, ascending.
    pub(crate) rings: Vec<u32>,
    /// Gradients of the same cells, where something is lit, else none.
    pub(crate) gradients: Vec<CellGradient>,
    /// Their constant gradients, where those are interpolated and some surface is to be lit flat, else none.
    pub(crate) flat_gradients: Vec<CellGradient>,
}

impl Records {
    /// How the samples of a cell are interpolated; `None` where they are as its planes have them.
    #[inline(always)]
    fn interpolated(&self, item: u32) -> Option<Interpolated<'_>> {
        let item = item as usize;
        if let Some(fan) = self.perspective.get(item) {
            return fan.as_ref().map(Interpolated::Perspective);
        }
        self.screen.get(item)?.as_ref().map(Interpolated::Screen)
    }

    /// Whether a cell whose outline touches a tile may show in it: cells at the plane of the eye have the whole picture as outline.
    pub(crate) fn may_show(&self, item: usize, tile: Tile, space: &PixelSpace) -> bool {
        let record = &self.cells[item];
        if record.entry_count > 0 || !space.is_perspective {
            return true;
        }
        let [u0, w0] = [PixelSpace::center(tile.x, space.size[0]), PixelSpace::center(tile.y, space.size[1])];
        let [u1, w1] = [u0 + f64::from(tile.width - 1), w0 + f64::from(tile.height - 1)];
        let corners = &self.careful[record.careful as usize].corners;
        // Half a pixel of margin: rounding moves an outline by far less.
        !is_outside_rectangle(corners, [u0 - 0.5, u1 + 0.5], [w0 - 0.5, w1 + 0.5])
    }
}

/// A record with what its run knows of it.
#[derive(Clone, Copy)]
pub(crate) struct Listed<'a> {
    pub(crate) records: &'a Records,
    pub(crate) record: &'a CellRecord,
    pub(crate) interpolated: Option<Interpolated<'a>>,
}

impl<'a> Listed<'a> {
    /// - `record`: the one at `item`, or a copy of it
    #[inline(always)]
    pub(crate) fn new(records: &'a Records, record: &'a CellRecord, item: u32) -> Self {
        Self { records, record, interpolated: records.interpolated(item) }
    }
}
