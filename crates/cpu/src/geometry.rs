//! A tetrahedron before a pixel's ray, in f64: the one definition of what a ray meets.

use glam::{DVec2, DVec3, Vec2};
use rayon::prelude::*;
use tetrascope_view::View;

/// Coordinates about the eye in which pixels are units.
///
/// A point becomes `(x, y, z)` with `z` its depth. In a perspective view the ray of the pixel center `(u, w)`, counted from
/// the middle of the picture to the right and down, is `z (u, w, 1)`; in an orthographic one it is `(u, w, z)`, and all
/// three axes have the pixel as unit. Right-handed, so that positive volumes stay positive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelSpace {
    eye: DVec3,
    right: DVec3,
    down: DVec3,
    forward: DVec3,
    /// Whether rays spread.
    pub(crate) is_perspective: bool,
    /// World length of one unit of depth, straight ahead.
    pub(crate) world_per_depth: f64,
    /// Width of a pixel at depth 1, horizontally and vertically (perspective); the pixel's size in an orthographic view.
    pub(crate) slope: [f64; 2],
    /// Pixels a row, and rows.
    pub(crate) size: [u32; 2],
    /// A depth in front of the whole mesh and near it; 0 if the eye is near. Depths in f32 count from here, so that they tell cells apart from
    /// however far away.
    pub(crate) start: f64,
}

impl PixelSpace {
    /// The space of a view given in the mesh's local coordinates, of which one unit is `world_per_local` long.
    pub(crate) fn new(view: &View, world_per_local: f64) -> Self {
        let slope = [2.0 * view.half_width / f64::from(view.width), 2.0 * view.half_height / f64::from(view.height)];
        let depth_unit = if view.is_perspective { 1.0 } else { slope[1] };
        Self {
            eye: view.eye,
            right: view.right / slope[0],
            down: -view.up / slope[1],
            forward: view.forward / depth_unit,
            is_perspective: view.is_perspective,
            world_per_depth: world_per_local * depth_unit,
            slope,
            size: [view.width, view.height],
            // Local coordinates are at most 1 long, but for the frame's rounding.
            start: ((-view.eye).dot(view.forward) - 1.25).max(0.0) / depth_unit,
        }
    }

    #[inline]
    pub(crate) fn transform(&self, local: DVec3) -> DVec3 {
        let from_eye = local - self.eye;
        DVec3::new(from_eye.dot(self.right), from_eye.dot(self.down), from_eye.dot(self.forward))
    }

    /// A gradient over pixel space as one over lengths along the camera's axes: right, down, forward.
    pub(crate) fn gradient_in_view(&self, gradient: DVec3) -> DVec3 {
        let depth_unit = if self.is_perspective { 1.0 } else { self.slope[1] };
        gradient / DVec3::new(self.slope[0], self.slope[1], depth_unit)
    }

    /// A direction along the mesh's axes as one along the camera's: right, down, forward.
    pub(crate) fn direction_in_view(&self, direction: DVec3) -> DVec3 {
        let depth_unit = if self.is_perspective { 1.0 } else { self.slope[1] };
        let [right, down] = [self.right * self.slope[0], self.down * self.slope[1]];
        DVec3::new(direction.dot(right), direction.dot(down), direction.dot(self.forward) * depth_unit)
    }

    /// A plane as the half-space behind it, from the mesh's coordinates. The turned plane gives the same bits with opposite sign.
    pub(crate) fn face(&self, point: DVec3, normal: DVec3) -> ClipFace {
        let depth_unit = if self.is_perspective { 1.0 } else { self.slope[1] };
        // Normals go against distances: what stretches an axis shrinks them along it.
        let unit = DVec3::new(self.slope[0], self.slope[1], depth_unit);
        ClipFace { normal: self.direction_in_view(normal) * unit, point: self.transform(point) }
    }

    /// Coordinate of the center of column (or row) `pixel` from the middle of a picture `size` pixels wide. Exact.
    #[inline]
    pub(crate) fn center(pixel: u32, size: u32) -> f64 {
        f64::from(pixel) + 0.5 - f64::from(size) * 0.5
    }

    /// World length along the ray of `(u, w)` of one unit of depth.
    #[inline]
    pub(crate) fn ray_stretch(&self, u: f64, w: f64) -> f64 {
        if !self.is_perspective {
            return self.world_per_depth;
        }
        let (x, y) = (u * self.slope[0], w * self.slope[1]);
        (1.0 + x * x + y * y).sqrt() * self.world_per_depth
    }
}

/// A tetrahedron as the intersection of four half-spaces, and its scalar as an affine function.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClipCell {
    pub(crate) faces: [ClipFace; 4],
    pub(crate) gradient: DVec3,
    pub(crate) scalar_at_anchor: f64,
    pub(crate) anchor: DVec3,
    pub(crate) scalar_range: [f64; 2],
}

