//! The functions of the power order as whole numbers, and what these still tell apart.

use glam::DVec3;
use rayon::prelude::*;
use tetrascope_mesh::{CellId, FaceAdjacency, VertexId};
use tetrascope_order::{Cells, Power};
use tetrascope_shaders::layout::PowerView;
use tetrascope_view::Viewpoint;

/// Bits of a component of a gradient, and of a constant: with an eye of 31 bits, sums stay within 96.
const GRADIENT_BITS: i32 = 60;
const CONSTANT_BITS: i32 = 62;
/// Bits of the components of an eye's offset, and the places that constants may be moved up by.
const EYE_BITS: i32 = 31;
/// How far from the plane of a face an eye may be whose order rounding turns: by the distance of the eye, but no less than the face's
/// longest edge; and by the reach of the mesh, as the lattice that is drawn rounds points no less.
const ANGLE: f64 = 1e-6;
const LATTICE: f64 = 1.0 / (1_u64 << 27) as f64;
/// Bits that keys keep whatever faces need: cells that see each other through a gap share none.
const FEWEST_BITS: u32 = 40;
/// Beyond this, exponents of scales are refused; that of 0 is the negative.
const EXPONENT: i32 = 400;

/// Why the order is not made on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NotResolved {
    /// Heights order not all faces.
    #[error("the keys of the power order are not proven right for every face")]
    NotExact,
    /// Some faces are turned by rounding.
    #[error("whole numbers of 64 bits do not tell apart the cells on the two sides of {faces} faces")]
    Faces {
        /// How many.
        faces: usize,
    },
    /// Nothing to scale by.
    #[error("the functions of the power order are too large, or too small")]
    OutOfRange,
}

/// The functions of all cells on common scales, and their bounds.
#[derive(Clone, Debug)]
pub(crate) struct PowerFunctions {
    /// Two entries a cell, as the shader has them.
    pub(crate) words: Vec<[u32; 4]>,
    center: DVec3,
    /// No point is farther from the center.
    reach: f64,
    /// Gradients are in 2^-this, constants in 2^-(this + `constant_exponent`).
    gradient_exponent: i32,
    constant_exponent: i32,
    /// Lowest and highest of gradients and of constants.
    bounds: [[i64; 2]; 4],
    /// What two keys of neighbors may differ by at least, from close by.
    finest: f64,
    /// The least difference of the gradients of neighbors.
    weakest: f64,
}

/// What a frame sorts by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PowerFrame {
    pub(crate) view: PowerView,
    /// Bits that keys have.
    pub(crate) bits: u32,
}

/// The lowest power of two that is larger, as exponent.
fn exponent(value: f64) -> i32 {
    if value > 0.0 { value.log2().floor() as i32 + 1 } else { -EXPONENT }
}

