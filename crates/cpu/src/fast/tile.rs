//! One tile of the picture: its cells blended front to back, eight pixels at a time.

use fearless_simd::{Level, Simd, dispatch, f32x8, prelude::*};
use tetrascope_integrate::{Integration, Integrator, OpticalModel};
use tetrascope_scene::Plan;

use super::blocks::Blocks;
use super::cell::CellPieces;
use super::cover::{BlockRange, CoverList};
use super::effects::{Effects, LocalSurface};
use super::held::Held;
use super::lookup::Lookup;
use super::methods::{Average, CellOptics, Cumulative, Ends, Exact, Method, Partial, Tabulated, Vertex};
use super::model::{Absorption, DensityEmitter, Emission, Emitter, Model};
use super::optics::Optics;
use super::record::{CellRecord, Listed, NO_EFFECTS, Records};
use super::sample::{BLOCK_HEIGHT, BLOCK_WIDTH, LANES, Light, Sample, lanes_from};
use super::sharp::SharpCell;
use super::surfaces::{CellWithEffects, Joint};
use super::survey::Sorting;
use crate::geometry::PixelSpace;
use crate::grid::{Bins, Tile, TileGrid};

/// Records that are fetched together before they are drawn. They lie scattered in memory; one after the other, each would be
/// waited for, while together their latencies overlap. 8 KiB.
const BATCH: usize = 64;

/// Everything that drawing a tile needs.
pub(crate) struct Job<'a> {
    pub(crate) records: &'a [Records],
    /// One for each of `records`.
    pub(crate) bins: &'a [Bins],
    pub(crate) grid: TileGrid,
    pub(crate) space: &'a PixelSpace,
    pub(crate) optics: &'a Optics,
    pub(crate) plan: &'a Plan,
    /// The table, where the integration has one.
    pub(crate) lookup: Option<&'a Lookup>,
    /// What cells are integrated with that are beyond 32 bits, if any may be.
    pub(crate) sharp: Option<&'a Integrator>,
    /// Isosurfaces and light, if there are any.
    pub(crate) effects: Option<&'a Effects>,
    /// How pixels sort what they see, if they do.
    pub(crate) sorting: Option<Sorting<'a>>,
    pub(crate) level: Level,
}

/// The opacity up to which a pixel is known by its opacity, and beyond by its transmittance: whichever is the smaller has the more digits.
/// Thousands of thin layers add up to the right sum so, and thousands more behind them still count.
pub(crate) const THIN: f32 = 0.5;

/// Color, opacity and transmittance of the eight pixels of a block, and how much longer their rays are than straight ahead.
///
/// The opacity is of use while it is below [`THIN`]; the transmittance always.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Block {
    pub(crate) rgb: [[f32; LANES]; 3],
    pub(crate) opacity: [f32; LANES],
    pub(crate) transmittance: [f32; LANES],
    stretch: [f32; LANES],
}

/// Cells that a block has seen from which on it keeps what rounding takes off: thousands of layers of a regular grid are nearly equal and would all round
/// the same way, by 4e-5 in 20,000 of them. Below this it is 5e-6 at most, and not worth the time.
const DEEP: u16 = 2048;

/// What rounding has taken off the sums of a block.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
struct Lost {
    rgb: [[f32; LANES]; 3],
    opacity: [f32; LANES],
    transmittance: [f32; LANES],
}

/// The pixels of a tile, block after block.
#[derive(Debug, Default)]
pub(crate) struct Pixels {
    blocks: Vec<Block>,
    /// Cells that each block has seen, up to [`DEEP`], in a tile that has more of them; else none.
    seen: Vec<u16>,
    /// One a block, likewise.
    lost: Vec<Lost>,
    /// One a block where there are isosurfaces or light, else none.
    joints: Vec<Joint>,
    /// Blocks a row.
    columns: u32,
}

/// A tile while it is drawn.
struct Canvas<'a> {
    tile: Tile,
    pixels: &'a mut Pixels,
    covers: CoverList,
    /// Segments that are held back, where any are.
    held: Option<Held>,
    done: Done,
}

