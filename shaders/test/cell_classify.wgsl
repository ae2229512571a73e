// For tests: one invocation classifies a cell.
//
// Told, in four vec4: volumes; scalars from the first corner's, place on the screen; length, depths, nearness; class, ring, its count, corner.
#use cell/classify.wgsl
#use include/list.wgsl

@group(0) @binding(3) var<storage, read> cells: array<vec4<u32>>;
@group(0) @binding(51) var<storage, read_write> told: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn classify_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = group_number(group, groups) * GROUP + thread;
    if index >= frame.cells {
        return;
    }
    let found = classify(cells[index]);
    told[4u * index] = found.volumes;
    told[4u * index + 1u] = vec4<f32>(found.scalars, found.screen);
    told[4u * index + 2u] = vec4<f32>(found.length, found.depth, found.nearness);
    told[4u * index + 3u] = vec4<f32>(vec4<u32>(found.class_number, found.ring, found.ring_count, found.corner));
}
