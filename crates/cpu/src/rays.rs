//! Rays of single pixels, in f64: what the reference knows of a pixel, without the picture around it.
//!
//! A [`RayTracer`] takes a mesh into the camera's space once. [`RayTracer::trace`] gives the segments that the rays of some pixels
//! have inside cells, sorted along each ray; a [`RayShader`] makes light of them, by any integration along a ray, in the
//! right order or in another one. All of it by the functions that [`reference`](mod@crate::reference) draws with, so that a ray has the color
//! that its pixel has there. Errors are measured with that: a few hundred rays cost less than a picture.

use std::borrow::Cow;

use rayon::prelude::*;
use tetrascope_integrate::{Integration, RgbaAssoc, Segment};
use tetrascope_mesh::{TetMesh, ascending};
use tetrascope_scene::{Plan, Progress, check_scalars};
use tetrascope_view::View;

use crate::RenderError;
use crate::geometry::{ClipCell, PixelBox, PixelSpace, Points};
use crate::reference::ray::{Fragment, Ray, RayComposer};
use crate::reference::vertex::FanPainter;
use crate::reference::{base_of, from_base, integrator, nearer_first};

/// Cells that one task looks at: enough to hide its start, few enough to spread over the cores.
const CHUNK: usize = 4096;

/// Traces rays through a mesh with a field, from one view.
#[derive(Debug)]
pub struct RayTracer<'a> {
    mesh: &'a TetMesh,
    /// Less the base.
    scalars: Cow<'a, [f64]>,
    /// See [`scalar_base`](tetrascope_mesh::scalar_base).
    base: f64,
    view: View,
    space: PixelSpace,
    points: Points,
    /// Tetrahedra that can be seen, and the pixels that they may cover.
    seen: Vec<(u32, PixelBox)>,
}

/// What the rays of some pixels meet.
#[derive(Clone, Debug, Default)]
pub struct Rays {
    /// Column and row.
    pixels: Vec<[u32; 2]>,
    /// Where the fragments of each ray begin, and the end of all.
    starts: Vec<usize>,
    /// Along each ray from the eye.
    fragments: Vec<Fragment>,
    /// World length of one unit of depth, one a ray.
    stretch: Vec<f64>,
    /// What the fragments' scalars count from.
    base: f64,
}

/// A ray's way through a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySegment {
    /// The tetrahedron, by its place in the mesh.
    pub cell: u32,
    /// Scalars where the ray enters and leaves, and the world length between.
    pub segment: Segment,
}

impl<'a> RayTracer<'a> {
    /// Takes every point of the mesh into the view, and finds out where each cell can be seen.
    ///
    /// - `scalars`: one a point of the mesh
    /// - `view`: in world coordinates
    ///
    /// # Errors
    /// [`RenderError::Plan`] if `scalars` does not fit the mesh or holds a value that is not finite where a tetrahedron uses it.
    pub fn new(mesh: &'a TetMesh, scalars: &'a [f64], view: &View) -> Result<Self, RenderError> {
        check_scalars(mesh, scalars)?;
        let frame = mesh.frame();
        let space = PixelSpace::new(&view.in_frame(frame.origin, frame.scale), frame.scale);
        let mut points = Points::default();
        let base = base_of(mesh, scalars);
        let scalars = if base == 0.0 { Cow::Borrowed(scalars) } else { Cow::Owned(from_base(scalars, base)) };
        points.project(&space, mesh.positions(), &scalars);
        let seen = mesh
            .tetrahedra()
            .par_iter()
            .enumerate()
            .filter_map(|(cell, corners)| Some((cell as u32, points.pixel_box(&space, corners.map(|v| v.0))?)))
            .collect();
        Ok(Self { mesh, scalars, base, view: *view, space, points, seen })
    }

    /// The cells that may be seen, ascending, and the pixels that each may cover: first and last column, first and last row, all included.
    pub fn seen(&self) -> &[(u32, [u32; 4])] {
        &self.seen
    }

