//! What must be known of a tile before it is drawn where pixels sort by themselves: which of them do, and where isosurfaces
//! are met.

use std::sync::{Mutex, PoisonError};

use fearless_simd::Simd;
use tetrascope_order::PixelSort;
use tetrascope_scene::Plan;

use super::blocks::Blocks;
use super::cover::CoverList;
use super::held::Held;
use super::record::{Listed, NO_EFFECTS};
use super::sample::LANES;
use super::tile::{Job, Pixels};
use crate::grid::Tile;

/// How pixels sort what they see.
#[derive(Clone, Copy)]
pub(crate) struct Sorting<'a> {
    /// Segments that a pixel holds back; [`Held::ALL`] for all.
    window: usize,
    /// Whether only blocks in which cells in rings are drawn do so.
    rings_alone: bool,
    /// Memory for a tile, one a thread.
    pool: &'a Mutex<Vec<Held>>,
}

impl<'a> Sorting<'a> {
    /// What a plan asks for; `None` if cells are blended as they come.
    ///
    /// - `rings_sort`: whether there are rings whose pixels are to be sorted
    pub(crate) fn of(plan: &Plan, rings_sort: bool, pool: &'a Mutex<Vec<Held>>) -> Option<Self> {
        let (window, rings_alone) = match plan.order.pixel_sort() {
            // One that is held back and given up when the next one comes changes nothing.
            PixelSort::None | PixelSort::Window(0 | 1) => {
                if !rings_sort {
                    return None;
                }
                (Held::ALL, true)
            }
            PixelSort::Window(window) => (window as usize, false),
            PixelSort::All => (Held::ALL, false),
        };
        Some(Self { window, rings_alone, pool })
    }

    /// Gives a tile's memory back.
    pub(crate) fn give_back(&self, held: Held) {
        self.pool.lock().unwrap_or_else(PoisonError::into_inner).push(held);
    }

    fn memory(&self) -> Held {
        let mut held = self.pool.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default();
        held.reset(self.window, !self.rings_alone);
        held
    }
}

impl Job<'_> {
    /// Where the segments of a tile are held back; `None` if they are not. Out of line, and one for all methods.
    #[inline(never)]
    pub(crate) fn survey<S: Simd>(
        &self,
        simd: S,
        sorting: &Sorting<'_>,
        index: usize,
        pixels: &Pixels,
        covers: &mut CoverList,
    ) -> Option<Held> {
        simd.vectorize(
            #[inline(always)]
            || {
                let tile = self.grid.tile(index);
                let mut held = sorting.memory();
                if sorting.rings_alone && !self.mark_rings(simd, index, tile, pixels, covers, &mut held) {
                    sorting.give_back(held);
                    return None;
                }
                if self.effects.is_some_and(|effects| !effects.surfaces.is_empty()) {
                    self.list_sides(simd, index, tile, pixels, covers, &mut held);
                }
                Some(held)
            },
        )
    }

    /// Makes the blocks hold back in which cells in rings are drawn; whether there are any.
    #[inline(always)]
    fn mark_rings<S: Simd>(
        &self,
        simd: S,
        index: usize,
        tile: Tile,
        pixels: &Pixels,
        covers: &mut CoverList,
        held: &mut Held,
    ) -> bool {
        let mut any = false;
        for (records, bins) in self.records.iter().zip(self.bins) {
            if records.rings.is_empty() {
                continue;
            }
            for &item in bins.of(index) {
                if records.rings.binary_search(&item).is_err() {
                    continue;
                }
                let record = &records.cells[item as usize];
                let listed = Listed::new(records, record, item);
                let blocks = Blocks::find(simd, listed, pixels.range(tile, record), self.space, covers);
                for visit in 0..blocks.len() {
                    if let Some((block, _)) = blocks.get(simd, covers, visit) {
                        held.take(block);
                        any = true;
                    }
                }
            }
        }
        any
    }

    /// Finds out on which side of isosurfaces the segments that are held back begin.
    #[inline(always)]
    fn list_sides<S: Simd>(
        &self,
        simd: S,
        index: usize,
        tile: Tile,
        pixels: &Pixels,
        covers: &mut CoverList,
        held: &mut Held,
    ) {
        let mut surfaces = Vec::new();
        for (records, bins) in self.records.iter().zip(self.bins) {
            for &item in bins.of(index) {
                let record = &records.cells[item as usize];
                if record.effects == NO_EFFECTS {
                    continue;
                }
                let Some(cell) = self.effects_of(records, record, &mut surfaces) else { continue };
                if !cell.has_surfaces() {
                    continue;
                }
                let listed = Listed::new(records, record, item);
                let blocks = Blocks::find(simd, listed, pixels.range(tile, record), self.space, covers);
                for visit in 0..blocks.len() {
                    if let Some((block, sample)) = blocks.get(simd, covers, visit)
                        && held.takes(block)
                    {
                        held.sides.push(simd, block, &sample, &cell);
                    }
                }
            }
        }
        held.sides.settle(pixels.len() * LANES);
    }
}
