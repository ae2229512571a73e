//! What `tetrascope check` tells: what a mesh is like for visibility orders, and how far each of them is right from a view.

use std::borrow::Cow;
use std::time::{Duration, Instant};

use tetrascope_mesh::{CellId, Decomposition, FaceAdjacency, MeshReport, check};
use tetrascope_order::{Budget, OrderMethod, Overlaps, Power, PowerCertificate, Relations, Verdict};
use tetrascope_scene::{Backend, Plan, Progress};
use tetrascope_view::{LinearImage, PixelDifference};

use crate::threads::on_threads;
use crate::{Error, VolumeField};

/// What a mesh is like for visibility orders, from wherever it is seen.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshCheck {
    /// What is odd about the mesh that is drawn.
    pub report: MeshReport,
    /// Tetrahedra left out of it since the field is not finite at one of their corners.
    pub left_out: usize,
    /// Faces of the tetrahedra, each once.
    pub faces: usize,
    /// Whether no ray leaves the mesh and enters it again.
    pub is_convex: bool,
    /// Where tetrahedra overlap.
    pub overlaps: Overlaps,
    /// What is proven of the heights `|p|²`, whatever other heights are known: whether the mesh is Delaunay.
    pub delaunay: PowerCertificate,
    /// What is proven of the best heights known; `None` where none were looked for.
    pub power: Option<PowerCertificate>,
}

/// What an order is worth from one view.
#[derive(Clone, Debug)]
pub struct OrderCheck {
    /// The order.
    pub method: OrderMethod,
    /// Pairs of cells in the wrong order; `None` for orders that are left to the pixels.
    pub verdict: Option<Verdict>,
    /// Wall time of sorting all cells of the mesh, once everything about the mesh is known. Without what pixels sort.
    pub sorted_in: Duration,
    /// Wall time of drawing the picture, likewise.
    pub drawn_in: Duration,
    /// Where the picture differs from one that is sorted in every pixel.
    pub pixels: PixelDifference,
}

/// Pixels in which anything is seen: those with a channel that is not 0.
pub fn seen_pixels(picture: &LinearImage) -> usize {
    picture.pixels().iter().filter(|pixel| pixel.iter().any(|channel| *channel != 0.0)).count()
}

impl VolumeField<'_> {
    /// Looks at the mesh that this field is drawn on: the volume's, without the cells at which the field is not finite.
    ///
    /// - `decomposition`: of the volume that the field is from
    /// - `with_heights`: whether heights are looked for where the mesh is not Delaunay, which may take seconds
    /// - `threads`: as [`Plan::threads`]
    ///
    /// # Errors
    /// [`Error::Render`] as [`Self::renderer`], and if the threads cannot be started.
    pub fn check_mesh(
        &self,
        decomposition: &Decomposition,
        with_heights: bool,
        threads: Option<usize>,
    ) -> Result<MeshCheck, Error> {
        on_threads(threads, || self.check_mesh_here(decomposition, with_heights))?
    }

    fn check_mesh_here(&self, decomposition: &Decomposition, with_heights: bool) -> Result<MeshCheck, Error> {
        let renderer = self.renderer()?;
        let (cells, visibility) = (renderer.cells(), renderer.visibility());
        let report = self.report(decomposition);
        let adjacency = visibility.adjacency(cells);
        let joined: usize =
            adjacency.table().iter().flatten().filter(|&&neighbor| neighbor != FaceAdjacency::NONE).count() / 2;
        let faces = joined + adjacency.boundary_faces().len() + adjacency.non_manifold_faces().len();
        let is_convex = visibility.is_convex(cells);
        let known = visibility.quick_certificate(cells);
        let delaunay = if self.made.known.get().is_some_and(|known| known.has_read_heights) {
            // What is known is of those heights.
            let squares = Power::with_adjacency(cells, adjacency, Budget { visits_per_face: 0 });
            squares.prove_gaps(cells, adjacency, is_convex).certificate()
        } else {
            known
        };
        let power =
            if known.is_exact() { Some(known) } else { with_heights.then(|| visibility.power(cells).certificate()) };
        let overlaps = visibility.overlaps(cells);
        Ok(MeshCheck { report, left_out: self.on_mesh.left_out, faces, is_convex, overlaps, delaunay, power })
    }

    /// What is odd about the mesh that is drawn.
    fn report(&self, decomposition: &Decomposition) -> MeshReport {
        let of =
            |decomposition: &Decomposition| check(decomposition, &FaceAdjacency::new(decomposition.mesh.tetrahedra()));
        match &self.on_mesh.mesh {
            Cow::Borrowed(_) => of(decomposition),
            Cow::Owned(mesh) => of(&Decomposition { mesh: mesh.clone(), ..decomposition.clone() }),
        }
    }

    /// Which cells come before which as the plan's view has them.
    ///
    /// # Errors
    /// [`Error::Render`] as [`Self::renderer`].
    pub fn relations(&self, plan: &Plan) -> Result<Relations<'_>, Error> {
        let renderer = self.renderer_on(plan.threads)?;
        let viewpoint = self.view(plan).viewpoint();
        on_threads(plan.threads, || renderer.visibility().relations(renderer.cells(), viewpoint))
    }

    /// The picture that orders are measured by: every pixel sorts what its ray meets.
    ///
    /// # Errors
    /// [`Error::Render`].
    pub fn exact_picture(&self, plan: &Plan, progress: &dyn Progress) -> Result<LinearImage, Error> {
        let plan = Plan { order: OrderMethod::PerPixel, backend: Backend::Cpu, ..plan.clone() };
        Ok(self.render(&plan, progress)?.image)
    }

    /// Judges an order from the plan's view: all pairs of cells of the mesh, and the plan's picture with this order in the place of its own.
    ///
    /// - `relations`, `exact`: [`Self::relations`] and [`Self::exact_picture`] of the same plan
    ///
    /// # Errors
    /// [`Error::Render`].
    pub fn check_order(
        &self,
        plan: &Plan,
        method: OrderMethod,
        relations: &Relations<'_>,
        exact: &LinearImage,
        progress: &dyn Progress,
    ) -> Result<OrderCheck, Error> {
        let renderer = self.renderer_on(plan.threads)?;
        let cells = renderer.cells();
        let viewpoint = self.view(plan).viewpoint();
        let all: Vec<CellId> = (0..cells.tetrahedra.len() as u32).map(CellId).collect();
        let is_left_to_pixels = matches!(method, OrderMethod::KBuffer { .. } | OrderMethod::PerPixel);
        let (sorted_in, verdict) = on_threads(plan.threads, || {
            let order = renderer.visibility().prepare(cells, method);
            let start = Instant::now();
            let sorted = order.order(cells, viewpoint, &all);
            let sorted_in = start.elapsed();
            (sorted_in, (!is_left_to_pixels).then(|| relations.judge(&sorted.front_to_back)))
        })?;
        let plan = Plan { order: method, backend: Backend::Cpu, ..plan.clone() };
        let start = Instant::now();
        let picture = renderer.render(&plan, progress)?.image;
        let drawn_in = start.elapsed();
        Ok(OrderCheck { method, verdict, sorted_in, drawn_in, pixels: PixelDifference::between(&picture, exact) })
    }

    /// The plan's view in the coordinates of the mesh.
    fn view(&self, plan: &Plan) -> tetrascope_view::View {
        let frame = self.on_mesh.mesh.frame();
        plan.view.in_frame(frame.origin, frame.scale)
    }
}
