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
    /// Whether two rectangles of one sheet have a point in common.
    #[inline]
    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..2).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

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

    /// Gives a rectangle for every sheet that a triangle is seen through.
    pub(super) fn project(&self, points: &[DVec3; 3], mut sink: impl FnMut(Rectangle)) {
        match *self {
            Self::Plane { axes, margin } => {
                let seen = points.iter().map(|p| axes.map(|axis| axis.dot(*p)));
                sink(Rectangle::around(seen, 0, true).widened(margin));
            }
            Self::Cube(eye) => {
                let relative = points.map(|p| p - eye);
                for sheet in 0..SHEETS {
                    let Some(rectangle) = seen_through(sheet, &relative) else { continue };
                    sink(rectangle);
                    if rectangle.is_whole {
                        break;
                    }
                }
            }
        }
    }
}

/// What is seen of a triangle, relative to the eye, through one face of the cube.
fn seen_through(sheet: usize, points: &[DVec3; 3]) -> Option<Rectangle> {
    let axis = sheet / 2;
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let facing = if sheet.is_multiple_of(2) { 1.0 } else { -1.0 };
    // Depth last; what lies in the pyramid |x|, |y| <= z is seen.
    let own = points.map(|p| DVec3::new(p[u], p[v], facing * p[axis]));
    if own.iter().all(|p| p.z <= 0.0) {
        return None;
    }
    if own.iter().all(|p| p.x.abs().max(p.y.abs()) <= p.z && p.z > 0.0) {
        return Some(Rectangle::around(own.iter().map(|p| [p.x / p.z, p.y / p.z]), sheet, true).widened(MARGIN));
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
        return Some(Rectangle { sheet: sheet as u8, is_whole: false, low: [-2.0; 2], high: [2.0; 2] });
    }
    let seen = polygon.iter().map(|p| [p.x / p.z, p.y / p.z]);
    Some(Rectangle::around(seen, sheet, false).widened(CLIPPED_MARGIN))
}

/// Tiles over one sheet, each with the rectangles that meet it.
#[derive(Clone, Debug)]
pub(super) struct Tiles {
    low: [f64; 2],
    per_length: [f64; 2],
    side: usize,
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Tiles {
    /// Tiles over rectangles of one sheet; tiles keep the order of `rectangles`. At most about eight places a
    /// rectangle.
    pub(super) fn new(rectangles: &[Rectangle]) -> Self {
        let empty = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (low, high) = rectangles.iter().fold(empty, |(low, high), r| {
            ([low[0].min(r.low[0]), low[1].min(r.low[1])], [high[0].max(r.high[0]), high[1].max(r.high[1])])
        });
        let mut tiles = Self {
            low,
            per_length: [0.0; 2],
            side: (rectangles.len() as f64).sqrt().ceil() as usize,
            starts: Vec::new(),
            members: Vec::new(),
        };
        let most = 8 * rectangles.len();
        loop {
            let side = tiles.side as f64;
            tiles.per_length = [0, 1].map(|i| side / (high[i] - low[i]).max(f64::MIN_POSITIVE));
            let places: usize = rectangles
                .iter()
                .map(|r| {
                    let [columns, rows] = tiles.covered(r);
                    (columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1)
                })
                .sum();
            if places <= most || tiles.side <= 1 {
                break;
            }
            tiles.side /= 2;
        }
        tiles.fill(rectangles);
        tiles
    }

    fn fill(&mut self, rectangles: &[Rectangle]) {
        let mut starts = vec![0_u32; self.side * self.side + 1];
        for rectangle in rectangles {
            self.each(rectangle, |tile| starts[tile + 1] += 1);
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut members = vec![0; starts.last().map_or(0, |&end| end as usize)];
        let mut next = starts.clone();
        for (index, rectangle) in rectangles.iter().enumerate() {
            self.each(rectangle, |tile| {
                members[next[tile] as usize] = index as u32;
                next[tile] += 1;
            });
        }
        (self.starts, self.members) = (starts, members);
    }

    /// First and last column and row; what lies outside belongs to the outermost tiles.
    fn covered(&self, rectangle: &Rectangle) -> [[usize; 2]; 2] {
        [0, 1].map(|i| {
            // A conversion from float to integer saturates.
            [rectangle.low[i], rectangle.high[i]]
                .map(|x| (((x - self.low[i]) * self.per_length[i]) as usize).min(self.side.max(1) - 1))
        })
    }

    fn each(&self, rectangle: &Rectangle, mut visit: impl FnMut(usize)) {
        let [columns, rows] = self.covered(rectangle);
        for row in rows[0]..=rows[1] {
            for column in columns[0]..=columns[1] {
                visit(row * self.side + column);
            }
        }
    }

    /// The number of rectangles in the tiles that a rectangle meets, some of them more than once.
    pub(super) fn candidates(&self, rectangle: &Rectangle) -> usize {
        let mut count = 0;
        if !self.members.is_empty() {
            self.each(rectangle, |tile| count += (self.starts[tile + 1] - self.starts[tile]) as usize);
        }
        count
    }

    /// Visits the members (indices into the rectangles that the tiles were made of) that meet a rectangle, each once.
    ///
    /// - `goes_on`: whether this member of a tile, and those after it, are wanted
    pub(super) fn meeting(
        &self,
        rectangles: &[Rectangle],
        rectangle: &Rectangle,
        goes_on: impl Fn(u32) -> bool,
        mut visit: impl FnMut(u32),
    ) {
        if self.members.is_empty() {
            return;
        }
        let [columns, rows] = self.covered(rectangle);
        self.each(rectangle, |tile| {
            let (row, column) = (tile / self.side, tile % self.side);
            let members = &self.members[self.starts[tile] as usize..self.starts[tile + 1] as usize];
            for &member in members.iter().take_while(|&&member| goes_on(member)) {
                let other = &rectangles[member as usize];
                if !rectangle.meets(other) {
                    continue;
                }
                // Both are in every tile that they share; the first of these is the one that counts.
                let [other_columns, other_rows] = self.covered(other);
                if column == columns[0].max(other_columns[0]) && row == rows[0].max(other_rows[0]) {
                    visit(member);
                }
            }
        });
    }
}
