// The direction of a cell's constant gradient along the camera's axes, of no particular length and sign; zero where the scalar is constant.
//
// The sum of the edges' cross products loses digits in a thin cell, where these are nearly parallel: the share of its thickness. There what the
// first result leaves of the scalars' differences is computed in whole numbers, without rounding, and gives a correction.
//
// All in lattice steps, of which products of four stay within f32.

#use cell/wide.wgsl

// Cells are thin whose volume is below this share of the product of their edges; below the other one 32 bits do not know their volume.
const THIN: f32 = 0.1;
const FLATTEST: f32 = 1e-6;

struct Spread {
    normal_b: vec3<f32>,
    normal_c: vec3<f32>,
    normal_d: vec3<f32>,
}

fn spread_of(b: vec3<f32>, c: vec3<f32>, d: vec3<f32>) -> Spread {
    return Spread(cross(c, d), cross(d, b), cross(b, c));
}

// Times six volumes, which may be negative.
fn gradient_of(spread: Spread, differences: vec3<f32>) -> vec3<f32> {
    return spread.normal_b * differences.x + spread.normal_c * differences.y + spread.normal_d * differences.z;
}

// What a slope, in steps of scalar times `unit` per step of length, leaves of the difference of scalars along an edge.
fn left_of(edge: vec4<i32>, slope: vec3<i32>, unit: i32) -> f32 {
    let across = wide_sum(wide_product(slope.x, edge.x), wide_product(slope.y, edge.y));
    return wide_to_float(wide_difference(wide_product(edge.w, unit), wide_sum(across, wide_product(slope.z, edge.z))));
}

fn constant_gradient(corners: array<vec4<i32>, 4>) -> vec3<f32> {
    let b = corners[1] - corners[0];
    let c = corners[2] - corners[0];
    let d = corners[3] - corners[0];
    let edge_b = vec3<f32>(b.xyz);
    let edge_c = vec3<f32>(c.xyz);
    let edge_d = vec3<f32>(d.xyz);
    let spread = spread_of(edge_b, edge_c, edge_d);
    let first = gradient_of(spread, vec3<f32>(vec3<i32>(b.w, c.w, d.w)));

    let volume = dot(edge_b, spread.normal_b);
    let box = sqrt(dot(edge_b, edge_b)) * sqrt(dot(edge_c, edge_c)) * sqrt(dot(edge_d, edge_d));
    if abs(volume) > THIN * box || abs(volume) <= FLATTEST * box {
        return first;
    }
    let slope = first / volume;
    let sizes = abs(slope);
    let largest = max(sizes.x, max(sizes.y, sizes.z));
    if largest < 1e-30 {
        return first;
    }
    // In units that give it 24 bits, or as many as there are.
    let unit = 1 << u32(clamp(23 + 127 - i32(bitcast<u32>(largest) >> 23u), 0, 30));
    let whole = vec3<i32>(clamp(slope * f32(unit), vec3<f32>(-1e9), vec3<f32>(1e9)));
    let left = vec3<f32>(left_of(b, whole, unit), left_of(c, whole, unit), left_of(d, whole, unit));
    return vec3<f32>(whole) + gradient_of(spread, left) / volume;
}
