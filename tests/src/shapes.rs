//! Meshes for visibility orders: what is convex, what has holes, cavities, several parts; Delaunay and not.
//!
//! Most are triangulations of the plane, made by `spade`, that are drawn up into layers of prisms and cut into tetrahedra; which prisms are
//! there makes the shape. Points are numbered by chance, so that the diagonals of the prisms' sides lie by chance too.

use glam::{DVec2, DVec3};
use robust::{Coord3D, insphere, orient3d};
use spade::{DelaunayTriangulation, Point2, Triangulation};

use crate::meshes::Random;
use tetrascope::mesh::VertexId;
use tetrascope::order::Cells;

/// Points and tetrahedra over them, in a cube from about -1 to 1.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// What it is.
    pub name: &'static str,
    /// Points.
    pub points: Vec<DVec3>,
    /// Four points each, either way round.
    pub tetrahedra: Vec<[VertexId; 4]>,
    /// Whether it fills a convex body.
    pub is_convex: bool,
    /// Whether no circumsphere has a point inside.
    pub is_delaunay: bool,
}

impl Shape {
    /// As orders see it.
    pub fn cells(&self) -> Cells<'_> {
        Cells { positions: &self.points, tetrahedra: &self.tetrahedra }
    }

    /// A cell's corners.
    pub fn corners(&self, cell: usize) -> [DVec3; 4] {
        self.tetrahedra[cell].map(|v| self.points[v.index()])
    }

    /// Puts another shape beside this one.
    fn add(&mut self, other: &Self, moved: impl Fn(DVec3) -> DVec3) {
        let first = self.points.len() as u32;
        self.points.extend(other.points.iter().map(|&p| moved(p)));
        self.tetrahedra.extend(other.tetrahedra.iter().map(|cell| cell.map(|v| VertexId(v.0 + first))));
    }
}

/// The Delaunay triangulation of random points in a cube, by looking at all sets of four.
pub fn delaunay(points: usize, seed: u64) -> Shape {
    let mut random = Random::new(seed);
    let points: Vec<DVec3> = (0..points).map(|_| random.point()).collect();
    let coord = |i: usize| Coord3D { x: points[i].x, y: points[i].y, z: points[i].z };
    let n = points.len();
    let mut tetrahedra = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            for c in b + 1..n {
                for d in c + 1..n {
                    let side = orient3d(coord(a), coord(b), coord(c), coord(d));
                    let is_empty = side != 0.0
                        && (0..n)
                            .filter(|e| ![a, b, c, d].contains(e))
                            .all(|e| insphere(coord(a), coord(b), coord(c), coord(d), coord(e)) * side.signum() <= 0.0);
                    if is_empty {
                        tetrahedra.push([a, b, c, d].map(|i| VertexId(i as u32)));
                    }
                }
            }
        }
    }
    Shape { name: "Delaunay", points, tetrahedra, is_convex: true, is_delaunay: true }
}

/// Prisms over the Delaunay triangulation of random points in a disk, cut along diagonals of chance.
///
/// - `is_there`: whether the prism over a triangle with this middle, in this layer, belongs to the mesh
fn prisms(layers: u32, points: usize, seed: u64, is_there: impl Fn(DVec2, u32) -> bool) -> Shape {
    let mut random = Random::new(seed);
    let mut plane = DelaunayTriangulation::<Point2<f64>>::new();
    while plane.num_vertices() < points {
        let p = random.point().truncate();
        if p.length() < 1.0 {
            plane.insert(Point2::new(p.x, p.y)).expect("a finite point");
        }
    }
    let base: Vec<DVec2> = plane.vertices().map(|v| DVec2::new(v.position().x, v.position().y)).collect();
    let count = base.len() * (layers as usize + 1);
    // Where a point of a layer stands in the list: anywhere.
    let mut numbers: Vec<u32> = (0..count as u32).collect();
    for i in (1..count).rev() {
        numbers.swap(i, (random.unit() * (i + 1) as f64) as usize);
    }
    let mut shape = Shape { points: vec![DVec3::ZERO; count], ..Shape::default() };
    let height = |layer: u32| 2.0 * f64::from(layer) / f64::from(layers) - 1.0;
    for layer in 0..=layers {
        for (i, p) in base.iter().enumerate() {
            // Bottom and top stay flat, so that a full body is convex without rounding; in between layers are bent.
            let bend = if layer == 0 || layer == layers { 0.0 } else { random.between(-0.2, 0.2) / f64::from(layers) };
            let number = numbers[i + base.len() * layer as usize];
            shape.points[number as usize] = p.extend(height(layer) + bend);
        }
    }
    for triangle in plane.inner_faces() {
        let corners = triangle.vertices().map(|v| v.fix().index());
        let middle = corners.iter().map(|&i| base[i]).sum::<DVec2>() / 3.0;
        for layer in (0..layers).filter(|&layer| is_there(middle, layer)) {
            let at = |level: u32| corners.map(|i| numbers[i + base.len() * level as usize]);
            shape.tetrahedra.extend(cut_prism(at(layer), at(layer + 1)));
        }
    }
    shape
}

