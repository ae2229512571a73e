// Cut at the control points, then closed form. The slot <volume>.
#use integrate/pieces.wgsl
#use integrate/parts.wgsl
#use <model>

// The light of a part of a segment within one piece; how much the piece's values count at its front and at its back.
fn volume_in(piece: LocalPiece, at_front: vec2<f32>, at_back: vec2<f32>, length: f32) -> Light {
    let extinction = vec2<f32>(dot(piece.extinction, at_front), dot(piece.extinction, at_back));
    let weights = model_linear(extinction, length);
    let counts = at_front * weights.front + at_back * weights.back;
    return Light(piece.color_start * counts.x + piece.color_end * counts.y, weights.opacity);
}

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    if (cell.count == 1u) {
        let piece = local_piece(cell.first, cell.reference);
        return volume_in(piece, shares_at(piece, front), shares_at(piece, back), length);
    }
    // In ascending order; where the scalar falls along the ray, each piece lies in front of those before.
    let rises = front <= back;
    let parts = parts_of(front, back);
    var light = Light(vec3<f32>(0.0), 0.0);
    for (var index = 0u; index < cell.count; index++) {
        let piece = local_piece(cell.first + index, cell.reference);
        let part = part_in(parts, piece, index, cell.count);
        let part_length = length * part.share;
        if (part_length > 0.0) {
            let at_front = select(part.at_high, part.at_low, rises);
            let at_back = select(part.at_low, part.at_high, rises);
            let next = volume_in(piece, at_front, at_back, part_length);
            let behind = light.rgb + (1.0 - light.opacity) * next.rgb;
            let before = next.rgb + (1.0 - next.opacity) * light.rgb;
            light = Light(select(before, behind, rises), light.opacity + (1.0 - light.opacity) * next.opacity);
        }
    }
    return light;
}
