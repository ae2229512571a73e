//! Segments held back until their pixel knows which one comes first.
//!
//! A tile's segments are listed as cells come: light, depth of the middle, pixel. They are dealt to their pixels in one pass,
//! and each pixel blends its own from the nearest on: all of them sorted, which needs no order of cells, or within a window
//! that holds so many back and gives up the nearest when one more comes ([Callahan 2005]).
//!
//! Segments of one ray do not overlap, so that their middles come in the order of their ends; and however thin one of two neighbors is,
//! the middles lie half of the thicker one apart, which rounding does not turn around. Where cells do overlap in space, the one
//! whose middle is nearer comes first.
//!
//! [Callahan 2005] hold faces back and integrate between the nearest two; here segments of cells are held, whose light is known. So a
//! window here holds whole segments, where a window of theirs holds about as many ends of segments, two neighbors sharing one; a wrong order
//! changes which segment is in front, never what is integrated, and a window of 1 is the order in which cells come.

use fearless_simd::{Simd, f32x4, f32x8, prelude::*};

use super::cover::MAX_BLOCKS;
use super::deal::{Deal, index_of, pass_through_window};
use super::sample::{LANES, Light, Sample};
use super::sides::Sides;
use super::tile::{Block, THIN};

/// Segments that a window lists before it blends what it can: 768 KiB, which stay in a second-level cache.
pub(crate) const LISTED: usize = 1 << 15;

/// The segments of a tile that are held back. Memory: 32 bytes for each one listed, kept for the next tile.
///
/// Without a window all of a tile's segments are listed. With one, at most [`LISTED`], those of one more cell, and twice the window for
/// every pixel.
#[derive(Debug)]
pub(crate) struct Held {
    /// Segments that a pixel holds back; [`Self::ALL`] for all.
    window: usize,
    /// Which blocks hold back.
    takes: [bool; MAX_BLOCKS],
    listed: Segments,
    /// How many may be listed.
    limit: usize,
    /// Those that stay in the window, while others are blended.
    staying: Segments,
    deal: Deal,
    /// On which side of isosurfaces the segments begin.
    pub(crate) sides: Sides,
    /// Segments that were held back, and the most of them at one time.
    pub(crate) sorted: u64,
    pub(crate) most: u64,
}

/// Segments whose light is known; what sorting looks at lies apart.
#[derive(Debug, Default)]
struct Segments {
    places: Vec<Place>,
    /// Linear premultiplied red, green and blue, and the opacity.
    lights: Vec<[f32; 4]>,
}

/// Where a segment lies.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Block times lanes, plus lane.
    pixel: u32,
    /// Of the middle, from where the mesh begins.
    depth: f32,
}

/// A pixel while it is blended.
struct Pixel<S: Simd> {
    /// The fourth lane holds nothing of use.
    rgb: f32x4<S>,
    opacity: f32,
    transmittance: f32,
}

impl Default for Held {
    fn default() -> Self {
        Self {
            window: Self::ALL,
            takes: [true; MAX_BLOCKS],
            listed: Segments::default(),
            limit: LISTED,
            staying: Segments::default(),
            deal: Deal::default(),
            sides: Sides::default(),
            sorted: 0,
            most: 0,
        }
    }
}

impl Held {
    /// A window that holds everything.
    pub(crate) const ALL: usize = usize::MAX;

    /// Nothing yet, for all blocks of a tile or for none.
    pub(crate) fn reset(&mut self, window: usize, all_blocks: bool) {
        self.window = window;
        self.takes = [all_blocks; MAX_BLOCKS];
        self.listed.clear();
        self.limit = LISTED;
        self.sides.clear();
        (self.sorted, self.most) = (0, 0);
    }

    /// Makes a block hold back.
    pub(crate) fn take(&mut self, block: usize) {
        self.takes[block & (MAX_BLOCKS - 1)] = true;
    }

    /// Whether a block holds back.
    #[inline(always)]
    pub(crate) fn takes(&self, block: usize) -> bool {
        self.takes[block & (MAX_BLOCKS - 1)]
    }