/// The half-space behind a face: `normal . (x - point) <= 0`, the normal pointing out of the cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClipFace {
    pub(crate) normal: DVec3,
    pub(crate) point: DVec3,
}

/// Part of a ray inside a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Depth where the ray enters and leaves, not negative.
    pub(crate) depth: [f64; 2],
    /// Scalar there.
    pub(crate) scalar: [f64; 2],
}

/// Relative size under which a number that ought to be zero counts as zero: far above the rounding of the few operations
/// that make it (some 1e-15), far below anything that a picture shows (1e-11 of the picture's width).
pub(crate) const IN_PLANE: f64 = 1e-11;

impl ClipCell {
    /// From corners in pixel space, sorted by vertex index, and whether the volume in this order is positive.
    ///
    /// Every face's numbers come from its own three corners in ascending order, so that the two cells of a face get the
    /// same bits with opposite sign: what one gives up the other takes, to the last bit.
    /// `None` if the cell has no volume in f64.
    pub(crate) fn new(corners: &[DVec3; 4], scalars: &[f64; 4], is_positive: bool) -> Option<Self> {
        let [a, b, c, d] = *corners;
        let sign = if is_positive { 1.0 } else { -1.0 };
        let face = |sign: f64, p: DVec3, q: DVec3, r: DVec3| ClipFace { normal: (q - p).cross(r - p) * sign, point: p };
        let faces = [face(sign, b, c, d), face(-sign, a, c, d), face(sign, a, b, d), face(-sign, a, b, c)];
        // The normal of the face opposite to b is (c - a) x (d - a) with the sign turned: six times the volume from b's height.
        let six_volume = -(b - a).dot(faces[1].normal);
        if !(six_volume > 0.0 && six_volume.is_finite()) {
            return None;
        }
        // A corner's share grows against the normal of the face opposite to it.
        let mut gradient = DVec3::ZERO;
        for corner in 1..4 {
            gradient -= faces[corner].normal * ((scalars[corner] - scalars[0]) / six_volume);
        }
        let low = scalars.iter().fold(f64::INFINITY, |m, &s| m.min(s));
        let high = scalars.iter().fold(f64::NEG_INFINITY, |m, &s| m.max(s));
        Some(Self { faces, gradient, scalar_at_anchor: scalars[0], anchor: a, scalar_range: [low, high] })
    }

    /// What the ray of the pixel center `(u, w)` has inside, or `None`.
    pub(crate) fn span(&self, is_perspective: bool, u: f64, w: f64) -> Option<Span> {
        self.span_behind(&[], is_perspective, u, w)
    }

    /// What a ray has inside of the part of the cell that lies behind `cuts`.
    ///
    /// A ray that runs in a cut belongs to one of the two parts, as one in a face does to one of its cells.
    pub(crate) fn span_behind(&self, cuts: &[ClipFace], is_perspective: bool, u: f64, w: f64) -> Option<Span> {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for face in self.faces.iter().chain(cuts) {
            let n = face.normal;
            // normal . (origin + depth * direction - point) <= 0, as depth * speed <= room.
            let (room, room_scale, speed, speed_scale) = if is_perspective {
                let p = face.point;
                let (nx, ny) = (n.x * u, n.y * w);
                let (px, py, pz) = (n.x * p.x, n.y * p.y, n.z * p.z);
                (px + py + pz, px.abs() + py.abs() + pz.abs(), nx + ny + n.z, nx.abs() + ny.abs() + n.z.abs())
            } else {
                let p = face.point - DVec3::new(u, w, 0.0);
                let scale = n.abs().dot(face.point.abs() + DVec3::new(u.abs(), w.abs(), 0.0));
                (n.dot(p), scale, n.z, n.abs().element_sum())
            };
            if room.abs() <= IN_PLANE * room_scale && speed.abs() <= IN_PLANE * speed_scale {
                // The ray runs in the face. All cells about it agree to move the ray a little to the right and, by far
                // less, down: then exactly one of them has it.
                let outward = if n.x.abs() > IN_PLANE * n.y.abs() { n.x } else { n.y };
                if outward >= 0.0 {
                    return None;
                }
                continue;
            }
            let depth = room / speed;
            if speed > 0.0 {
                leave = leave.min(depth);
            } else if speed < 0.0 {
                enter = enter.max(depth);
            } else if room < 0.0 {
                return None;
            }
        }
        if !(enter < leave && leave.is_finite()) {
            return None;
        }
        let scalar_at = |depth: f64| {
            let x = if is_perspective { DVec3::new(u, w, 1.0) * depth } else { DVec3::new(u, w, depth) };
            let scalar = self.scalar_at_anchor + self.gradient.dot(x - self.anchor);
            scalar.max(self.scalar_range[0]).min(self.scalar_range[1])
        };
        Some(Span { depth: [enter, leave], scalar: [scalar_at(enter), scalar_at(leave)] })
    }
}

