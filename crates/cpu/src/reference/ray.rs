//! What one ray shows: the volume of its fragments and the isosurfaces in them, front to back.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_integrate::{Integrator, Isosurfaces, RgbaAssoc, Segment};
use tetrascope_mesh::{TetMesh, VertexId, scalar_factor};
use tetrascope_scene::{Gradients, Plan, Shown};
use tetrascope_view::View;

use super::light::Light;
use super::vertex::FanPainter;
use crate::domain::scalar_range;
use crate::geometry::PixelSpace;

/// A cell's segment of one ray; 40 bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fragment {
    /// Depth where the ray enters and leaves.
    pub(crate) depth: [f64; 2],
    /// Scalar there.
    pub(crate) scalar: [f64; 2],
    pub(crate) cell: u32,
}

/// The ray of a pixel center.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    /// Where it is in pixel space.
    pub(crate) center: [f64; 2],
    is_perspective: bool,
    /// World length of one unit of depth.
    pub(crate) stretch: f64,
    /// Against the ray, world coordinates, of length 1.
    to_eye: DVec3,
}

impl Ray {
    /// The ray of a pixel.
    ///
    /// - `view`: in world coordinates, of which `space` is made
    pub(crate) fn of_pixel(space: &PixelSpace, view: &View, [x, y]: [u32; 2]) -> Self {
        let (u, w) = (PixelSpace::center(x, space.size[0]), PixelSpace::center(y, space.size[1]));
        let direction = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5).direction;
        Self {
            center: [u, w],
            is_perspective: space.is_perspective,
            stretch: space.ray_stretch(u, w),
            // Not zero: its component along the line of sight is 1.
            to_eye: -direction / direction.length(),
        }
    }
}

/// Everything that fragments become light with.
pub(crate) struct RayComposer<'a> {
    pub(crate) integrator: Integrator,
    surfaces: Option<Surfaces>,
    light: Option<Light<'a>>,
    /// For every cell whether the plan shows anything of it; empty where the integration knows that by itself. Between the samples of a
    /// table is light that a cell beside them does not have: which cells are left out is no matter of the table, see [`Shown`].
    is_shown: Vec<bool>,
    /// In the place of the integrator, where fans are painted.
    pub(crate) fans: Option<FanPainter<'a>>,
}

/// Isosurfaces in a field.
struct Surfaces {
    set: Isosurfaces,
    /// Scalars that lie below a value by no more than this count as on it.
    slack: f64,
}

/// How far apart, relative to the farthest depth of a ray, the exit of one fragment and the entry of the next may be for the
/// two to be neighbors. Faces give their two cells the same depth to the last bit; where a ray runs through an edge or a
/// vertex two faces round apart, by some 1e-15 unless they are seen nearly edge-on.
const CONTIGUOUS: f64 = 1e-9;

/// How far below the value of a surface, relative to the range of the field, a scalar still counts as on it: far
/// above the rounding of an interpolated scalar (some 1e-15), far below what a picture shows.
///
/// It moves all surfaces by this much and changes nothing else. Without it, a surface in a plane of the grid that is seen
/// edge-on, or that is the mesh's boundary, would be there or not as each pixel rounds.
const ON_SURFACE: f64 = 1e-12;

impl Surfaces {
    fn new(set: Isosurfaces, mesh: &TetMesh, scalars: &[f64]) -> Self {
        let [low, high] = scalar_range(mesh, scalars).unwrap_or_default();
        // Products first: the difference of huge scalars overflows. Then what a scalar itself rounds to.
        let slack = (high * ON_SURFACE - low * ON_SURFACE) + 4.0 * f64::EPSILON * low.abs().max(high.abs());
        Self { set, slack }
    }

    fn rank(&self, scalar: f64) -> usize {
        self.set.rank(scalar + self.slack)
    }
}

/// How far along a ray its fragments are composed, and on which side of the surfaces it is there.
struct Reached {
    depth: f64,
    rank: usize,
}

/// What fragments became.
pub(crate) struct Composed {
    pub(crate) light: RgbaAssoc,
    /// Fragments that were integrated.
    pub(crate) fragments: u64,
    /// Surfaces that they met, each time.
    pub(crate) crossings: u64,
}

