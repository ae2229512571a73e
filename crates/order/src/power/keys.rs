//! Keys of cells, and how sure they are.

use glam::DVec3;
use tetrascope_view::Viewpoint;

use super::certify::determinant;
use super::double::{Double, ROUNDING};

/// A cell's affine function: `constant + gradient · (p - center)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellKey {
    gradient: DVec3,
    constant: f64,
}

/// A key, and how far rounding may have moved it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// Roundings of a key, in units of 2⁻⁵³ of the sum of its terms' magnitudes: one each for the difference from the center,
/// the stored gradient and the stored constant, four for products and sums, one for what is of second order.
const KEY_ROUNDING: f64 = 8.0 * f64::EPSILON / 2.0;

/// A cell's gradient in twice the precision, and what it was made from.
struct Slope {
    gradient: [Double; 3],
    /// From the last corner to the others.
    edges: [[Double; 3]; 3],
    /// From the last corner's height to the others'.
    rises: [Double; 3],
    /// Six times the volume.
    volume: Double,
}

impl Slope {
    fn new(positions: [DVec3; 4], heights: [f64; 4]) -> Self {
        let edge =
            |k: usize| -> [Double; 3] { std::array::from_fn(|i| Double::difference(positions[k][i], positions[3][i])) };
        let edges = [edge(0), edge(1), edge(2)];
        let rises: [Double; 3] = std::array::from_fn(|k| Double::difference(heights[k], heights[3]));
        let volume = determinant(edges);
        // Cramer's rule by columns: the rises in the place of one coordinate.
        let component = |i: usize| {
            let column = |k: usize| {
                let mut row = edges[k];
                row[i] = rises[k];
                row
            };
            determinant([column(0), column(1), column(2)]).over(volume)
        };
        Self { gradient: [component(0), component(1), component(2)], edges, rises, volume }
    }

    /// The function's value at the center.
    fn constant(&self, positions: [DVec3; 4], heights: [f64; 4], center: DVec3) -> Double {
        let along = |i: usize| self.gradient[i] * Double::difference(center[i], positions[3][i]);
        (0..3).fold(Double::from(heights[3]), |sum, i| sum + along(i))
    }
}

/// What a [`CellKey`] lacks to twice the precision: of the gradient and of the constant. NaN for a cell without volume.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rest([f64; 4]);

impl Rest {
    /// About half a microsecond.
    pub(super) fn new(positions: [DVec3; 4], heights: [f64; 4], center: DVec3) -> Self {
        let slope = Slope::new(positions, heights);
        let [x, y, z] = slope.gradient;
        let constant = slope.constant(positions, heights, center);
        let is_finite = [x, y, z, constant].iter().all(|part| part.high.is_finite());
        Self(if is_finite { [x.low, y.low, z.low, constant.low] } else { [f64::NAN; 4] })
    }
}

impl CellKey {
    /// The slope of the function.
    pub(super) fn gradient(&self) -> DVec3 {
        self.gradient
    }

    /// The value of the function at the center.
    pub(super) fn constant(&self) -> f64 {
        self.constant
    }

    /// The function through the heights of four corners, and whether it is as precise as f64 holds it. A cell without volume has
    /// none; it gets the key of `|p|²` at its centroid, so that it lies among its neighbors on a Delaunay mesh.
    pub(super) fn new(positions: [DVec3; 4], heights: [f64; 4], center: DVec3) -> (Self, bool) {
        let slope = Slope::new(positions, heights);
        let constant = slope.constant(positions, heights, center);
        let Slope { gradient: exact, edges, rises, volume } = slope;
        let gradient = DVec3::from_array(exact.map(|component| component.high));
        let key = Self { gradient, constant: constant.high };

        let lengths = edges.map(|edge| edge.iter().map(|component| component.high.abs()).sum::<f64>());
        let rise = rises.iter().map(|rise| rise.high.abs()).fold(0.0, f64::max);
        let slope = gradient.abs().max_element();
        // The permanents of both determinants are at most these.
        let volume_error = ROUNDING * 6.0 * lengths[0] * lengths[1] * lengths[2];
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let rise_error = ROUNDING * 18.0 * longest * longest * rise;
        let relative = (volume_error * slope + rise_error) / volume.high.abs();
        let is_finite = key.gradient.is_finite() && key.constant.is_finite();
        if is_finite {
            return (key, relative <= slope * f64::EPSILON / 8.0);
        }
        let centroid = (positions[0] + positions[1] + positions[2] + positions[3]) * 0.25 - center;
        (Self { gradient: centroid * 2.0, constant: -centroid.length_squared() }, false)
    }

    /// Smaller is nearer. From an eye the negated function there; along a direction, where the eye has gone to infinity
    /// against it, the slope along it.
    #[inline(always)]
    pub(super) fn at(&self, viewpoint: Viewpoint, center: DVec3, reach: f64) -> Key {
        match viewpoint {
            Viewpoint::Eye(eye) => {
                let offset = eye - center;
                Key { value: self.seen_from(offset), error: self.extent().error(viewpoint, center, reach) }
            }
            Viewpoint::Direction(direction) => {
                Key { value: self.along(direction), error: self.extent().error(viewpoint, center, reach) }
            }
        }
    }

    /// The value of the key for an eye, as offset from the center.
    #[inline(always)]
    pub(super) fn seen_from(&self, offset: DVec3) -> f64 {
        -(self.constant + self.gradient.dot(offset))
    }

    /// The value of the key along a direction.
    #[inline(always)]
    pub(super) fn along(&self, direction: DVec3) -> f64 {
        self.gradient.dot(direction)
    }

    /// The key in twice the precision; `None` for a cell without volume.
    pub(super) fn precise(&self, Rest([x, y, z, rest]): Rest, viewpoint: Viewpoint, center: DVec3) -> Option<Double> {
        let lows = [x, y, z];
        let gradient = |i: usize| Double { high: self.gradient[i], low: lows[i] };
        let along = |way: [Double; 3]| gradient(0) * way[0] + gradient(1) * way[1] + gradient(2) * way[2];
        let key = match viewpoint {
            Viewpoint::Eye(eye) => {
                let offset = std::array::from_fn(|i| Double::difference(eye[i], center[i]));
                -(along(offset) + Double { high: self.constant, low: rest })
            }
            Viewpoint::Direction(direction) => along(direction.to_array().map(Double::from)),
        };
        (rest.is_finite() && key.high.is_finite()).then_some(key)
    }

    /// What bounds the error of the key from anywhere.
    #[inline]
    pub(super) fn extent(&self) -> Extent {
        Extent { steepest: self.gradient.abs().max_element(), constant: self.constant.abs() }
    }
}

/// Magnitudes of a cell's function, or the largest of many.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Extent {
    steepest: f64,
    constant: f64,
}

impl Extent {
    /// The larger of each.
    pub(super) fn max(self, other: Self) -> Self {
        Self { steepest: self.steepest.max(other.steepest), constant: self.constant.max(other.constant) }
    }

    /// How far rounding may have moved a key.
    #[inline]
    pub(super) fn error(self, viewpoint: Viewpoint, center: DVec3, reach: f64) -> f64 {
        match viewpoint {
            Viewpoint::Eye(eye) => {
                let offset = (eye - center).abs().element_sum();
                KEY_ROUNDING * (self.constant + self.steepest * (offset + reach))
            }
            Viewpoint::Direction(direction) => KEY_ROUNDING * self.steepest * direction.abs().element_sum(),
        }
    }
}
