//! What a plan asks for on a mesh, foreseen without drawing: to be said before, and to be compared with what was done.

mod fragments;

use tetrascope_integrate::{Integration, IsosurfaceError, LengthAxis, SurfaceShading};
use tetrascope_mesh::{TetMesh, VertexId, scalar_factor, scalar_range};
use tetrascope_order::{CycleRemedy, PixelSort};

pub use fragments::Fragments;

use crate::{
    Backend, BufferRole, Counts, Gradients, Interpolation, IsosurfaceMethod, Mixing, Plan, Rendered, Sharpness, Shown,
    Stage,
};

/// What a plan asks of its back end on a mesh.
///
/// Counts are exact unless they say otherwise; nothing is timed, and nothing is drawn to know them.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// Who is to do it.
    pub backend: Backend,
    /// Pixels of the picture.
    pub pixels: u64,
    /// Tetrahedra of the mesh.
    pub cells: u64,
    /// Points of the mesh.
    pub points: u64,
    /// Tetrahedra that are left out since the transfer function and the isosurfaces show nothing in them, whatever the view is; 0 for the
    /// back end `reference`, which looks at all.
    pub transparent: u64,
    /// Of the others, those that lie outside of the view as a whole: a back end leaves out these, and those that fall between pixels.
    pub outside: u64,
    /// Whether a visibility order sorts the cells.
    pub sorts_cells: bool,
    /// Whether the transfer function may change so fast, or cells be so dense, that they are drawn in 64 bits, see [`Sharpness`].
    pub may_be_sharp: bool,
    /// What pixels sort by themselves.
    pub pixel_sort: PixelSort,
    /// Whether pixels also sort where cells hide one another in rings, should the order find some.
    pub sorts_rings: bool,
    /// The table of the integration.
    pub table: Option<TableWork>,
    /// The maps of the isosurfaces.
    pub maps: Option<MapWork>,
    /// Isosurfaces that are to be seen.
    pub surfaces: u64,
    /// Gradients that the light needs.
    pub gradients: Gradients,
    /// Whether the volume is lit.
    pub lights_volume: bool,
    /// Whether cells become fans of triangles for the integration.
    pub makes_fans: bool,
    /// Pairs of a pixel and a cell, estimated.
    pub fragments: Fragments,
    /// The stages that run, in their order, as [`Rendered::timings`] will have them.
    pub stages: Vec<Stage>,
    /// Memory, by what it is for.
    pub buffers: Vec<WorkBuffer>,
}

/// A table that is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableWork {
    /// Samples along each axis of scalars.
    pub scalars: u32,
    /// Samples along the axis of lengths; `None` for a table of two dimensions.
    pub lengths: Option<u32>,
    /// How those are spaced.
    pub length_axis: LengthAxis,
}

/// Maps of isosurfaces that are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapWork {
    /// One, or two where surfaces are looked up at the front and at the back faces.
    pub count: u32,
    /// Texels along each side.
    pub size: u32,
}

/// Memory that is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorkBuffer {
    /// What is in it: of the back end `gpu` as [`crate::DeviceReport`] calls it.
    pub label: &'static str,
    /// What it is kept for.
    pub role: BufferRole,
    /// How much.
    pub bytes: Bytes,
}

/// An amount of memory, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bytes {
    /// So many.
    Exact(u64),
    /// Not more, unless cells are cut into pieces.
    AtMost(u64),
    /// Not fewer.
    AtLeast(u64),
    /// About as many.
    About(u64),
}

/// Bytes of an entry of a table or a map: red, green, blue and opacity in 32 bits each.
const ENTRY: u64 = 16;

impl TableWork {
    /// Number of entries.
    pub fn entries(&self) -> u64 {
        u64::from(self.scalars).pow(2) * u64::from(self.lengths.unwrap_or(1))
    }

    /// Bytes.
    pub fn bytes(&self) -> u64 {
        self.entries() * ENTRY
    }
}

impl MapWork {
    /// Number of texels of all maps.
    pub fn entries(&self) -> u64 {
        u64::from(self.count) * u64::from(self.size).pow(2)
    }

    /// Bytes.
    pub fn bytes(&self) -> u64 {
        self.entries() * ENTRY
    }
}

impl Bytes {
    /// The number of bytes.
    pub const fn number(self) -> u64 {
        match self {
            Self::Exact(bytes) | Self::AtMost(bytes) | Self::AtLeast(bytes) | Self::About(bytes) => bytes,
        }
    }

