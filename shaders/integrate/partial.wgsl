// Extinction and color linear between the values at both ends, by the table of psi: density emitter only. The slot <volume>.
//
// The table lies behind the pieces, [depth][balance], 16 bits for 0 to 1: each number has its entry in the low half and the next one
// along the balance in the high half. Axes: `tetrascope_integrate::PsiTable`.
#use integrate/pieces.wgsl
#use integrate/exponential.wgsl

// An entry and the next one.
fn psi_pair(index: u32) -> vec2<f32> {
    let both = pieces[optics.psi_start + (index >> 2u)][index & 3u];
    return vec2<f32>(f32(both & 0xffffu), f32(both >> 16u));
}

// The front's share in the light of a segment.
fn front_share(half_front: f32, depth: f32) -> f32 {
    // Without depth any balance will do.
    let part = min(half_front / max(depth, 1e-37), 1.0);
    let down = (1.0 - inverseSqrt(1.0 + 0.5 * depth)) * f32(PSI_DEPTHS - 1u);
    let right = sqrt(part) * f32(PSI_BALANCES - 1u);
    let row = min(u32(down), PSI_DEPTHS - 2u);
    let column = min(u32(right), PSI_BALANCES - 2u);
    let corner = row * PSI_BALANCES + column;
    let columns = mix(psi_pair(corner), psi_pair(corner + PSI_BALANCES), down - f32(row));
    let excess = mix(columns.x, columns.y, right - f32(column));
    return min(excess * (1.0 / 65535.0) + (part + 1.0) * (1.0 / 3.0), 1.0);
}

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    let near = transfer_at(cell, front);
    let far = transfer_at(cell, back);
    let half_front = 0.5 * near.extinction * length;
    let depth = half_front + 0.5 * far.extinction * length;
    let whole = opacity_transmittance(depth);
    let front_weight = whole.x * front_share(half_front, depth);
    return Light(near.color * front_weight + far.color * (whole.x - front_weight), whole.x);
}
