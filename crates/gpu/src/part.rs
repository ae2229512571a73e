//! Parts of a picture, each drawn on its own.

use tetrascope_shaders::layout::TILE_SIDE;

use crate::view::Part;

/// Bytes of a pixel in the buffer `picture`.
const BYTES_PER_PIXEL: u64 = 16;

/// Bytes of the buffer `picture` for a part whose pixels may sort: what they have to know from run to run comes last.
///
/// - `state`: what that is for a pixel, in pixels
pub(crate) fn sorted_picture_bytes(part: Part, state: u32) -> u64 {
    let [width, height] = part.extent.map(u64::from);
    picture_bytes(part) + u64::from(state) * BYTES_PER_PIXEL * width * height
}

/// Bytes of the buffer `picture` for a part: its pixels and the counts of its tiles.
pub(crate) fn picture_bytes(part: Part) -> u64 {
    let [width, height] = part.extent.map(u64::from);
    let tiles = part.extent.map(|side| u64::from(side.div_ceil(TILE_SIDE)));
    BYTES_PER_PIXEL * (width * height + tiles[0] * tiles[1])
}

/// A picture of this size in as few parts as fit.
///
/// - `limit`: bytes that one may take
/// - `side`: pixels that a side may have; a tile's at least
/// - `state`: as in [`sorted_picture_bytes`]
pub(crate) fn parts(size: [u32; 2], limit: u64, side: u32, state: u32) -> Vec<Part> {
    let mut waiting = vec![Part { origin: [0, 0], extent: size }];
    let mut parts = Vec::new();
    while let Some(part) = waiting.pop() {
        match halves(part) {
            Some(halves)
                if sorted_picture_bytes(part, state) > limit || part.extent.iter().any(|extent| *extent > side) =>
            {
                waiting.extend(halves.into_iter().rev())
            }
            _ => parts.push(part),
        }
    }
    parts
}

/// A part cut across its longer side, between two tiles; `None` for a single tile.
pub(crate) fn halves(part: Part) -> Option<[Part; 2]> {
    let axis = usize::from(part.extent[1] >= part.extent[0]);
    let tiles = part.extent[axis].div_ceil(TILE_SIDE);
    if tiles < 2 {
        return None;
    }
    let first = tiles / 2 * TILE_SIDE;
    let (mut near, mut far) = (part, part);
    near.extent[axis] = first;
    far.origin[axis] += first;
    far.extent[axis] -= first;
    Some([near, far])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_every_pixel_once() {
        for (size, limit) in [([70, 40], u64::MAX), ([70, 40], 19000), ([1, 1], 0), ([300, 17], 15000), ([33, 500], 0)]
        {
            let mut covered = vec![0; (size[0] * size[1]) as usize];
            let parts = parts(size, limit, 200, 2);
            for part in &parts {
                assert!(sorted_picture_bytes(*part, 2) <= limit || halves(*part).is_none());
                assert!(part.extent.iter().all(|extent| *extent <= 200));
                for y in part.origin[1]..part.origin[1] + part.extent[1] {
                    for x in part.origin[0]..part.origin[0] + part.extent[0] {
                        covered[(y * size[0] + x) as usize] += 1;
                    }
                }
            }
            assert!(covered.iter().all(|count| *count == 1), "{size:?} {parts:?}");
        }
        assert_eq!(parts([512, 512], 1 << 27, 512, 2).len(), 1);
        assert_eq!(parts([512, 512], 1 << 27, 511, 2).len(), 4);
        assert_eq!(parts([512, 512], 1 << 27, 512, 34).len(), 2);
    }
}
