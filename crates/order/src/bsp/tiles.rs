//! Faces sorted into tiles of what the eye sees, so that only near ones are compared.

use glam::DVec3;
use tetrascope_view::Viewpoint;

/// The faces of a cube about the eye that a triangle is seen through, or the one plane of a parallel view.
const SHEETS: usize = 6;

/// A rectangle that holds what is seen of a triangle through one sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub(super) sheet: u8,
    /// Whether the whole triangle is seen through this sheet.
    pub(super) is_whole: bool,
    low: [f64; 2],
    high: [f64; 2],
}

impl Rectangle {
    /// Adds a margin for rounding, relative to the sheet's extent.
    fn widened(mut self, margin: f64) -> Self {
        for i in 0..2 {
            self.low[i] -= margin;
            self.high[i] += margin;
        }
        self
    }

    fn around(points: impl Iterator<Item = [f64; 2]>, sheet: usize, is_whole: bool) -> Self {
        let empty = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (low, high) = points.fold(empty, |(low, high), p| {
            ([low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])])
        });
        Self { sheet: sheet as u8, is_whole, low, high }
    }
}

/// How triangles come onto sheets.
#[derive(Clone, Copy, Debug)]
pub(super) enum Sheets {
    /// The six faces of a cube about the eye, each with coordinates from -1 to 1.
    Cube(DVec3),
    /// A plane across the direction, with the coordinates along two axes, and a margin for their rounding.
    Plane { axes: [DVec3; 2], margin: f64 },
}

/// Rounding of a quotient of two differences, and a little more.
const MARGIN: f64 = 1e-14;

/// The same without the little more: three roundings of a number up to 1.
const QUOTIENT_ROUNDING: f64 = 4.5e-16;

/// The same where the triangle was clipped: up to 1e-15 of its size, at a depth of [`NEAREST`] of its size or more.
const CLIPPED_MARGIN: f64 = 1e-8;
const NEAREST: f64 = 1e-6;

impl Sheets {
    /// - `largest`: the largest coordinate of the triangles that will come
    pub(super) fn new(viewpoint: Viewpoint, largest: f64) -> Self {
        match viewpoint {
            Viewpoint::Eye(eye) => Self::Cube(eye),
            Viewpoint::Direction(direction) => {
                // Any two axes across do, they need not have length 1.
                let across = if direction.x.abs() < 0.6 { DVec3::X } else { DVec3::Y }.cross(direction);
                Self::Plane { axes: [across, direction.cross(across)], margin: MARGIN * largest }
            }
        }
    }

    /// Whether a sheet shows the world in a mirror.
    pub(super) fn is_mirror(sheet: u8) -> bool {
        !sheet.is_multiple_of(2)
    }

    /// How far rounding moves a coordinate of what is seen whole.
    pub(super) fn rounding(&self) -> f64 {
        match *self {
            Self::Cube(_) => QUOTIENT_ROUNDING,
            Self::Plane { margin, .. } => margin,
        }
    }

    /// Gives a rectangle for every sheet that a triangle is seen through, and the triangle itself where it is seen whole.
    ///
    pub(super) fn project(&self, points: &[DVec3; 3], mut sink: impl FnMut(Rectangle, [[f64; 2]; 3])) {
        match *self {
            Self::Plane { axes, margin } => {
                let seen = points.map(|p| axes.map(|axis| axis.dot(p)));
                sink(Rectangle::around(seen.into_iter(), 0, true).widened(margin), seen);
            }
            Self::Cube(eye) => {
                let relative = points.map(|p| p - eye);
                for sheet in 0..SHEETS {
                    let Some((rectangle, seen)) = seen_through(sheet, &relative) else { continue };
                    sink(rectangle, seen);
                    if rectangle.is_whole {
                        break;
                    }
                }
            }
        }
    }
}

/// What is seen of a triangle, relative to the eye, through one face of the cube; its corners count where all are seen.
fn seen_through(sheet: usize, points: &[DVec3; 3]) -> Option<(Rectangle, [[f64; 2]; 3])> {
    let axis = sheet / 2;
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let facing = if sheet.is_multiple_of(2) { 1.0 } else { -1.0 };
    // Depth last; what lies in the pyramid |x|, |y| <= z is seen.
    let own = points.map(|p| DVec3::new(p[u], p[v], facing * p[axis]));
    if own.iter().all(|p| p.z <= 0.0) {
        return None;
    }
    if own.iter().all(|p| p.x.abs().max(p.y.abs()) <= p.z && p.z > 0.0) {
        let seen = own.map(|p| [p.x / p.z, p.y / p.z]);
        return Some((Rectangle::around(seen.into_iter(), sheet, true).widened(MARGIN), seen));
    }
    // A little wider, so that rounding loses nothing at the cube's edges.
    let wide = 1.0 + CLIPPED_MARGIN;
    let inside = |p: DVec3, (i, sign): (usize, f64)| wide * p.z - sign * p[i];
    let edges = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
    if edges.iter().any(|&edge| own.iter().all(|&p| inside(p, edge) < 0.0)) {
        return None;
    }
    let mut polygon = own.to_vec();
    for edge in edges {
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        for (k, &p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            let (a, b) = (inside(p, edge), inside(q, edge));
            if a >= 0.0 {
                clipped.push(p);
            }
            if (a >= 0.0) != (b >= 0.0) {
                clipped.push(p.lerp(q, a / (a - b)));
            }
        }
        polygon = clipped;
    }
    if polygon.is_empty() {
        return None;
    }
    let size = own.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if polygon.iter().any(|p| p.z < NEAREST * size) {
        // So near the eye that its quotients say nothing.
        return Some((
            Rectangle { sheet: sheet as u8, is_whole: false, low: [-2.0; 2], high: [2.0; 2] },
            [[0.0; 2]; 3],
        ));
    }
    let seen = polygon.iter().map(|p| [p.x / p.z, p.y / p.z]);
    Some((Rectangle::around(seen, sheet, false).widened(CLIPPED_MARGIN), [[0.0; 2]; 3]))
}