impl<'a> RayComposer<'a> {
    /// Isosurfaces and light as the plan has them; gradients are computed if these need them.
    pub(crate) fn new(integrator: Integrator, plan: &Plan, mesh: &'a TetMesh, scalars: &'a [f64]) -> Self {
        let needed = plan.gradients();
        let lit = plan.lighting.filter(|_| needed != Gradients::None);
        let surfaces = plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.surfaces.visible());
        Self {
            integrator,
            is_shown: if plan.integration.needs_table() { is_shown(plan, mesh, scalars) } else { Vec::new() },
            surfaces: surfaces.map(|surfaces| Surfaces::new(surfaces, mesh, scalars)),
            light: lit.map(|lighting| Light::new(lighting, needed, mesh, scalars)),
            fans: None,
        }
    }

    /// Gradients that were computed, one a point; 0 if none are interpolated.
    pub(crate) fn point_gradients(&self) -> u64 {
        self.light.as_ref().map_or(0, Light::point_gradients)
    }

    /// Composes the fragments of a ray, sorted by where they begin, until nothing behind can be seen.
    ///
    /// - `corners`: of a cell, in pixel space
    pub(crate) fn compose(&self, ray: &Ray, fragments: &[Fragment], corners: impl Fn(u32) -> [DVec3; 4]) -> Composed {
        let farthest = fragments.iter().fold(0.0_f64, |farthest, fragment| farthest.max(fragment.depth[1]));
        let mut reached: Option<Reached> = None;
        let mut composed = Composed { light: RgbaAssoc::TRANSPARENT, fragments: 0, crossings: 0 };
        for fragment in fragments {
            let segment = Segment {
                scalar_front: fragment.scalar[0],
                scalar_back: fragment.scalar[1],
                chord_length: (fragment.depth[1] - fragment.depth[0]) * ray.stretch,
            };
            let light = match &self.surfaces {
                None => self.volume(ray, fragment, &segment, &corners),
                Some(surfaces) => {
                    let is_neighbor = |last: &&Reached| (fragment.depth[0] - last.depth).abs() <= CONTIGUOUS * farthest;
                    // A surface that lies between the scalars of two neighbors as they round is met once, in the second.
                    let front = reached.as_ref().filter(is_neighbor).map(|last| last.rank);
                    let ranks = [
                        front.unwrap_or_else(|| surfaces.rank(segment.scalar_front)),
                        surfaces.rank(segment.scalar_back),
                    ];
                    if reached.as_ref().is_none_or(|last| fragment.depth[1] > last.depth) {
                        reached = Some(Reached { depth: fragment.depth[1], rank: ranks[1] });
                    }
                    self.cut(surfaces, ranks, ray, fragment, &segment, &corners, &mut composed.crossings)
                }
            };
            composed.light = composed.light.over(light);
            composed.fragments += 1;
            // Exactly 1 behind an opaque surface: whatever follows would be multiplied by zero.
            if composed.light.opacity == 1.0 {
                break;
            }
        }
        composed
    }

    /// The light of a fragment that isosurfaces may cut; the cuts are counted.
    #[expect(clippy::too_many_arguments, reason = "what belongs to a fragment is known only one call above")]
    fn cut(
        &self,
        surfaces: &Surfaces,
        ranks: [usize; 2],
        ray: &Ray,
        fragment: &Fragment,
        segment: &Segment,
        corners: &impl Fn(u32) -> [DVec3; 4],
        crossings: &mut u64,
    ) -> RgbaAssoc {
        let volume_light = |part: &Segment| self.volume(ray, fragment, part, corners);
        surfaces.set.compose(ranks, segment, volume_light, |crossing| {
            *crossings += 1;
            let Some(light) = &self.light else { return crossing.color };
            let point = ray.point(fragment, crossing.share);
            light.shade(crossing, fragment.cell, &corners(fragment.cell), point, ray.to_eye)
        })
    }

    /// The light of the volume in a part of a fragment. Lit volume is lit by the gradient in the middle of the whole fragment.
    fn volume(
        &self,
        ray: &Ray,
        fragment: &Fragment,
        part: &Segment,
        corners: &impl Fn(u32) -> [DVec3; 4],
    ) -> RgbaAssoc {
        if self.is_shown.get(fragment.cell as usize) == Some(&false) {
            return RgbaAssoc::TRANSPARENT;
        }
        let light = match &self.fans {
            Some(fans) => fans.light(ray, fragment, &corners(fragment.cell), part),
            None => self.integrator.integrate(part),
        };
        let Some(source) = self.light.as_ref().filter(|source| source.lights_volume()) else { return light };
        let middle = ray.point(fragment, 0.5);
        let intensity = source.intensity(fragment.cell, &corners(fragment.cell), middle, ray.to_eye);
        RgbaAssoc { rgb: light.rgb.map(|channel| channel * intensity), ..light }
    }
}

