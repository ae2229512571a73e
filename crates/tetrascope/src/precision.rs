//! What 32 bits cannot hold of a picture, said with it.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_integrate::Integration;
use tetrascope_scene::{Backend, Interpolation, IsosurfaceMethod, Plan, Sharpness, TargetBits};

use crate::VolumeField;

/// Layers of cells, on average over all pixels, from which on blending into 16 bits is worth a word: it is off by some 3e-3 there.
const DEEP: f64 = 100.0;

/// Height of the picture, relative to about the size of the mesh, below which a GPU's coordinates are seen to be steps.
const CLOSE: f64 = 1e-2;

/// Height of a tetrahedron, relative to about the size of the mesh, from which on a GPU's coordinates hold it: some 60 of their steps.
const THIN: f64 = 1e-7;

impl VolumeField<'_> {
    /// Where the picture of a plan is less right than usual because of the numbers that its back end computes with: sentences for people.
    ///
    /// The CPU draws cells in which the transfer function changes faster than 32 bits know a scalar in 64 bits, unless isosurfaces are drawn by
    /// maps or the scene asks for segments by triangles; a GPU has no such numbers.
    pub fn precision_warnings(&self, plan: &Plan) -> Vec<String> {
        let mut warnings = Vec::new();
        let has_maps =
            plan.isosurfaces.as_ref().is_some_and(|isosurfaces| isosurfaces.method != IsosurfaceMethod::Exact);
        let is_cut_in_32_bits = has_maps || plan.interpolation != Interpolation::Exact;
        let is_in_32_bits = plan.backend == Backend::Gpu || (plan.backend == Backend::Cpu && is_cut_in_32_bits);
        if is_in_32_bits && matches!(plan.integration, Integration::Exact | Integration::Cumulative) {
            let cells = self.cells_beyond_32_bits(plan);
            if cells > 0 {
                warnings.push(format!(
                    "in {cells} tetrahedra the transfer function changes faster than 32-bit scalars can tell, and narrow peaks may be missed there; the back \
                     end \"reference\"{} is right",
                    if is_cut_in_32_bits { "" } else { ", and \"cpu\"," }
                ));
            }
        }
        if plan.backend == Backend::Gpu {
            let thin = self.cells_thinner_than_the_lattice();
            if thin > 0 {
                warnings.push(format!(
                    "{thin} tetrahedra are thinner than 1e-7 of the mesh, which is as exact as a GPU holds coordinates: between neighbors they are drawn \
                     rightly, but one that stands alone may be twice as dense as it is, or half{}; the back end \"cpu\" is right",
                    if plan.isosurfaces.is_some() { ", and isosurfaces in them may be missed" } else { "" }
                ));
            }
        }
        if plan.backend == Backend::Gpu && self.share_in_picture(plan) < CLOSE {
            warnings.push(
                "the picture shows less than a hundredth of the mesh, which is held in steps of 2e-9 of its size on a GPU, and small errors are magnified; \
                 the back end \"cpu\" is right"
                    .to_owned(),
            );
        }
        if plan.backend == Backend::Gpu && plan.gpu.target_bits == Some(TargetBits::Sixteen) {
            let layers = self.work(plan).map_or(0.0, |work| work.fragments.estimate)
                / (f64::from(plan.view.width) * f64::from(plan.view.height));
            if layers > DEEP {
                warnings.push(format!(
                    "{layers:.0} layers of cells lie in a pixel on average, and 16 bits round after each of them; use quality.target_bits = 32, or \
                     quality.gpu_path = \"compute\""
                ));
            }
        }
        warnings
    }

    /// How high the picture is at the middle of the mesh, relative to about the size of that; not small with the eye within the mesh.
    fn share_in_picture(&self, plan: &Plan) -> f64 {
        let frame = self.mesh().frame();
        let distance = plan.view.eye.distance(frame.origin) / frame.scale;
        let depth = if plan.view.is_perspective { distance.max(1.0) } else { 1.0 / frame.scale };
        2.0 * plan.view.half_height * depth
    }

    /// Tetrahedra whose least height is below [`THIN`].
    fn cells_thinner_than_the_lattice(&self) -> usize {
        let mesh = self.mesh();
        let is_thin = |corners: &&[tetrascope_mesh::VertexId; 4]| {
            let [a, b, c, d] = corners.map(|v| mesh.positions()[v.index()]);
            let twice_area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).length();
            let largest =
                twice_area(a, b, c).max(twice_area(a, b, d)).max(twice_area(a, c, d)).max(twice_area(b, c, d));
            (b - a).cross(c - a).dot(d - a).abs() < THIN * largest
        };
        mesh.tetrahedra().par_iter().filter(|corners| is_thin(corners)).count()
    }

    /// Tetrahedra for which [`Sharpness::is_beyond_32_bits`].
    fn cells_beyond_32_bits(&self, plan: &Plan) -> usize {
        let sharpness = Sharpness::new(&plan.transfer, plan.model);
        let mesh = self.mesh();
        let scale = mesh.frame().scale;
        // Local coordinates are at most 1 long.
        if !sharpness.may_be_beyond_32_bits(2.0 * scale) {
            return 0;
        }
        let is_beyond = |corners: &&[tetrascope_mesh::VertexId; 4]| {
            let scalars = corners.map(|v| self.on_mesh.scalars[v.index()]);
            let points = corners.map(|v| mesh.positions()[v.index()]);
            let [low, high] =
                scalars.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], &s| [l.min(s), h.max(s)]);
            let pairs = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
            let longest = pairs.map(|(i, j)| points[i].distance(points[j])).fold(0.0, f64::max);
            sharpness.is_beyond_32_bits(low, high, longest * scale)
        };
        mesh.tetrahedra().par_iter().filter(|corners| is_beyond(corners)).count()
    }
}
