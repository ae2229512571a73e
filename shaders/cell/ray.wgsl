// Rays of pixels over the lattice, in integers: where a ray is beside a point does not depend on the cell that asks.
#use include/frame.wgsl
#use cell/wide.wgsl

// The ray of a column: place on the plane through the base in lattice steps, and slope in units of 2^-frame.tangent.x. The same of rows.
struct Ray {
    place: vec2<i32>,
    tangent: vec2<i32>,
}

fn place_of(line: vec4<i32>, rest: vec2<f32>, pixel: i32) -> i32 {
    let offset = pixel - line.x;
    // The rest is at most half a step and half a step per pixel, of which a picture has 2^15.
    let rounded = line.y + i32(round(rest.x + f32(offset) * rest.y));
    return wide_rounded(wide_sum(wide_product(offset, line.z), wide(rounded)), 0u);
}

fn ray_of(pixel: vec2<i32>) -> Ray {
    // Twice the distance from the middle, whole.
    let offset = 2 * pixel + 1 - vec2<i32>(frame.size);
    return Ray(
        vec2<i32>(place_of(frame.columns, frame.rest.xy, pixel.x), place_of(frame.rows, frame.rest.zw, pixel.y)),
        vec2<i32>(
            wide_rounded(wide_product(offset.x, frame.columns.w), frame.tangent.y),
            wide_rounded(wide_product(offset.y, frame.rows.w), frame.tangent.z),
        ),
    );
}

// How far a point lies beside a ray, across, where both have the same depth; units of 2^-frame.tangent.x lattice steps.
fn beside(place: i32, tangent: i32, across: i32, depth: i32) -> vec2<u32> {
    let from_place = wide_shifted_up(wide_difference(wide(across), wide(place)), frame.tangent.x);
    return wide_difference(from_place, wide_product(tangent, depth));
}

// The same of columns and rows, in units of 2^frame.tangent.w lattice steps: whole, so that products of two of them are exact.
fn beside_rounded(ray: Ray, point: vec3<i32>) -> vec2<i32> {
    let bits = frame.tangent.x + frame.tangent.w;
    return vec2<i32>(
        wide_rounded(beside(ray.place.x, ray.tangent.x, point.x, point.z), bits),
        wide_rounded(beside(ray.place.y, ray.tangent.y, point.y, point.z), bits),
    );
}

// The same in local units.
fn beside_in_units(ray: Ray, point: vec3<i32>) -> vec2<f32> {
    let unit = power_below_one(frame.tangent.x) * LATTICE_STEP;
    return unit * vec2<f32>(
        wide_to_float(beside(ray.place.x, ray.tangent.x, point.x, point.z)),
        wide_to_float(beside(ray.place.y, ray.tangent.y, point.y, point.z)),
    );
}
