//! Set-up: a tetrahedron becomes a record of planes in f32, or, where f32 cannot hold it or it was cut, a cell to be drawn
//! carefully.

use fearless_simd::dispatch;
use glam::{DVec2, DVec3};
use tetrascope_classify::{DepthPlane, cut_at_depth};
use tetrascope_mesh::{CellId, VertexId};
use tetrascope_order::{CutPlane, Piece};
use tetrascope_scene::{Interpolation, Sharpness};

use super::CpuRenderer;
use super::cell::{CarefulCell, Cell, Outline};
use super::effects::Effects;
use super::fan::FanSetUp;
use super::optics::Optics;
use super::record::{CellRecord, NO_EFFECTS, Records};
use crate::geometry::{ClipCell, PixelSpace, Points};

/// A face counts as steep when its plane, over the cell's pixels, runs through this many times the cell's own range of nearness: then
/// rounding in f32 is 3e-7 times as much of the cell's chord, and the cell is drawn in f64 instead.
const STEEP: f64 = 256.0;

/// A cell whose nearest point is closer than this share of its farthest is drawn in f64: it reaches the plane of the eye, or nearly.
const NEAR: f64 = 1e-2;

/// A cell that reaches beyond this many pictures to any side is drawn in f64.
const MAGNIFIED: f64 = 64.0;

/// A cell whose volume is less than this share of that of its three edges at a right angle is drawn as the reference draws it: the planes of its faces
/// lie so near to one another that f32 finds chords where there are none, as long as 1e-7 of its longest edge, and where three corners are in line, a
/// face has no normal.
const FLAT: f64 = 1e-6;

/// Cells that are fetched together before they are set up.
const BATCH: usize = 32;

/// What set-up needs to know.
pub(crate) struct SetUp<'a> {
    pub(crate) renderer: &'a CpuRenderer,
    pub(crate) points: &'a Points,
    pub(crate) space: &'a PixelSpace,
    /// One a cell of the mesh.
    pub(crate) outlines: &'a [Outline],
    pub(crate) optics: &'a Optics,
    /// Whether the integration is defined on fans of triangles.
    pub(crate) with_fans: bool,
    /// Of the transfer function, where the integration is exact and some cell may be beyond 32 bits.
    pub(crate) sharpness: Option<&'a Sharpness>,
    /// World length of one unit of depth along the most slanted ray.
    pub(crate) longest_depth: f64,
    /// How segments are found at a pixel.
    pub(crate) interpolation: Interpolation,
    /// Isosurfaces and light, if there are any.
    pub(crate) effects: Option<&'a Effects>,
    /// The gradient at every point, along the mesh's axes, where they are interpolated.
    pub(crate) gradients: &'a [DVec3],
    /// What cuts the cells at some places of the order, by ascending place.
    pub(crate) pieces: &'a [Piece],
    /// For every cell whether it lies in a ring whose pixels are to be sorted; empty if there are none.
    pub(crate) in_ring: &'a [bool],
}

/// Fans have no place on the screen for what lies behind the eye: cells that reach there are cut at this share of their farthest depth.
const FAN_NEAR: f64 = 1e-4;

