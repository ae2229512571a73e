//! Memory of a frame: the cells of a block, their places in tiles, and the picture.

use wgpu::{Buffer, BufferUsages};

use crate::Gpu;
use crate::kept::TOTALS;
use crate::part::picture_bytes;
use crate::stopwatch::DeviceStopwatch;
use crate::view::Part;

/// Most cells of a block: their memory stays below some 200 MB, and a block keeps every device busy.
pub(crate) const MOST_IN_BLOCK: u32 = 1 << 22;
/// Fewest: blocks of fewer cells cost more than the picture.
pub(crate) const LEAST_IN_BLOCK: u32 = 1 << 12;
/// Bytes of a cell that was fetched.
const BYTES_PER_CELL: u64 = 16;

/// How an order is cut into blocks that are drawn one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BlockPlan {
    /// Cells of a block.
    pub(crate) cells: u32,
    /// Pairs of tile and cell that there is room for; none on the triangle path.
    pub(crate) pairs: u32,
}

impl BlockPlan {
    /// To begin with.
    ///
    /// - `whole`: whether all cells must be in one block, since pixels sort
    /// - `limit`: bytes of one binding
    pub(crate) fn new(cells: u32, whole: bool, limit: u64) -> Self {
        let most = (limit / BYTES_PER_CELL).min(u64::from(u32::MAX)) as u32;
        let cells = cells.max(1).min(if whole { most } else { most.min(MOST_IN_BLOCK) });
        // Most cells touch one tile or two.
        let pairs = (2 * u64::from(cells) + (1 << 14)).min(limit / 4) as u32;
        Self { cells, pairs }
    }

    /// With room for so many pairs, or with less of everything; `None` if neither helps.
    pub(crate) fn with_room(self, pairs: u64, whole: bool, limit: u64) -> Option<Self> {
        // A little more than is needed, since the next view may need it.
        let pairs = pairs + pairs / 8;
        if pairs * 4 <= limit {
            return Some(Self { pairs: pairs as u32, ..self });
        }
        let cells = self.cells / 2;
        (!whole && cells >= LEAST_IN_BLOCK).then_some(Self { cells, pairs: (limit / 4) as u32 })
    }
}

/// What every frame writes anew.
#[derive(Debug)]
pub(crate) struct Work {
    pub(crate) drawn: Buffer,
    pub(crate) picture: Buffer,
    /// What comes back: picture, totals, times.
    pub(crate) read_back: Buffer,
    cells: u32,
    picture_bytes: u64,
}

impl Work {
    /// - `cells`: of a block
    pub(crate) fn new(gpu: &Gpu, cells: u32, part: Part) -> Self {
        let picture_bytes = picture_bytes(part);
        let extra = (TOTALS * 4) as u64 + DeviceStopwatch::BYTES;
        Self {
            drawn: gpu.storage("drawn", u64::from(cells) * BYTES_PER_CELL),
            picture: gpu.storage("picture", picture_bytes),
            read_back: gpu.buffer("read-back", picture_bytes + extra, BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            cells,
            picture_bytes,
        }
    }

    /// Whether it has room.
    pub(crate) fn fits(&self, cells: u32, part: Part) -> bool {
        self.cells >= cells && self.picture_bytes >= picture_bytes(part)
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> [(&'static str, u64); 2] {
        [("cells in order", self.drawn.size()), ("picture", self.picture.size() + self.read_back.size())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_found_or_there_is_none() {
        let limit = 1 << 27;
        let plan = BlockPlan::new(5_000_000, false, limit);
        assert_eq!(plan.cells, MOST_IN_BLOCK);
        assert_eq!(BlockPlan::new(5_000_000, true, limit).cells, 5_000_000);
        let more = plan.with_room(20_000_000, false, limit).unwrap();
        assert!(more.cells == plan.cells && more.pairs >= 20_000_000);
        // 33 million pairs are all that fit: half of the cells may have so many.
        let less = more.with_room(40_000_000, false, limit).unwrap();
        assert_eq!(less.cells, plan.cells / 2);
        assert_eq!(more.with_room(40_000_000, true, limit), None);
        assert_eq!(BlockPlan { cells: LEAST_IN_BLOCK, pairs: 0 }.with_room(1 << 40, false, limit), None);
        assert!(BlockPlan::new(0, false, limit).cells > 0);
    }
}
