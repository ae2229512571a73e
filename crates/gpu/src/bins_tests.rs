//! Bins against those of the CPU, with outlines that are the vertex indices themselves.

use tetrascope_shaders::layout::{Block, Frame, NEGATIVE_BIT, RING_BIT, TILE_SIDE};
use wgpu::ComputePassDescriptor;

use crate::Gpu;
use crate::bins::{Bins, BinsKernels, BinsSize};
use crate::scan::ListKernels;
use crate::testing::{Numbers, checked, contents, gpu};

/// As `shaders/test/outline.wgsl` has it.
fn tiles_of(frame: &Frame, entry: [u32; 4]) -> Vec<u32> {
    let plain = [entry[0], entry[1], entry[2] & !RING_BIT, entry[3] & !NEGATIVE_BIT];
    let [left, top, right, bottom] = plain.map(|pixel| pixel as i32 - 100);
    if left > right || top > bottom {
        return Vec::new();
    }
    let side = TILE_SIDE as i32;
    let ends = |low: i32, high: i32, axis: usize| {
        let origin = frame.origin[axis] as i32;
        let first = (low - origin).max(0) / side;
        first..((high - origin).div_euclid(side) + 1).clamp(first, (frame.tiles[axis] as i32).max(first))
    };
    let (columns, rows) = (ends(left, right, 0), ends(top, bottom, 1));
    let mut tiles = Vec::new();
    for row in rows {
        for column in columns.clone() {
            let shows = (column * 7 + row * 3 + left + 100) % 5 < 2;
            if entry[3] & NEGATIVE_BIT == 0 || shows {
                tiles.push(row as u32 * frame.tiles[0] + column as u32);
            }
        }
    }
    tiles
}

struct Binned {
    totals: Vec<u32>,
    starts: Vec<u32>,
    items: Vec<u32>,
}

fn binned(gpu: &Gpu, frame: &Frame, drawn: &[[u32; 4]], block: Block, cells_in_order: u32, pairs: u32) -> Binned {
    checked(gpu, || {
        let lists = ListKernels::new(gpu).unwrap();
        let kernels = BinsKernels::new(gpu, "test/outline.wgsl").unwrap();
        let tiles = frame.tiles[0] * frame.tiles[1];
        let starts = gpu.storage("tile_starts", u64::from(tiles + 1) * 4);
        let items = gpu.storage("tile_items", u64::from(pairs) * 4);
        let totals = gpu.storage_of("totals", &[cells_in_order, 0, 0, 0, 0, 0, 0, 0]);
        let (frame, block) = (gpu.uniform_of("frame", frame), gpu.uniform_of("block", &block));
        let drawn_buffer = gpu.storage_of("drawn", drawn);
        let named = [
            ("frame", frame.as_entire_binding()),
            ("block", block.as_entire_binding()),
            ("drawn", drawn_buffer.as_entire_binding()),
            ("tile_starts", starts.as_entire_binding()),
        ];
        let size = BinsSize { cells: drawn.len() as u32, pairs, tiles };
        let bins = Bins::new(gpu, &lists, &kernels, [&items, &totals], &named, size).unwrap();
        assert!(bins.bytes() <= u64::from(pairs) * 25 / 2 + drawn.len() as u64 * 4 + 8192);
        let mut encoder = gpu.encoder("bins");
        bins.record(&mut encoder.begin_compute_pass(&ComputePassDescriptor::default()));
        let totals: Vec<u32> = contents(gpu, encoder, &totals, 5);
        let starts: Vec<u32> = contents(gpu, gpu.encoder("starts"), &starts, tiles as usize + 1);
        let count = starts.last().map_or(0, |&end| end as usize);
        Binned { totals, starts, items: contents(gpu, gpu.encoder("items"), &items, count) }
    })
}

fn frame(origin: [u32; 2], extent: [u32; 2]) -> Frame {
    Frame { origin, extent, tiles: extent.map(|pixels| pixels.div_ceil(TILE_SIDE)), ..Frame::default() }
}

