//! How wrong a picture of a field is.

use tetrascope_estimate::{BlendingOrder, ErrorEstimate, ROUNDING_OF_32_BITS, Subject, choose_integration, estimate};
use tetrascope_mesh::CellId;
use tetrascope_order::{CycleRemedy, Guarantee, OrderMethod};
use tetrascope_scene::{Backend, Completed, Interpolation, IsosurfaceMethod, Plan, Progress, Rendered, rough};
use tetrascope_view::LinearImage;

use crate::threads::on_threads;
use crate::{Error, VolumeField};

/// What `auto` trades for time where a scene does not say which error is wanted: nothing that a picture shows, whatever it is compared with.
const UNASKED: f64 = 1e-4;

impl VolumeField<'_> {
    /// How wrong a picture of this field is thought to be, measured on some of its rays: see [`tetrascope_estimate`].
    ///
    /// - `plan`: that the picture was drawn by
    ///
    /// # Errors
    /// [`Error::Render`].
    pub fn estimate_error(&self, plan: &Plan, rendered: &Rendered) -> Result<ErrorEstimate, Error> {
        on_threads(plan.threads, || {
            let ranks = (!self.has_right_order(plan, rendered)).then(|| self.ranks(plan));
            let order = ranks.as_deref().map_or(BlendingOrder::Right, BlendingOrder::Ranks);
            // The reference cuts rays whatever the plan says of segments and maps.
            let cuts = plan.backend == Backend::Reference;
            let mut drawn = plan.clone();
            if cuts {
                drawn.interpolation = Interpolation::Exact;
                if let Some(isosurfaces) = &mut drawn.isosurfaces {
                    isosurfaces.method = IsosurfaceMethod::Exact;
                }
            }
            let plan = &drawn;
            let subject = Subject { mesh: self.mesh(), scalars: &self.on_mesh.scalars, plan, order };
            Ok(estimate(&subject, &rendered.image)?)
        })?
    }

    /// The picture that all others are measured by: every ray against every cell, in f64, integrated exactly.
    ///
    /// # Errors
    /// [`Error::Render`].
    pub fn reference_picture(&self, plan: &Plan, progress: &dyn Progress) -> Result<LinearImage, Error> {
        let exact = Plan {
            backend: Backend::Reference,
            integration: tetrascope_integrate::Integration::Exact,
            interpolation: Interpolation::Exact,
            tables: None,
            ..plan.clone()
        };
        Ok(self.render(&exact, progress)?.image)
    }

    /// Settles an integration that was left open: the cheapest within the error that the scene wants, with the reason.
    ///
    /// # Errors
    /// [`Error::Scene`] and [`Error::Render`].
    pub(crate) fn settle_integration(&self, completed: &mut Completed) -> Result<(), Error> {
        let backend = completed.scene.backend;
        let wanted = completed.max_error();
        if wanted < ROUNDING_OF_32_BITS && backend != Some(Backend::Reference) {
            completed.warnings.push(format!(
                "an error of {} is wanted, and a picture in 32 bits may be off by {} in single pixels; quality.backend = \"reference\" is within \
                 1e-7, slowly",
                rough(wanted),
                rough(ROUNDING_OF_32_BITS)
            ));
        }
        if !completed.leaves_integration_open() || backend == Some(Backend::Reference) {
            return Ok(());
        }
        if backend == Some(Backend::Gpu) {
            // What methods take on a card is not known here, and the exact one has no error.
            return Ok(());
        }
        let plan = completed.scene.plan()?;
        let traded = if completed.asks_for_error() { wanted } else { wanted.min(UNASKED) };
        let choice = choose_integration(self.mesh(), &self.on_mesh.scalars, &plan, traded)?;
        Ok(completed.settle_integration(choice.integration, choice.tables, &choice.reason)?)
    }

    /// Whether every ray of a picture was blended in the right order, or the order does not matter.
    fn has_right_order(&self, plan: &Plan, rendered: &Rendered) -> bool {
        if plan.commutes() || plan.backend == Backend::Reference {
            return true;
        }
        let is_mended = plan.cycles != CycleRemedy::Report || rendered.order.rings == 0;
        match plan.order {
            OrderMethod::PerPixel => true,
            OrderMethod::Power => {
                let (cells, visibility) = (self.cells(), self.visibility());
                let certificate = visibility.power(cells).certificate();
                certificate.is_exact() && (visibility.is_convex(cells) || certificate.is_exact_across_gaps())
            }
            _ => match rendered.order.guarantee {
                Guarantee::Exact => is_mended,
                Guarantee::Faces => is_mended && self.visibility().is_convex(self.cells()),
                _ => false,
            },
        }
    }

    /// For every cell its place in the plan's order.
    fn ranks(&self, plan: &Plan) -> Vec<u32> {
        let (cells, visibility) = (self.cells(), self.visibility());
        let frame = self.mesh().frame();
        let viewpoint = plan.view.in_frame(frame.origin, frame.scale).viewpoint();
        let all: Vec<CellId> = (0..cells.tetrahedra.len() as u32).map(CellId).collect();
        let sorted = visibility.prepare(cells, plan.order).order(cells, viewpoint, &all);
        let mut ranks = vec![0; all.len()];
        for (rank, cell) in (0..).zip(&sorted.front_to_back) {
            ranks[cell.index()] = rank;
        }
        ranks
    }
}