/// What was drawn.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Done {
    /// Pairs of a pixel and a cell.
    pub(crate) fragments: u64,
    /// Surfaces met by rays.
    pub(crate) crossings: u64,
    /// Of the fragments, those that their pixel sorted.
    pub(crate) sorted: u64,
    /// Most fragments held back at one time.
    pub(crate) most_held: u64,
    /// Fragments of cells in which something is lit.
    pub(crate) lit: u64,
}

impl Pixels {
    /// Clears the pixels for a tile.
    #[inline(always)]
    fn reset<S: Simd>(&mut self, simd: S, tile: Tile, space: &PixelSpace, [with_effects, may_be_deep]: [bool; 2]) {
        let (columns, rows) = (tile.width.div_ceil(BLOCK_WIDTH), tile.height.div_ceil(BLOCK_HEIGHT));
        let [none, whole] = [[0.0; LANES], [1.0; LANES]];
        let nothing = Block { rgb: [none; 3], opacity: none, transmittance: whole, stretch: whole };
        self.columns = columns;
        self.blocks.clear();
        self.blocks.resize((columns * rows) as usize, nothing);
        self.seen.clear();
        self.lost.clear();
        if may_be_deep {
            self.seen.resize(self.blocks.len(), 0);
            self.lost.resize(self.blocks.len(), Lost { rgb: [none; 3], opacity: none, transmittance: none });
        }
        self.joints.clear();
        if with_effects {
            self.joints.resize(self.blocks.len(), Joint::NONE);
        }
        if !space.is_perspective {
            return;
        }
        let [slope_x, slope_y] = space.slope.map(|slope| slope as f32);
        for (index, block) in (0..).zip(&mut self.blocks) {
            let (x, y) = (tile.x + index % columns * BLOCK_WIDTH, tile.y + index / columns * BLOCK_HEIGHT);
            let [u, w] = lanes_from(simd, [x, y], space);
            let (right, down) = (u * slope_x, w * slope_y);
            (right.mul_add(right, down * down) + 1.0).sqrt().store_slice(&mut block.stretch);
        }
    }

    /// The blocks that a cell may cover; its outline touches the tile.
    #[inline(always)]
    pub(crate) fn range(&self, tile: Tile, record: &CellRecord) -> BlockRange {
        let [x0, x1, y0, y1] = record.pixel_box();
        let column = (x0.max(tile.x) - tile.x) / BLOCK_WIDTH;
        let row = (y0.max(tile.y) - tile.y) / BLOCK_HEIGHT;
        let last_column = (x1.min(tile.x + tile.width - 1) - tile.x) / BLOCK_WIDTH;
        let last_row = (y1.min(tile.y + tile.height - 1) - tile.y) / BLOCK_HEIGHT;
        BlockRange {
            pixel: [tile.x + column * BLOCK_WIDTH, tile.y + row * BLOCK_HEIGHT],
            first: row * self.columns + column,
            columns: last_column - column + 1,
            rows: last_row - row + 1,
            stride: self.columns,
        }
    }

    /// Where a block keeps what rounding takes off, once it has seen so much that this counts.
    #[inline(always)]
    fn lost<'a>(seen: &mut [u16], lost: &'a mut [Lost], number: usize) -> Option<&'a mut Lost> {
        let seen = seen.get_mut(number)?;
        if *seen < DEEP {
            *seen += 1;
            return None;
        }
        lost.get_mut(number)
    }

    /// Number of blocks.
    pub(crate) fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Writes one row of the tile's pixels, as many as `line` has.
    pub(crate) fn copy_row(&self, row: u32, line: &mut [[f32; 4]]) {
        let blocks = &self.blocks[(row / BLOCK_HEIGHT * self.columns) as usize..];
        let first_lane = (row % BLOCK_HEIGHT * BLOCK_WIDTH) as usize;
        for (pixels, block) in line.chunks_mut(BLOCK_WIDTH as usize).zip(blocks) {
            for (lane, pixel) in (first_lane..).zip(pixels) {
                let [r, g, b] = &block.rgb;
                let thin = block.opacity[lane];
                let opacity = if thin < THIN { thin } else { 1.0 - block.transmittance[lane] };
                *pixel = [r[lane], g[lane], b[lane], opacity];
            }
        }
    }
}

