// Pairs of tile and cell: which tiles each cell of the draw block may show in.
//
// One invocation looks at one cell; cells of many tiles are left to all threads of the group together. `pairs_count`: how many tiles each
// cell has; between the two stages these become prefix sums; `pairs_write`: the pairs, cell by cell. Tiles of one cell may come in any
// order: pairs are sorted by tile afterwards, and a cell has each tile once.
//
// in: frame, block, drawn (and what the outline's file takes), work.most (cells that there is room for); between: pair_starts (one more
// than work.most); out: pair_tiles and tile_items (tile, place in drawn), totals[1] (pairs that are needed, the most of all draws since
// it was cleared), totals[PAIRS_WRITTEN] (the pairs, or 0 if there is not enough room; nothing is written then).

#use include/frame.wgsl
#use include/list.wgsl
#use include/work.wgsl
#use include/block.wgsl
#use <outline>

// Tiles up to which a cell's own thread looks at them.
const FEW_TILES: u32 = 16u;

@group(0) @binding(10) var<storage, read> drawn: array<vec4<u32>>;
@group(0) @binding(12) var<storage, read_write> tile_items: array<u32>;
@group(0) @binding(18) var<storage, read_write> totals: array<u32>;
@group(0) @binding(31) var<storage, read_write> pair_starts: array<u32>;
@group(0) @binding(32) var<storage, read_write> pair_tiles: array<u32>;

var<workgroup> outlines: array<vec4<i32>, GROUP>;
// Threads whose cells have many tiles, in any order.
var<workgroup> large: array<u32, GROUP>;
var<workgroup> large_count: atomic<u32>;
// Pairs of each thread's cell so far.
var<workgroup> found: array<atomic<u32>, GROUP>;

// Cells of the block: no more than the order has.
fn cells_in_block() -> u32 {
    return min(min(block.count, totals[0] - min(block.first, totals[0])), work.most);
}

// A box of tiles.
struct Tiles {
    first: vec2<u32>,
    across: u32,
    count: u32,
}

fn tiles_of(outline: vec4<i32>) -> Tiles {
    let origin = vec2<i32>(frame.origin);
    let last_tile = vec2<i32>(frame.tiles) - 1;
    let side = i32(TILE_SIDE);
    if (any(outline.xy > outline.zw) || any(outline.zw < origin) || any(last_tile < vec2<i32>(0))) {
        return Tiles(vec2<u32>(0u), 1u, 0u);
    }
    let first = max(outline.xy - origin, vec2<i32>(0)) / side;
    let last = min((outline.zw - origin) / side, last_tile);
    if (any(first > last)) {
        return Tiles(vec2<u32>(0u), 1u, 0u);
    }
    let size = vec2<u32>(last - first + 1);
    return Tiles(vec2<u32>(first), size.x, size.x * size.y);
}

fn tile_at(tiles: Tiles, place: u32) -> vec2<u32> {
    return tiles.first + vec2<u32>(place % tiles.across, place / tiles.across);
}

// A cell's entry of `cells`.
fn vertices_at(place: u32) -> vec4<u32> {
    let entry = drawn[place];
    return vec4<u32>(entry.xy, entry.z & ~RING_BIT, entry.w);
}

// Finds the outline of the thread's cell, and leaves the cell to the group if it has many tiles; all threads know then.
fn find_tiles(place: u32, count: u32, thread: u32) -> Tiles {
    var outline = vec4<i32>(0, 0, -1, -1);
    if (place < count) {
        outline = find_outline(vertices_at(place));
    }
    outlines[thread] = outline;
    let tiles = tiles_of(outline);
    if (tiles.count > FEW_TILES) {
        large[atomicAdd(&large_count, 1u)] = thread;
    }
    workgroupBarrier();
    return tiles;
}

@compute @workgroup_size(GROUP)
fn pairs_count(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let first = group_number(group_id, groups) * GROUP;
    let place = first + thread;
    let own = find_tiles(place, cells_in_block(), thread);
    if (own.count > 0u && own.count <= FEW_TILES) {
        let vertices = vertices_at(place);
        var shown = 0u;
        for (var k = 0u; k < own.count; k++) {
            shown += select(0u, 1u, may_show(vertices, outlines[thread], tile_at(own, k)));
        }
        atomicStore(&found[thread], shown);
    }
    let many = atomicLoad(&large_count);
    for (var i = 0u; i < many; i++) {
        let owner = large[i];
        let outline = outlines[owner];
        let tiles = tiles_of(outline);
        let vertices = vertices_at(first + owner);
        var shown = 0u;
        for (var k = thread; k < tiles.count; k += GROUP) {
            shown += select(0u, 1u, may_show(vertices, outline, tile_at(tiles, k)));
        }
        if (shown > 0u) {
            atomicAdd(&found[owner], shown);
        }
    }
    workgroupBarrier();
    if (place <= work.most) {
        pair_starts[place] = atomicLoad(&found[thread]);
    }
}

fn write_pair(pair: u32, tile: vec2<u32>, place: u32) {
    pair_tiles[pair] = tile.y * frame.tiles.x + tile.x;
    tile_items[pair] = place;
}

@compute @workgroup_size(GROUP)
fn pairs_write(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let first = group_number(group_id, groups) * GROUP;
    let place = first + thread;
    var count = cells_in_block();
    let needed = pair_starts[count];
    let is_room = needed <= min(block.capacity, arrayLength(&pair_tiles));
    if (place == 0u) {
        totals[1] = max(totals[1], needed);
        totals[PAIRS_WRITTEN] = select(0u, needed, is_room);
    }
    // Without room no cell has tiles.
    count = select(0u, count, is_room);
    let own = find_tiles(place, count, thread);
    if (own.count > 0u && own.count <= FEW_TILES) {
        let vertices = vertices_at(place);
        var pair = pair_starts[place];
        for (var k = 0u; k < own.count; k++) {
            let tile = tile_at(own, k);
            if (may_show(vertices, outlines[thread], tile)) {
                write_pair(pair, tile, place);
                pair++;
            }
        }
    }
    let many = atomicLoad(&large_count);
    for (var i = 0u; i < many; i++) {
        let owner = large[i];
        let outline = outlines[owner];
        let tiles = tiles_of(outline);
        let vertices = vertices_at(first + owner);
        let start = pair_starts[first + owner];
        for (var k = thread; k < tiles.count; k += GROUP) {
            let tile = tile_at(tiles, k);
            if (may_show(vertices, outline, tile)) {
                write_pair(start + atomicAdd(&found[owner], 1u), tile, first + owner);
            }
        }
    }
}