    /// Whether so many bytes are what was foreseen; of [`Self::About`] any number is.
    pub const fn allows(self, found: u64) -> bool {
        match self {
            Self::Exact(bytes) => found == bytes,
            Self::AtMost(bytes) => found <= bytes,
            Self::AtLeast(bytes) => found >= bytes,
            Self::About(_) => true,
        }
    }
}

impl Work {
    /// What a plan asks for.
    ///
    /// - `scalars`: one a point of the mesh, finite where a tetrahedron uses it
    ///
    /// Looks at every cell once, and at no pixel.
    ///
    /// # Errors
    /// [`IsosurfaceError`] for maps of no possible size.
    pub fn of(plan: &Plan, mesh: &TetMesh, scalars: &[f64]) -> Result<Self, IsosurfaceError> {
        let range = scalar_range(mesh.tetrahedra(), scalars);
        let factor = scalar_factor(range);
        let shown = Shown::of(plan, factor, range.map(|scalar| scalar * factor))?;
        let is_reference = plan.backend == Backend::Reference;
        let shows = |cell: &[VertexId; 4]| {
            let values = cell.map(|v| scalars[v.index()] * factor);
            let (low, high) =
                values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &s| (low.min(s), high.max(s)));
            is_reference || shown.shows(low, high)
        };
        let seen: Vec<[VertexId; 4]> = mesh.tetrahedra().iter().copied().filter(shows).collect();
        let cells = mesh.tetrahedra().len() as u64;
        let (outside, fragments) = fragments::survey(&plan.view, mesh, &seen);

