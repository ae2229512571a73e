// Which tiles cells in rings touch: one group looks through the items of one tile.

#use include/frame.wgsl
#use include/list.wgsl

@group(0) @binding(10) var<storage, read> drawn: array<vec4<u32>>;
@group(0) @binding(11) var<storage, read> tile_starts: array<u32>;
@group(0) @binding(12) var<storage, read> tile_items: array<u32>;
@group(0) @binding(81) var<storage, read_write> ring_tiles: array<u32>;

var<workgroup> found: atomic<u32>;

@compute @workgroup_size(GROUP)
fn find_rings(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let tile = group_number(group, groups);
    let is_tile = tile < frame.tiles.x * frame.tiles.y;
    if is_tile {
        for (var item = tile_starts[tile] + local; item < tile_starts[tile + 1u]; item += GROUP) {
            if (drawn[tile_items[item]].z & RING_BIT) != 0u {
                atomicOr(&found, 1u);
            }
        }
    }
    workgroupBarrier();
    if is_tile && local == 0u {
        ring_tiles[tile] = atomicLoad(&found);
    }
}
