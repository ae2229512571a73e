// One invocation: the light of one segment, and what is seen of the cell around it. Tests alone.
#use include/list.wgsl
#use integrate/visible.wgsl
#use <volume>

struct Segment {
    // Lattice scalars.
    reference: i32,
    low: i32,
    high: i32,
    unused: i32,
    // From the reference, in units of 2^29 lattice steps; lengths in local units.
    front: f32,
    back: f32,
    length: f32,
    unused_too: f32,
}

@group(0) @binding(60) var<storage, read> segments: array<Segment>;
@group(0) @binding(61) var<storage, read_write> lights: array<vec4<f32>>;
// First piece, number of pieces, whether the cell is visible, 0.
@group(0) @binding(62) var<storage, read_write> found: array<vec4<u32>>;

@compute @workgroup_size(GROUP)
fn integrate(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = group_number(group, groups) * GROUP + local;
    if (index >= arrayLength(&segments)) {
        return;
    }
    let segment = segments[index];
    let low = f32(segment.low - segment.reference) * LATTICE_STEP;
    let high = f32(segment.high - segment.reference) * LATTICE_STEP;
    let range = find_pieces(segment.reference, low, high);
    let cell = Optics(segment.reference, low, high, range.x, range.y);
    let light = volume(cell, segment.front, segment.back, segment.length);
    lights[index] = vec4<f32>(light.rgb, light.opacity);
    found[index] = vec4<u32>(range, u32(is_visible(segment.low, segment.high)), 0u);
}
