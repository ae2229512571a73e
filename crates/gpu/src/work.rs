//! Memory of a frame: the cells of a block, their places in tiles, and the picture.

use tetrascope_scene::TargetBits;
use wgpu::{Buffer, BufferUsages};

use crate::Gpu;
use crate::draw::Path;
use crate::kept::TOTALS;
use crate::part::{picture_bytes, sorted_picture_bytes};
use crate::stopwatch::DeviceStopwatch;
use crate::triangles::LARGEST_RECORD;
use crate::view::Part;

/// Most cells of a block: their memory stays below some 200 MB, and a block keeps every device busy.
pub(crate) const MOST_IN_BLOCK: u32 = 1 << 22;
/// The same for drivers that are programs for processors: Mesa's ends an invocation's loops after 65536 turns together, without a word.
const MOST_IN_SOFTWARE: u32 = 1 << 14;
/// Cells of a tile that a run of pixels that sort looks at with such drivers: a turn for each is the least, and how many more there are depends on
/// window and shading, so that it is halved where loops are ended all the same.
const MOST_IN_SLICE: u32 = 1 << 13;
/// Fewest: as many as a group sets up at once.
const LEAST_IN_SLICE: u32 = 1 << 6;
/// Blocks of an order whose cells are blended in 16 bits: each is added up in 32, so that few layers round in 16.
const BLOCKS_OF_16_BITS: u32 = 64;

/// Most cells of a block on a device, by a path.
pub(crate) fn most_in_block(gpu: &Gpu, path: Path, cells: u32) -> u32 {
    let most = if gpu.description().is_software() { MOST_IN_SOFTWARE } else { MOST_IN_BLOCK };
    // The list of what is drawn of each cell is one binding.
    let of_list = (gpu.largest_binding() / LARGEST_RECORD).min(u64::from(most)) as u32;
    let most = if path == Path::Compute { most } else { of_list };
    match path {
        Path::Triangles(TargetBits::Sixteen) => most.min(cells.div_ceil(BLOCKS_OF_16_BITS).max(LEAST_IN_BLOCK)),
        _ => most,
    }
}

/// Most cells of a tile that a run of pixels that sort looks at on a device; 0 for all of them.
pub(crate) fn most_in_slice(gpu: &Gpu) -> u32 {
    if gpu.description().is_software() { MOST_IN_SLICE } else { 0 }
}

/// Half of that; `None` if that is few, or if all are looked at.
pub(crate) fn half_slice(slice: u32) -> Option<u32> {
    (slice > LEAST_IN_SLICE).then_some(slice / 2)
}

/// Fewest: blocks of fewer cells cost more than the picture.
pub(crate) const LEAST_IN_BLOCK: u32 = 1 << 10;
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
    /// - `in_block`: most cells of a block, if it need not be whole
    pub(crate) fn new(cells: u32, whole: bool, limit: u64, in_block: u32) -> Self {
        let most = (limit / BYTES_PER_CELL).min(u64::from(u32::MAX)) as u32;
        let cells = cells.max(1).min(if whole { most } else { most.min(in_block) });
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
    part: Part,
    state: u32,
}

impl Work {
    /// - `cells`: of a block
    /// - `state`: what a pixel that sorts has to know from run to run, in pixels
    pub(crate) fn new(gpu: &Gpu, cells: u32, part: Part, state: u32) -> Self {
        let extra = (TOTALS * 4) as u64 + DeviceStopwatch::BYTES;
        Self {
            drawn: gpu.storage("drawn", u64::from(cells) * BYTES_PER_CELL),
            picture: gpu.storage("picture", sorted_picture_bytes(part, state)),
            read_back: gpu.buffer(
                "read-back",
                picture_bytes(part) + extra,
                BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            ),
            cells,
            part,
            state,
        }
    }

    /// Whether it has room.
    ///
    /// Its picture is for parts of one size: what pixels have to know comes right behind.
    pub(crate) fn fits(&self, cells: u32, part: Part, state: u32) -> bool {
        self.cells >= cells && self.part.extent == part.extent && self.state == state
    }

    /// Width and height of its picture.
    pub(crate) fn extent(&self) -> [u32; 2] {
        self.part.extent
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
        let plan = BlockPlan::new(5_000_000, false, limit, MOST_IN_BLOCK);
        assert_eq!(plan.cells, MOST_IN_BLOCK);
        assert_eq!(BlockPlan::new(5_000_000, true, limit, MOST_IN_SOFTWARE).cells, 5_000_000);
        let more = plan.with_room(20_000_000, false, limit).unwrap();
        assert!(more.cells == plan.cells && more.pairs >= 20_000_000);
        assert_eq!(BlockPlan::new(5_000_000, false, limit, MOST_IN_SOFTWARE).cells, MOST_IN_SOFTWARE);
        // 33 million pairs are all that fit: half of the cells may have so many.
        let less = more.with_room(40_000_000, false, limit).unwrap();
        assert_eq!(less.cells, plan.cells / 2);
        assert_eq!(more.with_room(40_000_000, true, limit), None);
        assert_eq!(BlockPlan { cells: LEAST_IN_BLOCK, pairs: 0 }.with_room(1 << 40, false, limit), None);
        assert!(BlockPlan::new(0, false, limit, MOST_IN_BLOCK).cells > 0);
    }
}
