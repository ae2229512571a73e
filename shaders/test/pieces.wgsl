// For tests of what surrounds integration: a transfer function of one piece.

fn find_pieces(reference: i32, low: f32, high: f32) -> vec2<u32> {
    return vec2<u32>(0u, 1u);
}
