// Projection: one invocation takes one vertex of the mesh along the camera's axes, about the base of the view.
//
// In integers, so that every device has the same bits and the differences of two points are exact: within 2 lattice steps of the truth.
#use include/frame.wgsl
#use include/list.wgsl
#use cell/wide.wgsl

// Position in lattice steps along the mesh's axes, and scalar.
@group(0) @binding(1) var<storage, read> vertices: array<vec4<i32>>;
// Position from the base in lattice steps: right, down, forward; and scalar.
@group(0) @binding(2) var<storage, read_write> points: array<vec4<i32>>;

// The place along an axis, which is in units of 2^-30.
fn along(axis: vec4<i32>, position: vec3<i32>) -> i32 {
    let sum = wide_sum(
        wide_sum(wide_product(axis.x, position.x), wide_product(axis.y, position.y)),
        wide_product(axis.z, position.z),
    );
    return wide_rounded(sum, 30u) - axis.w;
}

@compute @workgroup_size(GROUP)
fn project(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = group_number(group, groups) * GROUP + thread;
    if index >= frame.points {
        return;
    }
    let vertex = vertices[index];
    let place = vec3<i32>(along(frame.right, vertex.xyz), along(frame.down, vertex.xyz), along(frame.forward, vertex.xyz));
    points[index] = vec4<i32>(place, vertex.w);
}
