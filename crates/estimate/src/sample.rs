//! Which pixels are looked at: some in every part of the picture where the mesh is, then more around the worst.

use tetrascope_cpu::rays::RayTracer;

/// Pixels spread over all that the mesh may cover: one by chance in each of about `count` equal rectangles. All of them, if there are no more.
///
/// The same pixels in every call.
pub(crate) fn spread(tracer: &RayTracer<'_>, count: usize) -> Spread {
    let Some([x0, x1, y0, y1]) = extent(tracer) else { return Spread { pixels: Vec::new(), is_whole: true } };
    let (width, height) = (x1 - x0 + 1, y1 - y0 + 1);
    let area = u64::from(width) * u64::from(height);
    if area <= count as u64 {
        let pixels = (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| [x, y])).collect();
        return Spread { pixels, is_whole: true };
    }
    let side = (area as f64 / count as f64).sqrt();
    let cells = |length: u32| ((f64::from(length) / side).round() as u32).clamp(1, length);
    let (columns, rows) = (cells(width), cells(height));
    // Where the part `index` of `parts` of a length begins; in 64 bits, as products are large.
    let begin = |length: u32, parts: u32, index: u32| (u64::from(length) * u64::from(index) / u64::from(parts)) as u32;
    let mut pixels = Vec::with_capacity(columns as usize * rows as usize);
    for row in 0..rows {
        for column in 0..columns {
            let [left, right] = [column, column + 1].map(|index| begin(width, columns, index));
            let [top, bottom] = [row, row + 1].map(|index| begin(height, rows, index));
            let chance = mixed(u64::from(row) << 32 | u64::from(column));
            let within = |length: u32, bits: u64| ((u64::from(length) * (bits & 0xffff_ffff)) >> 32) as u32;
            pixels.push([x0 + left + within(right - left, chance), y0 + top + within(bottom - top, chance >> 32)]);
        }
    }
    Spread { pixels, is_whole: false }
}

/// Pixels all over a mesh.
pub(crate) struct Spread {
    pub(crate) pixels: Vec<[u32; 2]>,
    /// Whether these are all that the mesh may cover.
    pub(crate) is_whole: bool,
}

/// Pixels about some others that are not there yet: the eight neighbors, and eight more within twice that distance.
pub(crate) fn around(
    worst: &[[u32; 2]],
    size: [u32; 2],
    known: &mut std::collections::HashSet<[u32; 2]>,
) -> Vec<[u32; 2]> {
    let mut pixels = Vec::new();
    for &[x, y] in worst {
        for [dx, dy] in NEAR {
            let at = [i64::from(x) + dx, i64::from(y) + dy];
            let is_inside = at.iter().zip(size).all(|(&c, size)| (0..i64::from(size)).contains(&c));
            if is_inside {
                let at = at.map(|c| c as u32);
                if known.insert(at) {
                    pixels.push(at);
                }
            }
        }
    }
    pixels
}

const NEAR: [[i64; 2]; 16] = [
    [-1, -1],
    [0, -1],
    [1, -1],
    [-1, 0],
    [1, 0],
    [-1, 1],
    [0, 1],
    [1, 1],
    [-2, -2],
    [2, -2],
    [-2, 2],
    [2, 2],
    [0, -3],
    [3, 0],
    [0, 3],
    [-3, 0],
];

/// First and last column and row that the mesh may cover.
fn extent(tracer: &RayTracer<'_>) -> Option<[u32; 4]> {
    let join = |[a, b, c, d]: [u32; 4], [e, f, g, h]: [u32; 4]| [a.min(e), b.max(f), c.min(g), d.max(h)];
    tracer.seen().iter().map(|(_, outline)| *outline).reduce(join)
}

/// Bits that look like chance (splitmix64).
fn mixed(index: u64) -> u64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
