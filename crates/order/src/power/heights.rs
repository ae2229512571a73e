//! Heights of points whose lift is convex across every interior face, found by relaxation.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::FaceAdjacency;

use super::lifted::LiftedMesh;
use super::quadratic::quadratic_heights;
use super::relax::{Schedule, count_violated, relax};
use crate::Cells;

/// How much the search for heights may cost, counted in looks at a face so that the result does not depend on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Looks at each interior face on average; one is about 5 ns, and a tetrahedron has two faces. 0 leaves `|p|²`.
    pub visits_per_face: u32,
}

impl Budget {
    /// Some five seconds for a million tetrahedra at worst, and a tenth of that for meshes of mesh generators and for grids
    /// that are graded, jittered or gently bent. Enough for the blunt fin.
    pub const QUICK: Self = Self { visits_per_face: 400 };
    /// For heights that are kept.
    pub const THOROUGH: Self = Self { visits_per_face: 2000 };
}

impl Default for Budget {
    fn default() -> Self {
        Self::QUICK
    }
}

/// Where heights come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HeightSource {
    /// The squared distance from the mesh's middle: Delaunay meshes.
    SquaredDistance,
    /// A quadratic form of the position: hexahedra of one shape cut alike.
    QuadraticForm,
    /// Relaxation from the squared distance, every point in units of its shortest edge.
    LocalRelaxation,
    /// Relaxation from the squared distance, all points in one unit.
    GlobalRelaxation,
}

/// A height for every point of a mesh, and how far they order it as f64 sees it; [`PowerCertificate`](super::PowerCertificate)
/// has what is proven.
#[derive(Clone, Debug)]
pub struct Heights {
    /// One for each position, in squared units of the positions; what a linear function adds is arbitrary.
    pub values: Vec<f64>,
    /// Interior faces between cells of positive volume on different sides.
    pub faces: usize,
    /// Of these, faces across which `|p|²` is not convex.
    pub violated_at_first: usize,
    /// Faces across which the lift by `values` is not convex.
    pub violated: usize,
    /// The smallest convexity over all faces, relative to the shortest edge squared at their points; not positive where
    /// a face is violated, 0 without faces.
    pub worst: f64,
    /// Which attempt gave them.
    pub source: HeightSource,
    /// Looks at faces spent.
    pub visits: u64,
}

/// Looks at each face in local units: where these suit the mesh, half is enough; beyond, the relaxation circles.
const LOCAL_VISITS: u64 = 30;
const LOCAL_MARGINS: [f64; 2] = [1e-2, 1e-2];
const LOCAL_OVER: f64 = 1.5;

/// The margins begin where they bend the lift over many cells and end near what the thinnest cells can give.
const GLOBAL_MARGINS: [f64; 2] = [1e-1, 1e-3];
const GLOBAL_OVER: f64 = 1.8;

impl Heights {
    /// Looks for heights: `|p|²`, then a relaxation in local units, then the best quadratic form, then a relaxation in one
    /// unit with a margin that shrinks. Stops at the first that violates nothing, or gives the one that violates least.
    ///
    /// Deterministic, whatever the number of threads. Memory: 64 bytes a face while it runs, twice where faces are scaled.
    /// Source: [Edelsbrunner 1990] for why heights order a mesh.
    pub fn solve(cells: Cells<'_>, adjacency: &FaceAdjacency, budget: Budget) -> Self {
        let lifted = LiftedMesh::new(cells, adjacency);
        let center = middle(cells);
        let squares: Vec<f64> = cells.positions.par_iter().map(|&p| finite((p - center).length_squared())).collect();
        let all_visits = u64::from(budget.visits_per_face) * lifted.faces.len() as u64;
        let mut left = all_visits;

        let violated_at_first = count_violated(&lifted.faces, &squares);
        let mut best = (violated_at_first, HeightSource::SquaredDistance, squares.clone());
        let mut offer = |violated: usize, source: HeightSource, values: Vec<f64>| {
            if violated < best.0 {
                best = (violated, source, values);
            }
            best.0 == 0
        };
        let relaxed = |scales: &[f64], schedule: Schedule, left: &mut u64| {
            let faces = lifted.in_units_of(scales);
            let mut values: Vec<f64> = squares.iter().zip(scales).map(|(square, scale)| square / scale).collect();
            *left = left.saturating_sub(relax(&faces, &mut values, schedule));
            values.iter_mut().zip(scales).for_each(|(value, scale)| *value *= scale);
            (count_violated(&lifted.faces, &values), values)
        };

        let mut done = violated_at_first == 0 || left == 0;
        if !done {
            let visits = left.min(LOCAL_VISITS * lifted.faces.len() as u64);
            let schedule = Schedule { margins: LOCAL_MARGINS, over: LOCAL_OVER, visits };
            let (violated, values) = relaxed(&lifted.scales, schedule, &mut left);
            done = offer(violated, HeightSource::LocalRelaxation, values);
        }
        if !done && let Some((values, violated)) = quadratic_heights(&lifted.faces, cells.positions, center, &mut left)
        {
            done = offer(violated, HeightSource::QuadraticForm, values.into_iter().map(finite).collect());
        }
        if !done {
            let mean = lifted.scales.iter().sum::<f64>() / lifted.scales.len() as f64;
            let schedule = Schedule { margins: GLOBAL_MARGINS, over: GLOBAL_OVER, visits: left };
            let (violated, values) = relaxed(&vec![mean; lifted.scales.len()], schedule, &mut left);
            offer(violated, HeightSource::GlobalRelaxation, values);
        }
        let (violated, source, values) = best;
        let worst = worst_convexity(&lifted, &values);
        let visits = all_visits - left;
        Self { values, faces: lifted.faces.len(), violated_at_first, violated, worst, source, visits }
    }
}

/// The middle of the box around the points that cells use; 0 without any.
pub(super) fn middle(cells: Cells<'_>) -> DVec3 {
    let used = cells.tetrahedra.iter().flatten().map(|v| cells.positions[v.index()]);
    let (low, high) = used.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let middle = (low + high) * 0.5;
    if middle.is_finite() { middle } else { DVec3::ZERO }
}

/// Points that no cell uses may be NaN; their height stands for nothing.
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

fn worst_convexity(lifted: &LiftedMesh, values: &[f64]) -> f64 {
    let worst = lifted
        .faces
        .par_iter()
        .map(|face| {
            let length = face.weights.iter().map(|w| w * w).sum::<f64>().sqrt();
            let scale = face.points.iter().map(|&p| lifted.scales[p as usize]).fold(f64::INFINITY, f64::min);
            face.convexity(values) / (length * scale)
        })
        .reduce(|| f64::INFINITY, f64::min);
    if lifted.faces.is_empty() { 0.0 } else { worst }
}
