// For tests: a volume that every renderer can compute with four operations. It hides l / (1 + l) of what lies behind, and its color is
// linear in the scalars, the front counting three times, so that no part of a segment may be turned round.

#use integrate/light.wgsl

fn volume(optics: Optics, front: f32, back: f32, length: f32) -> Light {
    let opacity = length / (1.0 + length);
    let mean = 0.75 * front + 0.25 * back;
    return Light(opacity * vec3<f32>(0.5 + 0.25 * mean, 0.5 - 0.25 * mean, 0.25), opacity);
}
