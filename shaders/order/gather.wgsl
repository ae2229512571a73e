// The cells of a draw block, fetched into their order: what comes after reads them one after the other.
//
// One invocation fetches one cell, if it is in the part of the mesh that `cells` holds. RING_BIT moves from its number to its third vertex.

#use include/list.wgsl
#use include/block.wgsl

// First cell of the part that `cells` holds, and how many.
@group(0) @binding(80) var<uniform> chunk: vec4<u32>;
@group(0) @binding(3) var<storage, read> cells: array<vec4<u32>>;
@group(0) @binding(9) var<storage, read> order: array<u32>;
@group(0) @binding(10) var<storage, read_write> drawn: array<vec4<u32>>;
@group(0) @binding(18) var<storage, read> totals: array<u32>;

@compute @workgroup_size(GROUP)
fn gather(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let place = group_number(group, groups) * GROUP + local;
    if place >= block.count || block.first + place >= totals[0] {
        return;
    }
    let number = order[block.first + place];
    let cell = number & ~RING_BIT;
    if cell >= chunk.x && cell - chunk.x < chunk.y {
        let vertices = cells[cell - chunk.x];
        drawn[place] = vec4<u32>(vertices.xy, vertices.z | (number & RING_BIT), vertices.w);
    }
}
