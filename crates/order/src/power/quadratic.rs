//! The quadratic form whose values at the points violate the fewest faces.

use glam::{DMat3, DVec3};

use super::lifted::LiftedFace;

/// Newton steps at most; where a form orders the whole mesh, six to eight find it.
const STEPS: u32 = 16;

/// Looks at a face that a step costs: one for the equations, and one or two for the sum of squares at its end.
const LOOKS_PER_STEP: u64 = 3;

/// A step that leaves more than this of the sum of squares is the last: no form orders the mesh.
const STALLED: f64 = 0.999;

/// Halvings of a step that makes the sum of squares larger.
const HALVINGS: u32 = 10;

/// The unknowns of a symmetric form in space.
const UNKNOWNS: usize = 6;

type Coefficients = [f64; UNKNOWNS];

/// Squares and products of coordinates: what the unknowns multiply.
fn products(p: DVec3) -> Coefficients {
    [p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.z * p.x]
}

/// Heights `pᵀ Q p` by the best form `Q`, and how many faces it violates; `None` if there is no face.
///
/// Affine images of meshes that `|p|²` orders are ordered by a form, and so are hexahedra of any one shape cut along the
/// same diagonals. Every face is one inequality in six unknowns, scaled to length 1; the sum of squares of what is
/// lacking to 1 is made smallest by Newton steps, each one pass over the faces and one system of six equations.
pub(super) fn quadratic_heights(
    faces: &[LiftedFace],
    positions: &[DVec3],
    center: DVec3,
    visits: &mut u64,
) -> Option<(Vec<f64>, usize)> {
    let rounding = rounding_map(faces, positions);
    let features: Vec<Coefficients> = faces.iter().filter_map(|face| feature(face, positions, rounding)).collect();
    let mut best: Option<(Coefficients, usize)> = None;
    // The map's own form first.
    let mut form = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    let mut cost = f64::INFINITY;
    for _ in 0..STEPS {
        let cost_of_step = LOOKS_PER_STEP * features.len() as u64;
        if *visits < cost_of_step {
            break;
        }
        *visits -= cost_of_step;
        let Some(target) = newton_target(&features, &form) else { break };
        let mut share = 1.0;
        let mut next = target;
        let mut next_cost = cost_of(&features, &next);
        for _ in 0..HALVINGS {
            if next_cost.0 <= cost {
                break;
            }
            share *= 0.5;
            next = std::array::from_fn(|k| form[k] + share * (target[k] - form[k]));
            next_cost = cost_of(&features, &next);
        }
        if next_cost.0 >= STALLED * cost {
            break;
        }
        (form, cost) = (next, next_cost.0);
        if best.is_none_or(|(_, violated)| next_cost.1 < violated) {
            best = Some((form, next_cost.1));
        }
        if next_cost.1 == 0 {
            break;
        }
    }
    let (form, _) = best?;
    let heights: Vec<f64> = positions.iter().map(|&p| dot(&products(rounding * (p - center)), &form)).collect();
    let violated = super::relax::count_violated(faces, &heights);
    Some((heights, violated))
}

fn dot(a: &Coefficients, b: &Coefficients) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A linear map after which the cells are as long in one direction as in another on the whole: the system of six equations is
/// then well conditioned, and for an affine image of a regular grid the first form is nearly the answer.
///
/// The inverse of the lower Cholesky factor of the edges' mean outer product; the identity if that is singular.
fn rounding_map(faces: &[LiftedFace], positions: &[DVec3]) -> DMat3 {
    let mut sum = DMat3::ZERO;
    for face in faces {
        let [a, b, c, d, _] = face.points.map(|p| positions[p as usize]);
        for edge in [b - a, c - b, a - c, d - a] {
            sum += DMat3::from_cols(edge * edge.x, edge * edge.y, edge * edge.z);
        }
    }
    let (xx, xy, xz) = (sum.x_axis.x, sum.x_axis.y, sum.x_axis.z);
    let (yy, yz, zz) = (sum.y_axis.y, sum.y_axis.z, sum.z_axis.z);
    let l11 = xx.sqrt();
    let (l21, l31) = (xy / l11, xz / l11);
    let l22 = (yy - l21 * l21).sqrt();
    let l32 = (yz - l31 * l21) / l22;
    let l33 = (zz - l31 * l31 - l32 * l32).sqrt();
    let lower = DMat3::from_cols(DVec3::new(l11, l21, l31), DVec3::new(0.0, l22, l32), DVec3::new(0.0, 0.0, l33));
    let inverse = lower.inverse() * xx.sqrt();
    if inverse.is_finite() { inverse } else { DMat3::IDENTITY }
}

/// What a face demands of the form, of length 1. The dependency's weights take linear parts away, so that any of the
/// points may be the origin.
fn feature(face: &LiftedFace, positions: &[DVec3], rounding: DMat3) -> Option<Coefficients> {
    let origin = positions[face.points[4] as usize];
    let mut sum = [0.0; UNKNOWNS];
    for (&point, weight) in face.points.iter().zip(face.weights).take(4) {
        for (sum, product) in sum.iter_mut().zip(products(rounding * (positions[point as usize] - origin))) {
            *sum += weight * product;
        }
    }
    let length = dot(&sum, &sum).sqrt();
    (length > 0.0 && length.is_finite()).then(|| sum.map(|s| s / length))
}

/// Sum of squares of what the faces lack, and how many are violated.
fn cost_of(features: &[Coefficients], form: &Coefficients) -> (f64, usize) {
    features.iter().fold((0.0, 0), |(cost, violated), feature| {
        let convexity = dot(feature, form);
        let lacking = (1.0 - convexity).max(0.0);
        (cost + lacking * lacking, violated + usize::from(convexity <= 0.0))
    })
}

/// Where the sum of squares over the faces that now lack something is smallest.
fn newton_target(features: &[Coefficients], form: &Coefficients) -> Option<Coefficients> {
    let mut matrix = [[0.0; UNKNOWNS]; UNKNOWNS];
    let mut right = [0.0; UNKNOWNS];
    for feature in features.iter().filter(|feature| dot(feature, form) < 1.0) {
        for i in 0..UNKNOWNS {
            right[i] += feature[i];
            for j in 0..UNKNOWNS {
                matrix[i][j] += feature[i] * feature[j];
            }
        }
    }
    // Keeps the system solvable where few faces lack anything; small against one face.
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] += 1e-9 * features.len() as f64;
    }
    solve(matrix, right)
}

/// Elimination without exchanges: the matrix is symmetric and positive definite.
fn solve(mut matrix: [[f64; UNKNOWNS]; UNKNOWNS], mut right: Coefficients) -> Option<Coefficients> {
    for pivot in 0..UNKNOWNS {
        let pivot_row = matrix[pivot];
        for row in pivot + 1..UNKNOWNS {
            let factor = matrix[row][pivot] / pivot_row[pivot];
            for column in pivot..UNKNOWNS {
                matrix[row][column] -= factor * pivot_row[column];
            }
            right[row] -= factor * right[pivot];
        }
    }
    for row in (0..UNKNOWNS).rev() {
        let known: f64 = (row + 1..UNKNOWNS).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right.iter().all(|r| r.is_finite()).then_some(right)
}