impl Job<'_> {
    /// Draws a tile into `pixels`, whatever was there before.
    pub(crate) fn draw(&self, index: usize, pixels: &mut Pixels) -> Done {
        use Integration as I;
        use OpticalModel as O;
        // Where several are one and the same, one is compiled.
        match (self.plan.integration, self.optics.model) {
            (I::Vertex, _) => self.draw_as::<Vertex, DensityEmitter>(index, pixels),
            (I::Partial, O::DensityEmitter) => self.draw_as::<Partial, DensityEmitter>(index, pixels),
            (I::Average, _) => self.draw_with::<Average>(index, pixels),
            (I::Opacity2d | I::Partial, _) => self.draw_with::<Ends>(index, pixels),
            (I::Table2d, _) => self.draw_as::<Tabulated<false>, DensityEmitter>(index, pixels),
            (I::Table3d, _) => self.draw_as::<Tabulated<true>, DensityEmitter>(index, pixels),
            (I::Cumulative, O::DensityEmitter) => self.draw_as::<Cumulative<false>, DensityEmitter>(index, pixels),
            (I::Cumulative, O::Emitter) => self.draw_as::<Cumulative<true>, Emitter>(index, pixels),
            (I::Cumulative | I::Exact, _) => self.draw_with::<Exact>(index, pixels),
        }
    }

    fn draw_with<I: Method>(&self, index: usize, pixels: &mut Pixels) -> Done {
        match self.optics.model {
            OpticalModel::DensityEmitter => self.draw_as::<I, DensityEmitter>(index, pixels),
            OpticalModel::Emitter => self.draw_as::<I, Emitter>(index, pixels),
            OpticalModel::Absorption => self.draw_as::<I, Absorption>(index, pixels),
            OpticalModel::Emission => self.draw_as::<I, Emission>(index, pixels),
        }
    }

    fn draw_as<I: Method, M: Model>(&self, index: usize, pixels: &mut Pixels) -> Done {
        dispatch!(self.level, simd => self.draw_tile::<_, I, M>(simd, index, pixels))
    }

    #[inline(always)]
    fn draw_tile<S: Simd, I: Method, M: Model>(&self, simd: S, index: usize, pixels: &mut Pixels) -> Done {
        let tile = self.grid.tile(index);
        let cells: usize = self.bins.iter().map(|bins| bins.of(index).len()).sum();
        pixels.reset(simd, tile, self.space, [self.effects.is_some(), cells > usize::from(DEEP)]);
        let mut covers = CoverList::new();
        let held = self.sorting.as_ref().and_then(|sorting| self.survey(simd, sorting, index, pixels, &mut covers));
        let mut canvas = Canvas { tile, pixels, covers, held, done: Done::default() };
        let (mut pieces, mut surfaces) = (Vec::new(), Vec::new());
        let mut batch = Vec::with_capacity(BATCH);
        for (records, bins) in self.records.iter().zip(self.bins) {
            for items in bins.of(index).chunks(BATCH) {
                batch.clear();
                batch.extend(items.iter().map(|&item| records.cells[item as usize]));
                for (record, &item) in batch.iter().zip(items) {
                    if I::NEEDS_PIECES {
                        self.optics.localize(record, &mut pieces);
                    }
                    let fan = records.fans.get(item as usize).and_then(Option::as_ref);
                    let table = self.lookup.map(|lookup| lookup.localize(record));
                    let with_effects = self.effects_of(records, record, &mut surfaces);
                    let cell = CellOptics { pieces: &pieces, fan, table, sharp: self.sharp(records, record) };
                    let listed = Listed::new(records, record, item);
                    self.draw_cell::<S, I, M>(simd, listed, cell, with_effects.as_ref(), &mut canvas);
                    if let Some(held) = canvas.held.as_mut().filter(|held| held.is_full()) {
                        held.blend(simd, self.plan.termination, &mut canvas.pixels.blocks, false);
                    }
                }
            }
        }
        if let (Some(sorting), Some(mut held)) = (&self.sorting, canvas.held) {
            held.blend(simd, self.plan.termination, &mut canvas.pixels.blocks, true);
            (canvas.done.sorted, canvas.done.most_held) = (held.sorted, held.most);
            sorting.give_back(held);
        }
        canvas.done
    }

    /// The cell, if its light is to be found in f64.
    #[inline(always)]
    fn sharp<'a>(&'a self, records: &'a Records, record: &CellRecord) -> Option<SharpCell<'a>> {
        if record.entry_count > 0 {
            return None;
        }
        let cell = &records.careful[record.careful as usize];
        let integrator = self.sharp.filter(|_| cell.is_sharp)?;
        Some(SharpCell { cell, pixel: record.pixel, integrator, space: self.space })
    }

    /// What a cell has besides its volume, if anything.
    #[inline(always)]
    pub(crate) fn effects_of<'a>(
        &'a self,
        records: &'a Records,
        record: &'a CellRecord,
        surfaces: &'a mut Vec<LocalSurface>,
    ) -> Option<CellWithEffects<'a>> {
        if record.effects == NO_EFFECTS {
            return None;
        }
        let effects = self.effects?;
        let number = record.effects as usize;
        let of_cell = &records.effects[number];
        // Maps know all surfaces by themselves.
        surfaces.clear();
        if effects.maps.is_none() {
            effects.localize(record, of_cell, surfaces);
        }
        Some(CellWithEffects {
            record,
            surfaces,
            range: CellPieces { first: of_cell.first, count: of_cell.count },
            slack: of_cell.slack,
            maps: effects.maps.as_deref(),
            gradient: records.gradients.get(number),
            flat_gradient: records.flat_gradients.get(number),
            lamp: effects.light.as_ref(),
            space: self.space,
        })
    }

    /// Blends one cell into the tile.
    #[inline(always)]
    fn draw_cell<S: Simd, I: Method, M: Model>(
        &self,
        simd: S,
        listed: Listed<'_>,
        cell: CellOptics<'_>,
        with_effects: Option<&CellWithEffects<'_>>,
        canvas: &mut Canvas<'_>,
    ) {
        let Canvas { tile, pixels, covers, held, done } = canvas;
        let range = pixels.range(*tile, listed.record);
        let brush = Brush { cell, with_effects, termination: self.plan.termination };
        // One place of the code that shades: it is large, and compiled for every method.
        let blocks = Blocks::find(simd, listed, range, self.space, covers);
        for index in 0..blocks.len() {
            let Some((block, sample)) = blocks.get(simd, covers, index) else { continue };
            brush.blend::<S, I, M>(simd, sample, block, pixels, held.as_mut(), done);
        }
    }
}

