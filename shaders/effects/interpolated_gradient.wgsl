// The gradient at a place of a ray, interpolated between those of a cell's corners, along the camera's axes.
//
// gradients: one a point, along the mesh's axes; units of scalars per local unit.

#use cell/cell.wgsl
#use include/frame.wgsl
#use effects/axes.wgsl

@group(0) @binding(16) var<storage, read> gradients: array<vec4<f32>>;

// How much each corner counts: not negative and adding up to 1, so that rounding in a thin cell stays within the corners' range.
fn corner_shares(corners: array<vec4<i32>, 4>, sample: Sample, depth: f32) -> vec4<f32> {
    let first = corners[0].xyz;
    let b = vec3<f32>(corners[1].xyz - first);
    let c = vec3<f32>(corners[2].xyz - first);
    let d = vec3<f32>(corners[3].xyz - first);
    // The place from the base. Along the view axis by the difference of two depths first: a far eye takes no digits from it.
    let spread = select(1.0, depth + frame.eye.w, frame.is_perspective != 0u);
    let across = sample.center * frame.slope.zw * spread + frame.eye.xy;
    let place = vec3<f32>(across, depth + (frame.eye.z + frame.eye.w));
    let p = place * (1.0 / LATTICE_STEP) - vec3<f32>(first);

    let normal_b = cross(c, d);
    let volume = dot(b, normal_b);
    let share_b = dot(p, normal_b);
    let share_c = dot(p, cross(d, b));
    let share_d = dot(p, cross(b, c));
    let shares = vec4<f32>(volume - share_b - share_c - share_d, share_b, share_c, share_d);
    let inside = max(select(shares, -shares, volume < 0.0), vec4<f32>(0.0));
    let sum = inside.x + inside.y + inside.z + inside.w;
    if sum > 0.0 {
        return inside / sum;
    }
    return vec4<f32>(0.25);
}

fn interpolated_gradient(corners: array<vec4<i32>, 4>, vertices: vec4<u32>, sample: Sample, depth: f32) -> vec3<f32> {
    let shares = corner_shares(corners, sample, depth);
    let gradient = shares.x * gradients[vertices.x].xyz
        + shares.y * gradients[vertices.y].xyz
        + shares.z * gradients[vertices.z & ~RING_BIT].xyz
        + shares.w * gradients[vertices.w & ~NEGATIVE_BIT].xyz;
    return along_camera(gradient);
}