/// Three tetrahedra of a prism: each side is cut through its lowest number, so that neighbors agree.
fn cut_prism(mut bottom: [u32; 3], mut top: [u32; 3]) -> [[VertexId; 4]; 3] {
    if top.iter().min() < bottom.iter().min() {
        std::mem::swap(&mut bottom, &mut top);
    }
    let first = (0..3).min_by_key(|&i| bottom[i]).unwrap_or(0);
    let [a, b, c] = [0, 1, 2].map(|i| bottom[(first + i) % 3]);
    let [d, e, f] = [0, 1, 2].map(|i| top[(first + i) % 3]);
    // The side away from the first corner has b, c, f, e.
    let rest = if b.min(f) < c.min(e) { [[a, b, c, f], [a, b, f, e]] } else { [[a, b, c, e], [a, c, f, e]] };
    [rest[0], rest[1], [a, d, e, f]].map(|cell| cell.map(VertexId))
}

/// A cylinder: convex, and not Delaunay.
pub fn convex(seed: u64) -> Shape {
    Shape { name: "convex", is_convex: true, ..prisms(3, 30, seed, |_, _| true) }
}

/// A cylinder with holes through it.
pub fn with_holes(seed: u64) -> Shape {
    let holes = [DVec2::new(0.4, 0.1), DVec2::new(-0.4, 0.3), DVec2::new(0.0, -0.5)];
    let is_there = |p: DVec2, _| holes.iter().all(|&hole| (p - hole).length() > 0.22);
    Shape { name: "holes", ..prisms(3, 70, seed, is_there) }
}

/// A body in the cavity of another.
pub fn nested_shells(seed: u64) -> Shape {
    let is_there = |p: DVec2, layer| {
        let ring = [0.3, 0.65].iter().filter(|&&r| p.length() > r).count() as u32;
        // The core in the middle layer, a shell about it, empty space between.
        match layer {
            2 => ring != 1,
            1 | 3 => ring == 2,
            _ => true,
        }
    };
    Shape { name: "nested shells", ..prisms(5, 60, seed, is_there) }
}

/// Three small bodies side by side, each turned and moved a little.
pub fn parts(seed: u64) -> Shape {
    let mut random = Random::new(seed);
    let mut all = Shape { name: "parts", ..Shape::default() };
    for part in 0..3 {
        let turn = crate::pictures::random_turn(&mut random);
        let away = DVec3::new([-0.7, 0.0, 0.7][part], random.between(-0.3, 0.3), random.between(-0.3, 0.3));
        all.add(&prisms(2, 16, seed * 3 + part as u64, |_, _| true), |p| turn * (p * 0.2) + away);
    }
    all
}

/// A wall that winds inwards.
pub fn spiral(seed: u64) -> Shape {
    let is_there = |p: DVec2, _| {
        let turns = p.to_angle() / std::f64::consts::TAU + p.length() * 2.5;
        p.length() > 0.1 && turns.rem_euclid(1.0) < 0.55
    };
    Shape { name: "spiral", ..prisms(2, 140, seed, is_there) }
}