impl PowerFunctions {
    /// Rounds the functions, and looks at every face.
    ///
    /// # Errors
    /// [`NotResolved`]: the order is to be made on the CPU.
    pub(crate) fn new(power: &Power, cells: Cells<'_>, adjacency: &FaceAdjacency) -> Result<Self, NotResolved> {
        if !power.certificate().is_exact() {
            return Err(NotResolved::NotExact);
        }
        let center = power.center();
        let functions: Vec<(DVec3, f64)> =
            (0..cells.tetrahedra.len() as u32).into_par_iter().map(|cell| power.function(CellId(cell))).collect();
        let ends = functions
            .par_iter()
            .map(|&(_, constant)| [constant, constant])
            .reduce(|| [f64::INFINITY, f64::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        // What all have in common moves no key past another.
        let common = if functions.is_empty() { 0.0 } else { 0.5 * (ends[0] + ends[1]) };
        let steepest = functions.par_iter().map(|(g, _)| g.abs().max_element()).reduce(|| 0.0, f64::max);
        let highest = functions.par_iter().map(|(_, constant)| (constant - common).abs()).reduce(|| 0.0, f64::max);
        let reach = cells.tetrahedra.par_iter().flatten_iter();
        let reach = reach.map(|v| cells.positions[v.index()].distance(center)).reduce(|| 0.0, f64::max);
        let is_finite = steepest.is_finite() && highest.is_finite() && reach.is_finite();
        // What is 0 takes any scale.
        let exponent_of = |value: f64| if value > 0.0 { exponent(value) } else { 0 };
        let gradient_exponent = GRADIENT_BITS - exponent_of(steepest);
        let constant_exponent = (CONSTANT_BITS - exponent_of(highest) - gradient_exponent).min(-exponent_of(reach));
        let exponents = [gradient_exponent, constant_exponent, gradient_exponent + constant_exponent];
        if !is_finite || exponents.iter().any(|e| e.abs() >= EXPONENT) {
            return Err(NotResolved::OutOfRange);
        }
        let scales = [gradient_exponent, gradient_exponent + constant_exponent].map(|e| 2.0_f64.powi(e));
        let whole = |(gradient, constant): (DVec3, f64)| {
            let [x, y, z] = (gradient * scales[0]).to_array().map(|g| g.round() as i64);
            // Negated: keys ascend away from the eye.
            [x, y, z, -(((constant - common) * scales[1]).round() as i64)]
        };
        let halves = |value: i64| [value as u32, (value >> 32) as u32];
        let words = functions.par_iter().flat_map_iter(|&function| {
            let [x, y, z, constant] = whole(function).map(halves);
            [[x[0], x[1], y[0], y[1]], [z[0], z[1], constant[0], constant[1]]]
        });
        let words = words.collect();
        let bounds = functions.par_iter().map(|&function| whole(function).map(|value| [value, value])).reduce(
            || [[i64::MAX, i64::MIN]; 4],
            |a, b| std::array::from_fn(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])]),
        );
        let bounds = if functions.is_empty() { [[0; 2]; 4] } else { bounds };
        let faces = Faces { functions: &functions, reach, rounding: scales.map(|scale| 1.0 / scale) };
        let Judged { turned, finest, weakest } = faces.judge(cells, adjacency);
        if turned > 0 {
            return Err(NotResolved::Faces { faces: turned });
        }
        Ok(Self { words, center, reach, gradient_exponent, constant_exponent, bounds, finest, weakest })
    }

    /// What a frame sorts by; `None` if keys would need more than 64 bits, or the viewpoint is no number.
    pub(crate) fn view(&self, viewpoint: Viewpoint) -> Option<PowerFrame> {
        let offset = match viewpoint {
            Viewpoint::Eye(eye) => self.center - eye,
            Viewpoint::Direction(direction) => direction,
        };
        if !offset.is_finite() {
            return None;
        }
        // The unit of the axis: 2^-this.
        let farthest = offset.abs().max_element();
        let scale = (EYE_BITS - exponent(farthest)).min(self.constant_exponent + EYE_BITS);
        // So far away that all rays are parallel.
        let is_eye = matches!(viewpoint, Viewpoint::Eye(_)) && scale >= self.constant_exponent;
        let scale = if is_eye { scale } else { EYE_BITS - exponent(farthest) };
        let axis = if farthest > 0.0 { offset * 2.0_f64.powi(scale) } else { DVec3::ZERO };
        let axis = axis.to_array().map(|value| value.round() as i32);
        let shift = if is_eye { (scale - self.constant_exponent) as u32 } else { 0 };

        let mut ends = [0_i128; 2];
        for (bound, factor) in self.bounds.iter().zip(axis) {
            let products = bound.map(|value| i128::from(value) * i128::from(factor));
            ends = [ends[0] + products[0].min(products[1]), ends[1] + products[0].max(products[1])];
        }
        if is_eye {
            let constant = self.bounds[3].map(|value| i128::from(value) << shift);
            ends = [ends[0] + constant[0], ends[1] + constant[1]];
        }
        let range_bits = i128::BITS - (ends[1] - ends[0]).leading_zeros();
        let least = match is_eye {
            true => self.finest.max(ANGLE * self.weakest * (offset.length() - self.reach)),
            false => ANGLE * self.weakest * offset.length(),
        };
        // A quarter of what must be told apart may be lost.
        let may_drop = exponent(least.min(f64::MAX)) - 3 + self.gradient_exponent + scale;
        let drop = may_drop.clamp(0, range_bits.saturating_sub(FEWEST_BITS) as i32) as u32;
        let bits = range_bits - drop;
        let low = ends[0];
        let view = PowerView {
            axis: [axis[0], axis[1], axis[2], 0],
            lowest: [low as u32, (low >> 32) as u32, (low >> 64) as u32, 0],
            constant_shift: shift,
            has_constant: u32::from(is_eye),
            drop,
            unused: 0,
        };
        (bits <= u64::BITS).then_some(PowerFrame { view, bits })
    }
}

struct Faces<'a> {
    functions: &'a [(DVec3, f64)],
    reach: f64,
    /// One step of a gradient, and of a constant.
    rounding: [f64; 2],
}

#[derive(Clone, Copy)]
struct Judged {
    turned: usize,
    finest: f64,
    weakest: f64,
}

impl Faces<'_> {
    fn judge(&self, cells: Cells<'_>, adjacency: &FaceAdjacency) -> Judged {
        let none = Judged { turned: 0, finest: f64::MAX, weakest: f64::MAX };
        let and = |a: Judged, b: Judged| Judged {
            turned: a.turned + b.turned,
            finest: a.finest.min(b.finest),
            weakest: a.weakest.min(b.weakest),
        };
        let of_cell = |(cell, points): (usize, &[VertexId; 4])| {
            let of_corner = |corner: usize| {
                let other = adjacency.neighbor(CellId(cell as u32), corner)?.index();
                let face = [1, 2, 3].map(|k| cells.positions[points[(corner + k) % 4].index()]);
                (other > cell).then(|| self.judge_face([cell, other], face))
            };
            (0..4).filter_map(of_corner).fold(none, and)
        };
        cells.tetrahedra.par_iter().enumerate().map(of_cell).reduce(|| none, and)
    }

    /// The difference of two cells' functions is their gradients' difference times the distance from the face's plane: how much of that
    /// rounding takes from twice the reach of the mesh. Farther eyes may be farther from the plane in the same measure.
    fn judge_face(&self, pair: [usize; 2], [a, b, c]: [DVec3; 3]) -> Judged {
        let [(g, k), (h, l)] = pair.map(|cell| self.functions[cell]);
        let jump = (g - h).length();
        let edge = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let finest = jump * (ANGLE * edge + LATTICE * self.reach);
        let far = 3.0_f64.sqrt() * 2.0 * self.reach;
        let stored = k.abs() + l.abs() + (g.length() + h.length()) * 2.0 * far;
        let error = self.rounding[0] * far + self.rounding[1] + 2.0 * f64::EPSILON * stored;
        // Not "or": what is no number is not resolved.
        let is_resolved = error <= 0.25 * finest && finest > 0.0;
        Judged { turned: usize::from(!is_resolved), finest, weakest: jump }
    }
}
