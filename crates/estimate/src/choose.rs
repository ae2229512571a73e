//! The cheapest integration whose error is within what is wanted.

use rayon::prelude::*;
use tetrascope_cpu::RenderError;
use tetrascope_cpu::rays::RayTracer;
use tetrascope_integrate::{Integration, TableSettings};
use tetrascope_mesh::TetMesh;
use tetrascope_scene::{Plan, Silent, rough, short};

use crate::bound::bounds;
use crate::cost::Work;
use crate::estimate::{BlendingOrder, Subject};
use crate::probe::{Probe, channels, difference};
use crate::survey::Survey;

/// Rays that are traced for a choice, before those around the worst.
const RAYS: usize = 384;

/// A method is worth its error only if it is expected to take less than this share of the time of the exact one.
const WORTH: f64 = 0.85;

/// What the largest error of a picture in 32 bits by an exact integration in an exact order stays below, as a rule: rounding, and steps of the
/// transfer function or isosurfaces in single pixels.
pub const ROUNDING_OF_32_BITS: f64 = 5e-5;

/// What other errors must leave to rounding.
const RESERVE: f64 = 5e-6;

/// Share of the pixels in a cell's outline that the cell covers.
const COVERED: f64 = 0.36;

/// An integration, and why it was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegrationChoice {
    /// The cheapest that is right enough.
    pub integration: Integration,
    /// Sizes of its table, if it has one.
    pub tables: Option<TableSettings>,
    /// Why.
    pub reason: String,
    /// All that were looked at, the cheapest first.
    pub candidates: Vec<Candidate>,
}

/// A method that was looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The method.
    pub integration: Integration,
    /// Expected time, as a share of that of the exact integration.
    pub relative_time: f64,
    /// What its error does not exceed; `None` if no bound is known, or if none was asked for.
    pub bound: Option<f64>,
    /// What its largest error is expected to be; `None` if nobody had to know.
    pub expected: Option<f64>,
}

/// Chooses an integration for the CPU back end: the cheapest that is expected to be within `max_error` of the exact picture, from
/// bounds over all cells where these are enough, else from a few hundred rays. No picture is drawn.
///
/// - `plan`: everything but its integration and its tables counts
///
/// # Errors
/// [`RenderError`] as [`RayTracer::new`] and [`RayTracer::shader`].
pub fn choose_integration(
    mesh: &TetMesh,
    scalars: &[f64],
    plan: &Plan,
    max_error: f64,
) -> Result<IntegrationChoice, RenderError> {
    let tracer = RayTracer::new(mesh, scalars, &plan.view)?;
    let work = work(mesh, scalars, plan, &tracer);
    let time =
        |integration: Integration| work.nanoseconds(integration, plan.model, TableSettings::of(integration).as_ref());
    let of_exact = time(Integration::Exact);
    let mut candidates: Vec<Candidate> = Integration::ALL
        .into_iter()
        .filter(|integration| *integration != Integration::Exact && is_possible(*integration, plan))
        .map(|integration| Candidate {
            integration,
            relative_time: time(integration) / of_exact,
            bound: None,
            expected: None,
        })
        .filter(|candidate| candidate.relative_time < WORTH)
        .collect();
    candidates.sort_by(|a, b| a.relative_time.total_cmp(&b.relative_time));
    let mut probe = None;
    for index in 0..candidates.len() {
        let candidate = &mut candidates[index];
        let integration = candidate.integration;
        let tables = TableSettings::of(integration);
        let with = Plan { integration, tables, ..plan.clone() };
        let subject = Subject { mesh, scalars, plan: &with, order: BlendingOrder::Right };
        candidate.bound = bounds(&subject, &tracer).integration;
        let mut said = None;
        if let Some(bound) = candidate.bound.filter(|bound| bound + RESERVE <= max_error) {
            said = Some(format!("its error is at most {}", rough(bound)));
        } else {
            let probe: &mut Probe<'_> = match &mut probe {
                Some(probe) => probe,
                empty => empty.insert(Probe::new(&tracer, plan, RAYS)?),
            };
            let shader = tracer.shader(&with, &Silent)?;
            let errors = probe
                .look_for_worse(|probe, ray| difference(&channels(shader.light(&probe.rays, ray)), &probe.exact[ray]));
            let expected = probe.extrapolated(errors.iter().copied().fold(0.0, f64::max));
            candidate.expected = Some(expected);
            if expected + RESERVE <= max_error {
                said = Some(format!("its error is estimated at {} on {} rays", rough(expected), errors.len()));
            }
        }
        if let Some(said) = said {
            let percent = short((100.0 * candidate.relative_time).round());
            let reason =
                format!("{said}, within {}; it is expected to take {percent} % of the time of exact", rough(max_error));
            return Ok(IntegrationChoice { integration, tables, reason, candidates });
        }
    }
    let reason = if candidates.is_empty() {
        "closed form in every piece of the transfer function, and no other way takes much less time here".to_owned()
    } else {
        format!(
            "closed form in every piece of the transfer function; those that take less time are not within {}",
            rough(max_error)
        )
    };
    Ok(IntegrationChoice { integration: Integration::Exact, tables: None, reason, candidates })
}

/// What a frame has to do, guessed from the outlines of cells.
fn work(mesh: &TetMesh, scalars: &[f64], plan: &Plan, tracer: &RayTracer<'_>) -> Work {
    let survey = Survey::new(mesh, scalars, plan);
    let outlines: f64 =
        tracer.seen().par_iter().map(|(_, [x0, x1, y0, y1])| f64::from(x1 - x0 + 1) * f64::from(y1 - y0 + 1)).sum();
    let visible = survey.visible as f64 / (mesh.tetrahedra().len() as f64).max(1.0);
    Work::new(&survey, tracer.seen().len() as f64 * visible, outlines * COVERED * visible)
}

/// Whether a plan may have an integration.
fn is_possible(integration: Integration, plan: &Plan) -> bool {
    let with = Plan { integration, tables: None, ..plan.clone() };
    with.check().is_ok()
}
