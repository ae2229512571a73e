// Isosurfaces in their own colors.

#use cell/cell.wgsl

// What a surface shows; rgb is premultiplied.
fn surface_light(
    rgb: vec3<f32>,
    opacity: f32,
    shading: u32,
    corners: array<vec4<i32>, 4>,
    vertices: vec4<u32>,
    sample: Sample,
    depth: f32,
) -> vec3<f32> {
    return rgb;
}
