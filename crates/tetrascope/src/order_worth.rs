//! Which order a mesh is given, and what it was worth in a picture.

use tetrascope_order::{CycleRemedy, Guarantee, OrderMethod, Overlaps, PowerCertificate};
use tetrascope_scene::{Backend, Completed, Plan, Rendered, short};

use crate::threads::on_threads;
use crate::{Error, VolumeField};

/// What the order of a picture was worth, in sentences.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OrderWorth {
    /// How far it can be trusted.
    pub summary: String,
    /// Cells that hide one another in rings, and what was done; `None` where there are none or nobody looked.
    pub rings: Option<String>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl VolumeField<'_> {
    /// The plan of a completed scene for this mesh: an order and a back end that the scene leaves open are settled, in
    /// `completed` too.
    ///
    /// What is learned of the mesh for that (whether it is convex, whether it is Delaunay) is kept for the pictures. If the scene says so, heights
    /// are read from the file beside the mesh, provided that nothing is known of the mesh yet; where they do not fit, `completed` has a
    /// warning.
    ///
    /// # Errors
    /// [`Error::Scene`] as [`Scene::plan`](tetrascope_scene::Scene::plan), [`Error::Render`] as [`Self::renderer`].
    pub fn plan(&self, completed: &mut Completed) -> Result<Plan, Error> {
        on_threads(completed.scene.threads, || {
            // Before a renderer asks what is known of the mesh.
            self.read_kept_heights(completed)?;
            self.settle_backend(completed)?;
            self.settle_integration(completed)?;
            self.settle_order(completed)
        })??;
        let mut plan = completed.scene.plan()?;
        plan.decisions.clone_from(&completed.decisions);
        Ok(plan)
    }

    /// Reads heights that were kept, if they are of use.
    fn read_kept_heights(&self, completed: &mut Completed) -> Result<(), Error> {
        let keeps_heights = completed.file.quality.keep_heights == Some(true);
        let has_use = completed.leaves_order_open() || completed.scene.order == Some(OrderMethod::Power);
        if keeps_heights && has_use && completed.scene.backend != Some(Backend::Reference) {
            completed.warnings.extend(self.read_heights()?);
        }
        Ok(())
    }

    /// Settles an order that was left open.
    fn settle_order(&self, completed: &mut Completed) -> Result<(), Error> {
        let keeps_heights = completed.file.quality.keep_heights == Some(true);
        let is_open = completed.leaves_order_open();
        if is_open {
            if completed.scene.backend != Some(Backend::Gpu) {
                // It will be needed, and has the cells.
                self.renderer()?;
            }
            let (cells, visibility) = (self.cells(), self.visibility());
            if keeps_heights && self.heights_path().is_some() {
                // Looking for heights takes longer than many frames; those that are kept are looked for once.
                visibility.power(cells);
            }
            let choice = visibility.choose(cells);
            completed.settle_order(choice.method, choice.reason);
        }
        Ok(())
    }

    /// What the order of a picture of this field was worth.
    pub fn order_worth(&self, plan: &Plan, rendered: &Rendered) -> OrderWorth {
        let mut worth = OrderWorth::default();
        if plan.commutes() {
            "nothing depends on the order".clone_into(&mut worth.summary);
            return worth;
        }
        let (cells, visibility) = (self.cells(), self.visibility());
        if plan.backend == Backend::Reference {
            // It needs to know nothing of the mesh; to look costs next to nothing beside its picture.
            let overlaps = visibility.overlaps(cells);
            worth.summary = if overlaps.any() {
                worth.warnings.push(overlapping(&overlaps));
                "sorted along every ray, exact but where tetrahedra overlap".to_owned()
            } else {
                "exact: sorted along every ray".to_owned()
            };
            return worth;
        }
        let across_gaps = "; the mesh is not convex, and across its gaps the order is a guess";
        worth.summary = match plan.order {
            OrderMethod::PerPixel if visibility.known_overlaps().is_some_and(|overlaps| overlaps.any()) => {
                "sorted in every pixel, exact but where tetrahedra overlap".to_owned()
            }
            OrderMethod::PerPixel => "exact: sorted in every pixel".to_owned(),
            OrderMethod::KBuffer { window } => {
                format!("not guaranteed: by centers, mended in every pixel within {window} cells")
            }
            OrderMethod::None => "none: cells are blended as they come".to_owned(),
            OrderMethod::Power => {
                let certificate = visibility.power(cells).certificate();
                if certificate.is_exact() {
                    let gaps = if visibility.is_convex(cells) {
                        ""
                    } else if certificate.is_exact_across_gaps() {
                        ", and across the gaps of the mesh"
                    } else {
                        across_gaps
                    };
                    format!("proven for all {} faces between cells{gaps}", certificate.faces)
                } else {
                    worth.warnings.push(unproven(&certificate));
                    "not proven for this mesh: neighbors may come in the wrong order".to_owned()
                }
            }
            _ => match rendered.order.guarantee {
                Guarantee::Exact if visibility.is_convex(cells) => "exact: the mesh is convex".to_owned(),
                Guarantee::Exact => "exact, across gaps of the mesh too".to_owned(),
                Guarantee::Overlapping => "exact but where tetrahedra overlap".to_owned(),
                Guarantee::Faces => format!("exact for neighbors{across_gaps}"),
                _ => "not guaranteed: by one point of a cell, so that neighbors may come in the wrong order".to_owned(),
            },
        };
        if let Some(overlaps) = visibility.known_overlaps().filter(Overlaps::any) {
            worth.warnings.push(overlapping(&overlaps));
        }
        if rendered.order.rings > 0 {
            worth.rings = Some(rings(plan.cycles, rendered));
        }
        worth
    }
}

