// Which tiles cells in rings touch: one group looks through the items of one tile, and marks with RING_BIT where they begin.

#use include/frame.wgsl
#use include/list.wgsl

@group(0) @binding(10) var<storage, read> drawn: array<vec4<u32>>;
@group(0) @binding(11) var<storage, read_write> tile_starts: array<atomic<u32>>;
@group(0) @binding(12) var<storage, read> tile_items: array<u32>;

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
        // Others may be marked already.
        let end = atomicLoad(&tile_starts[tile + 1u]) & ~RING_BIT;
        for (var item = (atomicLoad(&tile_starts[tile]) & ~RING_BIT) + local; item < end; item += GROUP) {
            if (drawn[tile_items[item]].z & RING_BIT) != 0u {
                atomicOr(&found, 1u);
            }
        }
    }
    workgroupBarrier();
    if is_tile && local == 0u {
        atomicOr(&tile_starts[tile], select(0u, RING_BIT, atomicLoad(&found) != 0u));
    }
}
