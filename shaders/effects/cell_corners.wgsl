// The corners of a cell as the frame sees them.

#use include/points.wgsl

// - vertices: as in `drawn`, with NEGATIVE_BIT and RING_BIT or without
fn cell_corners(vertices: vec4<u32>) -> array<vec4<i32>, 4> {
    return array<vec4<i32>, 4>(
        points[vertices.x],
        points[vertices.y],
        points[vertices.z & ~RING_BIT],
        points[vertices.w & ~NEGATIVE_BIT],
    );
}

// Lowest and highest scalar of the corners, lattice steps.
fn corner_scalars(corners: array<vec4<i32>, 4>) -> vec2<i32> {
    let low = min(min(corners[0].w, corners[1].w), min(corners[2].w, corners[3].w));
    return vec2<i32>(low, max(max(corners[0].w, corners[1].w), max(corners[2].w, corners[3].w)));
}