fn overlapping(overlaps: &Overlaps) -> String {
    let Overlaps { folded, piercing, contained, is_complete } = *overlaps;
    let mut found = Vec::new();
    for (count, what) in [
        (folded, "pairs of tetrahedra lie on one side of a face that both have"),
        (piercing, "pairs of boundary faces pass through each other"),
        (contained, "parts of the mesh lie inside others"),
    ] {
        if count > 0 {
            found.push(format!("{count} {what}"));
        }
    }
    let more = if is_complete { "" } else { ", and not everything was looked at" };
    format!(
        "the mesh overlaps itself: {}{more}. A ray is in two tetrahedra at once there, and no picture is right; mend the mesh",
        found.join(", ")
    )
}

fn unproven(certificate: &PowerCertificate) -> String {
    let PowerCertificate { faces, violated, folded, flat, imprecise, gaps: _ } = *certificate;
    let share = 100.0 * violated as f64 / faces.max(1) as f64;
    format!(
        "the order \"power\" is not proven for this mesh: {violated} of {faces} faces between cells ({} %) are not convex under the \
         heights found, {folded} are folded, {flat} belong to cells without volume, and {imprecise} cells are too thin for \
         their key; neighbors there may come in the wrong order. \"auto\", \"bsp-xmpvo\" and \"per-pixel\" are right",
        short(share)
    )
}

fn rings(remedy: CycleRemedy, rendered: &Rendered) -> String {
    let (cells, rings) = (rendered.counts.cyclic, rendered.order.rings);
    let plural = if rings == 1 { "" } else { "s" };
    let done = match (remedy, rendered.order.rings_left) {
        (CycleRemedy::Report, _) => {
            "they are blended by the distance of their centers, which may be wrong there; cycles \"per-pixel\" is right, and so is \
             \"cut\" for those that can be cut"
                .to_owned()
        }
        (CycleRemedy::Cut, 0) => "those of them that are drawn are cut so that an order is right".to_owned(),
        (CycleRemedy::Cut, left) => format!(
            "those of them that are drawn are cut so that an order is right, but for {left} rings whose tetrahedra overlap or are \
             too many: the pixels that these cover are sorted ray by ray"
        ),
        (CycleRemedy::PerPixel, _) => "the pixels that they cover are sorted ray by ray".to_owned(),
    };
    format!(
        "{cells} tetrahedra hide one another in {rings} ring{plural}, where no order of whole cells is right; {done}"
    )
}
