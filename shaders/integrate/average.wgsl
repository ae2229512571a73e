// The transfer function at the mean of the two scalars. The slot <volume>.
#use integrate/pieces.wgsl
#use <model>

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    let value = transfer_at(cell, 0.5 * (front + back));
    return model_constant(value.extinction, value.color, length);
}
