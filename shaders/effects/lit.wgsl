// Light of a segment whose volume is lit, without isosurfaces.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use effects/joint.wgsl
#use effects/cell_corners.wgsl
#use <volume>
#use <volume_light>

fn shade(
    cell: Cell,
    vertices: vec4<u32>,
    optics: Optics,
    sample: Sample,
    joint: ptr<function, Joint>,
    crossings: ptr<function, u32>,
) -> Light {
    let light = volume(optics, sample.front, sample.back, sample.length);
    return Light(light.rgb * volume_intensity(cell_corners(vertices), vertices, sample), light.opacity);
}