impl SetUp<'_> {
    /// Sets up cells in the order given; those without volume are left out. What was in `records` gives its memory.
    ///
    /// - `place`: of the first of them in the order
    pub(crate) fn fill(&self, place: usize, cells: &[CellId], records: &mut Records) {
        records.cells.clear();
        records.careful.clear();
        records.fans.clear();
        records.perspective.clear();
        records.screen.clear();
        records.effects.clear();
        records.rings.clear();
        records.gradients.clear();
        records.flat_gradients.clear();
        dispatch!(self.renderer.level, _simd => self.fill_here(place, cells, records));
    }

    /// [`Self::fill`], compiled for the processor's instructions.
    #[inline(always)]
    fn fill_here(&self, place: usize, cells: &[CellId], records: &mut Records) {
        let at = |place: usize| self.pieces.partition_point(|piece| (piece.place as usize) < place);
        let mut pieces = self.pieces[at(place)..at(place + cells.len())].iter().peekable();
        let mut places = place..;
        let mut vertices = Vec::with_capacity(BATCH);
        let mut batch = Vec::with_capacity(BATCH);
        for cells in cells.chunks(BATCH) {
            // Cells and points lie scattered in memory. Fetched for many cells at once, their latencies overlap.
            vertices.clear();
            vertices.extend(cells.iter().map(|&cell| self.renderer.tetrahedra[cell.index()]));
            batch.clear();
            for (&cell, [a, b, c, d]) in cells.iter().zip(&vertices) {
                let [a, b, c, d] = self.points.gather([a.0, b.0, c.0, d.0]);
                batch.push(Cell {
                    corners: [a.position, b.position, c.position, d.position],
                    scalars: [a.scalar, b.scalar, c.scalar, d.scalar],
                    is_positive: self.renderer.is_positive[cell.index()],
                    outline: self.outlines[cell.index()],
                    pieces: self.optics.pieces_of(cell),
                });
            }
            for (((cell, vertices), id), place) in batch.iter().zip(&vertices).zip(cells).zip(&mut places) {
                let before = records.cells.len();
                if let Some(piece) = pieces.next_if(|piece| piece.place as usize == place) {
                    self.add_piece(cell, &piece.planes, records);
                } else if self.with_fans {
                    self.add_with_fan(cell, records);
                } else {
                    self.add(cell, records);
                }
                if self.interpolation != Interpolation::Exact {
                    records.add_fans_of_segments(self.interpolation, cell, before, self.space);
                }
                if let Some(effects) = self.effects {
                    self.add_effects(effects, cell, vertices, before, records);
                }
                if self.in_ring.get(id.index()) == Some(&true) {
                    records.rings.extend(before as u32..records.cells.len() as u32);
                }
            }
        }
    }

    /// Adds a cell's record, if it has volume.
    #[inline(always)]
    fn add(&self, cell: &Cell, records: &mut Records) {
        let is_sharp = self.is_sharp(cell);
        let record = if is_sharp { None } else { self.record(cell) };
        let record = record.or_else(|| {
            let clip = ClipCell::new(&cell.corners, &cell.scalars, cell.is_positive)?;
            records.careful.push(CarefulCell { corners: cell.corners, clip, cuts: Box::default(), is_sharp });
            Some(self.careful_record(cell, records.careful.len() - 1))
        });
        records.cells.extend(record);
    }

    /// Whether the transfer function changes faster in a cell than 32 bits know a scalar, or is denser than they know a depth.
    #[inline(always)]
    fn is_sharp(&self, cell: &Cell) -> bool {
        let Some(sharp) = self.sharpness else { return false };
        let range = |values: [f64; 4]| {
            values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], &v| [l.min(v), h.max(v)])
        };
        let ([low, high], [nearest, farthest]) = (range(cell.scalars), range(cell.corners.map(|p| p.z)));
        let chord = (farthest - nearest) * self.longest_depth;
        sharp.is_beyond_32_bits(low, high, chord)
            || (self.optics.model.needs_extinction()
                && Sharpness::is_chord_beyond_32_bits(self.optics.transfer().max_extinction(low, high), chord))
    }

    /// Adds the part of a cell that lies behind planes, if the cell has volume; in f64, where any number of planes can bound it.
    #[cold]
    fn add_piece(&self, cell: &Cell, planes: &[CutPlane], records: &mut Records) {
        let Some(clip) = ClipCell::new(&cell.corners, &cell.scalars, cell.is_positive) else { return };
        let cuts = planes.iter().map(|plane| self.space.face(plane.point, plane.normal)).collect();
        let record = self.careful_record(cell, records.careful.len());
        records.careful.push(CarefulCell { corners: cell.corners, clip, cuts, is_sharp: self.is_sharp(cell) });
        records.cells.push(record);
    }

    /// Adds a cell's effects and makes the records that it has become, from `first` on, point to them.
    fn add_effects(
        &self,
        effects: &Effects,
        cell: &Cell,
        vertices: &[VertexId; 4],
        first: usize,
        records: &mut Records,
    ) {
        let Some(of_cell) = effects.of_cell(&cell.scalars, cell.corners.map(|p| p.z)) else { return };
        for record in &mut records.cells[first..] {
            record.effects = records.effects.len() as u32;
        }
        records.effects.push(of_cell);
        let at_points = || vertices.map(|v| self.gradients[v.index()]);
        records.gradients.extend(effects.gradient(cell, at_points, self.space));
        records.flat_gradients.extend(effects.flat_gradient(cell, self.space));
    }

    /// Adds a cell's record and its fan; a cell that reaches the plane of the eye is cut there into cells that do not.
    fn add_with_fan(&self, cell: &Cell, records: &mut Records) {
        let space = self.space;
        let fans = FanSetUp { space, transfer: self.optics.transfer(), model: self.optics.model };
        let mut add = |cell: &Cell| {
            self.add(cell, records);
            if let Some(record) = records.cells.get(records.fans.len()) {
                let [u, w] = [0, 1].map(|i| PixelSpace::center(u32::from(record.pixel[i]), space.size[i]));
                let depth = if space.is_perspective { record.length / space.world_per_depth } else { 1.0 };
                records.fans.push(fans.fan(cell, DVec2::new(u, w), depth));
            }
        };
        // In f64 whatever lies in front of the eye has a place on the screen, however near.
        if cell.corners.iter().all(|p| if space.is_perspective { p.z > 0.0 } else { p.z >= 0.0 }) {
            add(cell);
            return;
        }
        let farthest = cell.corners.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.z));
        let depth = if space.is_perspective { FAN_NEAR * farthest } else { 0.0 };
        let (mut corners, mut scalars) = (cell.corners, cell.scalars);
        if !cell.is_positive {
            corners.swap(2, 3);
            scalars.swap(2, 3);
        }
        let ids = if cell.is_positive { [0, 1, 2, 3] } else { [0, 1, 3, 2] };
        let plane = DepthPlane { origin: DVec3::ZERO, forward: DVec3::Z, depth };
        for piece in cut_at_depth(&corners, &scalars, ids, &plane).pieces() {
            add(&Cell { corners: piece.positions, scalars: piece.scalars, is_positive: true, ..*cell });
        }
    }

    /// Whether a cell is so much larger than the picture that f32, relative to the cell, does not resolve what of it is seen.
    #[inline(always)]
    fn is_magnified(&self, cell: &Cell) -> bool {
        let [width, height] = self.space.size;
        let [x0, x1, y0, y1] = cell.outline.map(u32::from);
        // Most cells lie in the picture as a whole.
        if x0 > 0 && x1 + 1 < width && y0 > 0 && y1 + 1 < height {
            return false;
        }
        let limit = MAGNIFIED * f64::from(width.max(height));
        let is_far = |p: DVec3| p.x.abs().max(p.y.abs()) > if self.space.is_perspective { limit * p.z } else { limit };
        cell.corners.into_iter().any(is_far)
    }

    /// The record of a cell that f32 can draw; `None` if it cannot.
    #[inline(always)]
    fn record(&self, cell: &Cell) -> Option<CellRecord> {
        let &Cell { corners: [a, b, c, d], scalars, is_positive, outline, pieces } = cell;
        let is_perspective = self.space.is_perspective;
        let nearest = a.z.min(b.z).min(c.z).min(d.z);
        let farthest = a.z.max(b.z).max(c.z).max(d.z);
        if nearest <= if is_perspective { NEAR * farthest } else { 0.0 } {
            return None;
        }
        if self.is_magnified(cell) {
            return None;
        }
        // Outward normals, and what they make of the edge from the first corner.
        let sign = if is_positive { 1.0 } else { -1.0 };
        let (ab, ac, ad) = ((b - a) * sign, c - a, d - a);
        let n1 = -ac.cross(ad) * sign;
        let n2 = ab.cross(ad);
        let n3 = -ab.cross(ac);
        let n0 = -(n1 + n2 + n3);
        let six_volume = -n1.dot(b - a);
        // Where the volume is next to nothing for such edges, normals are rounding, and other roundings give another cell.
        let deep = if is_perspective { 1.0 / self.space.slope[0] } else { 1.0 };
        let squared = |edge: DVec3| edge.x * edge.x + edge.y * edge.y + edge.z * edge.z * (deep * deep);
        let largest = (squared(ab) * squared(ac) * squared(ad)).sqrt();
        if !(six_volume * deep > FLAT * largest && six_volume.is_finite()) {
            return None;
        }

        let [x0, x1, y0, y1] = outline.map(u32::from);
        let pixel = [(x0 + x1) / 2, (y0 + y1) / 2];
        let [u, w] =
            [PixelSpace::center(pixel[0], self.space.size[0]), PixelSpace::center(pixel[1], self.space.size[1])];
        let depth = (a.z + b.z + c.z + d.z) * 0.25;
        let (reference, across) =
            if is_perspective { (DVec3::new(u, w, 1.0) * depth, depth) } else { (DVec3::new(u, w, depth), 1.0) };
        let nearness_range = if is_perspective {
            [depth / farthest - 1.0, depth / nearest - 1.0]
        } else {
            [depth - farthest, depth - nearest]
        };
        let limit = STEEP * (nearness_range[1] - nearness_range[0]);
        let half = [f64::from(x1 - x0) * 0.5 + 4.0, f64::from(y1 - y0) * 0.5 + 4.0];

        let from_b = reference - b;
        let from_a = reference - a;
        let mut planes = [[0.0_f32; 3]; 4];
        let (mut entry, mut exit) = (0, 3);
        for (normal, point, from) in [(n0, b, from_b), (n1, a, from_a), (n2, a, from_a), (n3, a, from_a)] {
            let away = if is_perspective { normal.dot(point) } else { normal.z };
            let inverse = 1.0 / away;
            let plane = [normal.dot(from) * inverse, normal.x * across * inverse, normal.y * across * inverse];
            let steepness = plane[0].abs() + plane[1].abs() * half[0] + plane[2].abs() * half[1];
            // NaN where a face is seen exactly edge-on.
            if steepness > limit || steepness.is_nan() {
                return None;
            }
            let slot = if away < 0.0 { &mut entry } else { &mut exit };
            // Four entry faces, or none, are rounding: no ray has room between.
            if *slot > 3 {
                return None;
            }
            planes[*slot] = plane.map(|x| x as f32);
            if away < 0.0 { entry += 1 } else { exit = exit.wrapping_sub(1) }
        }
        if entry == 0 || entry == 4 {
            return None;
        }

        let gradient =
            -(n1 * (scalars[1] - scalars[0]) + n2 * (scalars[2] - scalars[0]) + n3 * (scalars[3] - scalars[0]))
                / six_volume;
        let scalar_reference = scalars[0] + gradient.dot(from_a);
        let low = scalars.iter().fold(f64::INFINITY, |m, &s| m.min(s));
        let high = scalars.iter().fold(f64::NEG_INFINITY, |m, &s| m.max(s));
        let along = if is_perspective { gradient.dot(reference) } else { gradient.z };
        let scalar = [gradient.x * across, gradient.y * across, along];
        let scalar_limit = STEEP * (high - low);
        if !(scalar[0].abs() * half[0] + scalar[1].abs() * half[1] <= scalar_limit
            && along.abs() * (nearness_range[1] - nearness_range[0]) <= scalar_limit)
        {
            return None;
        }
        Some(CellRecord {
            planes,
            scalar: scalar.map(|x| x as f32),
            nearness_range: nearness_range.map(|x| x as f32),
            scalar_range: [(low - scalar_reference) as f32, (high - scalar_reference) as f32],
            scalar_reference,
            length: self.space.world_per_depth * across,
            pixel: pixel.map(|p| p as u16),
            outline,
            pieces,
            entry_count: entry as u32,
            careful: 0,
            effects: NO_EFFECTS,
            depth: (depth - self.space.start) as f32,
        })
    }

    fn careful_record(&self, cell: &Cell, careful: usize) -> CellRecord {
        let &Cell { scalars, outline, pieces, .. } = cell;
        let low = scalars.iter().fold(f64::INFINITY, |m, &s| m.min(s));
        let high = scalars.iter().fold(f64::NEG_INFINITY, |m, &s| m.max(s));
        CellRecord {
            planes: [[0.0; 3]; 4],
            scalar: [0.0; 3],
            nearness_range: [0.0; 2],
            scalar_range: [0.0, (high - low) as f32],
            scalar_reference: low,
            length: self.space.world_per_depth,
            pixel: [outline[0].midpoint(outline[1]), outline[2].midpoint(outline[3])],
            outline,
            pieces,
            entry_count: 0,
            careful: careful as u32,
            effects: NO_EFFECTS,
            depth: 0.0,
        }
    }
}