/// A method's shading out of line, for what is drawn with effects.
#[inline(never)]
fn shade<S: Simd, I: Method, M: Model>(simd: S, cell: CellOptics<'_>, sample: &Sample<S>) -> Light<S> {
    simd.vectorize(
        #[inline(always)]
        || I::shade::<S, M>(simd, cell, sample),
    )
}

/// A cell that is being blended.
struct Brush<'a> {
    cell: CellOptics<'a>,
    with_effects: Option<&'a CellWithEffects<'a>>,
    termination: f32,
}

impl Brush<'_> {
    /// Puts the cell's light behind what a block has, or into what it holds back, unless the block is opaque.
    #[inline(always)]
    fn blend<S: Simd, I: Method, M: Model>(
        &self,
        simd: S,
        mut sample: Sample<S>,
        number: usize,
        pixels: &mut Pixels,
        held: Option<&mut Held>,
        done: &mut Done,
    ) {
        let mut held = held.filter(|held| held.takes(number));
        // Also for an opaque block: each was listed.
        let mut told = match (&mut held, self.with_effects) {
            (Some(held), Some(cell)) if cell.has_surfaces() => held.sides.next(number, &sample),
            _ => None,
        };
        let block = &mut pixels.blocks[number];
        let before = f32x8::from_slice(simd, &block.transmittance);
        // What lies behind an opaque block is not seen.
        if (M::ABSORBS || self.with_effects.is_some())
            && !before.simd_ge(f32x8::splat(simd, self.termination)).any_true()
        {
            return;
        }
        sample.length *= f32x8::from_slice(simd, &block.stretch);
        let covered = u64::from(sample.covered.to_bitmask().count_ones());
        done.fragments += covered;
        let Some(with_effects) = self.with_effects else {
            let light = I::shade::<S, M>(simd, self.cell, &sample);
            match held {
                Some(held) => held.push(simd, number, &sample, &light),
                None => {
                    let lost = Pixels::lost(&mut pixels.seen, &mut pixels.lost, number);
                    block.add(simd, before, light, M::EMITS, M::ABSORBS, lost);
                }
            }
            return;
        };
        let joint = told.as_mut().unwrap_or(&mut pixels.joints[number]);
        let (light, crossings) = with_effects.shade(simd, self.cell, &sample, joint, shade::<S, I, M>);
        done.crossings += crossings;
        // Once a block, and only where there are effects.
        done.lit += if with_effects.lamp.is_some() { covered } else { 0 };
        match held {
            Some(held) => held.push(simd, number, &sample, &light),
            None => {
                let lost = Pixels::lost(&mut pixels.seen, &mut pixels.lost, number);
                block.add(simd, before, light, true, true, lost);
            }
        }
    }
}

