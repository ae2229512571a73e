// For tests: one invocation sets up a cell and takes what the ray of a pixel has inside of it.
//
// Asked: number of the cell, column, row, unused. Told, in four vec4: scalars of both ends in lattice steps relative to the first corner's
// in units, length, whether covered; depths of both ends, 0, 0; the outline; entry faces, whether the tile may show, 0, 0.
#use cell/optics.wgsl
#use cell/sample.wgsl
#use cell/set_up.wgsl
#use include/list.wgsl

@group(0) @binding(3) var<storage, read> cells: array<vec4<u32>>;
@group(0) @binding(50) var<storage, read> asked: array<vec4<i32>>;
@group(0) @binding(51) var<storage, read_write> told: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn sample_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = group_number(group, groups) * GROUP + thread;
    if index >= arrayLength(&asked) {
        return;
    }
    let vertices = cells[asked[index].x];
    let pixel = asked[index].yz;
    let cell = set_up(vertices);
    let found = sample(cell, pixel);
    let first = f32(cell.reference - points[bare(vertices).x].w) * LATTICE_STEP;
    let tile = (vec2<u32>(pixel) - frame.origin) / TILE_SIDE;
    let shows = may_show(vertices, cell.outline, tile);
    told[4u * index] = vec4<f32>(first + found.front, first + found.back, found.length, f32(found.covered));
    told[4u * index + 1u] = vec4<f32>(found.depth, 0.0, 0.0);
    told[4u * index + 2u] = vec4<f32>(cell.outline);
    told[4u * index + 3u] = vec4<f32>(f32(cell.entry_count), f32(shows), f32(optics_of(cell).count), 0.0);
}
