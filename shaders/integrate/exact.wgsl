// Cut at the control points, then closed form. The slot <volume>.
#use integrate/pieces.wgsl
#use integrate/parts.wgsl
#use <model>

// The light of a part of a segment within one piece.
fn volume_in(piece: LocalPiece, front: f32, back: f32, length: f32) -> Light {
    let at_front = shares_at(piece, front);
    let at_back = shares_at(piece, back);
    let extinction = vec2<f32>(dot(piece.extinction, at_front), dot(piece.extinction, at_back));
    let weights = model_linear(extinction, length);
    let counts = at_front * weights.front + at_back * weights.back;
    return Light(piece.color_start * counts.x + piece.color_end * counts.y, weights.transmittance);
}

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    if (cell.count == 1u) {
        return volume_in(local_piece(cell.first, cell.reference), front, back, length);
    }
    // In ascending order; where the scalar falls along the ray, each piece lies in front of those before.
    let rises = front <= back;
    let parts = parts_of(front, back);
    var light = Light(vec3<f32>(0.0), 1.0);
    for (var index = 0u; index < cell.count; index++) {
        let piece = local_piece(cell.first + index, cell.reference);
        let part = part_in(parts, piece, index, cell.count);
        let part_length = length * part.share;
        if (part_length > 0.0) {
            let next = volume_in(piece, select(part.high, part.low, rises), select(part.low, part.high, rises), part_length);
            let behind = light.rgb + light.transmittance * next.rgb;
            let before = next.rgb + next.transmittance * light.rgb;
            light = Light(select(before, behind, rises), light.transmittance * next.transmittance);
        }
    }
    return light;
}