/// Tetrahedra that lie apart, with empty space between.
pub fn scattered(seed: u64) -> Shape {
    let mut random = Random::new(seed);
    let mut shape = Shape { name: "scattered", ..Shape::default() };
    for place in 0..64 {
        let [i, j, k] = [place & 3, place >> 2 & 3, place >> 4].map(f64::from);
        // Within a ball of its own, so that no two touch.
        let middle = DVec3::new(i, j, k) * 0.5 - 0.75;
        let first = shape.points.len() as u32;
        let corners: [DVec3; 4] = std::array::from_fn(|_| middle + random.point().normalize() * 0.245);
        let volume = (corners[1] - corners[0]).dot((corners[2] - corners[0]).cross(corners[3] - corners[0]));
        if volume.abs() > 1e-4 {
            shape.points.extend(corners);
            shape.tetrahedra.push([0, 1, 2, 3].map(|i| VertexId(first + i)));
        }
    }
    shape
}

/// One of each kind.
pub fn all(seed: u64) -> Vec<Shape> {
    vec![
        delaunay(22, seed),
        convex(seed),
        with_holes(seed),
        nested_shells(seed),
        parts(seed),
        spiral(seed),
        scattered(seed),
    ]
}

/// A cell's part of a ray, in units of the ray's direction.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Where the ray enters and leaves it.
    pub depth: [f64; 2],
    /// The cell.
    pub cell: usize,
}

/// The cells that a ray meets for longer than `least`, by the middles of their parts, nearest first.
///
/// - `from`: where the ray begins; minus infinity for a whole line
pub fn along_ray(cells: Cells<'_>, origin: DVec3, direction: DVec3, from: f64, least: f64) -> Vec<Span> {
    let span = |(cell, corners): (usize, &[VertexId; 4])| {
        let corners = corners.map(|v| cells.positions[v.index()]);
        let (mut start, mut end) = (from, f64::INFINITY);
        for i in 0..4 {
            let [a, b, c] = [1, 2, 3].map(|k| corners[(i + k) % 4]);
            let normal = (b - a).cross(c - a);
            let inward = normal * normal.dot(corners[i] - a).signum();
            let (height, slope) = (inward.dot(origin - a), inward.dot(direction));
            if slope > 0.0 {
                start = f64::max(start, -height / slope);
            } else if slope < 0.0 {
                end = f64::min(end, -height / slope);
            } else if height < 0.0 {
                return None;
            }
        }
        (end - start > least).then_some(Span { depth: [start, end], cell })
    };
    let mut met: Vec<Span> = cells.tetrahedra.iter().enumerate().filter_map(span).collect();
    met.sort_by(|a, b| (a.depth[0] + a.depth[1]).total_cmp(&(b.depth[0] + b.depth[1])));
    met
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(shape: &Shape) -> f64 {
        let six = |[a, b, c, d]: [DVec3; 4]| (b - a).dot((c - a).cross(d - a)).abs();
        (0..shape.tetrahedra.len()).map(|cell| six(shape.corners(cell))).sum::<f64>() / 6.0
    }

    #[test]
    fn shapes_have_the_volumes_that_they_should() {
        for seed in 0..4 {
            let [delaunay, convex] = [delaunay(22, seed), convex(seed)];
            // Lines through the middle of a cell meet several.
            for shape in [&delaunay, &convex] {
                let mut random = Random::new(seed);
                let lines = (0..20).map(|_| {
                    let corners = shape.corners((random.unit() * shape.tetrahedra.len() as f64) as usize);
                    let middle = corners.iter().sum::<DVec3>() / 4.0;
                    along_ray(shape.cells(), middle, random.point(), f64::NEG_INFINITY, 1e-9).len()
                });
                let met: usize = lines.sum();
                assert!(met > 60, "{}: {met} cells on 20 lines", shape.name);
            }
            let base = volume(&convex);
            assert!(base > 3.0 && base < std::f64::consts::TAU, "{base}");
            for shape in [with_holes(seed), nested_shells(seed), spiral(seed)] {
                let part = volume(&shape);
                assert!(part > 1.0 && part < 6.2, "{}: {part}", shape.name);
            }
        }
    }
}