    /// Traces the rays of some pixels: column and row of each. One outside of the picture meets nothing.
    pub fn trace(&self, pixels: &[[u32; 2]]) -> Rays {
        let near = PixelLists::new(pixels, self.space.size);
        // Cells are looked at in their order, so that the result does not depend on threads.
        let met: Vec<Vec<(u32, Fragment)>> =
            self.seen.par_chunks(CHUNK).map(|cells| self.fragments_of(cells, pixels, &near)).collect();
        let mut starts = vec![0; pixels.len() + 1];
        for (ray, _) in met.iter().flatten() {
            starts[*ray as usize + 1] += 1;
        }
        for ray in 0..pixels.len() {
            starts[ray + 1] += starts[ray];
        }
        let mut next = starts.clone();
        let mut fragments = vec![Fragment { depth: [0.0; 2], scalar: [0.0; 2], cell: 0 }; starts[pixels.len()]];
        for (ray, fragment) in met.iter().flatten() {
            fragments[next[*ray as usize]] = *fragment;
            next[*ray as usize] += 1;
        }
        for ray in 0..pixels.len() {
            fragments[starts[ray]..starts[ray + 1]].sort_by(nearer_first);
        }
        let stretch = pixels.iter().map(|&at| Ray::of_pixel(&self.space, &self.view, at).stretch).collect();
        Rays { pixels: pixels.to_vec(), starts, fragments, stretch, base: self.base }
    }

    fn fragments_of(&self, cells: &[(u32, PixelBox)], pixels: &[[u32; 2]], near: &PixelLists) -> Vec<(u32, Fragment)> {
        let mut found = Vec::new();
        let mut candidates = Vec::new();
        for &(cell, outline) in cells {
            candidates.clear();
            near.inside(pixels, outline, &mut candidates);
            if candidates.is_empty() {
                continue;
            }
            let corners = self.mesh.tetrahedra()[cell as usize].map(|v| v.0);
            let (vertices, is_positive) = ascending(corners);
            let points = self.points.gather(vertices);
            let (corners, scalars) = (points.map(|p| p.position), points.map(|p| p.scalar));
            let Some(clip) = ClipCell::new(&corners, &scalars, is_positive) else { continue };
            for &ray in &candidates {
                let [x, y] = pixels[ray as usize];
                let (u, w) = (PixelSpace::center(x, self.space.size[0]), PixelSpace::center(y, self.space.size[1]));
                if let Some(span) = clip.span(self.space.is_perspective, u, w) {
                    found.push((ray, Fragment { depth: span.depth, scalar: span.scalar, cell }));
                }
            }
        }
        found
    }

    /// Prepares what makes light of rays as the plan says: its table and its gradients, if it has any. The plan's view is not looked at, nor
    /// are its order and its back end. The integration that is defined on fans paints the pixel of a fan.
    ///
    /// # Errors
    /// [`RenderError::Plan`].
    pub fn shader(&self, plan: &Plan, progress: &dyn Progress) -> Result<RayShader<'_>, RenderError> {
        let plan = &plan.with_scalars_from(self.base);
        let with_fans = plan.integration.needs_fan();
        // Not looked at where fans are painted.
        let integration = if with_fans { Integration::Exact } else { plan.integration };
        let integrator = integrator(self.mesh, &self.scalars, &Plan { integration, ..plan.clone() }, progress)?;
        let mut composer = RayComposer::new(integrator, plan, self.mesh, &self.scalars);
        composer.fans = with_fans.then(|| FanPainter::new(plan, self.space, self.mesh, &self.scalars));
        Ok(RayShader { tracer: self, composer })
    }
}

impl Rays {
    /// Number of rays.
    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// Column and row of each ray's pixel.
    pub fn pixels(&self) -> &[[u32; 2]] {
        &self.pixels
    }

    /// What a ray meets, from the eye.
    pub fn segments(&self, ray: usize) -> impl ExactSizeIterator<Item = RaySegment> + '_ {
        let stretch = self.stretch[ray];
        self.of(ray).iter().map(move |fragment| RaySegment {
            cell: fragment.cell,
            segment: Segment {
                scalar_front: fragment.scalar[0] + self.base,
                scalar_back: fragment.scalar[1] + self.base,
                chord_length: (fragment.depth[1] - fragment.depth[0]) * stretch,
            },
        })
    }

    /// The rays of both.
    #[must_use]
    pub fn joined(mut self, more: &Self) -> Self {
        let end = self.fragments.len();
        if self.is_empty() {
            self.base = more.base;
        }
        self.starts.truncate(self.pixels.len());
        self.starts.extend(more.starts.iter().map(|start| start + end));
        self.pixels.extend(&more.pixels);
        self.fragments.extend(&more.fragments);
        self.stretch.extend(&more.stretch);
        self
    }

    fn of(&self, ray: usize) -> &[Fragment] {
        &self.fragments[self.starts[ray]..self.starts[ray + 1]]
    }
}

