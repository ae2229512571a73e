// The corners of a cell, and the reference that its numbers count from.
//
// Lengths in local units, scalars in units of 2^29 lattice steps. Every difference is one of whole numbers first, so that small and far
// cells lose nothing.

#use include/frame.wgsl
#use include/points.wgsl

struct Corners {
    points: array<vec4<i32>, 4>,
    // Whether the volume is negative in this order.
    is_negative: bool,
    // Depths from the eye.
    depths: vec4<f32>,
    // Depth of the reference, the mean of the corners', from the eye, and from where depths count; and the depths beyond it.
    depth: f32,
    depth_shown: f32,
    beyond: vec4<f32>,
    // The scalar of the reference, lattice steps; and the scalars from there.
    scalar: i32,
    scalars: vec4<f32>,
}

// From one point to another.
fn between(start: vec4<i32>, end: vec4<i32>) -> vec3<f32> {
    return vec3<f32>(end.xyz - start.xyz) * LATTICE_STEP;
}

fn corners_of(vertices: vec4<u32>) -> Corners {
    var corners: Corners;
    corners.is_negative = (vertices.w & NEGATIVE_BIT) != 0u;
    let a = points[vertices.x];
    let b = points[vertices.y];
    let c = points[vertices.z];
    let d = points[vertices.w & ~NEGATIVE_BIT];
    corners.points = array<vec4<i32>, 4>(a, b, c, d);
    // A difference of two scalars is below 2^30, the sum of three quarters of them too.
    corners.scalar = a.w + ((b.w - a.w) >> 2u) + ((c.w - a.w) >> 2u) + ((d.w - a.w) >> 2u);
    corners.scalars = vec4<f32>(vec4<i32>(a.w, b.w, c.w, d.w) - corners.scalar) * LATTICE_STEP;
    let after = vec4<f32>(vec4<i32>(0, b.z - a.z, c.z - a.z, d.z - a.z)) * LATTICE_STEP;
    let mean = 0.25 * (after.y + after.z + after.w);
    let first = f32(a.z) * LATTICE_STEP - frame.eye.z;
    corners.depths = first + after;
    corners.depth = first + mean;
    corners.depth_shown = f32(a.z) * LATTICE_STEP + mean - start_from_base();
    corners.beyond = after - mean;
    return corners;
}

// Of a point: how much more inverse depth it has than the reference, as a share of the reference's; orthographic: how much nearer it lies.
//
// - beyond: its depth from the reference's; depth: from the eye, not 0
fn nearness_at(beyond: f32, depth: f32) -> f32 {
    return select(-beyond, -beyond / depth, frame.is_perspective != 0u);
}

fn lowest(values: vec4<f32>) -> f32 {
    return min(min(values.x, values.y), min(values.z, values.w));
}

fn highest(values: vec4<f32>) -> f32 {
    return max(max(values.x, values.y), max(values.z, values.w));
}