    /// Lists the segments of a block. Out of line, and one for all methods.
    #[inline(never)]
    pub(crate) fn push<S: Simd>(&mut self, simd: S, block: usize, sample: &Sample<S>, light: &Light<S>) {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut lanes = [[0.0_f32; LANES]; 5];
                let middle = (sample.depth[0] + sample.depth[1]) * f32x8::splat(simd, 0.5);
                let [r, g, b] = light.rgb;
                for (lanes, values) in lanes.iter_mut().zip([r, g, b, light.opacity, middle]) {
                    values.store_slice(lanes);
                }
                let mut covered = sample.covered.to_bitmask();
                self.sorted += u64::from(covered.count_ones());
                while covered != 0 {
                    let lane = covered.trailing_zeros() as usize & (LANES - 1);
                    covered &= covered - 1;
                    let [r, g, b, opacity, depth] = [0, 1, 2, 3, 4].map(|i: usize| lanes[i][lane]);
                    let pixel = (block * LANES + lane) as u32;
                    self.listed.push(Place { pixel, depth }, [r, g, b, opacity]);
                }
            },
        );
    }

    /// Whether the window lists so much that what left it is to be blended.
    #[inline(always)]
    pub(crate) fn is_full(&self) -> bool {
        self.window != Self::ALL && self.listed.places.len() >= self.limit
    }

    /// Blends what has left the window into the blocks; all that is held if `is_last`.
    ///
    /// - `termination`: transmittance below which a pixel is not blended any further
    #[inline(never)]
    pub(crate) fn blend<S: Simd>(&mut self, simd: S, termination: f32, blocks: &mut [Block], is_last: bool) {
        simd.vectorize(
            #[inline(always)]
            || self.blend_here(simd, termination, blocks, is_last),
        );
    }

    #[inline(always)]
    fn blend_here<S: Simd>(&mut self, simd: S, termination: f32, blocks: &mut [Block], is_last: bool) {
        let Self { window, listed, staying, deal, .. } = self;
        self.most = self.most.max(listed.places.len() as u64);
        let things = (0..).zip(listed.places.iter()).map(|(index, place)| (place.pixel, place.depth, index));
        deal.fill(blocks.len() * LANES, things);
        staying.clear();
        for (number, keys) in deal.pixels() {
            if keys.is_empty() {
                continue;
            }
            pass_through_window(keys, *window);
            let leave = if is_last { keys.len() } else { keys.len().saturating_sub(*window) };
            let (leaving, held) = keys.split_at(leave);
            let (block, lane) = (&mut blocks[number / LANES], number % LANES);
            let mut pixel = Pixel::load(simd, block, lane);
            for &key in leaving {
                // What lies behind an opaque pixel is not seen.
                if pixel.transmittance < termination {
                    break;
                }
                pixel.add(simd, listed.lights[index_of(key)]);
            }
            pixel.store(block, lane);
            // Sorted, so that those of one depth stay in the order in which they came.
            for &key in held {
                staying.push(listed.places[index_of(key)], listed.lights[index_of(key)]);
            }
        }
        std::mem::swap(listed, staying);
        self.limit = LISTED.max(2 * self.listed.places.len());
    }
}

impl Segments {
    fn clear(&mut self) {
        self.places.clear();
        self.lights.clear();
    }

    #[inline(always)]
    fn push(&mut self, place: Place, light: [f32; 4]) {
        self.places.push(place);
        self.lights.push(light);
    }
}

impl<S: Simd> Pixel<S> {
    #[inline(always)]
    fn load(simd: S, block: &Block, lane: usize) -> Self {
        let [r, g, b] = &block.rgb;
        Self {
            rgb: f32x4::load_array(simd, [r[lane], g[lane], b[lane], 0.0]),
            opacity: block.opacity[lane],
            transmittance: block.transmittance[lane],
        }
    }

    #[inline(always)]
    fn store(self, block: &mut Block, lane: usize) {
        let mut rgb = [0.0; 4];
        self.rgb.store_slice(&mut rgb);
        for (channel, value) in block.rgb.iter_mut().zip(rgb) {
            channel[lane] = value;
        }
        block.opacity[lane] = self.opacity;
        block.transmittance[lane] = self.transmittance;
    }

    /// Puts a segment behind what is there.
    #[inline(always)]
    fn add(&mut self, simd: S, light: [f32; 4]) {
        self.rgb = f32x4::splat(simd, self.transmittance).mul_add(f32x4::load_array(simd, light), self.rgb);
        let hidden = self.transmittance * light[3];
        self.opacity += hidden;
        // As in `Block::add`.
        self.transmittance = if self.opacity < THIN { 1.0 - self.opacity } else { self.transmittance - hidden };
    }
}
