//! On which side of isosurfaces segments begin, where cells come in an order that says nothing of it.
//!
//! [`Joint`] hands the side on from one cell to the next, which needs cells in their order along the ray. Where pixels sort by themselves,
//! the ends of all segments in cells with surfaces are listed and sorted first, pixel by pixel; the side is handed
//! on along each ray, and then the cells are drawn, eight lanes at a time, each told on which side its segments begin. A window changes nothing
//! in this: sides are those of the exact order.

use fearless_simd::{Simd, prelude::*};

use super::deal::{Deal, index_of};
use super::sample::{LANES, Sample};
use super::surfaces::{CellWithEffects, Joint};

/// The ends of a tile's segments in cells with surfaces, in the order in which blocks are drawn. Memory: 168 bytes a block of a cell, and 8 a
/// segment.
#[derive(Debug, Default)]
pub(crate) struct Sides {
    ends: Vec<Ends>,
    /// The one that is drawn next.
    next: usize,
    deal: Deal,
}

/// The ends of a block's segments in one cell.
#[derive(Clone, Copy, Debug)]
struct Ends {
    block: u32,
    /// The lanes that the cell covers, as bits.
    covered: u32,
    /// How far depths may be off.
    slack: [f32; LANES],
    /// Depths and ranks where the rays enter and leave, as [`Joint`] has them.
    depth: [[f32; LANES]; 2],
    rank: [[f32; LANES]; 2],
}

impl Sides {
    pub(crate) fn clear(&mut self) {
        self.ends.clear();
        self.next = 0;
    }

    /// Lists the ends of a block's segments in a cell with surfaces.
    #[inline(always)]
    pub(crate) fn push<S: Simd>(&mut self, simd: S, block: usize, sample: &Sample<S>, cell: &CellWithEffects<'_>) {
        let mut ends = Ends {
            block: block as u32,
            covered: sample.covered.to_bitmask() as u32,
            slack: [0.0; LANES],
            depth: [[0.0; LANES]; 2],
            rank: [[0.0; LANES]; 2],
        };
        cell.slack(simd, sample).store_slice(&mut ends.slack);
        let [front, back] = cell.own_ranks(simd, sample);
        front.store_slice(&mut ends.rank[0]);
        back.store_slice(&mut ends.rank[1]);
        sample.depth[0].store_slice(&mut ends.depth[0]);
        sample.depth[1].store_slice(&mut ends.depth[1]);
        self.ends.push(ends);
    }

    /// Hands sides on along the rays, when all ends are listed.
    ///
    /// - `pixels`: of the tile
    pub(crate) fn settle(&mut self, pixels: usize) {
        let Self { ends, deal, .. } = self;
        let lanes = |number: usize, ends: &Ends| {
            let &Ends { block, covered, depth, .. } = ends;
            (0..LANES).filter(move |lane| covered >> lane & 1 == 1).map(move |lane| {
                let middle = (depth[0][lane] + depth[1][lane]) * 0.5;
                ((block as usize * LANES + lane) as u32, middle, (number * LANES + lane) as u32)
            })
        };
        deal.fill(pixels, ends.iter().enumerate().flat_map(|(number, ends)| lanes(number, ends)));
        for (_, keys) in deal.pixels() {
            keys.sort_unstable();
            // As `Joint::carry`.
            let (mut depth, mut slack, mut rank) = (f32::NEG_INFINITY, 0.0_f32, 0.0);
            for &key in &*keys {
                let (ends, lane) = (&mut ends[index_of(key) / LANES], index_of(key) % LANES);
                if (ends.depth[0][lane] - depth).abs() <= ends.slack[lane].max(slack) {
                    ends.rank[0][lane] = rank;
                }
                (depth, slack, rank) = (ends.depth[1][lane], ends.slack[lane], ends.rank[1][lane]);
            }
        }
    }

    /// The joint at which the segments of the next block begin: cells and blocks come as they were listed.
    #[inline(always)]
    pub(crate) fn next<S: Simd>(&mut self, block: usize, sample: &Sample<S>) -> Option<Joint> {
        let ends = self.ends.get(self.next)?;
        debug_assert_eq!(ends.block as usize, block, "blocks come as they were listed");
        self.next += 1;
        Some(Joint::told(sample, ends.rank[0]))
    }
}
