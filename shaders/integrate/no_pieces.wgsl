// Nothing of the transfer function is looked at piece by piece: the light is in a table. The slot <pieces>.

fn find_pieces(reference: i32, low: f32, high: f32) -> vec2<u32> {
    return vec2<u32>(0u, 1u);
}