/// Tiles over one sheet, each with the rectangles that meet it.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    low: [f64; 2],
    per_length: [f64; 2],
    side: usize,
    starts: Vec<u32>,
    members: Vec<Member>,
}

/// A rectangle in units of tiles. Every step there keeps the order of coordinates, so that what meets still meets.
#[derive(Clone, Copy, Debug, Default)]
struct Bounds {
    low: [f32; 2],
    high: [f32; 2],
}

/// What a tile knows of a rectangle, side by side for all of a tile.
#[derive(Clone, Copy, Debug, Default)]
struct Member {
    bounds: Bounds,
    rank: u32,
    index: u32,
}

impl Bounds {
    /// First and last column and row; what lies outside belongs to the outermost tiles.
    #[inline]
    fn covered(&self, side: usize) -> [[usize; 2]; 2] {
        // A conversion from float to integer saturates.
        [0, 1].map(|i| [self.low[i], self.high[i]].map(|x| (x as usize).min(side.max(1) - 1)))
    }

    #[inline]
    fn meets(&self, other: &Self) -> bool {
        (self.low[0] <= other.high[0])
            & (other.low[0] <= self.high[0])
            & (self.low[1] <= other.high[1])
            & (other.low[1] <= self.high[1])
    }
}

impl Tiles {
    /// Tiles over rectangles of one sheet, each with a rank; they come with the highest first. At most about eight places a
    /// rectangle.
    pub(super) fn new(ranked: &[(Rectangle, u32)]) -> Self {
        let empty = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (low, high) = ranked.iter().fold(empty, |(low, high), (r, _)| {
            ([low[0].min(r.low[0]), low[1].min(r.low[1])], [high[0].max(r.high[0]), high[1].max(r.high[1])])
        });
        let mut tiles = Self {
            low,
            per_length: [0.0; 2],
            side: (ranked.len() as f64).sqrt().ceil() as usize,
            starts: Vec::new(),
            members: Vec::new(),
        };
        let most = 8 * ranked.len();
        loop {
            let side = tiles.side as f64;
            tiles.per_length = [0, 1].map(|i| side / (high[i] - low[i]).max(f64::MIN_POSITIVE));
            let places: usize = ranked
                .iter()
                .map(|(rectangle, _)| {
                    let [columns, rows] = tiles.bounds(rectangle).covered(tiles.side);
                    (columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1)
                })
                .sum();
            if places <= most || tiles.side <= 1 {
                break;
            }
            tiles.side /= 2;
        }
        tiles.fill(ranked);
        tiles
    }

    fn fill(&mut self, ranked: &[(Rectangle, u32)]) {
        let mut starts = vec![0_u32; self.side * self.side + 1];
        for (rectangle, _) in ranked {
            self.each(&self.bounds(rectangle), |tile, _| starts[tile + 1] += 1);
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut members = vec![Member::default(); starts.last().map_or(0, |&end| end as usize)];
        let mut next = starts.clone();
        for (index, &(rectangle, rank)) in ranked.iter().enumerate() {
            let bounds = self.bounds(&rectangle);
            self.each(&bounds, |tile, _| {
                members[next[tile] as usize] = Member { bounds, rank, index: index as u32 };
                next[tile] += 1;
            });
        }
        (self.starts, self.members) = (starts, members);
    }

    #[inline]
    fn bounds(&self, rectangle: &Rectangle) -> Bounds {
        let unit = |at: [f64; 2]| [0, 1].map(|i| ((at[i] - self.low[i]) * self.per_length[i]) as f32);
        Bounds { low: unit(rectangle.low), high: unit(rectangle.high) }
    }

    #[inline]
    fn each(&self, bounds: &Bounds, mut visit: impl FnMut(usize, [usize; 2])) {
        let [columns, rows] = bounds.covered(self.side);
        for row in rows[0]..=rows[1] {
            for column in columns[0]..=columns[1] {
                visit(row * self.side + column, [column, row]);
            }
        }
    }

    /// The number of rectangles in the tiles that a rectangle meets, some of them more than once.
    pub(super) fn candidates(&self, rectangle: &Rectangle) -> usize {
        let mut count = 0;
        if !self.members.is_empty() {
            self.each(&self.bounds(rectangle), |tile, _| {
                count += (self.starts[tile + 1] - self.starts[tile]) as usize;
            });
        }
        count
    }

    /// Visits the members (indices into the rectangles that the tiles were made of) that meet a rectangle, each once.
    ///
    /// - `lowest`: the lowest rank that is wanted
    #[inline]
    pub(super) fn meeting(&self, rectangle: &Rectangle, lowest: u32, mut visit: impl FnMut(u32)) {
        if self.members.is_empty() {
            return;
        }
        let bounds = self.bounds(rectangle);
        let [columns, rows] = bounds.covered(self.side);
        self.each(&bounds, |tile, [column, row]| {
            for member in &self.members[self.starts[tile] as usize..self.starts[tile + 1] as usize] {
                if member.rank < lowest {
                    break;
                }
                if !bounds.meets(&member.bounds) {
                    continue;
                }
                // Both are in every tile that they share; the first of these is the one that counts.
                let [other_columns, other_rows] = member.bounds.covered(self.side);
                if column == columns[0].max(other_columns[0]) && row == rows[0].max(other_rows[0]) {
                    visit(member.index);
                }
            }
        });
    }
}