/// The pixels whose centers a cell may cover: first and last column, first and last row, both included.
pub(crate) type PixelBox = [u32; 4];

/// A point in pixel space and its scalar, side by side: one cache line serves both.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Point {
    pub(crate) position: DVec3,
    pub(crate) scalar: f64,
}

/// Points in pixel space, and where they are on the screen.
#[derive(Debug, Default)]
pub(crate) struct Points {
    points: Vec<Point>,
    /// Column and row, counted so that the center of the first pixel is `(0, 0)`; NaN for a point that is not in front of
    /// the eye of a perspective view. In 32 bits, which is enough for outlines and stays in a near cache.
    screen: Vec<Vec2>,
}

impl Points {
    /// Takes every point into pixel space, once. What was there before gives its memory.
    pub(crate) fn project(&mut self, space: &PixelSpace, local: &[DVec3], scalars: &[f64]) {
        let middle = DVec2::new(f64::from(space.size[0]), f64::from(space.size[1])) * 0.5 - 0.5;
        let project = |(&p, &scalar): (&DVec3, &f64)| {
            let p = space.transform(p);
            let screen = match space.is_perspective {
                true if p.z > 0.0 => p.truncate() / p.z,
                true => DVec2::NAN,
                false => p.truncate(),
            };
            (Point { position: p, scalar }, (screen + middle).as_vec2())
        };
        local.par_iter().zip(scalars).map(project).unzip_into_vecs(&mut self.points, &mut self.screen);
    }

    /// A cell's corners in pixel space.
    #[inline]
    pub(crate) fn corners(&self, [a, b, c, d]: [u32; 4]) -> [DVec3; 4] {
        [a, b, c, d].map(|v| self.points[v as usize].position)
    }

    /// A cell's corners with their scalars.
    #[inline(always)]
    pub(crate) fn gather(&self, [a, b, c, d]: [u32; 4]) -> [Point; 4] {
        [self.points[a as usize], self.points[b as usize], self.points[c as usize], self.points[d as usize]]
    }

    /// Where a cell can be seen, or `None` if it cannot. Conservative.
    ///
    /// A cell that reaches the plane of the eye in a perspective view has no finite outline; it is bounded by the picture.
    #[inline]
    pub(crate) fn pixel_box(&self, space: &PixelSpace, vertices: [u32; 4]) -> Option<PixelBox> {
        let [a, b, c, d] = vertices.map(|v| self.screen[v as usize]);
        if space.is_perspective {
            // NaN if one of them is.
            if (a.x + b.x + c.x + d.x).is_nan() {
                return self.box_at_the_eye(space, vertices);
            }
        } else if vertices.iter().all(|&v| self.points[v as usize].position.z <= 0.0) {
            return None;
        }
        pixels_between(space, a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }

    #[cold]
    fn box_at_the_eye(&self, space: &PixelSpace, vertices: [u32; 4]) -> Option<PixelBox> {
        let corners = self.corners(vertices);
        let half = space.size.map(|n| f64::from(n) * 0.5);
        if corners.iter().all(|p| p.z <= 0.0)
            || is_outside_rectangle(&corners, [-half[0], half[0]], [-half[1], half[1]])
        {
            return None;
        }
        let [width, height] = space.size;
        Some([0, width - 1, 0, height - 1])
    }
}

/// The pixel centers in a rectangle of the screen.
#[inline]
fn pixels_between(space: &PixelSpace, low: Vec2, high: Vec2) -> Option<PixelBox> {
    // In 32 bits the last pixel of the largest picture is off by 2e-3; a pixel too many costs nothing.
    const MARGIN: f32 = 4e-3;
    let [width, height] = space.size;
    let (low, high) = (low - MARGIN, high + MARGIN);
    // Written so that NaN gives nothing.
    let is_in = low.x <= (width - 1) as f32 && low.y <= (height - 1) as f32 && high.x >= 0.0 && high.y >= 0.0;
    if !is_in {
        return None;
    }
    let first = |x: f32| {
        let below = x.max(0.0) as u32;
        below + u32::from((below as f32) < x)
    };
    let last = |x: f32, count: u32| (x as u32).min(count - 1);
    let outline = [first(low.x), last(high.x, width), first(low.y), last(high.y, height)];
    (outline[0] <= outline[1] && outline[2] <= outline[3]).then_some(outline)
}

/// Whether no ray through a rectangle of the picture can meet a cell (perspective); right for cells behind the eye too.
pub(crate) fn is_outside_rectangle(corners: &[DVec3; 4], u: [f64; 2], w: [f64; 2]) -> bool {
    corners.iter().all(|p| p.x < u[0] * p.z)
        || corners.iter().all(|p| p.x > u[1] * p.z)
        || corners.iter().all(|p| p.y < w[0] * p.z)
        || corners.iter().all(|p| p.y > w[1] * p.z)
}

#[cfg(test)]
mod tests;
