// Where each tile's items begin among the pairs, which are sorted by tile.
//
// One invocation looks for one tile's first pair by halving; one more than there are tiles, for the end.
//
// in: frame, pair_tiles (ascending), totals[PAIRS_WRITTEN]; out: tile_starts.

#use include/frame.wgsl
#use include/list.wgsl

@group(0) @binding(11) var<storage, read_write> tile_starts: array<u32>;
@group(0) @binding(18) var<storage, read_write> totals: array<u32>;
@group(0) @binding(32) var<storage, read_write> pair_tiles: array<u32>;

@compute @workgroup_size(GROUP)
fn find_starts(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let tile = group_number(group_id, groups) * GROUP + thread;
    if (tile > frame.tiles.x * frame.tiles.y || tile >= arrayLength(&tile_starts)) {
        return;
    }
    var low = 0u;
    var high = min(totals[PAIRS_WRITTEN], arrayLength(&pair_tiles));
    while (low < high) {
        let middle = low + (high - low) / 2u;
        if (pair_tiles[middle] < tile) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    tile_starts[tile] = low;
}
