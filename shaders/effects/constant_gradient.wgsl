// The direction of a cell's constant gradient along the camera's axes, of no particular length and sign; zero where the scalar is constant.
//
// Times six volumes, so that nothing is divided by a small one; in lattice steps, of which products of three stay within f32.

fn constant_gradient(corners: array<vec4<i32>, 4>) -> vec3<f32> {
    let first = corners[0];
    let b = corners[1] - first;
    let c = corners[2] - first;
    let d = corners[3] - first;
    let edge_b = vec3<f32>(b.xyz);
    let edge_c = vec3<f32>(c.xyz);
    let edge_d = vec3<f32>(d.xyz);
    return cross(edge_c, edge_d) * f32(b.w) + cross(edge_d, edge_b) * f32(c.w) + cross(edge_b, edge_c) * f32(d.w);
}
