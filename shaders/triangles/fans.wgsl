// Classifies the cells of a draw block: one invocation makes the fan of one cell, and the first writes the arguments of the draw.
//
// In: frame, points, drawn, totals, block. Out: fans (a record a cell, see triangles/fan.wgsl), arguments (vertices and instances of the draw).
//
// The four signed volumes that the eye makes with the faces are taken from edges and one vector to the eye, so that distance costs no
// digits; all sums run over terms of one sign. A tiny volume of the wrong sign changes a cell's class and not its picture.

#use include/list.wgsl
#use triangles/list.wgsl
#use triangles/fan.wgsl

@group(0) @binding(40) var<storage, read_write> fans: array<vec4<u32>>;
@group(0) @binding(41) var<storage, read_write> arguments: array<u32>;

struct Volumes {
    // One for each face, of the corner opposite: above 0 where the face is turned away from the eye.
    faces: vec4<f32>,
    // Six times the cell's.
    six_volume: f32,
}

fn volumes_of(corners: Corners) -> Volumes {
    let a = corners.points[0];
    let b = corners.points[1];
    let ab = between(a, b);
    let ac = between(a, corners.points[2]);
    let ad = between(a, corners.points[3]);
    let opposite_a = cross(between(b, corners.points[2]), between(b, corners.points[3]));
    let opposite_b = cross(ad, ac);
    let opposite_c = cross(ab, ad);
    let opposite_d = cross(ac, ab);
    var faces = vec4<f32>(opposite_a.z, opposite_b.z, opposite_c.z, opposite_d.z);
    if frame.is_perspective != 0u {
        let to_a = vec3<f32>(a.xyz) * LATTICE_STEP - frame.eye.xyz;
        let to_b = vec3<f32>(b.xyz) * LATTICE_STEP - frame.eye.xyz;
        faces = vec4<f32>(dot(opposite_a, to_b), dot(opposite_b, to_a), dot(opposite_c, to_a), dot(opposite_d, to_a));
    }
    let sign = select(1.0, -1.0, corners.is_negative);
    return Volumes(sign * faces, -sign * dot(opposite_d, ad));
}

// Corners by a mask, ascending, two bits each.
fn members_of(mask: u32) -> vec4<u32> {
    var members = vec4<u32>();
    var count = 0u;
    for (var corner = 0u; corner < 4u; corner++) {
        if ((mask >> corner) & 1u) != 0u {
            members[count] = corner;
            count += 1u;
        }
    }
    return members;
}

// The ring of corners around the thick vertex, the triangles, and the thick vertex's corner, as bits of the shape.
fn shape_of(plus: u32, minus: u32) -> u32 {
    let p = members_of(plus);
    let n = members_of(minus);
    let z = members_of(15u & ~(plus | minus));
    let p_count = countOneBits(plus);
    let n_count = countOneBits(minus);
    var ring = array<u32, 5>(p.x, n.x, p.y, n.y, p.x);
    var triangles = 4u;
    var corner = 0u;
    if p_count != 2u || n_count != 2u {
        // The corner that is alone with its sign; of two that cover each other the nearer.
        let is_plus = p_count == 1u;
        corner = select(n.x, p.x, is_plus) | 4u;
        let others = select(p, n, vec4<bool>(is_plus));
        triangles = p_count + n_count - 1u;
        if triangles == 3u {
            ring = array<u32, 5>(others.x, others.y, others.z, others.x, 0u);
        } else if triangles == 2u {
            ring = array<u32, 5>(others.x, z.x, others.y, 0u, 0u);
        } else {
            ring = array<u32, 5>(z.x, z.y, 0u, 0u, 0u);
        }
    }
    let bits = ring[0] | (ring[1] << 2u) | (ring[2] << 4u) | (ring[3] << 6u) | (ring[4] << 8u);
    return (bits << SHAPE_RING) | (triangles << SHAPE_TRIANGLES) | (corner << SHAPE_CORNER);
}

fn fan_of(corners: Corners) -> vec4<u32> {
    let is_perspective = frame.is_perspective != 0u;
    let nearest = lowest(corners.depths);
    let farthest = highest(corners.depths);
    let volumes = volumes_of(corners);
    if !(volumes.six_volume > 0.0) || farthest <= 0.0 {
        return vec4<u32>();
    }
    if nearest <= select(0.0, NEAR_SHARE * farthest, is_perspective) {
        return vec4<u32>(SHAPE_BOX << SHAPE_TRIANGLES, 0u, 0u, 0u);
    }
    let is_plus = volumes.faces > vec4<f32>();
    let is_minus = volumes.faces < vec4<f32>();
    let bits = vec4<u32>(1u, 2u, 4u, 8u);
    let plus = dot(select(vec4<u32>(), bits, is_plus), vec4<u32>(1u));
    let minus = dot(select(vec4<u32>(), bits, is_minus), vec4<u32>(1u));
    if plus == 0u || minus == 0u {
        // What no corners before the eye give, and rounding does.
        return vec4<u32>(SHAPE_BOX << SHAPE_TRIANGLES, 0u, 0u, 0u);
    }
    let up = dot(max(volumes.faces, vec4<f32>()), vec4<f32>(1.0));
    let down = dot(max(-volumes.faces, vec4<f32>()), vec4<f32>(1.0));

    var weights = array<f32, 2>();
    var used = 0u;
    for (var side = 0u; side < 2u; side++) {
        let members = select(minus, plus, side == 0u);
        let sum = select(down, up, side == 0u);
        for (var corner = countTrailingZeros(members) + 1u; corner < 4u; corner++) {
            if ((members >> corner) & 1u) != 0u && used < 2u {
                weights[used] = abs(volumes.faces[corner]) / sum;
                used += 1u;
            }
        }
    }

    let signs = vec4<i32>(select(vec4<i32>(), vec4<i32>(1), is_plus)) - select(vec4<i32>(), vec4<i32>(1), is_minus);
    let code = u32(27 * (1 - signs.w) + 9 * (1 + signs.z) + 3 * (1 - signs.y) + 1 + signs.x);
    let shape = code | shape_of(plus, minus) | (plus << SHAPE_PLUS) | (minus << SHAPE_MINUS);

    // Along the chord, 1 / near depth - 1 / far depth is six volumes over the sum above and the near depth: no difference to cancel.
    let near = chord_end(corners, plus, vec2<f32>(weights[0], weights[1]));
    var difference = volumes.six_volume / (0.5 * up + 0.5 * down);
    if is_perspective {
        difference = corners.depth / (corners.depth + near.beyond) * (volumes.six_volume / up);
    }
    let most = nearness_at(lowest(corners.beyond), nearest) - nearness_at(highest(corners.beyond), farthest);
    // Where rounding makes up all of the volumes the quotient can be anything.
    return vec4<u32>(shape, bitcast<u32>(weights[0]), bitcast<u32>(weights[1]), bitcast<u32>(min(difference, most)));
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
        fans[place] = fan_of(corners_of(vertices_of(place)));
    }
}
