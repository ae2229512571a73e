// Exact opacity of a linear extinction, mean of the end colors: opacity-2d, and partial in models where it is the same. The slot <volume>.
#use integrate/pieces.wgsl
#use <model>

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    let near = transfer_at(cell, front);
    let far = transfer_at(cell, back);
    return model_constant(0.5 * (near.extinction + far.extinction), 0.5 * (near.color + far.color), length);
}
