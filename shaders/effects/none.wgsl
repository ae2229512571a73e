// Light of a segment that has nothing but its volume.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use effects/joint.wgsl
#use <volume>

fn shade(
    cell: Cell,
    vertices: vec4<u32>,
    optics: Optics,
    sample: Sample,
    joint: ptr<function, Joint>,
    crossings: ptr<function, u32>,
) -> Light {
    return volume(optics, sample.front, sample.back, sample.length);
}
