// Whether the volume of a cell shows, whatever ray meets it.
#use integrate/pieces.wgsl

// The last piece that starts at or below a lattice scalar; the first if none does.
fn piece_from(scalar: i32) -> u32 {
    var found = 0u;
    var size = optics.piece_count;
    while (size > 1u) {
        let half = size / 2u;
        found = select(found, found + half, bitcast<i32>(pieces[3u * (found + half)].x) <= scalar);
        size -= half;
    }
    return found;
}

// - `low`, `high`: a cell's lowest and highest scalar, lattice steps; both sides of a step on them count
fn is_visible(low: i32, high: i32) -> bool {
    let first = piece_from(low - 1);
    let last = piece_from(high);
    let first_end = bitcast<i32>(pieces[3u * first].y);
    let last_start = bitcast<i32>(pieces[3u * last].x);
    let first_count = pieces[3u * first + 1u].w;
    let last_count = pieces[3u * last + 1u].w;
    // A piece that contributes at one end does so everywhere but at the other.
    let from_low = (first_count & 1u) != 0u && low < first_end;
    let to_high = (last_count & 2u) != 0u && high > last_start;
    // Besides, where there is more than one: the end of the first, the start of the last, and what is between.
    let own = u32((first_count & 3u) != 0u);
    let between = (last_count >> 2u) - (first_count >> 2u) > own;
    let inner = (first_count & 2u) != 0u || (last_count & 1u) != 0u || between;
    return from_low || to_high || (first < last && inner);
}
