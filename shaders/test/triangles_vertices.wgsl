// What the vertices of fans carry, for comparison with the classification on the CPU: one invocation writes the twelve of one cell: nearness,
// difference, both scalars over the depth; then the place on the screen and whether it is the thick vertex.

#use triangles/list.wgsl
#use triangles/fan.wgsl
#use triangles/screen.wgsl

@group(0) @binding(40) var<storage, read> fans: array<vec4<u32>>;
@group(0) @binding(44) var<storage, read_write> found: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn vertices_of_fans(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= cells_of_block() {
        return;
    }
    let corners = corners_of(vertices_of(id.x));
    for (var number = 0u; number < 12u; number++) {
        let at = fan_vertex(corners, fans[id.x], number);
        let place = 2u * (12u * id.x + number);
        found[place] = vec4<f32>(at.nearness, at.difference, at.front, at.back);
        found[place + 1u] = vec4<f32>(screen_place(at.point, at.beside), corners.depth, f32(corners.scalar) * LATTICE_STEP);
    }
}
