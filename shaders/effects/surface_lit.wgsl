// Isosurfaces lit with the field's gradient as normal.

#use cell/cell.wgsl
#use effects/lamp.wgsl
#use <gradient>

// What a surface shows at a depth; rgb is premultiplied.
fn surface_light(
    rgb: vec3<f32>,
    opacity: f32,
    shading: u32,
    corners: array<vec4<i32>, 4>,
    vertices: vec4<u32>,
    sample: Sample,
    depth: f32,
) -> vec3<f32> {
    if shading == SHADING_NONE {
        return rgb;
    }
    let intensities = lamp_intensities(gradient_at(corners, vertices, sample, depth, shading), sample.center);
    return rgb * intensities.x + opacity * intensities.y;
}
