// The points' gradients, interpolated.

#use cell/cell.wgsl
#use effects/interpolated_gradient.wgsl

fn gradient_at(corners: array<vec4<i32>, 4>, vertices: vec4<u32>, sample: Sample, depth: f32, shading: u32) -> vec3<f32> {
    return interpolated_gradient(corners, vertices, sample, depth);
}