/// Makes light of rays.
pub struct RayShader<'a> {
    tracer: &'a RayTracer<'a>,
    composer: RayComposer<'a>,
}

impl RayShader<'_> {
    /// The light of a ray, front to back.
    pub fn light(&self, rays: &Rays, ray: usize) -> RgbaAssoc {
        self.compose(rays, ray, rays.of(ray))
    }

    /// The light of a ray whose cells are blended in another order: that of their ranks, the least in front.
    pub fn light_by_rank(&self, rays: &Rays, ray: usize, rank: impl Fn(u32) -> u32) -> RgbaAssoc {
        let mut fragments = rays.of(ray).to_vec();
        fragments.sort_by_key(|fragment| rank(fragment.cell));
        self.compose(rays, ray, &fragments)
    }

    /// The same where the pixel holds back as many cells as `window`, and blends the nearest of them when one more comes.
    pub fn light_in_window(&self, rays: &Rays, ray: usize, rank: impl Fn(u32) -> u32, window: usize) -> RgbaAssoc {
        let mut coming = rays.of(ray).to_vec();
        coming.sort_by_key(|fragment| rank(fragment.cell));
        let mut held: Vec<Fragment> = Vec::with_capacity(window + 1);
        let mut fragments = Vec::with_capacity(coming.len());
        for fragment in coming {
            let place = held.partition_point(|other| nearer_first(other, &fragment).is_le());
            held.insert(place, fragment);
            if held.len() > window {
                fragments.push(held.remove(0));
            }
        }
        fragments.append(&mut held);
        self.compose(rays, ray, &fragments)
    }

    fn compose(&self, rays: &Rays, ray: usize, fragments: &[Fragment]) -> RgbaAssoc {
        let Self { tracer, composer } = self;
        let at = Ray::of_pixel(&tracer.space, &tracer.view, rays.pixels[ray]);
        let corners = |cell: u32| tracer.points.corners(tracer.mesh.tetrahedra()[cell as usize].map(|v| v.0));
        composer.compose(&at, fragments, corners).light
    }
}

impl std::fmt::Debug for RayShader<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RayShader").finish_non_exhaustive()
    }
}

/// Pixels in squares of the picture, about one in each, so that those in a rectangle are found at once.
struct PixelLists {
    /// Pixels a side of a square.
    side: u32,
    columns: u32,
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl PixelLists {
    fn new(pixels: &[[u32; 2]], size: [u32; 2]) -> Self {
        let area = f64::from(size[0]) * f64::from(size[1]) / pixels.len().max(1) as f64;
        let side = (area.sqrt() as u32).max(1);
        let (columns, rows) = (size[0].div_ceil(side), size[1].div_ceil(side));
        let square = |[x, y]: [u32; 2]| (y / side * columns + x / side) as usize;
        let is_inside = |[x, y]: [u32; 2]| x < size[0] && y < size[1];
        let mut starts = vec![0_u32; (columns * rows) as usize + 1];
        for &pixel in pixels.iter().filter(|pixel| is_inside(**pixel)) {
            starts[square(pixel) + 1] += 1;
        }
        for index in 1..starts.len() {
            starts[index] += starts[index - 1];
        }
        let mut next = starts.clone();
        let mut items = vec![0; pixels.len()];
        for (item, &pixel) in (0..).zip(pixels).filter(|(_, pixel)| is_inside(**pixel)) {
            let place = &mut next[square(pixel)];
            items[*place as usize] = item;
            *place += 1;
        }
        Self { side, columns, starts, items }
    }

    /// Adds the pixels in a rectangle to `found`.
    fn inside(&self, pixels: &[[u32; 2]], [x0, x1, y0, y1]: PixelBox, found: &mut Vec<u32>) {
        for row in y0 / self.side..=y1 / self.side {
            let first = row * self.columns + x0 / self.side;
            let last = row * self.columns + x1 / self.side;
            let range = self.starts[first as usize] as usize..self.starts[last as usize + 1] as usize;
            found.extend(self.items[range].iter().copied().filter(|&item| {
                let [x, y] = pixels[item as usize];
                (x0..=x1).contains(&x) && (y0..=y1).contains(&y)
            }));
        }
    }
}
