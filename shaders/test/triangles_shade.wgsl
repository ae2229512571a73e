// The light of a cell without surfaces, for tests of the triangles alone. <volume>: of a segment.

#use cell/cell.wgsl
#use integrate/light.wgsl
#use <volume>

struct Joint {
    depth: f32,
    slack: f32,
    rank: f32,
}

fn no_joint() -> Joint {
    return Joint(0.0, 0.0, 0.0);
}

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