impl Block {
    /// Puts light behind what is there; `before` is the block's transmittance.
    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        before: f32x8<S>,
        light: Light<S>,
        emits: bool,
        absorbs: bool,
        lost: Option<&mut Lost>,
    ) {
        if let Some(lost) = lost {
            return self.add_compensated(simd, before, &light, lost);
        }
        if emits {
            for (channel, color) in self.rgb.iter_mut().zip(light.rgb) {
                before.mul_add(color, f32x8::from_slice(simd, channel)).store_slice(channel);
            }
        }
        if absorbs {
            let hidden = before * light.opacity;
            let opacity = hidden + f32x8::from_slice(simd, &self.opacity);
            opacity.store_slice(&mut self.opacity);
            let is_thin = opacity.simd_lt(f32x8::splat(simd, THIN));
            is_thin.select(1.0 - opacity, before - hidden).store_slice(&mut self.transmittance);
        }
    }

    /// [`Self::add`] that keeps what rounding takes off [Kahan 1965]. Out of line, and for every model: a light that is not there adds 0.
    #[inline(never)]
    fn add_compensated<S: Simd>(&mut self, simd: S, before: f32x8<S>, light: &Light<S>, lost: &mut Lost) {
        simd.vectorize(
            #[inline(always)]
            || {
                let add = |sum: &mut [f32; LANES], lost: &mut [f32; LANES], more: f32x8<S>| {
                    let old = f32x8::from_slice(simd, sum);
                    let more = more - f32x8::from_slice(simd, lost);
                    let new = old + more;
                    ((new - old) - more).store_slice(lost);
                    new.store_slice(sum);
                    new
                };
                for ((channel, lost), color) in self.rgb.iter_mut().zip(&mut lost.rgb).zip(light.rgb) {
                    add(channel, lost, before * color);
                }
                let hidden = before * light.opacity;
                let opacity = add(&mut self.opacity, &mut lost.opacity, hidden);
                let transmittance = add(&mut self.transmittance, &mut lost.transmittance, -hidden).max(0.0);
                let is_thin = opacity.simd_lt(f32x8::splat(simd, THIN));
                is_thin.select(1.0 - opacity, transmittance).store_slice(&mut self.transmittance);
            },
        );
    }
}