        let surfaces = shown.surfaces();
        let table = plan.table_settings().map(|settings| TableWork {
            scalars: settings.scalars,
            lengths: (plan.integration == Integration::Table3d).then_some(settings.lengths),
            length_axis: settings.length_axis,
        });
        let method = plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.method);
        let maps = match method {
            // The reference cuts rays where others look surfaces up.
            Some(IsosurfaceMethod::Map { size, mixing }) if !surfaces.is_empty() && !is_reference => {
                let is_one = mixing == Mixing::Stopped && surfaces.shading() != SurfaceShading::Smooth;
                Some(MapWork { count: if is_one { 1 } else { 2 }, size })
            }
            _ => None,
        };
        let mut work = Self {
            backend: plan.backend,
            pixels: u64::from(plan.view.width) * u64::from(plan.view.height),
            cells,
            points: mesh.positions().len() as u64,
            transparent: cells - seen.len() as u64,
            outside,
            sorts_cells: !is_reference && plan.order.sorts_cells(),
            may_be_sharp: plan.backend == Backend::Cpu && {
                // Local coordinates are at most 1 long, so that no chord is longer than 2.
                let longest = 2.0 * mesh.frame().scale;
                let densest = plan.transfer.max_extinction(f64::NEG_INFINITY, f64::INFINITY);
                Sharpness::new(&plan.transfer, plan.model).may_be_beyond_32_bits(longest)
                    || Sharpness::is_chord_beyond_32_bits(densest, longest)
            },
            pixel_sort: if is_reference { PixelSort::All } else { plan.order.pixel_sort() },
            sorts_rings: !is_reference && plan.cycles != CycleRemedy::Report && plan.order.sorts_cells(),
            table,
            maps,
            surfaces: surfaces.as_slice().len() as u64,
            gradients: plan.gradients(),
            lights_volume: plan.lighting.is_some_and(|lighting| lighting.volume),
            makes_fans: !is_reference && (plan.integration.needs_fan() || plan.interpolation != Interpolation::Exact),
            fragments,
            stages: Vec::new(),
            buffers: Vec::new(),
        };
        work.stages = work.stages_of();
        work.buffers = match plan.backend {
            Backend::Cpu => work.on_cpu(),
            Backend::Reference => work.on_reference(),
            Backend::Gpu => work.on_gpu(),
        };
        Ok(work)
    }

    /// Tetrahedra that show something and are not known to lie outside of the view.
    pub fn drawn_at_most(&self) -> u64 {
        self.cells - self.transparent - self.outside
    }

    fn stages_of(&self) -> Vec<Stage> {
        let all: &[Stage] = match self.backend {
            Backend::Cpu => &[
                Stage::Prepare,
                Stage::Tabulate,
                Stage::Transform,
                Stage::Order,
                Stage::SetUp,
                Stage::Bin,
                Stage::Rasterize,
            ],
            Backend::Reference => &[Stage::Tabulate, Stage::Prepare, Stage::Transform, Stage::Bin, Stage::Rasterize],
            // What it does in between it does on the device.
            Backend::Gpu => &[Stage::Prepare, Stage::Tabulate, Stage::Order, Stage::Rasterize],
        };
        all.iter().copied().filter(|stage| *stage != Stage::Tabulate || self.table.is_some()).collect()
    }

    /// Memory of tables and maps, of which entries are the same in every back end.
    fn lookups(&self) -> Vec<WorkBuffer> {
        let buffer = |label, bytes| WorkBuffer { label, role: BufferRole::Lookup, bytes: Bytes::Exact(bytes) };
        let table = self.table.map(|table| buffer("table", table.bytes()));
        table.into_iter().chain(self.maps.map(|maps| buffer("maps of isosurfaces", maps.bytes()))).collect()
    }

    fn on_cpu(&self) -> Vec<WorkBuffer> {
        let (cells, points, shown) = (self.cells, self.points, self.cells - self.transparent);
        let buffer = |label, role, bytes| WorkBuffer { label, role, bytes };
        let mut all = vec![
            // Four points and a sign; a position and a scalar.
            buffer("cells", BufferRole::Mesh, Bytes::Exact(17 * cells)),
            buffer("points", BufferRole::Mesh, Bytes::Exact(32 * points)),
            // Where the pieces of a cell begin, how many there are, and whether it shows anything; the cells that do.
            buffer("transfer function", BufferRole::Lookup, Bytes::Exact(9 * cells + 4 * shown)),
        ];
        if self.gradients == Gradients::Points {
            all.push(buffer("gradients", BufferRole::Mesh, Bytes::Exact(24 * points)));
        }
        all.extend(self.lookups());
        if self.sorts_cells {
            // The cells before and after; what the order knows of the mesh comes to it.
            all.push(buffer("order", BufferRole::Order, Bytes::About(8 * self.drawn_at_most())));
        }
        all.push(buffer("points in view", BufferRole::Frame, Bytes::Exact(32 * points)));
        all.push(buffer("outlines", BufferRole::Frame, Bytes::Exact(8 * cells)));
        let record = if self.may_be_sharp { Bytes::About } else { Bytes::AtMost };
        // With the cell itself where it is drawn in 64 bits; cells at the eye or seen edge-on are few.
        let bytes = if self.may_be_sharp { 128 + 384 } else { 128 };
        all.push(buffer("cells set up", BufferRole::Frame, record(bytes * self.drawn_at_most())));
        if self.makes_fans {
            all.push(buffer("fans", BufferRole::Frame, Bytes::About(232 * self.drawn_at_most())));
        }
        if self.surfaces > 0 || self.lights_volume {
            // Which surfaces may cut a cell, and its gradient, or two.
            let gradient = if self.gradients == Gradients::None { 0 } else { 84 };
            let bytes = Bytes::About((12 + gradient) * self.drawn_at_most());
            all.push(buffer("effects of cells", BufferRole::Frame, bytes));
        }
        // Tiles, and the picture.
        all.push(buffer("picture", BufferRole::Frame, Bytes::About((24 + 16) * self.pixels)));
        all
    }

    fn on_reference(&self) -> Vec<WorkBuffer> {
        let buffer = |label, role, bytes| WorkBuffer { label, role, bytes };
        let mut all = vec![
            buffer("cells", BufferRole::Mesh, Bytes::Exact(16 * self.cells)),
            buffer("points in view", BufferRole::Frame, Bytes::Exact(32 * self.points)),
        ];
        if self.gradients == Gradients::Points {
            all.push(buffer("gradients", BufferRole::Mesh, Bytes::Exact(24 * self.points)));
        }
        all.extend(self.lookups());
        all.push(buffer("picture", BufferRole::Frame, Bytes::About(32 * self.pixels)));
        all
    }

    fn on_gpu(&self) -> Vec<WorkBuffer> {
        let buffer = |label, role, bytes| WorkBuffer { label, role, bytes };
        let (table, maps) = (self.table.map_or(0, |t| t.bytes()), self.maps.map_or(0, |m| m.bytes()));
        let mut all = vec![
            buffer("cells", BufferRole::Mesh, Bytes::Exact(20 * self.cells)),
            // On the lattice, and as a view has them.
            buffer("points", BufferRole::Mesh, Bytes::Exact(32 * self.points)),
            // The table lies with the pieces of the transfer function.
            buffer("transfer function", BufferRole::Lookup, Bytes::AtLeast(table)),
            // What becomes of each cell, and where it stands.
            buffer("sorting", BufferRole::Order, Bytes::AtLeast(8 * self.cells)),
            buffer("cells in order", BufferRole::Frame, Bytes::AtMost(16 * self.cells)),
            // On the device, and on its way back.
            buffer("picture", BufferRole::Frame, Bytes::About(32 * self.pixels)),
        ];
        if self.gradients == Gradients::Points {
            all.push(buffer("gradients", BufferRole::Mesh, Bytes::Exact(16 * self.points)));
        }
        if self.surfaces > 0 || self.lights_volume {
            let bytes = Bytes::AtLeast(48 * self.surfaces + maps);
            all.push(buffer("isosurfaces and light", BufferRole::Lookup, bytes));
        }
        all
    }

    /// Where a picture took other work than this, in sentences; empty where what was done is what was foreseen and nothing else.
    ///
    /// - `rendered`: the picture of the same plan on the same mesh by a renderer that has drawn nothing else, as memory is kept from picture
    ///   to picture
    ///
    /// Counts that a back end does not make are not looked at.
    pub fn differences(&self, rendered: &Rendered) -> Vec<String> {
        let mut found = Vec::new();
        let mut check = |what: &str, is_right: bool, done: &dyn std::fmt::Debug, foreseen: &dyn std::fmt::Debug| {
            if !is_right {
                found.push(format!("{what}: {done:?} where the plan has {foreseen:?}"));
            }
        };
        let Counts { cells, transparent, outside, drawn, ordered, .. } = rendered.counts;
        let counts = &rendered.counts;
        let none = |allowed: bool, number: u64| allowed || number == 0;
        check("cells", cells == self.cells, &cells, &self.cells);
        // The device rounds scalars to its lattice.
        let lattice = if self.backend == Backend::Gpu { self.cells / 1000 } else { 0 };
        let is_near = transparent.abs_diff(self.transparent) <= lattice;
        check("transparent cells", is_near, &transparent, &self.transparent);
        check("cells out of view", outside + lattice >= self.outside, &outside, &self.outside);
        let shown = cells - transparent - outside;
        let orders_right = if self.sorts_cells { ordered >= shown } else { ordered == 0 };
        check("cells in order", orders_right, &ordered, &self.sorts_cells);
        let table = self.table.map_or(0, |table| table.entries());
        check("entries of the table", counts.table_entries == table, &counts.table_entries, &table);
        let maps = self.maps.map_or(0, |maps| maps.entries());
        check("texels of maps", counts.map_entries == maps, &counts.map_entries, &maps);
        let points = if self.gradients == Gradients::Points { self.points } else { 0 };
        check("gradients of points", counts.point_gradients == points, &counts.point_gradients, &points);
        let is_lit = self.gradients != Gradients::None;
        let has_effects = self.surfaces > 0 || self.lights_volume;
        let of_cells = counts.cell_gradients.unwrap_or_default();
        check("gradients of cells", none(is_lit, of_cells), &of_cells, &self.gradients);
        let with_effects = counts.with_effects.unwrap_or_default();
        check("cells with effects", none(has_effects, with_effects), &with_effects, &has_effects);
        if self.lights_volume && counts.with_effects.is_some() {
            check("cells whose volume is lit", with_effects == drawn, &with_effects, &drawn);
        }
        let lit = counts.lit.unwrap_or_default();
        check("fragments that are lit", none(is_lit, lit), &lit, &self.gradients);
        check("crossings", none(self.surfaces > 0, counts.crossings), &counts.crossings, &self.surfaces);
        check("fans", none(self.makes_fans, counts.fans), &counts.fans, &self.makes_fans);
        let may_sort = self.pixel_sort != PixelSort::None || self.sorts_rings && rendered.order.rings > 0;
        check("fragments sorted by pixels", none(may_sort, counts.sorted), &counts.sorted, &self.pixel_sort);
        let stages: Vec<Stage> = rendered.timings.iter().map(|(stage, _)| *stage).collect();
        check("stages", stages == self.stages, &stages, &self.stages);
        if let Some(device) = &rendered.device {
            for buffer in &self.buffers {
                let bytes: u64 = device.buffers.iter().filter(|b| b.label == buffer.label).map(|b| b.bytes).sum();
                check(buffer.label, buffer.bytes.allows(bytes), &bytes, &buffer.bytes);
            }
            // What is not foreseen must not be there, but for what frames and orders need besides.
            let is_foreseen = |label: &str| self.buffers.iter().any(|buffer| buffer.label == label);
            for made in device.buffers.iter().filter(|made| matches!(made.role, BufferRole::Mesh | BufferRole::Lookup))
            {
                check("memory", is_foreseen(&made.label), made, &"nothing of it");
            }
        }
        found
    }
}

#[cfg(test)]
mod tests;
