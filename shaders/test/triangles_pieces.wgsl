// A transfer function of one piece, for tests: extinction and green are linear in the scalar.

#use integrate/light.wgsl

struct Value {
    extinction: f32,
    color: vec3<f32>,
}

fn find_pieces(reference: i32, low: f32, high: f32) -> vec2<u32> {
    return vec2<u32>(0u, 1u);
}

fn transfer_at(cell: Optics, scalar: f32) -> Value {
    let s = f32(cell.reference) * LATTICE_STEP + scalar;
    return Value(EXTINCTION + EXTINCTION_SLOPE * s, vec3<f32>(0.9, 0.5 + 0.5 * s, 0.2));
}
