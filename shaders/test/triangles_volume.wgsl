// Light of a segment whose extinction is linear in the scalar and whose color is that of its middle, for tests.

#use <pieces>
#use <model>

fn volume(optics: Optics, front: f32, back: f32, length: f32) -> Light {
    let middle = transfer_at(optics, 0.5 * (front + back));
    return model_constant(middle.extinction, middle.color, length);
}