/// Boxes up to so large, a few of the whole part, some empty, in the frame.
fn boxes(frame: &Frame, count: usize, largest: u32, numbers: &mut Numbers) -> Vec<[u32; 4]> {
    (0..count)
        .map(|_| {
            let low = [0, 1].map(|axis| frame.origin[axis] + numbers.below(frame.extent[axis].max(1)));
            let high = [0, 1].map(|axis| {
                let last = (frame.origin[axis] + frame.extent[axis]).saturating_sub(1);
                (low[axis] + numbers.below(largest)).min(last)
            });
            let bits = [numbers.below(2) * RING_BIT, numbers.below(2) * NEGATIVE_BIT];
            let last = [0, 1].map(|axis| frame.origin[axis] + frame.extent[axis] - 1);
            let [low, high] = match numbers.below(200) {
                0 => [frame.origin, last],
                1..20 => [last, [frame.origin[0], last[1]]],
                _ => [low, high],
            };
            [low[0] + 100, low[1] + 100, (high[0] + 100) | bits[0], (high[1] + 100) | bits[1]]
        })
        .collect()
}

fn check(frame: &Frame, drawn: &[[u32; 4]], block: Block, cells_in_order: u32) {
    let Some(gpu) = gpu() else { return };
    let tiles = (frame.tiles[0] * frame.tiles[1]) as usize;
    let count = block.count.min(cells_in_order.saturating_sub(block.first));
    let mut expected = vec![Vec::new(); tiles];
    for (place, entry) in drawn.iter().enumerate().take(count as usize) {
        tiles_of(frame, *entry).into_iter().for_each(|tile| expected[tile as usize].push(place as u32));
    }
    let needed = expected.iter().map(Vec::len).sum::<usize>() as u32;
    for pairs in [needed, needed + 5000] {
        let got = binned(&gpu, frame, drawn, Block { capacity: pairs, ..block }, cells_in_order, pairs);
        assert_eq!(got.totals, [cells_in_order, needed, 0, 0, needed]);
        for (tile, items) in expected.iter().enumerate() {
            let range = got.starts[tile] as usize..got.starts[tile + 1] as usize;
            assert_eq!(&got.items[range], items, "tile {tile} of {tiles}");
        }
    }
    // One pair too few: nothing is listed, and the number is told. Likewise if the buffer is smaller than the block says.
    if needed > 100 {
        let short = Block { capacity: needed - 1, ..block };
        let wrong = Block { capacity: u32::MAX, ..block };
        for (block, pairs) in [(short, needed - 1), (short, needed), (wrong, needed / 8)] {
            let got = binned(&gpu, frame, drawn, block, cells_in_order, pairs);
            assert_eq!(got.totals, [cells_in_order, needed, 0, 0, 0]);
            assert!(got.starts.iter().all(|&start| start == 0) && got.items.is_empty());
        }
    }
}

#[test]
fn cells_come_tile_by_tile() {
    let mut numbers = Numbers::new(8);
    for (origin, extent) in [([0, 0], [64, 48]), ([37, 11], [333, 250]), ([5, 900], [1, 1])] {
        let frame = frame(origin, extent);
        for (count, largest) in [(0, 1), (1, 50), (255, 400), (256, 9), (3001, 30)] {
            let drawn = boxes(&frame, count, largest, &mut numbers);
            check(&frame, &drawn, Block { count: count as u32, ..Block::default() }, count as u32);
        }
    }
}

/// The block ends before the list of the last block does, or after the order.
#[test]
fn a_block_has_no_more_cells_than_the_order() {
    let mut numbers = Numbers::new(9);
    let frame = frame([16, 16], [200, 100]);
    let drawn = boxes(&frame, 1000, 40, &mut numbers);
    for (first, count, in_order) in [(0, 400, 1000), (5000, 1000, 5300), (100, 1000, 50), (0, 1000, 0)] {
        check(&frame, &drawn, Block { first, count, ..Block::default() }, in_order);
    }
}