/// For every cell whether the plan shows anything of it.
fn is_shown(plan: &Plan, mesh: &TetMesh, scalars: &[f64]) -> Vec<bool> {
    let factor = scalar_factor(tetrascope_mesh::scalar_range(mesh.tetrahedra(), scalars));
    let surfaces = plan.isosurfaces.as_ref().map(|isosurfaces| isosurfaces.surfaces.visible()).unwrap_or_default();
    let transfer = plan.transfer.with_scalars_scaled(factor);
    let shown = Shown::new(transfer, plan.model, surfaces.with_scalars_scaled(factor));
    let shows = |cell: &[VertexId; 4]| {
        let scalars = cell.map(|v| scalars[v.index()] * factor);
        let (low, high) = scalars.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &s| (l.min(s), h.max(s)));
        shown.shows(low, high)
    };
    mesh.tetrahedra().par_iter().map(shows).collect()
}

impl Ray {
    /// A point of a fragment in pixel space; `share` is 0 at its front and 1 at its back.
    fn point(&self, fragment: &Fragment, share: f64) -> DVec3 {
        let [u, w] = self.center;
        let depth = fragment.depth[0] + (fragment.depth[1] - fragment.depth[0]) * share;
        if self.is_perspective { DVec3::new(u, w, 1.0) * depth } else { DVec3::new(u, w, depth) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tetrascope_integrate::{Integration, Isosurface, OpticalModel, SurfaceShading, TransferFunction};

    /// Opacity of fragments given by depths and scalars, with one surface of half opacity.
    fn opacity(value: f64, fragments: &[([f64; 2], [f64; 2])]) -> f64 {
        let surface =
            Isosurface { value, color: [1.0; 3], back_color: [0.5; 3], opacity: 0.5, shading: SurfaceShading::None };
        let set = Isosurfaces::new(vec![surface]).unwrap();
        let transfer = TransferFunction::new(&[[0.0; 4]], &[[0.0; 2]]).unwrap();
        let composer = RayComposer {
            integrator: Integrator::new(Integration::Exact, &transfer, OpticalModel::Absorption, None, &|_, _| ())
                .unwrap(),
            surfaces: Some(Surfaces { set, slack: 0.0 }),
            light: None,
            is_shown: Vec::new(),
            fans: None,
        };
        let fragments: Vec<Fragment> =
            fragments.iter().map(|&(depth, scalar)| Fragment { depth, scalar, cell: 0 }).collect();
        let ray = Ray { center: [0.0; 2], is_perspective: false, stretch: 1.0, to_eye: -DVec3::Z };
        let composed = composer.compose(&ray, &fragments, |_| [DVec3::ZERO; 4]);
        assert_eq!(composed.fragments, fragments.len() as u64);
        composed.light.opacity
    }

    /// Two neighbors that round the scalar between them to different sides of a surface: one crossing, whichever way round.
    #[test]
    fn surface_at_a_joint_is_met_once() {
        let ulp = f64::EPSILON;
        for [exit, entry] in [[-ulp, ulp], [ulp, -ulp], [0.0, -ulp], [-ulp, 0.0], [0.0, 0.0]] {
            for apart in [0.0, 1e-12, -1e-12] {
                let rising = [([1.0, 2.0], [0.0, 0.5 + exit]), ([2.0 + apart, 3.0], [0.5 + entry, 1.0])];
                assert_eq!(opacity(0.5, &rising), 0.5, "{exit} {entry} {apart}");
                let falling = rising.map(|(depth, [front, back])| (depth, [1.0 - front, 1.0 - back]));
                assert_eq!(opacity(0.5, &falling), 0.5, "{exit} {entry} {apart}");
            }
        }
    }

    /// Between fragments that do not touch the field is not known; a sliver that rounding put inside another does not count
    /// as the end of it.
    #[test]
    fn neighbors_are_those_that_touch() {
        assert_eq!(opacity(0.5, &[([1.0, 2.0], [0.0, 0.4]), ([2.1, 3.0], [0.6, 1.0])]), 0.0);
        assert_eq!(opacity(0.5, &[([1.0, 2.0], [0.0, 0.4]), ([2.0, 3.0], [0.6, 1.0])]), 0.5);
        let sliver = [([1.0, 2.0], [0.0, 0.4]), ([1.5, 1.5 + 1e-15], [0.2, 0.2]), ([2.0, 3.0], [0.6, 1.0])];
        assert_eq!(opacity(0.5, &sliver), 0.5);
    }
}
