//! How wrong a picture is, measured on some of its rays.

use rayon::prelude::*;
use tetrascope_cpu::RenderError;
use tetrascope_cpu::rays::{RayShader, RayTracer};
use tetrascope_mesh::TetMesh;
use tetrascope_order::PixelSort;
use tetrascope_scene::{Interpolation, Plan, Silent};
use tetrascope_view::LinearImage;

use crate::EstimateError;
use crate::bound::{Bounds, bounds};
use crate::probe::{Probe, channels, difference};

/// Rays that are traced for an estimate, before those around the worst.
pub const RAYS: usize = 1024;

/// What a picture is of.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The mesh.
    pub mesh: &'a TetMesh,
    /// One a point.
    pub scalars: &'a [f64],
    /// What was asked for.
    pub plan: &'a Plan,
    /// In which order cells were blended.
    pub order: BlendingOrder<'a>,
}

/// The order in which cells of a picture were blended.
#[derive(Clone, Copy, Debug)]
pub enum BlendingOrder<'a> {
    /// The right one on every ray, or one on which nothing depends.
    Right,
    /// For every tetrahedron of the mesh its place, the least in front.
    Ranks(&'a [u32]),
}

/// Where an error comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// How a ray's way through a cell becomes light.
    Integration,
    /// In which order cells are blended.
    Order,
    /// How that way is found at a pixel.
    Interpolation,
    /// Isosurfaces that are looked up in maps, half a sample beside their values.
    Isosurfaces,
    /// Rounding: of the cells, of their light, and of adding it up; and rays that end where hardly anything comes through.
    Blending,
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Integration => "integration",
            Self::Order => "order",
            Self::Interpolation => "interpolation",
            Self::Isosurfaces => "isosurfaces",
            Self::Blending => "blending",
        })
    }
}

/// What one cause has to do with a picture's error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorPart {
    /// The cause.
    pub cause: Cause,
    /// An estimate of the largest error of any channel of any pixel that it makes by itself.
    pub expected: f64,
    /// What that error does not exceed; `None` where no bound is known. 0 is no error at all, but for rounding, which is a part of its own.
    pub bound: Option<f64>,
}

/// How wrong a picture is thought to be.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// One a cause.
    pub parts: [ErrorPart; 5],
    /// An estimate of the largest error of any channel of any pixel, from all causes.
    pub expected: f64,
    /// What that error does not exceed, whatever the rays say.
    pub bound: f64,
    /// Rays on which it was measured.
    pub rays: usize,
}

/// The least error that is ever expected: rounding of a channel near 1 to 32 bits.
const ROUNDING: f64 = 6e-8;

/// Measures a picture on about [`RAYS`] rays, traced in f64 and integrated exactly, and says what the whole of it is expected to be like.
///
/// # Errors
/// [`EstimateError::PictureSize`] and [`EstimateError::Ranks`], else as [`RayTracer::new`] and [`RayTracer::shader`].
pub fn estimate(subject: &Subject<'_>, picture: &LinearImage) -> Result<ErrorEstimate, EstimateError> {
    let Subject { mesh, scalars, plan, .. } = *subject;
    let (found, expected) = ([picture.width(), picture.height()], [plan.view.width, plan.view.height]);
    if found != expected {
        return Err(EstimateError::PictureSize { found, expected });
    }
    if let BlendingOrder::Ranks(ranks) = subject.order
        && ranks.len() != mesh.tetrahedra().len()
    {
        return Err(EstimateError::Ranks { ranks: ranks.len(), cells: mesh.tetrahedra().len() });
    }
    let tracer = RayTracer::new(mesh, scalars, &plan.view)?;
    let mut probe = Probe::new(&tracer, plan, RAYS)?;
    let pixel = |probe: &Probe<'_>, ray: usize| {
        let [x, y] = probe.rays.pixels()[ray];
        picture.pixel(x, y).map(f64::from)
    };
    let errors = probe.look_for_worse(|probe, ray| difference(&pixel(probe, ray), &probe.exact[ray]));
    let method = Method::of(subject, &tracer)?;
    // What the methods make of each ray, without the rounding of a back end.
    let lights: Vec<[[f64; 4]; 2]> =
        (0..probe.rays.len()).into_par_iter().map(|ray| method.lights(&probe, ray)).collect();
    let part = |cause: Cause, error: &(dyn Fn(usize) -> f64 + Sync), bound: Option<f64>| {
        let largest = (0..probe.rays.len()).map(error).fold(0.0, f64::max);
        // What is guessed beyond what was measured does not go beyond the bound.
        let expected = probe.extrapolated(largest).min(bound.unwrap_or(f64::INFINITY)).max(largest);
        ErrorPart { cause, expected, bound }
    };
    let Bounds { integration, order, interpolation, surfaces, total } = bounds(subject, &tracer);
    // What is left has one cause that is not rounding, at most.
    let has_maps = surfaces.is_none();
    let interpolates = plan.interpolation != Interpolation::Exact && !has_maps;
    let rest = |ray: usize| difference(&pixel(&probe, ray), &lights[ray][1]);
    let rest_if = |is_cause: bool, cause: Cause, bound: Option<f64>| {
        if is_cause { part(cause, &rest, bound) } else { ErrorPart { cause, expected: 0.0, bound: Some(0.0) } }
    };
    let parts = [
        part(Cause::Integration, &|ray| difference(&lights[ray][0], &probe.exact[ray]), integration),
        part(Cause::Order, &|ray| difference(&lights[ray][1], &lights[ray][0]), order),
        rest_if(interpolates, Cause::Interpolation, interpolation),
        rest_if(has_maps, Cause::Isosurfaces, surfaces),
        if interpolates || has_maps {
            ErrorPart { cause: Cause::Blending, expected: ROUNDING, bound: None }
        } else {
            part(Cause::Blending, &rest, None)
        },
    ];
    let largest = errors.iter().copied().fold(0.0, f64::max);
    // Added, as the pixel itself was rounded once more.
    let expected = (probe.extrapolated(largest) + ROUNDING).min(total);
    Ok(ErrorEstimate { parts, expected, bound: total, rays: probe.rays.len() })
}

/// The methods of a plan along a ray.
struct Method<'a> {
    shader: RayShader<'a>,
    order: BlendingOrder<'a>,
    sort: PixelSort,
}

impl<'a> Method<'a> {
    fn of(subject: &Subject<'a>, tracer: &'a RayTracer<'a>) -> Result<Self, RenderError> {
        let plan = subject.plan;
        Ok(Self { shader: tracer.shader(plan, &Silent)?, order: subject.order, sort: plan.order.pixel_sort() })
    }

    /// The light of a ray in the right order, and in that of the picture.
    fn lights(&self, probe: &Probe<'_>, ray: usize) -> [[f64; 4]; 2] {
        let Self { shader, .. } = self;
        let right = channels(shader.light(&probe.rays, ray));
        let rank = |ranks: &'a [u32]| move |cell: u32| ranks[cell as usize];
        let drawn = match (self.order, self.sort) {
            (BlendingOrder::Right, _) => right,
            (BlendingOrder::Ranks(ranks), PixelSort::Window(window)) => {
                channels(shader.light_in_window(&probe.rays, ray, rank(ranks), window as usize))
            }
            (BlendingOrder::Ranks(ranks), _) => channels(shader.light_by_rank(&probe.rays, ray, rank(ranks))),
        };
        [right, drawn]
    }
}
