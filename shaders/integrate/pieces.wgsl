// The transfer function as pieces over which color and extinction are linear, ascending and without gaps; together they cover all scalars.
//
// A piece is three vectors: [start, end (i32 lattice scalars), extinction at start, at end], [color at start, count], [color at end,
// inverse of the width]. Extinction per local unit, widths in units of 2^29 lattice steps; floats as bits, since integers would be no
// floats that every driver leaves alone. The count: how many pieces before this one contribute, times 4; plus 1 if it does at its start
// and 2 if it does at its end.
//
// Values between come from shares of both ends, out of exact differences of integers: nothing cancels, and a value that falls to zero
// keeps its digits.
#use integrate/light.wgsl
#use integrate/optics.wgsl

@group(0) @binding(7) var<storage, read> pieces: array<vec4<u32>>;

// A piece with scalars that count from a cell's reference.
struct LocalPiece {
    start: f32,
    end: f32,
    inverse_width: f32,
    // At start and end.
    extinction: vec2<f32>,
    color_start: vec3<f32>,
    color_end: vec3<f32>,
}

// Extinction and color at one scalar.
struct Value {
    extinction: f32,
    color: vec3<f32>,
}

fn local_scalar(lattice: u32, reference: i32) -> f32 {
    return f32(bitcast<i32>(lattice) - reference) * LATTICE_STEP;
}

fn local_piece(index: u32, reference: i32) -> LocalPiece {
    let ends = pieces[3u * index];
    let at_start = pieces[3u * index + 1u];
    let at_end = pieces[3u * index + 2u];
    return LocalPiece(
        local_scalar(ends.x, reference),
        local_scalar(ends.y, reference),
        bitcast<f32>(at_end.w),
        bitcast<vec2<f32>>(ends.zw),
        bitcast<vec3<f32>>(at_start.xyz),
        bitcast<vec3<f32>>(at_end.xyz),
    );
}

// How much the values at a piece's start and end count at a scalar.
fn shares_at(piece: LocalPiece, scalar: f32) -> vec2<f32> {
    return saturate(vec2<f32>(piece.end - scalar, scalar - piece.start) * piece.inverse_width);
}

fn value_in(piece: LocalPiece, scalar: f32) -> Value {
    let shares = shares_at(piece, scalar);
    return Value(dot(piece.extinction, shares), piece.color_start * shares.x + piece.color_end * shares.y);
}

// The last of `count` pieces that starts below a scalar, or on it if `is_on`; the first if none does.
fn last_piece(first: u32, count: u32, reference: i32, scalar: f32, is_on: bool) -> u32 {
    var found = first;
    var size = count;
    while (size > 1u) {
        let half = size / 2u;
        let start = local_scalar(pieces[3u * (found + half)].x, reference);
        found = select(found, found + half, start < scalar || (is_on && start == scalar));
        size -= half;
    }
    return found;
}

// The pieces that a cell's range of scalars shares more than a point with, first and count; of a single scalar the one that holds it.
fn find_pieces(reference: i32, low: f32, high: f32) -> vec2<u32> {
    let first = last_piece(0u, optics.piece_count, reference, low, true);
    let last = last_piece(first, optics.piece_count - first, reference, high, false);
    return vec2<u32>(first, last - first + 1u);
}

// Extinction and color at a scalar within a cell's range; on a step, those above.
fn transfer_at(cell: Optics, scalar: f32) -> Value {
    let index = last_piece(cell.first, cell.count, cell.reference, scalar, true);
    return value_in(local_piece(index, cell.reference), scalar);
}
