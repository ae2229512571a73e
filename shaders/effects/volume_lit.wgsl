// The volume lit by the field's gradient in the middle of the segment.

#use cell/cell.wgsl
#use effects/lamp.wgsl
#use <gradient>

// What the volume's light is multiplied by.
fn volume_intensity(corners: array<vec4<i32>, 4>, vertices: vec4<u32>, sample: Sample) -> f32 {
    let middle = 0.5 * (sample.depth.x + sample.depth.y);
    let intensities = lamp_intensities(gradient_at(corners, vertices, sample, middle, SHADING_SMOOTH), sample.center);
    return intensities.x + intensities.y;
}
