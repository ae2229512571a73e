// Cuts a segment at the ends of the transfer function's pieces.
#use integrate/pieces.wgsl

struct Parts {
    low: f32,
    high: f32,
    // Of the difference; 0 for a segment without one.
    inverse: f32,
}

// What a segment has in one piece.
struct Part {
    low: f32,
    high: f32,
    // Share of the segment's length.
    share: f32,
}

// Below it the inverse would not be finite. No place in a segment as flat as that can be told from another.
const FLAT: f32 = 1e-30;

fn parts_of(front: f32, back: f32) -> Parts {
    let low = min(front, back);
    let high = max(front, back);
    let width = high - low;
    let is_flat = width < FLAT;
    return Parts(low, high, select(1.0 / select(width, 1.0, is_flat), 0.0, is_flat));
}

// - `index`: of the piece among the `count` of the cell; the first and the last reach the ends of its range
fn part_in(parts: Parts, piece: LocalPiece, index: u32, count: u32) -> Part {
    let is_first = index == 0u;
    let is_last = index + 1u == count;
    let start = select(piece.start, parts.low, is_first);
    let end = select(piece.end, parts.high, is_last);
    let low = clamp(parts.low, start, max(start, end));
    let high = clamp(parts.high, start, max(start, end));
    // A flat segment lies in one piece as a whole, in the upper one when it lies on a cut.
    let holds = (is_first || parts.high >= piece.start) && (is_last || parts.high < piece.end);
    let share = select((high - low) * parts.inverse, select(0.0, 1.0, holds), parts.inverse == 0.0);
    return Part(low, high, share);
}
