// Light looked up over both scalars and the length. The slot <volume>; the optical model is in the table.
#use integrate/table.wgsl

// Where a length lies on its axis; beyond it, at its end.
fn length_place(length: f32) -> Place {
    // A logarithmic axis resolves ten octaves below the longest chord, evenly in exponent plus mantissa: in the bits of a float.
    const FIRST_OCTAVE: f32 = 1.0 / 1024.0;
    const OCTAVES_PER_BIT: f32 = 1.0 / 8388608.0;
    let last = optics.table_lengths - 1u;
    let share = saturate(length * optics.table_per_length);
    let octaves = f32(bitcast<i32>(max(share, FIRST_OCTAVE)) - bitcast<i32>(FIRST_OCTAVE)) * OCTAVES_PER_BIT;
    let resolved = 1.0 + octaves * (f32(last - 1u) * 0.1);
    let logarithmic = select(share / FIRST_OCTAVE, resolved, share >= FIRST_OCTAVE);
    let coordinate = select(share * f32(last), logarithmic, optics.table_is_logarithmic != 0u);
    let below = min(u32(coordinate), last - 1u);
    return Place(below, saturate(coordinate - f32(below)));
}

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    let near = scalar_place(cell.reference, front);
    let far = scalar_place(cell.reference, back);
    let node = length_place(length);
    let slice = optics.table_scalars * optics.table_scalars;
    let first = node.below * slice + far.below * optics.table_scalars + near.below;
    let shorter = mixed_scalars(first, near.share, far.share);
    let entry = mix(shorter, mixed_scalars(first + slice, near.share, far.share), node.share);
    // Mixing two entries of 1 may round up.
    return Light(entry.xyz, min(entry.w, 1.0));
}
