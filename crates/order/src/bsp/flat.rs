//! Triangles as a sheet shows them: most pairs overlap, or do not, beyond what rounding could change.

/// A triangle that is seen whole through one sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flat {
    corners: [[f64; 2]; 3],
    /// A corner of two triangles has one number, and lies on the lines through it whatever is rounded.
    numbers: [u32; 3],
    /// 1 if the corners turn to the left, -1 if to the right.
    turn: f32,
}

impl Flat {
    /// - `turn`: 1 if the corners turn to the left, -1 if to the right; exact
    pub(super) fn new(corners: [[f64; 2]; 3], numbers: [u32; 3], turn: i8) -> Self {
        Self { corners, numbers, turn: f32::from(turn) }
    }
}

/// What [`overlap`](super::overlap::overlap) finds out exactly for two triangles on one sheet; `None` where rounding might decide.
///
/// - `rounding`: how far it moves a coordinate
#[inline]
pub(super) fn overlap_surely(a: &Flat, b: &Flat, rounding: f64) -> Option<bool> {
    let beyond_a = beyond_an_edge(a, b, rounding);
    if beyond_a == Some(true) {
        return Some(false);
    }
    match (beyond_a, beyond_an_edge(b, a, rounding)) {
        (_, Some(true)) => Some(false),
        (Some(false), Some(false)) => Some(true),
        _ => None,
    }
}

/// Whether all of `b` is seen beyond the line of one edge of `a`, or on it.
#[inline]
fn beyond_an_edge(a: &Flat, b: &Flat, rounding: f64) -> Option<bool> {
    // A difference of two coordinates is off by 2.5 roundings: two, and its own. So a product of two differences is off by that
    // times the sum of both, and a little that the last factor takes.
    let unsure = 4.0 * rounding;
    let mut is_open = false;
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let [start, end] = [a.corners[i], a.corners[j]];
        let (x, y) = (end[0] - start[0], end[1] - start[1]);
        let length = x.abs() + y.abs() + unsure;
        let (mut is_inside, mut is_doubtful) = (false, false);
        for k in 0..3 {
            let (u, v) = (b.corners[k][0] - start[0], b.corners[k][1] - start[1]);
            let height = (x * v - y * u) * f64::from(a.turn);
            let bound = unsure * (length + u.abs() + v.abs());
            let is_common = (b.numbers[k] == a.numbers[i]) | (b.numbers[k] == a.numbers[j]);
            is_inside |= !is_common & (height > bound);
            // NaN is in doubt.
            let is_sure = height.abs() > bound;
            is_doubtful |= !is_common & !is_sure;
        }
        match (is_inside, is_doubtful) {
            (true, _) => {}
            (false, false) => return Some(true),
            (false, true) => is_open = true,
        }
    }
    (!is_open).then_some(false)
}
