// The points' gradients, interpolated, but for what is lit flat.

#use cell/cell.wgsl
#use effects/constant_gradient.wgsl
#use effects/interpolated_gradient.wgsl

fn gradient_at(corners: array<vec4<i32>, 4>, vertices: vec4<u32>, sample: Sample, depth: f32, shading: u32) -> vec3<f32> {
    if shading == SHADING_FLAT {
        return constant_gradient(corners);
    }
    return interpolated_gradient(corners, vertices, sample, depth);
}
