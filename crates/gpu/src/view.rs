//! From a view to what the shaders know of it.

use glam::{DVec3, IVec3};
use tetrascope_shaders::layout::{Frame, LATTICE_STEP, TILE_SIDE, UNIT};
use tetrascope_view::View;

/// The part of a picture that is drawn, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    /// First column and row.
    pub(crate) origin: [u32; 2],
    /// Width and height.
    pub(crate) extent: [u32; 2],
}

/// How far from the origin the base may lie along each axis, local units: in front of a mesh that an eye sees from outside.
const BASE_REACH: f64 = 1.0625;
/// How far points may lie from the origin, local units; a frame's rounding is in it.
const MESH_REACH: f64 = 1.01;
/// What eyes and slopes are clamped to, so that products of some of them are finite in f32. A picture of something so far away or
/// so small shows nothing.
const FAR: f64 = 1e15;
/// Bits of the factor that makes slopes of pixels.
const FACTOR_BITS: i32 = 30;

/// What the shaders know of a view.
///
/// - `view`: in the mesh's local coordinates
/// - `cells`, `points`: how many the mesh has
///
/// Every number is finite, whatever the view's size and distance.
pub(crate) fn frame_of(view: &View, part: Part, termination: f32, cells: u32, points: u32) -> Frame {
    let axes = [view.right, -view.up, view.forward];
    let eye = DVec3::from(axes.map(|axis| axis.dot(view.eye))).clamp(DVec3::splat(-FAR), DVec3::splat(FAR));
    let base = (eye.clamp(DVec3::splat(-BASE_REACH), DVec3::splat(BASE_REACH)) / LATTICE_STEP).round();
    let eye = eye - base * LATTICE_STEP;
    let base = base.as_ivec3();
    let [right, down, forward] = [0, 1, 2].map(|axis| integer_axis(axes[axis], base, axis));

    let size = [view.width, view.height];
    let slope = [view.half_width, view.half_height]
        .into_iter()
        .zip(size)
        .map(|(half, size)| (2.0 * half / f64::from(size)).clamp(1.0 / FAR, FAR));
    let slope: Vec<f64> = slope.collect();
    let (slope_x, slope_y) = (slope[0], slope[1]);
    let spread = |slope: f64| if view.is_perspective { slope } else { 0.0 };
    // Half a pixel more than the picture has.
    let steepest = [0, 1].map(|axis| spread(slope[axis]) * 0.5 * f64::from(size[axis] + 1));
    let bits = tangent_bits(steepest[0].max(steepest[1]));
    let line = |axis: usize| {
        let size = size[axis];
        let (first, rest) = line_of(eye[axis], spread(slope[axis]), eye.z, slope[axis], size);
        let (factor, shift) = tangent_factor(spread(slope[axis]), bits);
        ([first[0], first[1], first[2], factor], rest, shift)
    };
    let (columns, [column_rest, column_step_rest], column_shift) = line(0);
    let (rows, [row_rest, row_step_rest], row_shift) = line(1);
    Frame {
        right,
        down,
        forward,
        // Depths count from the base: those of an eye in the mesh from the eye.
        eye: [eye.x, eye.y, eye.z, -eye.z].map(|x| x as f32),
        columns,
        rows,
        rest: [column_rest, column_step_rest, row_rest, row_step_rest],
        slope: [spread(slope_x), spread(slope_y), slope_x, slope_y].map(|x| x as f32),
        size,
        origin: part.origin,
        extent: part.extent,
        tiles: part.extent.map(|extent| extent.div_ceil(TILE_SIDE)),
        is_perspective: u32::from(view.is_perspective),
        termination,
        cells,
        points,
        tangent: [bits, column_shift, row_shift, spare_bits(base, steepest)],
    }
}

/// An axis of the camera in units of 2^-30, and the base along it.
fn integer_axis(axis: DVec3, base: IVec3, index: usize) -> [i32; 4] {
    let [x, y, z] = (axis * UNIT).to_array().map(|component| component.round() as i32);
    [x, y, z, base[index]]
}

/// Where the rays of columns (or rows) meet the plane through the base: the column that is next to the base, its place and the step per
/// column in lattice steps; and what rounding took from both.
///
/// - `eye`, `eye_depth`: from the base, across and along the line of sight
/// - `spread`: slope of rays per pixel, 0 if they are parallel
/// - `pixel`: a pixel's size, at depth 1 if rays spread
fn line_of(eye: f64, spread: f64, eye_depth: f64, pixel: f64, size: u32) -> ([i32; 3], [f32; 2]) {
    let step = if spread > 0.0 { -eye_depth * spread } else { pixel };
    let middle = 0.5 * f64::from(size) - 0.5;
    let nearest = if step == 0.0 { 0.0 } else { (middle - eye / step).round().clamp(0.0, f64::from(size - 1)) };
    let place = (eye + (nearest - middle) * step) / LATTICE_STEP;
    let step = step / LATTICE_STEP;
    // Steps that are larger than the mesh: no other column meets it, and none does after the cast has saturated.
    let rest = |x: f64| if x.abs() < f64::from(i32::MAX) { (x - x.round()) as f32 } else { 0.0 };
    ([nearest as i32, place.round() as i32, step.round() as i32], [rest(place), rest(step)])
}

/// Bits of slopes in integers: as many as a word holds, and no more than positions deserve.
fn tangent_bits(steepest: f64) -> u32 {
    (1..=30).rev().find(|&bits| steepest * f64::from(1u32 << bits) < f64::from(i32::MAX)).unwrap_or(1)
}

/// What half a pixel adds to a ray's slope, times a power of two, and by how many bits the product with half pixels is to be shifted down
/// to have `bits` bits.
fn tangent_factor(spread: f64, bits: u32) -> (i32, u32) {
    if spread <= 0.0 {
        return (0, 0);
    }
    let half = 0.5 * spread;
    let scale = FACTOR_BITS - 1 - half.log2().ceil() as i32;
    let shift = scale - bits as i32;
    match u32::try_from(shift) {
        // Slopes of less than a unit.
        Ok(shift) if shift > 62 => (0, 0),
        Ok(shift) => ((half * f64::from(scale).exp2()).round() as i32, shift),
        // A picture of one pixel, whose ray is straight ahead, or slopes that no word holds.
        Err(_) => ((half * f64::from(bits).exp2()).round() as i32, 0),
    }
}

/// By how many bits distances of points from rays exceed a word.
fn spare_bits(base: IVec3, steepest: [f64; 2]) -> u32 {
    let reach = |axis: usize| MESH_REACH + f64::from(base[axis].abs()) * LATTICE_STEP;
    let most = [0, 1].map(|axis| {
        // About an eye in the mesh, and about a ray that meets the mesh.
        let near = reach(axis) + steepest[axis] * reach(2);
        near.max(2.0 * MESH_REACH * (1.0 + steepest[axis]))
    });
    // 4 local units are 2^31 steps.
    (most[0].max(most[1]) / 4.0).log2().ceil().clamp(0.0, 30.0) as u32
}
