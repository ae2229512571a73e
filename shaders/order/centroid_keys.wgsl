// Keys of the order by centroids: its squared distance from the eye, or its depth in an orthographic view.
//
// One invocation makes one entry's key. The squared distance c·c - 2 c·e + e·e is taken without e·e, which all cells share, so that far
// eyes still tell neighbors apart; f32, rounded to about 2^-23 of its size. The depth is exact: the mean of whole numbers, rounded down.
//
// in: frame, points, cells, order, totals[0], work.most; out: keys (ascending: front to back).

#use include/frame.wgsl
#use include/list.wgsl
#use include/work.wgsl

@group(0) @binding(2) var<storage, read> points: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> cells: array<vec4<u32>>;
@group(0) @binding(9) var<storage, read> order: array<u32>;
@group(0) @binding(18) var<storage, read> totals: array<u32>;
@group(0) @binding(21) var<storage, read_write> keys: array<u32>;

// The mean, rounded down, without leaving 32 bits.
fn mean(a: vec3<i32>, b: vec3<i32>, c: vec3<i32>, d: vec3<i32>) -> vec3<i32> {
    let two = vec3<u32>(2u);
    let three = vec3<i32>(3);
    let rest = (a & three) + (b & three) + (c & three) + (d & three);
    return (a >> two) + (b >> two) + (c >> two) + (d >> two) + (rest >> two);
}

// Bits that ascend with the number.
fn sortable_bits(value: f32) -> u32 {
    let bits = bitcast<u32>(value);
    return select(bits | 0x80000000u, ~bits, (bits & 0x80000000u) != 0u);
}

@compute @workgroup_size(GROUP)
fn centroid_keys(
    @builtin(workgroup_id) group_id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let place = group_number(group_id, groups) * GROUP + thread;
    if (place >= min(totals[0], work.most)) {
        return;
    }
    let corners = cells[order[place] & ~RING_BIT];
    let centroid = mean(
        points[corners.x].xyz,
        points[corners.y].xyz,
        points[corners.z].xyz,
        points[corners.w & ~NEGATIVE_BIT].xyz,
    );
    if (frame.is_perspective == 0u) {
        keys[place] = bitcast<u32>(centroid.z) ^ 0x80000000u;
        return;
    }
    let eye = frame.eye.xyz;
    // Eyes may be so far that products would overflow.
    let farthest = max(max(abs(eye.x), abs(eye.y)), max(abs(eye.z), 1.0));
    let c = vec3<f32>(centroid) * LATTICE_STEP;
    keys[place] = sortable_bits(dot(c, c / farthest - 2.0 * (eye / farthest)));
}
