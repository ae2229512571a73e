// Classifies the cells of a draw block: one invocation makes the fan of one cell, and the first writes the arguments of the draw.
//
// In: frame, points, drawn, totals, block. Out: fans (a record a cell, see triangles/fan.wgsl), arguments (vertices and instances of the draw).
//
#use include/list.wgsl
#use cell/classify.wgsl
#use triangles/list.wgsl
#use triangles/fan.wgsl

@group(0) @binding(40) var<storage, read_write> fans: array<vec4<u32>>;
@group(0) @binding(41) var<storage, read_write> arguments: array<u32>;

// A cell that is found ray by ray.
const BOX = vec4<u32>(SHAPE_BOX << SHAPE_TRIANGLES, 0u, 0u, 0u);

fn fan_of(vertices: vec4<u32>) -> vec4<u32> {
    let corners = corners_of(vertices);
    let nearest = lowest(corners.depths);
    let farthest = highest(corners.depths);
    if farthest <= 0.0 {
        return vec4<u32>();
    }
    let found = classify(vertices);
    let has_fan = found.ring_count > 0u;
    // Without a fan, before the eye, is what rounding makes of cells that are next to nothing.
    if !has_fan || nearest <= select(0.0, NEAR_SHARE * farthest, frame.is_perspective != 0u) {
        return BOX;
    }

    let is_plus = found.volumes > vec4<f32>();
    let is_minus = found.volumes < vec4<f32>();
    let bits = vec4<u32>(1u, 2u, 4u, 8u);
    let plus = dot(select(vec4<u32>(), bits, is_plus), vec4<u32>(1u));
    let minus = dot(select(vec4<u32>(), bits, is_minus), vec4<u32>(1u));
    let up = dot(max(found.volumes, vec4<f32>()), vec4<f32>(1.0));
    let down = dot(max(-found.volumes, vec4<f32>()), vec4<f32>(1.0));
    var volumes = found.volumes;
    var weights = array<u32, 2>();
    var used = 0u;
    for (var side = 0u; side < 2u; side++) {
        let members = select(minus, plus, side == 0u);
        let sum = select(down, up, side == 0u);
        for (var corner = countTrailingZeros(members) + 1u; corner < 4u; corner++) {
            if ((members >> corner) & 1u) != 0u && used < 2u {
                weights[used] = bitcast<u32>(abs(volumes[corner]) / sum);
                used += 1u;
            }
        }
    }

    let signs = vec4<i32>(select(vec4<i32>(), vec4<i32>(1), is_plus)) - select(vec4<i32>(), vec4<i32>(1), is_minus);
    var shape = u32(27 * (1 - signs.w) + 9 * (1 + signs.z) + 3 * (1 - signs.y) + 1 + signs.x);
    for (var place = 0u; place < found.ring_count; place++) {
        shape |= ring_corner(found.ring, place) << (SHAPE_RING + 2u * place);
    }
    shape |= (found.ring_count - 1u) << SHAPE_TRIANGLES;
    if found.corner < 4u {
        shape |= (found.corner << SHAPE_CORNER) | (1u << SHAPE_HAS_CORNER);
    }
    shape |= (plus << SHAPE_PLUS) | (minus << SHAPE_MINUS);

    let unit = select(1.0, corners.depth, frame.is_perspective != 0u);
    let most = nearness_at(lowest(corners.beyond), nearest) - nearness_at(highest(corners.beyond), farthest);
    // Where rounding makes up all of the volumes the quotient can be anything.
    return vec4<u32>(shape, weights[0], weights[1], bitcast<u32>(min(found.nearness * unit, most)));
}

@compute @workgroup_size(GROUP)
fn fans_of_block(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let place = group_number(group, groups) * GROUP + thread;
    let cells = cells_of_block();
    if place == 0u {
        arguments[0] = 12u;
        arguments[1] = cells;
        arguments[2] = 0u;
        arguments[3] = 0u;
    }
    if place < cells {
        fans[place] = fan_of(vertices_of(place));
    }
}
