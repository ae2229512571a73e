// Light of segments of the mean length, looked up over both scalars and scaled to the length. The slot <volume>; the optical model is in
// the table.
#use integrate/table.wgsl

fn volume(cell: Optics, front: f32, back: f32, length: f32) -> Light {
    let near = scalar_place(cell.reference, front);
    let far = scalar_place(cell.reference, back);
    let entry = mixed_scalars(far.below * optics.table_scalars + near.below, near.share, far.share);
    // Where the opacity would exceed 1 the factor is the one at which it is 1, for the light too.
    let factor = length * optics.table_per_length;
    let is_opaque = entry.w * factor > 1.0;
    let limited = select(factor, 1.0 / select(1.0, entry.w, is_opaque), is_opaque);
    return Light(entry.xyz * limited, select(entry.w * factor, 1.0, is_opaque));
}
