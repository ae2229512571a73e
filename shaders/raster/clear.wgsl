// A picture with nothing in it: one invocation a pixel, count of a tile, or a part of what a pixel that sorts has to know.

#use include/frame.wgsl
#use include/list.wgsl

@group(0) @binding(13) var<storage, read_write> picture: array<vec4<u32>>;

@compute @workgroup_size(GROUP)
fn clear(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let place = group_number(group, groups) * GROUP + local;
    if place < arrayLength(&picture) {
        picture[place] = vec4<u32>(0u);
    }
}
